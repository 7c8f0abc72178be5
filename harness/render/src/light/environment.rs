//! The light around the scene, as a texture and as harmonics.

use crate::error::RenderError;
use crate::frame::{Builder, Contents, Texture};
use crate::settings::Settings;
use glam::DVec3;
use lapidary_plan::Effect;
use lapidary_scene::{Environment, harmonics};

/// The smallest difference in radiance times exposure that counts: half a step of an 8-bit display,
/// taken as linear.
pub const LEAST_DIFFERENCE: f64 = 1.0 / 510.0;

/// An upper bound on the procedural studio's radiance, in any channel: no two of its lights
/// overlap, the brightest has 20 in red, and the tent at most 0.26 there.
pub const STUDIO_LARGEST: f32 = 20.4;

/// Returns a radiance that no channel of the environment exceeds from any direction. For a map it
/// is the largest texel's, since a mix of texels lies between them.
pub fn largest_radiance(environment: &Environment) -> f32 {
    match environment {
        Environment::Studio => STUDIO_LARGEST,
        Environment::Map(map) => map.pixels.iter().flat_map(|texel| &texel[..3]).copied().fold(0.0, f32::max),
    }
}

/// Returns the environment map as a texture. For the studio, which has no map, it is one black
/// texel, so that recipes that read a map still have one to bind.
pub(crate) fn texture(builder: &mut Builder<'_>, environment: &Environment) -> Result<Texture, RenderError> {
    let black = [[0f32; 4]];
    let (width, height, pixels): (u32, u32, &[[f32; 4]]) = match environment {
        Environment::Studio => (1, 1, &black),
        Environment::Map(map) => (map.width, map.height, &map.pixels),
    };
    let limit = builder.limits().max_texture_dimension_2d;
    if width.max(height) > limit {
        let bytes = std::mem::size_of_val(pixels) as u64;
        let what = format!("an environment map of {width}x{height} (at most {limit} a side)");
        return Err(RenderError::TooLarge { what, bytes, limit: u64::from(limit) * u64::from(limit) * 16 });
    }
    let format = (wgpu::TextureDimension::D2, wgpu::TextureFormat::Rgba32Float);
    let contents = Contents::Bytes(bytemuck::cast_slice(pixels).to_vec());
    Ok(builder.texture("environment map", format, [width, height, 1], contents))
}

/// Returns the harmonics of the environment that lights matte surfaces; 0 if it is left out.
pub(crate) fn around(settings: &Settings) -> [DVec3; harmonics::COUNT] {
    if settings.without.has(Effect::Environment) {
        return [DVec3::ZERO; harmonics::COUNT];
    }
    harmonics::project(&settings.environment)
}
