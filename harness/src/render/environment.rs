//! The light around the scene, on the device.

use super::device::view;
use super::{Environment, RenderError};
use crate::gpu::Gpu;
use wgpu::util::DeviceExt as _;

/// The environment map as a texture; one black texel where the studio stands in.
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
    let texture = gpu.guarded("uploading the environment", |device| {
        device.create_texture_with_data(
            &gpu.queue,
            &wgpu::TextureDescriptor {
                label: Some("environment"),
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: wgpu::TextureFormat::Rgba32Float,
                usage: wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            },
            wgpu::util::TextureDataOrder::LayerMajor,
            bytemuck::cast_slice(pixels),
        )
    })?;
    Ok(view(&texture))
}
