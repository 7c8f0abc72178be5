//! The ladder of optical paths: solver, stencil and grid size. Each rung has errors against a
//! closed form, the finest grid and random walks, and the times of the same pictures.

pub mod frames;
mod page;
pub mod plot;
mod table;
pub mod views;
mod walks;

pub use frames::{PathTiming, Solved};
pub use views::{COMPARED, Distance, VIEWS, WALKED};

use super::{CostError, Row, mark, mark_rows};
use lapidary_gpu::Gpu;
use lapidary_plan::Rung;
use lapidary_scene::solver::{Method, Paths};
use serde::{Deserialize, Serialize};
use walks::Walks;

/// The ladder's name.
pub const TECHNIQUE: &str = "optical_path";
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
pub const LAMBERT: &str = "lambert";
/// The same baseline with cast shadows: what one would use without optical paths, and therefore
/// what they are compared with.
pub const LAMBERT_SHADOWED: &str = "lambert-shadowed";
/// The paper's own form: its solver with the full extinction.
pub const UNSCALED: &str = "paper-64-unscaled";
/// The rung that serves as the converged costs of a body without a closed form.
pub const FINEST: &str = "godunov-256";
/// Random walks.
pub const REFERENCE: &str = "reference";
/// The default rung of a scene.
pub const USUAL: &str = "godunov-64";
/// The solvers whose time is measured from the coarsest grid to the finest.
pub const GROWING: [&str; 3] = ["ping-pong-26", "tiled-26", "godunov"];
/// Voxels along an edge of those grids.
pub const CELLS: [u32; 5] = [16, 32, 64, 128, 256];

/// The measures of a row.
pub const MEASURES: [&str; 3] = ["nats", "luminance", "walks"];

/// What to measure, and how thoroughly.
#[derive(Clone, Debug)]
pub struct Options {
    /// Rounds of timing; 0 skips timing.
    pub rounds: u32,
    /// Width and height of the timed frame in pixels.
    pub frame: [u32; 2],
    /// The rungs to measure: Lambert's law, optical paths through voxels, and the reference.
    pub rungs: Vec<Rung>,
}

impl Default for Options {
    fn default() -> Self {
        Self { rounds: 5, frame: [512, 512], rungs: RUNGS.iter().filter_map(|name| name.parse().ok()).collect() }
    }
}

/// All results of one rung.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RungReport {
    /// The rung's name.
    pub rung: String,
    /// Errors by view, in the order of [`VIEWS`].
    pub distances: Vec<Distance>,
    /// Times of the same pictures by view, in the order of [`VIEWS`].
    pub times: Vec<ViewTimes>,
    /// Final state of the solver for the grey bunny; `None` if nothing is solved.
    pub solved: Option<Solved>,
    /// Bytes of the maps, voxels, costs and solver for the grey bunny.
    pub bytes: u64,
    /// Whether another rung is faster and has no larger error in any view.
    pub dominated: bool,
}

/// The times of a view's frames.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ViewTimes {
    /// The frame in white, with one extinction for all channels, whose costs are compared; `None`
    /// if it was not timed.
    pub grey: Option<PathTiming>,
    /// The frame in its own colours, as `cook plan` has it, which is compared with random walks;
    /// `None` if it was not timed.
    pub rgb: Option<PathTiming>,
}

/// The settings that a row of the ladder is drawn with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Measured {
    rung: Rung,
    /// Whether the cost is the full extinction.
    unscaled: bool,
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

/// The measured ladder.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OpticalPathReport {
    /// The device and its driver.
    pub adapter: String,
    /// Width and height of the timed frame in pixels.
    pub frame: [u32; 2],
    /// Rounds of timing; slow rungs have fewer.
    pub rounds: u32,
    /// The rungs, from cheap to exact.
    pub rungs: Vec<RungReport>,
}

/// Measures the ladder. `progress` receives the current step, the work done and the total.
///
/// # Errors
///
/// Returns an error if a committed reference is damaged or if the device fails.
pub fn run(
    gpu: &Gpu,
    options: &Options,
    progress: &mut dyn FnMut(&'static str, u64, u64),
) -> Result<OpticalPathReport, CostError> {
    let measured = Measured::all(&options.rungs);
    let mut rungs: Vec<RungReport> = measured.iter().map(|of| RungReport::unmeasured(of.name())).collect();
    let total = (VIEWS.len() * rungs.len()) as u64;
    let mut done = 0;
    for name in VIEWS {
        progress("comparing", done, total);
        let view = views::View::new(gpu, name)?;
        let walks = Walks::of(gpu, name)?;
        for (report, &of) in rungs.iter_mut().zip(&measured) {
            let mut distance = if of.rung == Rung::Reference { Distance::default() } else { view.distance(gpu, of)? };
            distance.walks = walks.as_ref().map(|walks| walks.distance(gpu, of)).transpose()?;
            report.distances.push(distance);
            done += 1;
            progress("comparing", done, total);
        }
    }
    frames::measure(gpu, options, &measured, &mut rungs, &mut |done, total| progress("timing", done, total))?;
    let mut report = OpticalPathReport { adapter: gpu.describe(), frame: options.frame, rounds: options.rounds, rungs };
    report.mark_dominated();
    Ok(report)
}

impl RungReport {
    fn unmeasured(rung: String) -> Self {
        Self {
            rung,
            distances: Vec::new(),
            times: vec![ViewTimes::default(); VIEWS.len()],
            solved: None,
            bytes: 0,
            dominated: false,
        }
    }

    /// Returns the time of the grey bunny's frame in milliseconds.
    pub fn ms(&self) -> Option<f64> {
        Some(self.grey("bunny")?.ms)
    }

    fn times(&self, view: &str) -> Option<&ViewTimes> {
        self.times.get(VIEWS.iter().position(|name| *name == view)?)
    }

    /// Returns the time of a view's frame with one extinction for all channels.
    pub fn grey(&self, view: &str) -> Option<&PathTiming> {
        self.times(view)?.grey.as_ref()
    }

    /// Returns the time of a view's frame in its own colours.
    pub fn rgb(&self, view: &str) -> Option<&PathTiming> {
        self.times(view)?.rgb.as_ref()
    }

    /// Returns the errors in the view with that name.
    pub fn distance(&self, view: &str) -> Distance {
        let place = VIEWS.iter().position(|name| *name == view);
        place.and_then(|place| self.distances.get(place)).copied().unwrap_or_default()
    }

    /// Whether this rung is faster than `other` and has no larger error wherever both have an
    /// error.
    fn beats(&self, other: &Self) -> bool {
        let faster = matches!((self.ms(), other.ms()), (Some(mine), Some(others)) if mine < others);
        let both = self.distances.iter().zip(&other.distances).filter_map(|(mine, others)| mine.nats.zip(others.nats));
        faster && both.clone().next().is_some() && both.into_iter().all(|(mine, others)| mine <= others)
    }
}

impl OpticalPathReport {
    /// Returns the rung with that name.
    pub fn rung(&self, name: &str) -> Option<&RungReport> {
        self.rungs.iter().find(|rung| rung.rung == name)
    }

    /// Marks the rungs that another one beats.
    pub fn mark_dominated(&mut self) {
        mark(&mut self.rungs, RungReport::beats, |rung| &mut rung.dominated);
    }

    /// Returns one row per rung, view and measure, with the time of the frame that the error
    /// belongs to: the grey frame for costs and luminance, the frame in the view's own colours for
    /// the distance from walks.
    pub fn rows(&self) -> Vec<Row> {
        let mut rows = Vec::new();
        for rung in &self.rungs {
            for view in VIEWS {
                for (measure, error_measure) in MEASURES.into_iter().enumerate() {
                    let timing = if error_measure == "walks" { rung.rgb(view) } else { rung.grey(view) };
                    rows.push(Row {
                        technique: TECHNIQUE,
                        rung: rung.rung.clone(),
                        view: view.to_owned(),
                        error: rung.distance(view).of(measure),
                        error_measure,
                        ms: timing.map(|timing| timing.ms),
                        dominated: false,
                        adapter: self.adapter.clone(),
                    });
                }
            }
        }
        mark_rows(&mut rows, |_, _| true);
        rows
    }

    /// Returns the report as text.
    pub fn text(&self) -> String {
        table::text(self)
    }
}

#[cfg(test)]
mod tests;
