//! What a frame compiles, and the resources that it binds.

use super::handles::{Bound, PipelineId};
use super::shader::Shader;

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
    pub(super) fn runs_as(&self, other: &Self) -> bool {
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
