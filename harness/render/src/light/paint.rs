//! Images of a scene's bodies and colours of their vertices, as the part `scene_images` reads them.

use crate::error::RenderError;
use crate::frame::{Bound, Builder, Texture as Bounded, level_size};
use crate::material::textures::{levels_of, rows};
use exr::prelude::f16;
use glam::{Vec2, Vec3, Vec4};
use lapidary_plan::{Effects, IMAGES_MET};
use lapidary_scene::{Material, Texture, TextureSlot, Wrap};
use std::sync::Arc;

/// Bindings in group 0: texels of numbers, and images.
pub(crate) const BINDINGS: [u32; 2] = [19, 20];

/// Texels of numbers in a row.
const ROW: usize = 4096;
/// Images in a texture that every device offers.
const MOST_IMAGES: usize = 256;
/// Bytes that all images together take at most; of larger ones, smaller levels are kept.
const MOST_BYTES: u64 = 512 << 20;
/// Texels of an image's entry.
const ENTRY: usize = 3;
/// Levels of an image, each its texels row by row.
type Levels = Vec<Vec<Vec4>>;

/// What bodies' images and vertices hold, before it is in a frame.
#[derive(Default)]
pub(crate) struct Paint {
    /// Entries of the bodies' images, from texel 1 on.
    entries: Vec<Vec4>,
    /// Two texels for each corner.
    corners: Vec<Vec4>,
    layers: Vec<Layer>,
    /// Angle between the rays of neighbouring samples.
    footprint: f32,
}

struct Layer {
    texture: Texture,
    /// Of normals, the factor of the slopes; not a number for other images.
    scale: f32,
    size: [u32; 2],
    levels: Levels,
}

impl Paint {
    pub(crate) fn new(footprint: f32) -> Self {
        Self { footprint, ..Self::default() }
    }

    /// Adds the images of a body; returns the number of its first texel, 0 if it has none.
    pub(crate) fn body(&mut self, material: &Material, without: Effects) -> Result<u32, RenderError> {
        let images = IMAGES_MET.map(|(effect, slot)| (slot, material.effective(slot).filter(|_| !without.has(effect))));
        if images.iter().all(|(_, texture)| texture.is_none()) {
            return Ok(0);
        }
        let first = 1 + self.entries.len() as u32;
        for (slot, texture) in images {
            let entry = match texture {
                Some(texture) => self.entry(slot, texture, material)?,
                None => [Vec4::NEG_ONE; ENTRY],
            };
            self.entries.extend(entry);
        }
        Ok(first)
    }

    /// Returns `SceneImage` of the part.
    fn entry(
        &mut self,
        slot: TextureSlot,
        texture: &Texture,
        material: &Material,
    ) -> Result<[Vec4; ENTRY], RenderError> {
        let scale = if slot == TextureSlot::Normal { material.normal_scale } else { f32::NAN };
        let is_known = |known: &Layer| {
            let same = Arc::ptr_eq(&known.texture.texels, &texture.texels);
            same && known.texture.encoding == texture.encoding && known.scale.to_bits() == scale.to_bits()
        };
        let layer = match self.layers.iter().position(is_known) {
            Some(known) => known,
            None if self.layers.len() == MOST_IMAGES => return Err(RenderError::TooManyImages { limit: MOST_IMAGES }),
            None => {
                let (size, levels) = levels_of(texture, (slot == TextureSlot::Normal).then_some(scale));
                self.layers.push(Layer { texture: texture.clone(), scale, size, levels });
                self.shrink();
                self.layers.len() - 1
            }
        };
        let [u, v] = rows(texture.transform);
        let wrap = texture.wrap.map(code);
        let (share, cutoff) =
            material.coverage.map_or((-1.0, -1.0), |coverage| (coverage.share, coverage.cutoff.unwrap_or(-1.0)));
        // The size follows once all images are there.
        Ok([u.extend(layer as f32), v.extend((wrap[0] + 4 * wrap[1]) as f32), Vec4::new(0.0, 0.0, share, cutoff)])
    }

    /// Takes the first level from the largest images until all together take no more than they may.
    fn shrink(&mut self) {
        while self.bytes() > MOST_BYTES {
            let longest = |layer: &Layer| layer.size[0].max(layer.size[1]);
            let largest = self.layers.iter().map(longest).max().unwrap_or(1);
            for layer in self.layers.iter_mut().filter(|layer| longest(layer) == largest) {
                layer.size = level_size(layer.size, 1);
                layer.levels.remove(0);
            }
        }
    }

    /// Returns the width and height that hold all images.
    fn size(&self) -> [u32; 2] {
        [0, 1].map(|axis| self.layers.iter().map(|layer| layer.size[axis]).max().unwrap_or(1))
    }

    /// Returns the bytes of the texture of all images, whose levels together take a third more than the first.
    fn bytes(&self) -> u64 {
        let [width, height] = self.size().map(u64::from);
        self.layers.len() as u64 * width * height * 8 / 3 * 4
    }

    /// Adds a corner of a triangle whose body's images start at a texel.
    pub(crate) fn corner(&mut self, images: u32, uv: Vec2, color: Vec3) {
        self.corners.extend([Vec4::new(uv.x, uv.y, images as f32, 0.0), color.extend(0.0)]);
    }

    /// Adds both textures to a frame, the second one of a single black texel if there are no images.
    pub(crate) fn bound(&self, builder: &mut Builder<'_>) -> Result<[(u32, Bound); 2], RenderError> {
        let first = 1 + self.entries.len();
        let head = Vec4::new(first as f32, self.footprint, 0.0, 0.0);
        let mut texels = vec![head];
        texels.extend(&self.entries);
        for entry in texels[1..].chunks_exact_mut(ENTRY) {
            if let Some(layer) = self.layers.get(entry[0].w as usize).filter(|_| entry[0].w >= 0.0) {
                let [width, height] = layer.size.map(|side| side as f32);
                (entry[2].x, entry[2].y) = (width, height);
            }
        }
        texels.extend(&self.corners);
        let rows = texels.len().div_ceil(ROW);
        let most = wgpu::Limits::default().max_texture_dimension_2d as usize;
        let bytes = (rows * ROW * size_of::<Vec4>()) as u64;
        if rows > most {
            return Err(RenderError::too_large(bytes, "the colours and texture coordinates of the scene".to_owned()));
        }
        texels.resize(rows * ROW, Vec4::ZERO);
        let numbers = bytemuck::cast_slice(&texels).to_vec();
        let (size, levels) = self.stacked();
        let [numbers, images]: [Bounded; 2] = builder.of_object("", |builder| {
            let size_of_numbers = [ROW as u32, rows as u32, 1];
            let numbers =
                builder.mipped("texture coordinates", wgpu::TextureFormat::Rgba32Float, size_of_numbers, (1, numbers));
            [numbers, builder.mipped("images of bodies", wgpu::TextureFormat::Rgba16Float, size, levels)]
        });
        let images = Bound::Texture(images, wgpu::TextureViewDimension::D2Array);
        Ok([(BINDINGS[0], numbers.into()), (BINDINGS[1], images)])
    }

    /// Returns the size of the texture of all images, the number of its levels, and their bytes, layer by layer, level by level.
    fn stacked(&self) -> ([u32; 3], (u32, Vec<u8>)) {
        let Self { layers, .. } = self;
        if layers.is_empty() {
            return ([1; 3], (1, vec![0; size_of::<[f16; 4]>()]));
        }
        let size = self.size();
        let count = size[0].max(size[1]).ilog2() + 1;
        let mut texels: Vec<[f16; 4]> = Vec::new();
        for level in 0..count {
            let [width, height] = level_size(size, level);
            for layer in layers {
                let start = texels.len();
                texels.resize(start + (width * height) as usize, [f16::ZERO; 4]);
                let Some(of_level) = layer.levels.get(level as usize) else { continue };
                let own = level_size(layer.size, level)[0] as usize;
                for (row, of_row) in of_level.chunks_exact(own).enumerate() {
                    let place = start + row * width as usize;
                    for (texel, value) in texels[place..place + own].iter_mut().zip(of_row) {
                        *texel = value.to_array().map(f16::from_f32);
                    }
                }
            }
        }
        let bytes = texels.iter().flatten().flat_map(|part| part.to_le_bytes()).collect();
        ([size[0], size[1], layers.len() as u32], (count, bytes))
    }
}

/// Returns the part's number of a way to go on beyond an image's edge.
fn code(wrap: Wrap) -> u32 {
    match wrap {
        Wrap::Repeat => 0,
        Wrap::MirroredRepeat => 1,
        Wrap::ClampToEdge => 2,
    }
}
