//! A frame as data: resources with their contents, pipelines, bind groups, and passes in order. [`Builder`] makes one,
//! [`Executor`] runs it on wgpu, [`Frame::write`] writes it for another host. Whoever runs it needs to know nothing of
//! techniques.

mod build;
mod document;
mod execute;

pub(crate) use build::Readback;
pub use build::{Builder, PipelineSource};
pub use document::{Document, WriteError};
pub use execute::Executor;

use crate::shader::Shader;
use lapidary_specialise::layout::StructLayout;

/// A buffer of a frame: its place among [`Frame::resources`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Buffer(usize);

/// A texture of a frame: its place among [`Frame::resources`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Texture(usize);

/// A sampler of a frame: its place among [`Frame::resources`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Sampler(usize);

/// A pipeline of a frame: its place among [`Frame::pipelines`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct PipelineId(usize);

/// A bind group of a frame: its place among [`Frame::bind_groups`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct BindGroupId(usize);

/// All that is made and run for a picture.
#[derive(Clone, Debug, Default)]
pub struct Frame {
    /// Buffers, textures and samplers.
    pub resources: Vec<Resource>,
    /// Pipelines, each once.
    pub pipelines: Vec<Pipeline>,
    /// What the pipelines read and write.
    pub bind_groups: Vec<BindGroup>,
    /// What is run, in order.
    pub passes: Vec<Pass>,
}

/// A buffer, texture or sampler.
#[derive(Clone, Debug)]
pub struct Resource {
    /// `object/what`; `what` alone where all objects share it. Not unique: each tile has a `view`.
    pub name: String,
    /// The object that it is made for; empty where all share it.
    pub object: String,
    /// What it is.
    pub kind: ResourceKind,
}

/// What a resource is.
#[derive(Clone, Debug)]
pub enum ResourceKind {
    /// A buffer.
    Buffer {
        /// In bytes.
        size: u64,
        /// What it is used for.
        usage: wgpu::BufferUsages,
        /// Its bytes at the start.
        contents: Contents,
        /// The struct that it holds, or an array of it, by name and layout; none of plain arrays.
        layout: Option<(&'static str, &'static StructLayout)>,
    },
    /// A texture of one mip level and one sample a texel.
    Texture {
        /// Width, height, and depth or number of layers, in texels.
        size: [u32; 3],
        /// One, two or three dimensions.
        dimension: wgpu::TextureDimension,
        /// Of a texel.
        format: wgpu::TextureFormat,
        /// What it is used for.
        usage: wgpu::TextureUsages,
        /// Its texels at the start, row by row without gaps, layer by layer.
        contents: Contents,
    },
    /// A sampler.
    Sampler {
        /// Of magnification and minification.
        filter: wgpu::FilterMode,
        /// Along u and v.
        address: [wgpu::AddressMode; 2],
    },
}

/// What a resource holds at the start.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Contents {
    /// Zeros.
    Zeros,
    /// These bytes.
    Bytes(Vec<u8>),
    /// What a device computes, for a frame that was made without one and cannot be run.
    LeftOut,
}

impl Resource {
    /// The bytes of its contents, without what a driver adds; none of a sampler.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        match &self.kind {
            ResourceKind::Buffer { size, .. } => *size,
            ResourceKind::Texture { size, format, .. } => {
                size.iter().map(|side| u64::from(*side)).product::<u64>() * u64::from(texel_bytes(*format))
            }
            ResourceKind::Sampler { .. } => 0,
        }
    }
}

/// Bytes of a texel. Only formats without blocks of several texels are used; depth has 32 bits.
pub(crate) fn texel_bytes(format: wgpu::TextureFormat) -> u32 {
    format.block_copy_size(None).unwrap_or_default()
}

/// A pipeline, without a layout of its own: bind groups take the layout that follows from its shader.
#[derive(Clone, Debug)]
pub struct Pipeline {
    /// Of a graphics pipeline the recipe's name, of a compute pipeline its entry point's; where several would have one
    /// name, with `#2`, `#3` and so on.
    pub name: String,
    /// What it runs, specialised.
    pub shader: Shader,
    /// What it runs as.
    pub kind: PipelineKind,
}

/// What a pipeline runs as.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PipelineKind {
    /// Triangles without vertex buffers, counter-clockwise fronts; the shader's first entry point is of vertices, its
    /// second of fragments.
    Render {
        /// Formats of its colour targets.
        targets: Vec<wgpu::TextureFormat>,
        /// Format of its depth buffer, where there is one: less passes, and is written.
        depth: Option<wgpu::TextureFormat>,
        /// The faces that are not drawn.
        cull: Option<wgpu::Face>,
    },
    /// The shader's one entry point.
    Compute,
}

/// What a pipeline reads and writes in one group.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct BindGroup {
    /// Whose layout it has.
    pub pipeline: PipelineId,
    /// Number of the group.
    pub group: u32,
    /// By number of the binding: all that the pipeline has in this group.
    pub entries: Vec<(u32, Bound)>,
}

/// What stands at a binding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Bound {
    /// A whole buffer.
    Buffer(Buffer),
    /// All of a texture.
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
    /// As a texture of two dimensions.
    fn from(texture: Texture) -> Self {
        Self::Texture(texture, wgpu::TextureViewDimension::D2)
    }
}

/// One thing that is run.
#[derive(Clone, Debug, PartialEq)]
pub enum Pass {
    /// Draws to targets.
    Render(RenderPass),
    /// Dispatches.
    Compute(ComputePass),
    /// Sets the first bytes of a buffer to 0.
    Clear {
        /// Which.
        buffer: Buffer,
        /// How many, a multiple of 4.
        bytes: u64,
    },
    /// Copies the first bytes of one buffer to another.
    Copy {
        /// From where.
        from: Buffer,
        /// To where.
        to: Buffer,
        /// How many, a multiple of 4.
        bytes: u64,
    },
    /// Copies the upper left part of a texture to a buffer, and brings it back to the host.
    Read(Read),
}

/// A pass of draws.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderPass {
    /// Its name.
    pub name: String,
    /// What is drawn to, one for each of the pipelines' targets.
    pub targets: Vec<Target>,
    /// The depth buffer, which starts at 1, and whether it is kept for later passes.
    pub depth: Option<(Texture, bool)>,
    /// Left, top, width and height in texels; all of the target where there is none.
    pub viewport: Option<[u32; 4]>,
    /// In order.
    pub draws: Vec<Draw>,
}

/// A colour target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// What is drawn to.
    pub texture: Texture,
    /// Which of its layers.
    pub layer: u32,
    /// What it starts with: red, green, blue, alpha.
    pub clear: [f64; 4],
}

impl From<Texture> for Target {
    /// Its first layer, from nothing.
    fn from(texture: Texture) -> Self {
        Self { texture, layer: 0, clear: [0.0; 4] }
    }
}

/// A draw of one instance.
#[derive(Clone, Debug, PartialEq)]
pub struct Draw {
    /// The object that it is for; empty where it is for all.
    pub object: String,
    /// By what.
    pub pipeline: PipelineId,
    /// By number of the group; none where the pipeline has none.
    pub groups: Vec<Option<BindGroupId>>,
    /// How many.
    pub vertices: u32,
    /// The part of the targets that may change, left, top, width and height in texels; all where there is none.
    pub scissor: Option<[u32; 4]>,
}

/// A pass of dispatches.
#[derive(Clone, Debug, PartialEq)]
pub struct ComputePass {
    /// Its name.
    pub name: String,
    /// In order.
    pub dispatches: Vec<Dispatch>,
    /// How often all of them are run, one time after the other.
    pub repeat: u32,
}

/// A dispatch.
#[derive(Clone, Debug, PartialEq)]
pub struct Dispatch {
    /// The object that it is for; empty where it is for all.
    pub object: String,
    /// By what.
    pub pipeline: PipelineId,
    /// By number of the group; none where the pipeline has none.
    pub groups: Vec<Option<BindGroupId>>,
    /// How many workgroups.
    pub workgroups: Workgroups,
}

/// How many workgroups a dispatch has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Workgroups {
    /// Along each axis.
    Count([u32; 3]),
    /// As the first three words of a buffer say.
    Indirect(Buffer),
}

/// A part of a texture on its way to the host.
#[derive(Clone, Debug, PartialEq)]
pub struct Read {
    /// The picture that it is a part of.
    pub picture: &'static str,
    /// From where: its upper left part.
    pub texture: Texture,
    /// Width and height, in texels.
    pub size: [u32; 2],
    /// Where in the picture: left and top.
    pub at: [u32; 2],
    /// By way of this buffer.
    pub buffer: Buffer,
    /// Bytes from one row to the next in the buffer.
    pub bytes_per_row: u32,
}

impl Frame {
    /// What a handle stands for.
    ///
    /// # Panics
    /// For a buffer of another frame.
    #[must_use]
    pub fn buffer(&self, buffer: Buffer) -> &Resource {
        &self.resources[buffer.0]
    }

    /// What a handle stands for.
    ///
    /// # Panics
    /// For a texture of another frame.
    #[must_use]
    pub fn texture(&self, texture: Texture) -> &Resource {
        &self.resources[texture.0]
    }

    /// What a handle stands for.
    ///
    /// # Panics
    /// For a pipeline of another frame.
    #[must_use]
    pub fn pipeline(&self, pipeline: PipelineId) -> &Pipeline {
        &self.pipelines[pipeline.0]
    }

    /// What a handle stands for.
    ///
    /// # Panics
    /// For a bind group of another frame.
    #[must_use]
    pub fn bind_group(&self, group: BindGroupId) -> &BindGroup {
        &self.bind_groups[group.0]
    }

    /// The resource at a binding.
    #[must_use]
    pub fn bound(&self, bound: Bound) -> &Resource {
        let (Bound::Buffer(Buffer(place)) | Bound::Texture(Texture(place), _) | Bound::Sampler(Sampler(place))) = bound;
        &self.resources[place]
    }

    /// How many draw calls it takes.
    #[must_use]
    pub fn draw_calls(&self) -> usize {
        let draws = |pass: &Pass| if let Pass::Render(pass) = pass { pass.draws.len() } else { 0 };
        self.passes.iter().map(draws).sum()
    }
}
