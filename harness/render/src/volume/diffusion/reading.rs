//! What the last frame tells of its diffusion, read back from the device.

use super::bodies::Diffusions;
use super::levels::Levels;
use crate::frame::Executor;
use lapidary_gpu::GpuError;
use lapidary_plan::Note;

impl Diffusions {
    /// Returns the notes on the last frame that was run. Waits for it.
    pub(crate) fn notes(&self, executor: &Executor<'_>) -> Result<Vec<Note>, GpuError> {
        let mut notes = Vec::new();
        for body in &self.bodies {
            notes.extend(body.cells.voxelizer.note(executor, &body.name)?);
            let residual = body.levels.residual(executor)?;
            notes.extend(residual.map(|residual| Note::Solved {
                object: body.name.clone(),
                cycles: body.levels.cycles(),
                residual,
            }));
        }
        Ok(notes)
    }

    /// Returns what the last frame left of each body's equations; see [`Levels::residual`].
    pub(crate) fn residuals(&self, executor: &Executor<'_>) -> Result<Vec<[f64; 3]>, GpuError> {
        let all = self.bodies.iter().filter_map(|body| body.levels.residual(executor).transpose());
        all.collect()
    }
}

impl Levels {
    /// Returns what the last frame left of the equations in each channel, as a share of their right side, both as
    /// root mean squares; `None` unless the options ask for it. 0 for a channel without light. Waits for the device.
    pub(super) fn residual(&self, executor: &Executor<'_>) -> Result<Option<[f64; 3]>, GpuError> {
        let Some(sums) = self.residual_sums() else { return Ok(None) };
        let mut totals = [0.0; 8];
        for tile in executor.words(sums)?.chunks_exact(8) {
            for (total, word) in totals.iter_mut().zip(tile) {
                *total += f64::from(f32::from_bits(*word));
            }
        }
        let share = |channel: usize| {
            let [left, right] = [totals[channel], totals[channel + 4]];
            if right > 0.0 { (left / right).sqrt() } else { 0.0 }
        };
        Ok(Some([0, 1, 2].map(share)))
    }
}
