//! The table in the formats that a texture may have, and its lookup as a sampler does it.

pub use super::bake::bake;
use glam::{UVec2, Vec2, Vec3};
use lapidary_cdrf as mirror;
use lapidary_scene::solver::Format;

/// Returns the nearest value that the format holds.
pub fn round(format: Format, value: f32) -> f32 {
    match format {
        Format::Rgba8 => (value * 255.0).round() / 255.0,
        Format::Rgba16Float => exr::prelude::f16::from_f32(value).to_f32(),
        Format::R32Float => value,
    }
}

/// Returns the texture's format.
pub fn format(format: Format) -> wgpu::TextureFormat {
    match format {
        Format::Rgba8 => wgpu::TextureFormat::Rgba8Unorm,
        Format::Rgba16Float => wgpu::TextureFormat::Rgba16Float,
        Format::R32Float => wgpu::TextureFormat::R32Float,
    }
}

/// Returns the bytes of `texels` in the texture's format; alpha, if the format has one, is 1.
pub fn texels(format: Format, texels: &[Vec3]) -> Vec<u8> {
    let colors = || texels.iter().flat_map(|texel| texel.extend(1.0).to_array());
    match format {
        Format::Rgba8 => colors().map(|value| (value * 255.0).round() as u8).collect(),
        Format::Rgba16Float => {
            let half = |value| exr::prelude::f16::from_f32(value).to_le_bytes();
            colors().flat_map(half).collect()
        }
        Format::R32Float => texels.iter().flat_map(|texel| texel.x.to_le_bytes()).collect(),
    }
}

/// A baked table in a texture's format.
#[derive(Clone, Debug)]
pub struct Table {
    size: UVec2,
    texels: Vec<Vec3>,
}

impl Table {
    /// Stores the texels, row by row, rounded to the format.
    ///
    /// # Panics
    /// If the number of texels does not match `size`.
    pub fn new(size: UVec2, format: Format, texels: &[Vec3]) -> Table {
        assert_eq!(texels.len(), (size.x * size.y) as usize, "a table of {size}");
        let kept = |texel: &Vec3| Vec3::new(round(format, texel.x), round(format, texel.y), round(format, texel.z));
        Table { size, texels: texels.iter().map(kept).collect() }
    }

    /// Returns the bilinear lookup at a point of the table, where 0 and 1 are the centres of its
    /// first and last texel.
    fn at(&self, coordinates: Vec2) -> Vec3 {
        let around = mirror::texels(coordinates, self.size);
        let texel = |column: u32, row: u32| self.texels[(row * self.size.x + column) as usize];
        mirror::blend(
            around.weight,
            texel(around.lower.x, around.lower.y),
            texel(around.upper.x, around.lower.y),
            texel(around.lower.x, around.upper.y),
            texel(around.upper.x, around.upper.y),
        )
    }

    /// Returns the value of a linear sampler that clamps to the edge, at `texture`, fractions of
    /// the texture's size.
    fn sample(&self, texture: Vec2) -> Vec3 {
        let size = self.size.as_vec2();
        self.at((texture * size - 0.5) / (size - 1.0))
    }

    /// Returns the reflectance looked up by hand: texels and weights.
    pub fn lookup(&self, cosine: f32, sigma: f32) -> Vec3 {
        self.at(mirror::table_coordinates(cosine, sigma))
    }

    /// Returns the reflectance looked up through a sampler.
    pub fn sampled(&self, cosine: f32, sigma: f32) -> Vec3 {
        self.sample(mirror::texture_coordinates(mirror::table_coordinates(cosine, sigma), self.size))
    }

    /// Like [`Table::sampled`], with the half texel left out.
    pub fn sampled_naive(&self, cosine: f32, sigma: f32) -> Vec3 {
        self.sample(mirror::texture_coordinates_naive(mirror::table_coordinates(cosine, sigma)))
    }
}
