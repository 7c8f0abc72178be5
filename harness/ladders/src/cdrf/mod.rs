//! The ladder of the curvature-dependent reflectance: each rung's error against the convolution and
//! against random walks through spheres, and its time compared with Lambert's law and a blur in
//! texture space.

pub mod error;
mod frames;
mod head;
mod law;
mod scenes;
mod shader;
mod tables;
mod walks;

use super::{CostError, Ladder, Options, Progress, Report, Row};
use error::Samples;
use lapidary_cdrf::oracle;
use lapidary_gpu::Gpu;
use lapidary_plan::Rung;
use lapidary_scene::solver::Reflectance;

/// The ladder.
pub const LADDER: Ladder = Ladder { name: "cdrf", tables: tables::tables, plots: tables::plots, whole: tables::whole };
/// The rungs: no technique, the cheapest, tables, closed forms, the definition, another function,
/// and the blur that the others replace.
pub const RUNGS: [&str; 10] =
    [LAMBERT, "wrap", PAPER, "table-257-rgba16f", "table-257-r32f", "cheap", "accurate", "quadrature", SPHERICAL, BLUR];
/// The baseline that costs are compared with.
const LAMBERT: &str = "lambert";
/// The paper's rung.
const PAPER: &str = "table-256-rgba8";
/// The rung that approximates a different function from the others and is compared with its own
/// definition.
pub const SPHERICAL: &str = "spherical";
/// The blur in texture space, which the technique replaces.
const BLUR: &str = "blur";
/// The rungs without a table that approximate the convolution.
const ANALYTIC: [&str; 3] = ["cheap", "accurate", "quadrature"];

/// The views: the lit part alone and a whole frame, each with curvature from screen-space
/// derivatives and from vertices.
pub const VIEWS: [&str; 4] = [SCREEN, "lit+vertex", "whole+screen", "whole+vertex"];
/// The view by which errors are looked up, which are those of a function and equal in all views.
pub const SCREEN: &str = "lit+screen";
/// The measures of a row: the largest and the RMS distance from the convolution, and the residuals
/// against random walks through spheres with a free and with a fixed scale.
pub const MEASURES: [&str; 4] = ["largest", "rms", "scale free", "scale fixed"];
/// The view of lookup tables, whose errors alone are measured.
pub const TABLE: &str = "lookup table";
/// The view of the spherical form compared with the others' definition.
pub const CIRCULAR: &str = "circular";

/// Returns what to measure by default.
pub fn options() -> Options<Reflectance> {
    let rung = |name: &&str| if let Ok(Rung::Diffuse(rung)) = name.parse() { Some(rung) } else { None };
    Options { rounds: 7, frame: [1920, 1080], rungs: RUNGS.iter().filter_map(rung).collect() }
}

/// Measures the ladder. The time rows of [`VIEWS`] have the bytes of a rung's textures for one
/// material and the instructions of its vertex and fragment shader; the view `mesh` has the bytes of
/// the timed mesh besides positions, normals and indices.
///
/// # Errors
///
/// Returns an error if the record of spheres is missing or if the device fails.
pub fn run(gpu: &Gpu, options: &Options<Reflectance>, progress: Progress<'_>) -> Result<Report, CostError> {
    let spheres = walks::record(&walks::record_file())?;
    let scenes = frames::Scenes::new()?;
    let [width, height] = options.frame;
    let settings = [
        ("width", u64::from(width)),
        ("height", height.into()),
        ("rounds", options.rounds.into()),
        ("vertices", scenes.vertices() as u64),
        ("spheres", spheres.len() as u64),
        ("side", scenes::SIDE.into()),
    ];
    let mut report = Report::new(LADDER.name, gpu.describe(), &settings);
    let total = options.rungs.len() as u64 + 1;
    progress("comparing", 0, total);
    let convolution = Samples::of_the_convolution();
    let spherical = Samples::of(oracle::spherical);
    let mut errors = Vec::new();
    for (done, &reflectance) in (1..).zip(&options.rungs) {
        progress("comparing", done, total);
        let function = error::function(gpu, reflectance)?;
        let definition = if reflectance == Reflectance::Spherical { &spherical } else { &convolution };
        errors.push(function.map(|function| {
            let distance = definition.distance(&function);
            let [free, fixed] = walks::residuals(&spheres, &function);
            [distance.largest, distance.rms, free, fixed]
        }));
        let bytes = scenes.mesh_bytes(reflectance);
        let mesh = Row::new(reflectance.name(), "mesh", "vertex data", bytes as f64, "B");
        report.rows.push(Row { bytes: Some(bytes), ..mesh });
    }
    frames::measure(gpu, &scenes, options, &errors, &mut report, &mut |done, total| progress("timing", done, total))?;
    for (name, distance) in error::tables(gpu, &convolution)? {
        report.rows.extend(distance.rows(&name, TABLE));
    }
    report.rows.extend(convolution.distance(lapidary_cdrf::spherical).rows(SPHERICAL, CIRCULAR));
    scenes::measure(gpu, options, &mut report, &mut |done, total| progress("beside walks", done, total))?;
    law::measure(gpu, options, &mut report, &mut |done, total| progress("beside walks, by law", done, total))?;
    head::measure(gpu, options, &mut report, &mut |done, total| progress("a head beside walks", done, total))?;
    Ok(report)
}

#[cfg(test)]
mod tests;
