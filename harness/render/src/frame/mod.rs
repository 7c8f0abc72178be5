//! A frame as data: resources with their contents, pipelines, bind groups, and passes in order.
//!
//! [`Builder`] makes a frame, [`Executor`] runs it on wgpu, [`Frame::write`] writes it for another
//! host. Running a frame requires no knowledge of techniques.

mod build;
mod document;
mod execute;

pub(crate) use build::Readback;
pub use build::{Builder, PipelineSource};
pub use document::{Document, WriteError};
pub use execute::Executor;

use crate::shader::Shader;
use lapidary_specialise::layout::StructLayout;

/// A buffer of a frame: its index in [`Frame::resources`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Buffer(usize);

/// A texture of a frame: its index in [`Frame::resources`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Texture(usize);

/// A sampler of a frame: its index in [`Frame::resources`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Sampler(usize);

/// A pipeline of a frame: its index in [`Frame::pipelines`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct PipelineId(usize);

/// A bind group of a frame: its index in [`Frame::bind_groups`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct BindGroupId(usize);

/// Everything created and run for a picture.
#[derive(Clone, Debug, Default)]
pub struct Frame {
    /// Buffers, textures and samplers.
    pub resources: Vec<Resource>,
    /// Pipelines, each once.
    pub pipelines: Vec<Pipeline>,
    /// Resources that the pipelines read and write.
    pub bind_groups: Vec<BindGroup>,
    /// Passes, in the order in which they run.
    pub passes: Vec<Pass>,
}

impl Frame {
    /// Returns the buffers whose contents differ in `next`, with these contents: all that a host
    /// uploads to run `next` on this frame's resources. `None` if anything else differs.
    #[must_use]
    pub fn changes<'a>(&self, next: &'a Self) -> Option<Vec<(Buffer, &'a [u8])>> {
        let same = self.resources.len() == next.resources.len()
            && self.pipelines.len() == next.pipelines.len()
            && self.pipelines.iter().zip(&next.pipelines).all(|(one, other)| one.runs_as(other))
            && self.bind_groups == next.bind_groups
            && self.passes == next.passes;
        if !same {
            return None;
        }
        let mut changes = Vec::new();
        for (place, (one, other)) in self.resources.iter().zip(&next.resources).enumerate() {
            match (&one.kind, &other.kind) {
                (one, other) if one == other => {}
                (
                    ResourceKind::Buffer { size, usage, contents: Contents::Bytes(_), .. },
                    ResourceKind::Buffer { size: next_size, contents: Contents::Bytes(bytes), .. },
                ) if size == next_size && usage.contains(wgpu::BufferUsages::COPY_DST) => {
                    changes.push((Buffer(place), &bytes[..]));
                }
                _ => return None,
            }
        }
        Some(changes)
    }

    /// Returns a resource's name.
    #[must_use]
    pub fn name(&self, Buffer(place): Buffer) -> &str {
        &self.resources[place].name
    }
}

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

impl Resource {
    /// Drops its bytes, which are somewhere else.
    fn leave_out(&mut self) {
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

/// A pipeline without an explicit layout: bind groups use the layout derived from its shader.
#[derive(Clone, Debug)]
pub struct Pipeline {
    /// Name: the recipe's for a graphics pipeline, the entry point's for a compute pipeline. If
    /// several would have the same name, `#2`, `#3` and so on are appended.
    pub name: String,
    /// The shader, specialised.
    pub shader: Shader,
    /// Graphics or compute.
    pub kind: PipelineKind,
}

impl Pipeline {
    /// Whether the other one has the same code and the same state.
    fn runs_as(&self, other: &Self) -> bool {
        self.name == other.name
            && self.kind == other.kind
            && self.shader.is_specialised_as(&other.shader)
            && self.shader.wgsl().ok() == other.shader.wgsl().ok()
    }
}

/// Kind of a pipeline.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PipelineKind {
    /// Triangles without vertex buffers, with counter-clockwise front faces. The shader's first
    /// entry point is the vertex stage, its second the fragment stage.
    Render {
        /// Formats of its colour targets.
        targets: Vec<wgpu::TextureFormat>,
        /// Format of its depth buffer; `None` if it has none. The depth test is `less`, and depth
        /// is written.
        depth: Option<wgpu::TextureFormat>,
        /// Faces that are culled; `None` if all are drawn.
        cull: Option<wgpu::Face>,
        /// How a texel is joined with what is there; `None` if it replaces that.
        blend: Option<Blend>,
    },
    /// The shader's only entry point.
    Compute,
}

/// How colour and alpha are joined with what is there, both with factors of one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Blend {
    /// Operation on the colour.
    pub color: wgpu::BlendOperation,
    /// Operation on alpha.
    pub alpha: wgpu::BlendOperation,
}

/// Resources that a pipeline reads and writes in one group.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct BindGroup {
    /// Pipeline whose layout the group has.
    pub pipeline: PipelineId,
    /// Number of the group.
    pub group: u32,
    /// Resources by binding number: all that the pipeline uses in this group.
    pub entries: Vec<(u32, Bound)>,
}

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

/// One step of a frame.
#[derive(Clone, Debug, PartialEq)]
pub enum Pass {
    /// Draws to targets.
    Render(RenderPass),
    /// Dispatches.
    Compute(ComputePass),
    /// Sets the first bytes of a buffer to 0.
    Clear {
        /// The buffer.
        buffer: Buffer,
        /// Number of bytes, a multiple of 4.
        bytes: u64,
    },
    /// Copies the first bytes of one buffer to another.
    Copy {
        /// Source.
        from: Buffer,
        /// Destination.
        to: Buffer,
        /// Number of bytes, a multiple of 4.
        bytes: u64,
    },
    /// Copies the upper left part of a texture to a buffer, and reads it back to the host.
    Read(Read),
}

/// A pass of draws.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderPass {
    /// Name of the pass.
    pub name: String,
    /// Colour targets, one for each target of the pipelines.
    pub targets: Vec<Target>,
    /// The depth buffer; `None` if there is none.
    pub depth: Option<Depth>,
    /// Left, top, width and height in texels; `None` for the whole target.
    pub viewport: Option<[u32; 4]>,
    /// Draws, in order.
    pub draws: Vec<Draw>,
}

/// A colour target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// The texture that is drawn to.
    pub texture: Texture,
    /// Layer of the texture.
    pub layer: u32,
    /// Clear value: red, green, blue, alpha; `None` if what is there stays.
    pub clear: Option<[f64; 4]>,
}

/// A depth buffer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Depth {
    /// The texture that is drawn to.
    pub texture: Texture,
    /// Whether what is there stays; cleared to 1 otherwise.
    pub load: bool,
    /// Whether it is kept for later passes.
    pub keep: bool,
}

impl From<Texture> for Depth {
    /// Is cleared, and not kept.
    fn from(texture: Texture) -> Self {
        Self { texture, load: false, keep: false }
    }
}

impl From<Texture> for Target {
    /// Takes the first layer, cleared to 0.
    fn from(texture: Texture) -> Self {
        Self { texture, layer: 0, clear: Some([0.0; 4]) }
    }
}

/// A draw.
#[derive(Clone, Debug, PartialEq)]
pub struct Draw {
    /// The object that it is for; empty if it is for all objects.
    pub object: String,
    /// Pipeline of the draw.
    pub pipeline: PipelineId,
    /// Bind groups by group number; `None` if the pipeline has no such group.
    pub groups: Vec<Option<BindGroupId>>,
    /// Number of vertices.
    pub vertices: u32,
    /// Number of instances.
    pub instances: u32,
    /// Part of the targets that may change: left, top, width and height in texels. `None` for all of
    /// them. Either all draws of a pass have one or none has.
    pub scissor: Option<[u32; 4]>,
}

/// A pass of dispatches.
#[derive(Clone, Debug, PartialEq)]
pub struct ComputePass {
    /// Name of the pass.
    pub name: String,
    /// Dispatches, in order.
    pub dispatches: Vec<Dispatch>,
    /// How many times all of them are run, one after the other.
    pub repeat: u32,
}

/// A dispatch.
#[derive(Clone, Debug, PartialEq)]
pub struct Dispatch {
    /// The object that it is for; empty if it is for all objects.
    pub object: String,
    /// Pipeline of the dispatch.
    pub pipeline: PipelineId,
    /// Bind groups by group number; `None` if the pipeline has no such group.
    pub groups: Vec<Option<BindGroupId>>,
    /// Number of workgroups.
    pub workgroups: Workgroups,
}

/// Number of workgroups of a dispatch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Workgroups {
    /// Number along each axis.
    Count([u32; 3]),
    /// The first three words of a buffer.
    Indirect(Buffer),
}

/// A part of a texture that is read back to the host.
#[derive(Clone, Debug, PartialEq)]
pub struct Read {
    /// Name of the picture that it belongs to.
    pub picture: &'static str,
    /// Source texture; its upper left part is read.
    pub texture: Texture,
    /// Width and height in texels.
    pub size: [u32; 2],
    /// Position in the picture: left and top.
    pub at: [u32; 2],
    /// Staging buffer.
    pub buffer: Buffer,
    /// Bytes from one row to the next in the buffer.
    pub bytes_per_row: u32,
}

impl Frame {
    /// Returns the buffer, texture or sampler of a handle or binding.
    ///
    /// # Panics
    /// If the handle is of another frame.
    #[must_use]
    pub fn resource(&self, of: impl Into<Bound>) -> &Resource {
        let (Bound::Buffer(Buffer(place)) | Bound::Texture(Texture(place), _) | Bound::Sampler(Sampler(place))) =
            of.into();
        &self.resources[place]
    }

    /// Returns the sum of the sizes of some buffers in bytes.
    ///
    /// # Panics
    /// If a handle is of another frame.
    #[must_use]
    pub fn bytes_of(&self, buffers: impl IntoIterator<Item = Buffer>) -> u64 {
        buffers.into_iter().map(|buffer| self.resource(buffer).bytes()).sum()
    }

    /// Returns the pipeline of a handle.
    ///
    /// # Panics
    /// For a pipeline of another frame.
    #[must_use]
    pub fn pipeline(&self, pipeline: PipelineId) -> &Pipeline {
        &self.pipelines[pipeline.0]
    }

    /// Returns the bind group of a handle.
    ///
    /// # Panics
    /// For a bind group of another frame.
    #[must_use]
    pub fn bind_group(&self, group: BindGroupId) -> &BindGroup {
        &self.bind_groups[group.0]
    }

    /// Returns the number of draw calls in the frame.
    #[must_use]
    pub fn draw_calls(&self) -> usize {
        let draws = |pass: &Pass| if let Pass::Render(pass) = pass { pass.draws.len() } else { 0 };
        self.passes.iter().map(draws).sum()
    }
}
