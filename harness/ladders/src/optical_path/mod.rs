//! The ladder of optical paths: solver, stencil and grid size. Each rung has errors against a
//! closed form, the finest grid and random walks, and the times of the same pictures.

mod frames;
mod tables;
mod views;
mod walks;

pub use views::{COMPARED, VIEWS, WALKED};

use super::{CostError, Ladder, Options, Progress, Report};
use lapidary_gpu::Gpu;
use lapidary_plan::Rung;
use lapidary_scene::solver::{Method, Paths};
pub(super) use views::settings;
pub(super) use walks::Walks;

/// The ladder.
pub const LADDER: Ladder =
    Ladder { name: "optical_path", tables: tables::tables, plots: tables::plots, whole: tables::whole };
/// The rungs: no path through the body, the paper's solver, stencils on growing grids with two
/// solvers, the Eikonal equation, and random walks.
pub const RUNGS: [&str; 22] = [
    LAMBERT,
    LAMBERT_SHADOWED,
    "paper-64",
    "ping-pong-6-64",
    "ping-pong-18-64",
    "ping-pong-26-16",
    "ping-pong-26-32",
    "ping-pong-26-64",
    "ping-pong-26-128",
    "tiled-6-64",
    "tiled-18-64",
    "tiled-26-16",
    "tiled-26-32",
    "tiled-26-64",
    "tiled-26-128",
    "tiled-26-256",
    "godunov-16",
    "godunov-32",
    "godunov-64",
    "godunov-128",
    FINEST,
    REFERENCE,
];
/// The baseline without paths through the body.
const LAMBERT: &str = "lambert";
/// The same baseline with cast shadows: what one would use without optical paths, and therefore
/// what they are compared with.
const LAMBERT_SHADOWED: &str = "lambert-shadowed";
/// The paper's own form: its solver with the full extinction.
const UNSCALED: &str = "paper-64-unscaled";
/// The rung that serves as the converged costs of a body without a closed form.
const FINEST: &str = "godunov-256";
/// Random walks.
const REFERENCE: &str = "reference";
/// The default rung of a scene.
const USUAL: &str = "godunov-64";
/// The solvers whose time is measured from the coarsest grid to the finest.
const GROWING: [&str; 3] = ["ping-pong-26", "tiled-26", "godunov"];
/// Voxels along an edge of those grids.
const CELLS: [u32; 5] = [16, 32, 64, 128, 256];

/// The measures of a row: the RMS error of the cost in nats, that of the luminance, and the distance
/// from random walks.
pub const MEASURES: [&str; 3] = ["nats", "luminance", "walks"];
/// The measure that is the median time of the frame in white, with one extinction for all channels.
const GREY: &str = "grey";
/// The measure that is the median time of the frame in the view's own colours.
const RGB: &str = "rgb";
/// The view whose stages are timed separately, in white.
const STAGED: &str = "bunny";

/// Returns what to measure by default; slow rungs have fewer rounds.
pub fn options() -> Options {
    Options { rounds: 5, frame: [512, 512], rungs: RUNGS.iter().filter_map(|name| name.parse().ok()).collect() }
}

/// The settings that a row of the ladder is drawn with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Measured {
    pub(super) rung: Rung,
    /// Whether the cost is the full extinction.
    pub(super) unscaled: bool,
}

impl Measured {
    /// Returns each rung; one with the paper's solver is followed by its unscaled version, which is
    /// the paper's own form.
    fn all(rungs: &[Rung]) -> Vec<Self> {
        let is_papers = |rung: Rung| matches!(rung, Rung::OpticalPath(Paths { method: Method::Paper, .. }));
        let of = |&rung: &Rung| {
            let ways = [false, true].into_iter().filter(move |unscaled| !unscaled || is_papers(rung));
            ways.map(move |unscaled| Self { rung, unscaled })
        };
        rungs.iter().flat_map(of).collect()
    }

    fn name(self) -> String {
        format!("{}{}", self.rung, if self.unscaled { "-unscaled" } else { "" })
    }
}

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
    let mut report = Report::new(LADDER.name, gpu.describe(), &settings.map(|(name, value)| (name, value.into())));
    let measured = Measured::all(&options.rungs);
    let total = (VIEWS.len() * measured.len()) as u64;
    let mut done = 0;
    let mut errors = Vec::new();
    for name in VIEWS {
        let view = views::View::new(gpu, name)?;
        let walks = Walks::of(gpu, name)?;
        for &of in &measured {
            progress("comparing", done, total);
            let [nats, luminance] = if of.rung == Rung::Reference { [None; 2] } else { view.distance(gpu, of)? };
            errors.push([nats, luminance, walks.as_ref().map(|walks| walks.distance(gpu, of)).transpose()?]);
            done += 1;
        }
    }
    frames::measure(gpu, options, &measured, &errors, &mut report, &mut |done, total| progress("timing", done, total))?;
    Ok(report)
}

#[cfg(test)]
mod tests;
