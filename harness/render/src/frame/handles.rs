//! Places of a frame's parts: indices into its lists.

/// A buffer of a frame: its index in [`Frame::resources`](super::Frame::resources).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Buffer(pub(super) usize);

/// A texture of a frame: its index in [`Frame::resources`](super::Frame::resources).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Texture(pub(super) usize);

/// A sampler of a frame: its index in [`Frame::resources`](super::Frame::resources).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Sampler(pub(super) usize);

/// A pipeline of a frame: its index in [`Frame::pipelines`](super::Frame::pipelines).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct PipelineId(pub(super) usize);

/// A bind group of a frame: its index in [`Frame::bind_groups`](super::Frame::bind_groups).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct BindGroupId(pub(super) usize);

/// Resource at a binding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Bound {
    /// A whole buffer.
    Buffer(Buffer),
    /// A whole texture.
    Texture(Texture, wgpu::TextureViewDimension),
    /// A sampler.
    Sampler(Sampler),
}

impl From<Buffer> for Bound {
    fn from(buffer: Buffer) -> Self {
        Self::Buffer(buffer)
    }
}

impl From<Sampler> for Bound {
    fn from(sampler: Sampler) -> Self {
        Self::Sampler(sampler)
    }
}

impl From<Texture> for Bound {
    /// Binds the texture with two dimensions.
    fn from(texture: Texture) -> Self {
        Self::Texture(texture, wgpu::TextureViewDimension::D2)
    }
}
