//! Measures the ladder of optical paths.

use super::frames;
use super::measured::Measured;
use super::rungs::NAME;
use super::views::{self, VIEWS};
use super::walks::Walks;
use crate::error::CostError;
use crate::options::{Options, Progress};
use crate::report::Report;
use lapidary_gpu::Gpu;
use lapidary_plan::Rung;

/// Measures the ladder. Errors of costs and of luminance stand beside the time of the frame in white,
/// with one extinction for all channels, and distances from walks beside that of the frame in its
/// own colours, as `cook plan` has it.
///
/// # Errors
///
/// Returns an error if a committed reference is damaged or if the device fails.
pub fn run(gpu: &Gpu, options: &Options, progress: Progress<'_>) -> Result<Report, CostError> {
    let [width, height] = options.frame;
    let settings = [("width", width), ("height", height), ("rounds", options.rounds)];
    let mut report = Report::new(NAME, gpu.describe(), &settings.map(|(name, value)| (name, value.into())));
    let measured = Measured::all(&options.rungs);
    let total = (VIEWS.len() * measured.len()) as u64;
    let mut done = 0;
    let mut errors = Vec::new();
    for name in VIEWS {
        let view = views::View::new(gpu, name)?;
        let walks = Walks::of(gpu, name)?;
        for &variant in &measured {
            progress("comparing", done, total);
            let [nats, luminance] =
                if variant.rung == Rung::Reference { [None; 2] } else { view.distance(gpu, variant)? };
            errors.push([nats, luminance, walks.as_ref().map(|walks| walks.distance(gpu, variant)).transpose()?]);
            done += 1;
        }
    }
    frames::measure(gpu, options, &measured, &errors, &mut report, &mut |done, total| progress("timing", done, total))?;
    Ok(report)
}
