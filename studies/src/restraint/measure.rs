//! Measures all kinds of restraint.

use super::rungs::NAME;
use super::{limit, tiles, variants};
use lapidary_gpu::Gpu;
use lapidary_ladders::{CostError, Options, Progress, Report};

/// Measures all kinds of restraint. A rung's name is followed by the way of work; values are
/// differences from the result without restraint, and amounts of work.
///
/// # Errors
///
/// Returns an error if a scene cannot be made or if the device fails.
pub fn run(gpu: &Gpu, options: &Options, progress: Progress<'_>) -> Result<Report, CostError> {
    let [width, height] = options.frame;
    let settings = [("width", width), ("height", height), ("rounds", options.rounds)];
    let mut report = Report::new(NAME, gpu.describe(), &settings.map(|(name, value)| (name, value.into())));
    limit::measure(gpu, options, &mut report, progress)?;
    tiles::measure(gpu, options.rounds, &mut report, &mut |done, total| progress("solving by tiles", done, total))?;
    variants::measure(gpu, options, &mut report, &mut |done, total| progress("drawing stones", done, total))?;
    Ok(report)
}
