//! What a frame creates: buffers, textures and samplers, with their contents.

use lapidary_specialise::layout::StructLayout;

/// A buffer, texture or sampler.
#[derive(Clone, Debug)]
pub struct Resource {
    /// Name: `object/what`, or `what` alone if all objects share it. Not unique: each tile has a
    /// `view`.
    pub name: String,
    /// The object that it is made for; empty if all objects share it.
    pub object: String,
    /// Kind of the resource, with its properties.
    pub kind: ResourceKind,
}

/// Kind of a resource.
#[derive(Clone, Debug, PartialEq)]
pub enum ResourceKind {
    /// A buffer.
    Buffer {
        /// Size in bytes.
        size: u64,
        /// Allowed usages.
        usage: wgpu::BufferUsages,
        /// Initial contents.
        contents: Contents,
        /// Name and layout of the struct that it holds, once or as an array; `None` for plain
        /// arrays.
        layout: Option<(&'static str, &'static StructLayout)>,
    },
    /// A texture with one sample per texel.
    Texture {
        /// Width, height, and depth or number of layers, in texels.
        size: [u32; 3],
        /// Number of mip levels, each half as wide and half as high as the one before, rounded down, and at least 1.
        levels: u32,
        /// One, two or three dimensions.
        dimension: wgpu::TextureDimension,
        /// Format of a texel.
        format: wgpu::TextureFormat,
        /// Allowed usages.
        usage: wgpu::TextureUsages,
        /// Initial contents, row by row without gaps, layer by layer, level by level.
        contents: Contents,
    },
    /// A sampler.
    Sampler {
        /// Filter for magnification and minification, and between mip levels.
        filter: wgpu::FilterMode,
        /// Address modes along u and v.
        address: [wgpu::AddressMode; 2],
    },
}

/// Initial contents of a resource.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Contents {
    /// Zeros.
    Zeros,
    /// These bytes.
    Bytes(Vec<u8>),
    /// Contents that a device computes, left out because the frame was made without one. Such a
    /// frame cannot be run.
    LeftOut,
}

impl From<Vec<u8>> for Contents {
    fn from(bytes: Vec<u8>) -> Self {
        Self::Bytes(bytes)
    }
}

impl Resource {
    /// Drops its bytes, which are somewhere else.
    pub(super) fn leave_out(&mut self) {
        if let ResourceKind::Buffer { contents, .. } | ResourceKind::Texture { contents, .. } = &mut self.kind
            && matches!(contents, Contents::Bytes(_))
        {
            *contents = Contents::LeftOut;
        }
    }

    /// Whether its contents are [`Contents::LeftOut`].
    #[must_use]
    pub fn is_left_out(&self) -> bool {
        let (ResourceKind::Buffer { contents, .. } | ResourceKind::Texture { contents, .. }) = &self.kind else {
            return false;
        };
        *contents == Contents::LeftOut
    }

    /// Returns the size of its contents in bytes, driver overhead excluded; 0 for a sampler.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        match &self.kind {
            ResourceKind::Buffer { size, .. } => *size,
            ResourceKind::Texture { size, levels, format, .. } => {
                let [width, height, layers] = *size;
                let texels = |[width, height]: [u32; 2]| u64::from(width) * u64::from(height) * u64::from(layers);
                let texels: u64 = (0..*levels).map(|level| texels(level_size([width, height], level))).sum();
                texels * u64::from(texel_bytes(*format))
            }
            ResourceKind::Sampler { .. } => 0,
        }
    }
}

/// Returns the width and height of a mip level of a texture of this width and height.
pub(crate) fn level_size(size: [u32; 2], level: u32) -> [u32; 2] {
    size.map(|side| side.checked_shr(level).unwrap_or_default().max(1))
}

/// Returns the bytes of a texel. Only formats without blocks of several texels are used; depth has
/// 32 bits.
pub(crate) fn texel_bytes(format: wgpu::TextureFormat) -> u32 {
    format.block_copy_size(None).unwrap_or_default()
}
