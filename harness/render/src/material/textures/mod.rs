//! Images of materials in a frame, as the part `material_textures` reads them.

pub(crate) mod levels;
mod normals;

use crate::frame::record::Record;
use crate::frame::{Bound, Builder, PipelineId, level_size};
use glam::{Vec3, Vec4};
use lapidary_scene::{Encoding, Material, Mesh, Texture, TextureTransform, Wrap};
use normals::{Normals, texel_length};

/// Bindings of the part, in group 1.
const BASE_COLOR: [u32; 2] = [11, 12];
const NORMAL: [u32; 2] = [13, 14];
const THICKNESS: [u32; 2] = [16, 17];
const TRANSMISSION: [u32; 2] = [18, 19];
const ROUGHNESS: [u32; 2] = [20, 21];

/// Fills a `TexturePlace` for a texture; the identity for none.
pub(crate) fn place(record: Record, texture: Option<&Texture>) -> Record {
    let [u, v] = rows(texture.map_or(TextureTransform::IDENTITY, |texture| texture.transform));
    record.with("u", u).with("v", v)
}

/// Returns the rows of a map of texture coordinates.
pub(crate) fn rows(transform: TextureTransform) -> [Vec3; 2] {
    let map = transform.affine();
    [0, 1].map(|row| map.matrix2.row(row).extend(map.translation[row]))
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
        (&material.diffuse_transmission_texture, "transmission image", "transmission image's sampler", TRANSMISSION),
        (&material.metallic_roughness_texture, "roughness image", "roughness image's sampler", ROUGHNESS),
    ] {
        let (Some(texture), true) = (slot, reads(builder, bindings)) else { continue };
        let texels = &texture.texels;
        let image = builder.image((texels, texture.encoding), |builder| {
            let format = match texture.encoding {
                Encoding::Srgb => wgpu::TextureFormat::Rgba8UnormSrgb,
                Encoding::Linear => wgpu::TextureFormat::Rgba8Unorm,
            };
            let size = [texels.width(), texels.height(), 1];
            builder.mipped(name, format, size, levels::of_image(texels, texture.encoding))
        });
        let sampler = builder.sampler(sampler, texture.wrap.map(address));
        bound.extend([(bindings[0], image.into()), (bindings[1], sampler.into())]);
    }
    if let (Some(texture), true) = (&material.normal_texture, reads(builder, NORMAL)) {
        let layers =
            Normals::of(texture, material.normal_scale).layers(texture.wrap, reach / texel_length(mesh, texture));
        let size = [layers.size[0], layers.size[1], 4];
        let image = builder.mipped("normals by image", wgpu::TextureFormat::Rg16Float, size, layers.levels());
        let sampler = builder.sampler("normal image's sampler", texture.wrap.map(address));
        let image = Bound::Texture(image, wgpu::TextureViewDimension::D2Array);
        bound.extend([(NORMAL[0], image), (NORMAL[1], sampler.into())]);
    }
    bound
}

/// Longest side in texels of an image that rays look up; of a larger one they see a smaller level.
const LARGEST_MET: u32 = 2048;

/// Returns the size of an image, and its levels: linear RGBA, or, of normals whose slopes have a `scale`, their x and y.
pub(crate) fn levels_of(texture: &Texture, scale: Option<f32>) -> ([u32; 2], Vec<Vec<Vec4>>) {
    let texels = &texture.texels;
    let (mut size, first) = match scale {
        Some(scale) => {
            let (size, slopes) = Normals::of(texture, scale).slopes();
            (size, slopes.into_iter().map(|slopes| slopes.extend(0.0).extend(0.0)).collect())
        }
        None => {
            let decoded = texels.bytes().chunks_exact(4);
            let decoded = decoded.map(|texel| texture.encoding.decoded([texel[0], texel[1], texel[2], texel[3]]));
            ([texels.width(), texels.height()], decoded.collect::<Vec<Vec4>>())
        }
    };
    let mut levels = levels::of_linear(size, first);
    while size[0].max(size[1]) > LARGEST_MET {
        size = level_size(size, 1);
        levels.remove(0);
    }
    (size, levels)
}

fn address(wrap: Wrap) -> wgpu::AddressMode {
    match wrap {
        Wrap::Repeat => wgpu::AddressMode::Repeat,
        Wrap::MirroredRepeat => wgpu::AddressMode::MirrorRepeat,
        Wrap::ClampToEdge => wgpu::AddressMode::ClampToEdge,
    }
}
