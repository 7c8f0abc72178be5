//! The ladder of the curvature-dependent reflectance: each rung's error against the convolution and against spheres of random walks,
//! and its time beside Lambert's law and a blur in texture space.

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
/// The rungs: none, the cheapest, tables, closed forms, the definition, another function, and the way that the ladder does without.
pub const RUNGS: [&str; 10] =
    [LAMBERT, "wrap", PAPER, "table-257-rgba16f", "table-257-r32f", "cheap", "accurate", "quadrature", SPHERICAL, BLUR];
/// What costs are measured against.
pub const LAMBERT: &str = "lambert";
/// The paper's rung.
pub const PAPER: &str = "table-256-rgba8";
/// The rung that is no approximation of the others' function, and is compared with its own definition.
pub const SPHERICAL: &str = "spherical";
/// What the technique replaces.
pub const BLUR: &str = "blur";
/// The rungs without a table that stand for the convolution.
const ANALYTIC: [&str; 3] = ["cheap", "accurate", "quadrature"];

/// The measures of a row.
pub const MEASURES: [&str; 3] = ["largest", "rms", "walks"];

/// What is measured, and how carefully.
#[derive(Clone, Debug)]
pub struct Options {
    /// Rounds of timing; none leaves times out.
    pub rounds: u32,
    /// Width and height of the timed frame.
    pub frame: [u32; 2],
    /// The rungs.
    pub rungs: Vec<Reflectance>,
}

impl Default for Options {
    fn default() -> Self {
        let rung = |name: &&str| if let Ok(Rung::Diffuse(rung)) = name.parse() { Some(rung) } else { None };
        Self { rounds: 7, frame: [1920, 1080], rungs: RUNGS.iter().filter_map(rung).collect() }
    }
}

/// All of one rung.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RungReport {
    /// The rung's name.
    pub rung: String,
    /// From the convolution, and of the spherical form from its own definition; none of the blur, which is no function of angle and width.
    pub distance: Option<Distance>,
    /// What is left beside spheres of random walks; none of the blur.
    pub residuals: Option<Residuals>,
    /// The frames that it draws.
    pub frames: Vec<FrameReport>,
    /// Bytes of its textures for one material.
    pub texture_bytes: u64,
    /// Bytes of the timed mesh beside positions, normals and indices: curvatures, where they come from there, or what its texture needs.
    pub mesh_bytes: u64,
    /// Another rung's lit part is faster with curvature from either source, and it errs no more.
    pub dominated: bool,
}

/// The ladder, measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CdrfReport {
    /// The device and its driver.
    pub adapter: String,
    /// The size of the timed frame.
    pub frame: [u32; 2],
    /// Rounds of timing.
    pub rounds: u32,
    /// Vertices of the timed mesh, as it is shown.
    pub vertices: usize,
    /// How many spheres of random walks there are.
    pub spheres: usize,
    /// From cheap to exact.
    pub rungs: Vec<RungReport>,
    /// Lookup tables of several sizes and formats.
    pub tables: Vec<TableReport>,
    /// Whole pictures beside random walks.
    pub scenes: Vec<SceneReport>,
    /// How far the spherical form is from the convolution on the circle.
    pub spherical_from_circular: Distance,
}

/// Measures the ladder. `progress` is told what is done, and how much of it.
///
/// # Errors
///
/// Where the record of spheres is missing, or the device refuses.
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
    /// The frame of that part of the work and that source of curvature; where none is used, the same for either.
    pub fn frame(&self, part: Part, source: CurvatureSource) -> Option<&FrameReport> {
        self.frames.iter().find(|frame| frame.part == part && frame.curvature.is_none_or(|used| used == source))
    }

    /// Its time in milliseconds.
    pub fn ms(&self, part: Part, source: CurvatureSource) -> Option<f64> {
        Some(self.frame(part, source)?.timing?.ms)
    }

    /// Its error by the measure of that number in [`MEASURES`].
    fn error(&self, measure: usize) -> Option<f64> {
        match measure {
            0 => self.distance.map(|distance| distance.largest),
            1 => self.distance.map(|distance| distance.rms),
            _ => self.residuals.map(|residuals| residuals.fixed),
        }
    }

    /// Whether this rung is faster than `other` in the lit part, with curvature from either source, and errs no more.
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

/// Whether the errors of two rungs by a measure can be compared: the spherical form is measured against another function, but by walks.
fn are_comparable(rungs: [&str; 2], error_measure: &str) -> bool {
    let [one, other] = rungs.map(|rung| rung == SPHERICAL);
    error_measure == MEASURES[2] || one == other
}

impl CdrfReport {
    /// The rung of that name.
    pub fn rung(&self, name: &str) -> Option<&RungReport> {
        self.rungs.iter().find(|rung| rung.rung == name)
    }

    /// How many times as long `slow` takes as `fast`.
    pub fn ratio(&self, slow: &str, fast: &str, part: Part, source: CurvatureSource) -> Option<f64> {
        Some(self.rung(slow)?.ms(part, source)? / self.rung(fast)?.ms(part, source)?)
    }

    /// Marks the rungs that another one beats.
    pub fn mark_dominated(&mut self) {
        mark(&mut self.rungs, RungReport::beats, |rung| &mut rung.dominated);
    }

    /// A row for each rung, measure and view, a view being a part of the work and a source of curvature: `lit+screen`.
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

    /// For people.
    pub fn text(&self) -> String {
        table::text(self)
    }
}

#[cfg(test)]
mod tests;
