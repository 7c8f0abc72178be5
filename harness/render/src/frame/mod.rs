//! A frame as data: resources with their contents, pipelines, bind groups, and passes in order.
//!
//! [`Builder`] makes a frame, [`Executor`] runs it on wgpu, [`Frame::write`] writes it for another
//! host. Running a frame requires no knowledge of techniques.

mod build;
pub mod compute;
mod document;
mod execute;
mod handles;
mod pass;
mod pipeline;
pub(crate) mod record;
mod resource;
pub mod shader;
mod whole;
mod write;

pub(crate) use build::Readback;
pub use build::{Builder, PipelineSource};
pub use document::Document;
pub use execute::Executor;
pub use handles::{BindGroupId, Bound, Buffer, PipelineId, Sampler, Texture};
pub use pass::{ComputePass, Depth, Dispatch, Draw, Pass, Read, RenderPass, Target, Workgroups};
pub use pipeline::{BindGroup, Blend, Pipeline, PipelineKind};
pub(crate) use resource::level_size;
pub use resource::{Contents, Resource, ResourceKind};
pub use whole::Frame;
pub use write::WriteError;
