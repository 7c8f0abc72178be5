//! The light around the scene, on the device.

use super::device::{self, view};
use super::{Environment, RenderError};
use lapidary_gpu::Gpu;

/// The environment map as a texture; one black texel where the studio stands in, for a recipe's text that reads it all the same.
pub(super) fn texture(gpu: &Gpu, environment: &Environment) -> Result<wgpu::TextureView, RenderError> {
    let black = [[0f32; 4]];
    let (width, height, pixels): (u32, u32, &[[f32; 4]]) = match environment {
        Environment::Studio => (1, 1, &black),
        Environment::Map(map) => (map.width, map.height, &map.pixels),
    };
    let limit = gpu.device.limits().max_texture_dimension_2d;
    if width.max(height) > limit {
        let bytes = std::mem::size_of_val(pixels) as u64;
        let what = format!("an environment map of {width}x{height} (at most {limit} a side)");
        return Err(RenderError::TooLarge { what, bytes, limit: u64::from(limit) * u64::from(limit) * 16 });
    }
    let texture = gpu.guarded("uploading the environment", |_| {
        let format = (wgpu::TextureDimension::D2, wgpu::TextureFormat::Rgba32Float);
        device::texture(gpu, "environment map", format, [width, height, 1], bytemuck::cast_slice(pixels))
    })?;
    Ok(view(&texture))
}
