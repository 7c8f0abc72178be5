//! Measures the gem's studies behind a report of the ladder.

use super::{growth, proxy_sizes, reflection};
use lapidary_gpu::Gpu;
use lapidary_ladders::{CostError, Progress, Report};

/// Adds the rows of the studies: times of stones of more and more facets, in the report's rounds and of its frame's size;
/// the proxy at small sizes; and total reflection by how the proxy's mesh is made.
///
/// # Errors
/// Returns an error if a committed reference is damaged or if the device fails.
pub fn measure(gpu: &Gpu, report: &mut Report, progress: Progress<'_>) -> Result<(), CostError> {
    let [rounds, width, height] = ["rounds", "width", "height"].map(|name| report.setting(name) as u32);
    growth::measure(gpu, (rounds, [width, height]), report, progress)?;
    let mut small = |done| progress("following small references", done, proxy_sizes::FOLLOWED);
    proxy_sizes::measure(gpu, report, &mut small)?;
    reflection::measure(report)
}
