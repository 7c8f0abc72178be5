//! A frame: its parts in lists, and what hosts ask about them.

use super::handles::{BindGroupId, Bound, Buffer, PipelineId, Sampler, Texture};
use super::pass::Pass;
use super::pipeline::{BindGroup, Pipeline};
use super::resource::{Contents, Resource, ResourceKind};

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

    /// Returns the buffer, texture or sampler of a handle or binding.
    ///
    /// # Panics
    /// If the handle is of another frame.
    #[must_use]
    pub fn resource(&self, handle: impl Into<Bound>) -> &Resource {
        let (Bound::Buffer(Buffer(place)) | Bound::Texture(Texture(place), _) | Bound::Sampler(Sampler(place))) =
            handle.into();
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
