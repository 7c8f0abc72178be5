//! How far a solve got, read back from the device.

use crate::frame::{Buffer, Executor};
use lapidary_gpu::GpuError;
use lapidary_optical_path as mirror;

/// How far a solve got.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Status {
    /// Number of passes in which anything was left to do.
    pub passes: u32,
    /// Number of tiles, or for untiled solvers voxels, that these passes processed; a tile counts
    /// each time.
    pub updates: u32,
    /// Number of tiles or voxels that another pass would process: 0 if the costs are final.
    pub active: u32,
    /// Every cost up to this one is final. If the solve ended early, the luminance of the others
    /// may be off by at most e to the power of minus this cost.
    pub least: f32,
}

impl Status {
    /// Upper bound on the error of any luminance that is due to passes that were not granted.
    #[must_use]
    pub fn luminance_bound(&self) -> f32 {
        if self.active == 0 { 0.0 } else { mirror::luminance(self.least) }
    }
}

impl Status {
    /// Reads the progress that the last run kept of a solve. Waits for it, so do not call it every
    /// frame.
    ///
    /// # Errors
    /// If the device is lost.
    pub fn read(executor: &Executor<'_>, kept: Buffer) -> Result<Self, GpuError> {
        let words = executor.words(kept)?;
        let parity = (words[0] & 1) as usize;
        let least = mirror::decode(words[5 + parity]);
        Ok(Self { passes: words[1], updates: words[2], active: words[3 + parity], least })
    }
}
