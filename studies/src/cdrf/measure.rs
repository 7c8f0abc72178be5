//! Measures the reflectance's studies behind a report of the ladder.

use super::{head, law};
use lapidary_gpu::Gpu;
use lapidary_ladders::{CostError, Progress, Report};

/// Adds the rows of the studies, timed in the report's rounds: pictures with and without the law of a half space, by kinds
/// of shadow, and of a head, all beside random walks.
///
/// # Errors
/// Returns an error if a committed picture is missing or damaged, or if the device fails.
pub fn measure(gpu: &Gpu, report: &mut Report, progress: Progress<'_>) -> Result<(), CostError> {
    let rounds = report.setting("rounds") as u32;
    law::measure(gpu, rounds, report, &mut |done, total| progress("beside walks, by law", done, total))?;
    head::measure(gpu, rounds, report, &mut |done, total| progress("a head beside walks", done, total))
}
