//! Images of materials in a frame, as the part `material_textures` reads them.

use crate::frame::{Bound, Builder, Contents, PipelineId};
use crate::record::Record;
use exr::prelude::f16;
use glam::{Vec2, Vec3};
use lapidary_scene::{Encoding, Material, Mesh, Texels, Texture, TextureTransform, Wrap};

/// Bindings of the part, in group 1.
const BASE_COLOR: [u32; 2] = [11, 12];
const NORMAL: [u32; 2] = [13, 14];
const THICKNESS: [u32; 2] = [16, 17];
/// Longest side of the normals' layers in texels. Of larger images each layer holds every second texel, or fewer:
/// they would take a gigabyte.
const LARGEST_NORMALS: u32 = 2048;
/// Widest blur of the normals, as a standard deviation in texels.
const WIDEST_BLUR: f32 = 16.0;

/// Fills a `TexturePlace` for a texture; the identity for none.
pub(crate) fn place(record: Record, texture: Option<&Texture>) -> Record {
    let transform = texture.map_or(TextureTransform::IDENTITY, |texture| texture.transform).affine();
    let row =
        |row: usize| Vec3::new(transform.matrix2.row(row).x, transform.matrix2.row(row).y, transform.translation[row]);
    record.with("u", row(0)).with("v", row(1))
}

/// Adds the images that a pipeline reads of a body's material, and the samplers; returns them by binding. `reach` is how
/// far each channel's light spreads and evens out slopes, as a standard deviation in units of length.
pub(crate) fn bound(
    builder: &mut Builder<'_>,
    pipeline: PipelineId,
    material: &Material,
    (mesh, reach): (&Mesh, Vec3),
) -> Vec<(u32, Bound)> {
    let mut bound: Vec<(u32, Bound)> = Vec::new();
    let reads = |builder: &Builder<'_>, bindings: [u32; 2]| builder.binds(pipeline, 1, bindings[0]);
    for (slot, name, sampler, bindings) in [
        (&material.base_color_texture, "base colour image", "base colour image's sampler", BASE_COLOR),
        (&material.thickness_texture, "thickness image", "thickness image's sampler", THICKNESS),
    ] {
        let (Some(texture), true) = (slot, reads(builder, bindings)) else { continue };
        let texels = &texture.texels;
        let format = match texture.encoding {
            Encoding::Srgb => wgpu::TextureFormat::Rgba8UnormSrgb,
            Encoding::Linear => wgpu::TextureFormat::Rgba8Unorm,
        };
        let contents = Contents::Bytes(texels.bytes().to_vec());
        let size = [texels.width(), texels.height(), 1];
        let image = builder.texture(name, (wgpu::TextureDimension::D2, format), size, contents);
        let sampler = builder.sampler(sampler, texture.wrap.map(address));
        bound.extend([(bindings[0], image.into()), (bindings[1], sampler.into())]);
    }
    if let (Some(texture), true) = (&material.normal_texture, reads(builder, NORMAL)) {
        let layers =
            Normals::of(texture, material.normal_scale).layers(texture.wrap, reach / texel_length(mesh, texture));
        let format = (wgpu::TextureDimension::D2, wgpu::TextureFormat::Rg16Float);
        let contents = Contents::Bytes(layers.bytes);
        let image = builder.texture("normals by image", format, [layers.size[0], layers.size[1], 4], contents);
        let sampler = builder.sampler("normal image's sampler", texture.wrap.map(address));
        let image = Bound::Texture(image, wgpu::TextureViewDimension::D2Array);
        bound.extend([(NORMAL[0], image), (NORMAL[1], sampler.into())]);
    }
    bound
}

fn address(wrap: Wrap) -> wgpu::AddressMode {
    match wrap {
        Wrap::Repeat => wgpu::AddressMode::Repeat,
        Wrap::MirroredRepeat => wgpu::AddressMode::MirrorRepeat,
        Wrap::ClampToEdge => wgpu::AddressMode::ClampToEdge,
    }
}

/// Returns the length of a texel's side on the body: the root of the mean area. 0 where the mesh has no area; infinite
/// where the coordinates have none.
fn texel_length(mesh: &Mesh, texture: &Texture) -> f32 {
    let transform = texture.transform.affine();
    let size = Vec2::new(texture.texels.width() as f32, texture.texels.height() as f32);
    let texels = mesh.indices.chunks_exact(3).map(|corners| {
        let place = |corner: usize| size * transform.transform_point2(mesh.uvs[corners[corner] as usize]);
        let [a, b, c] = [0, 1, 2].map(place);
        0.5 * f64::from((b - a).perp_dot(c - a).abs())
    });
    let (_, area) = mesh.volume_and_area();
    (area / texels.sum::<f64>()).sqrt() as f32
}

/// Unit normals of an image, row by row.
struct Normals {
    size: [u32; 2],
    normals: Vec<Vec3>,
    /// Texels of the image along a side of one of these.
    step: u32,
}

/// The layers' bytes: x and y of each normal as half floats.
struct Layers {
    size: [u32; 2],
    bytes: Vec<u8>,
}

impl Normals {
    /// Returns an image's normals, with their slopes scaled.
    fn of(texture: &Texture, scale: f32) -> Self {
        let texels: &Texels = &texture.texels;
        let longest = texels.width().max(texels.height());
        let step = longest.div_ceil(LARGEST_NORMALS);
        let size = [texels.width(), texels.height()].map(|side| side.div_ceil(step));
        let normal = |row: u32, column: u32| {
            let texel = texture.encoding.decoded(texels.at(column * step, row * step));
            let tilt = (2.0 * texel.truncate() - 1.0) * Vec3::new(scale, scale, 1.0);
            tilt.try_normalize().unwrap_or(Vec3::Z)
        };
        let normals = (0..size[1]).flat_map(|row| (0..size[0]).map(move |column| (row, column)));
        let normals = normals.map(|(row, column)| normal(row, column)).collect();
        Self { size, normals, step }
    }

    /// Returns the normals as they are, and blurred with a Gaussian of each of these widths in texels of the image.
    fn layers(&self, wrap: [Wrap; 2], widths: Vec3) -> Layers {
        let mut bytes = Vec::new();
        let mut add = |normals: &[Vec3]| {
            for normal in normals {
                bytes.extend([normal.x, normal.y].into_iter().flat_map(|part| f16::from_f32(part).to_le_bytes()));
            }
        };
        add(&self.normals);
        for width in widths.to_array() {
            add(&self.blurred(wrap, width / self.step as f32));
        }
        Layers { size: self.size, bytes }
    }

    /// Returns the directions of the means by a Gaussian of this width.
    fn blurred(&self, [along, down]: [Wrap; 2], width: f32) -> Vec<Vec3> {
        let width = if width.is_finite() { width.min(WIDEST_BLUR) } else { 0.0 };
        let reach = (3.0 * width).ceil() as i64;
        if reach == 0 {
            return self.normals.clone();
        }
        let weight = |step: i64| (-0.5 * (step as f32 / width).powi(2)).exp();
        let weights: Vec<f32> = (-reach..=reach).map(weight).collect();
        let whole: f32 = weights.iter().sum();
        let weights: Vec<f32> = weights.into_iter().map(|weight| weight / whole).collect();
        let [width, height] = self.size.map(i64::from);
        let places = |count: i64, wrap: Wrap| -> Vec<usize> {
            (-reach..count + reach).map(|place| wrap.texel(place, count) as usize).collect()
        };
        let (columns, rows) = (places(width, along), places(height, down));
        let place = |row: usize, column: usize| row * width as usize + column;
        let mut once = Vec::with_capacity(self.normals.len());
        for row in 0..height as usize {
            for column in 0..width as usize {
                let beside = &columns[column..=column + 2 * reach as usize];
                once.push(
                    weights
                        .iter()
                        .zip(beside)
                        .map(|(weight, at)| *weight * self.normals[place(row, *at)])
                        .sum::<Vec3>(),
                );
            }
        }
        let mut twice = Vec::with_capacity(self.normals.len());
        for row in 0..height as usize {
            let beside = &rows[row..=row + 2 * reach as usize];
            for column in 0..width as usize {
                let mean: Vec3 =
                    weights.iter().zip(beside).map(|(weight, at)| *weight * once[place(*at, column)]).sum();
                twice.push(mean.try_normalize().unwrap_or(Vec3::Z));
            }
        }
        twice
    }
}

#[cfg(test)]
mod tests;
