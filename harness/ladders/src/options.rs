//! What to measure, and how far a measurement is.

use lapidary_plan::Rung;

/// Receives the current step of a measurement, the work done and the total.
pub type Progress<'a> = &'a mut dyn FnMut(&'static str, u64, u64);

/// What to measure, and how thoroughly.
#[derive(Clone, Debug)]
pub struct Options<R = Rung> {
    /// Rounds of timing; 0 skips timing.
    pub rounds: u32,
    /// Width and height of the timed frame in pixels.
    pub frame: [u32; 2],
    /// The rungs to measure.
    pub rungs: Vec<R>,
}
