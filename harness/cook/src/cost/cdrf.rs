//! The ladder of the curvature-dependent reflectance: each rung's error against the convolution and
//! against random walks through spheres, and its time compared with Lambert's law and a blur in
//! texture space.

pub mod error;
mod frames;
mod page;
pub mod plot;
mod scenes;
mod shader;
mod table;
pub mod walks;

pub use error::{Distance, TableReport};
pub use frames::{CurvatureSource, FrameReport, Part};
pub use scenes::{SCENES, SceneReport};
pub use walks::Residuals;

use super::{CostError, Row, mark, mark_rows};
use error::Samples;
use lapidary_cdrf::oracle;
use lapidary_gpu::Gpu;
use lapidary_plan::Rung;
use lapidary_scene::solver::Reflectance;
use serde::{Deserialize, Serialize};

/// The ladder's name.
pub const TECHNIQUE: &str = "cdrf";
/// The rungs: no technique, the cheapest, tables, closed forms, the definition, another function,
/// and the blur that the others replace.
pub const RUNGS: [&str; 10] =
    [LAMBERT, "wrap", PAPER, "table-257-rgba16f", "table-257-r32f", "cheap", "accurate", "quadrature", SPHERICAL, BLUR];
/// The baseline that costs are compared with.
pub const LAMBERT: &str = "lambert";
/// The paper's rung.
pub const PAPER: &str = "table-256-rgba8";
/// The rung that approximates a different function from the others and is compared with its own
/// definition.
pub const SPHERICAL: &str = "spherical";
/// The blur in texture space, which the technique replaces.
pub const BLUR: &str = "blur";
/// The rungs without a table that approximate the convolution.
const ANALYTIC: [&str; 3] = ["cheap", "accurate", "quadrature"];

/// The measures of a row.
pub const MEASURES: [&str; 3] = ["largest", "rms", "walks"];

/// What to measure, and how thoroughly.
#[derive(Clone, Debug)]
pub struct Options {
    /// Rounds of timing; 0 skips timing.
    pub rounds: u32,
    /// Width and height of the timed frame in pixels.
    pub frame: [u32; 2],
    /// The rungs to measure.
    pub rungs: Vec<Reflectance>,
}

impl Default for Options {
    fn default() -> Self {
        let rung = |name: &&str| if let Ok(Rung::Diffuse(rung)) = name.parse() { Some(rung) } else { None };
        Self { rounds: 7, frame: [1920, 1080], rungs: RUNGS.iter().filter_map(rung).collect() }
    }
}

/// All results of one rung.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RungReport {
    /// The rung's name.
    pub rung: String,
    /// Distance from the convolution, or for the spherical form from its own definition; `None` for
    /// the blur, which is not a function of angle and width.
    pub distance: Option<Distance>,
    /// Residuals against random walks through spheres; `None` for the blur.
    pub residuals: Option<Residuals>,
    /// The frames drawn with the rung.
    pub frames: Vec<FrameReport>,
    /// Bytes of its textures for one material.
    pub texture_bytes: u64,
    /// Bytes of the timed mesh besides positions, normals and indices: curvatures, if they come
    /// from the mesh, or what the texture needs.
    pub mesh_bytes: u64,
    /// Whether another rung's lit part is faster with curvature from either source and has no
    /// larger error.
    pub dominated: bool,
}

/// The measured ladder.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CdrfReport {
    /// The device and its driver.
    pub adapter: String,
    /// Width and height of the timed frame in pixels.
    pub frame: [u32; 2],
    /// Rounds of timing.
    pub rounds: u32,
    /// Number of vertices of the timed mesh as displayed.
    pub vertices: usize,
    /// Number of spheres simulated by random walks.
    pub spheres: usize,
    /// The rungs, from cheap to exact.
    pub rungs: Vec<RungReport>,
    /// Lookup tables of several sizes and formats.
    pub tables: Vec<TableReport>,
    /// Whole pictures compared with random walks.
    pub scenes: Vec<SceneReport>,
    /// Distance of the spherical form from the convolution on the circle.
    pub spherical_from_circular: Distance,
}

/// Measures the ladder. `progress` receives the current step, the work done and the total.
///
/// # Errors
///
/// Returns an error if the record of spheres is missing or if the device fails.
pub fn run(
    gpu: &Gpu,
    options: &Options,
    progress: &mut dyn FnMut(&'static str, u64, u64),
) -> Result<CdrfReport, CostError> {
    let spheres = walks::record(&walks::record_file())?;
    let total = options.rungs.len() as u64 + 1;
    progress("comparing", 0, total);
    let convolution = Samples::of_the_convolution();
    let spherical = Samples::of(oracle::spherical);
    let tables = error::tables(gpu, &convolution)?;
    let scenes = frames::Scenes::new()?;
    let mut rungs = Vec::new();
    for (done, &reflectance) in (1..).zip(&options.rungs) {
        progress("comparing", done, total);
        let function = error::function(gpu, reflectance)?;
        let definition = if reflectance == Reflectance::Spherical { &spherical } else { &convolution };
        rungs.push(RungReport {
            rung: reflectance.name().to_owned(),
            distance: function.as_ref().map(|function| definition.distance(function)),
            residuals: function.as_ref().map(|function| walks::residuals(&spheres, function)),
            frames: frames::frames(&scenes, reflectance, options.frame)?,
            texture_bytes: frames::texture_bytes(reflectance),
            mesh_bytes: scenes.mesh_bytes(reflectance),
            dominated: false,
        });
    }
    if options.rounds > 0 {
        frames::time(gpu, &scenes, options, &mut rungs, &mut |done, total| progress("timing", done, total))?;
    }
    let mut report = CdrfReport {
        adapter: gpu.describe(),
        frame: options.frame,
        rounds: options.rounds,
        vertices: scenes.vertices(),
        spheres: spheres.profiles.len(),
        scenes: scenes::measure(gpu, &options.rungs, options.rounds, &mut |done, total| {
            progress("beside walks", done, total);
        })?,
        rungs,
        tables,
        spherical_from_circular: convolution.distance(lapidary_cdrf::spherical),
    };
    report.mark_dominated();
    Ok(report)
}

impl RungReport {
    /// Returns the frame for a part of the work and a source of curvature; a rung without curvature
    /// has the same frame for either source.
    pub fn frame(&self, part: Part, source: CurvatureSource) -> Option<&FrameReport> {
        self.frames.iter().find(|frame| frame.part == part && frame.curvature.is_none_or(|used| used == source))
    }

    /// Returns the time of that frame in milliseconds.
    pub fn ms(&self, part: Part, source: CurvatureSource) -> Option<f64> {
        Some(self.frame(part, source)?.timing?.ms)
    }

    /// Returns the error, by index into [`MEASURES`].
    fn error(&self, measure: usize) -> Option<f64> {
        match measure {
            0 => self.distance.map(|distance| distance.largest),
            1 => self.distance.map(|distance| distance.rms),
            _ => self.residuals.map(|residuals| residuals.fixed),
        }
    }

    /// Whether this rung is faster than `other` in the lit part, with curvature from either source,
    /// and has no larger error.
    fn beats(&self, other: &Self) -> bool {
        let faster = |source| match (self.ms(Part::Lit, source), other.ms(Part::Lit, source)) {
            (Some(mine), Some(others)) => mine < others,
            _ => false,
        };
        let nearer = |measure| match (self.error(measure), other.error(measure)) {
            (Some(mine), Some(others)) => {
                are_comparable([&self.rung, &other.rung], MEASURES[measure]) && mine <= others
            }
            _ => false,
        };
        CurvatureSource::ALL.into_iter().all(faster) && (0..2).all(nearer)
    }
}

/// Whether the errors of two rungs in a measure are comparable. The spherical form has a different
/// definition, so only its distance from random walks is comparable with the others'.
fn are_comparable(rungs: [&str; 2], error_measure: &str) -> bool {
    let [one, other] = rungs.map(|rung| rung == SPHERICAL);
    error_measure == MEASURES[2] || one == other
}

impl CdrfReport {
    /// Returns the rung with that name.
    pub fn rung(&self, name: &str) -> Option<&RungReport> {
        self.rungs.iter().find(|rung| rung.rung == name)
    }

    /// Returns the time of `slow` divided by the time of `fast`.
    pub fn ratio(&self, slow: &str, fast: &str, part: Part, source: CurvatureSource) -> Option<f64> {
        Some(self.rung(slow)?.ms(part, source)? / self.rung(fast)?.ms(part, source)?)
    }

    /// Marks the rungs that another one beats.
    pub fn mark_dominated(&mut self) {
        mark(&mut self.rungs, RungReport::beats, |rung| &mut rung.dominated);
    }

    /// Returns one row per rung, measure and view; a view is a part of the work and a source of
    /// curvature, such as `lit+screen`.
    pub fn rows(&self) -> Vec<Row> {
        let mut rows = Vec::new();
        for rung in &self.rungs {
            for (part, source) in frames::views() {
                for (measure, error_measure) in MEASURES.into_iter().enumerate() {
                    rows.push(Row {
                        technique: TECHNIQUE,
                        rung: rung.rung.clone(),
                        view: format!("{}+{}", part.name(), source.name()),
                        error: rung.error(measure),
                        error_measure,
                        ms: rung.ms(part, source),
                        dominated: false,
                        adapter: self.adapter.clone(),
                    });
                }
            }
        }
        mark_rows(&mut rows, |one, other| are_comparable([&one.rung, &other.rung], one.error_measure));
        rows
    }

    /// Returns the report as text.
    pub fn text(&self) -> String {
        table::text(self)
    }
}

#[cfg(test)]
mod tests;
