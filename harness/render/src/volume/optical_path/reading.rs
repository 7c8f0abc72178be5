//! What the last frame tells of its paths, read back from the device.

use super::bodies::{BodyPaths, OpticalPaths};
use crate::frame::Executor;
use crate::volume::solver::Status;
use lapidary_gpu::GpuError;
use lapidary_plan::Note;

impl OpticalPaths {
    /// Returns the notes on the last frame that was run. Waits for it.
    pub(crate) fn notes(&self, executor: &Executor<'_>) -> Result<Vec<Note>, GpuError> {
        let mut notes = Vec::new();
        for body in &self.bodies {
            notes.extend(body.voxelizer.note(executor, &body.name)?);
            let mut bound = 0f32;
            for (number, channel) in body.channels.iter().enumerate() {
                // The first brightness covers all three channels if there is only one.
                let brightest = if body.channels.len() == 1 {
                    body.brightest.max_element()
                } else {
                    body.brightest.to_array()[number]
                };
                bound = bound.max(brightest * Status::read(executor, channel.solved.kept)?.luminance_bound());
            }
            if bound > 0.0 {
                notes.push(Note::StoppedEarly { object: body.name.clone(), bound });
            }
        }
        Ok(notes)
    }

    /// Returns how far each body's solver got in its last channel. Waits for the device.
    pub(crate) fn statuses(&self, executor: &Executor<'_>) -> Result<Vec<Status>, GpuError> {
        let last = |body: &BodyPaths| Some(Status::read(executor, body.channels.last()?.solved.kept));
        self.bodies.iter().filter_map(last).collect()
    }
}
