//! What a frame runs.

use super::handles::{BindGroupId, Buffer, PipelineId, Texture};

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
