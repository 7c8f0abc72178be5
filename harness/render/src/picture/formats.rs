//! Formats of the targets that a tile's samples are drawn to.

/// Format of the samples. f32, because radiance spans more than f16 holds exactly, and references
/// are compared in linear light.
pub(crate) const SAMPLE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;
/// Format of the depth buffer.
pub(crate) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
