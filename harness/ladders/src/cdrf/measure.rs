//! Measures the ladder of reflectances.

use super::error::{self, Samples};
use super::rungs::{CIRCULAR, NAME, SPHERICAL, TABLE};
use super::{as_drawn, frames, scenes, sphere_fit, spheres};
use crate::error::CostError;
use crate::options::{Options, Progress};
use crate::report::{Report, Row};
use lapidary_cdrf::oracle;
use lapidary_gpu::Gpu;
use lapidary_scene::solver::Reflectance;

/// Measures the ladder. The time rows of [`VIEWS`](super::VIEWS) have the bytes of a rung's textures for one
/// material and the instructions of its vertex and fragment shader; the view `mesh` has the bytes of
/// the timed mesh besides positions, normals and indices.
///
/// # Errors
///
/// Returns an error if the record of spheres is missing or if the device fails.
pub fn run(gpu: &Gpu, options: &Options<Reflectance>, progress: Progress<'_>) -> Result<Report, CostError> {
    let walked = spheres::record(&spheres::record_file())?;
    let scenes = frames::Scenes::new()?;
    let [width, height] = options.frame;
    let settings = [
        ("width", u64::from(width)),
        ("height", height.into()),
        ("rounds", options.rounds.into()),
        ("vertices", scenes.vertices() as u64),
        ("spheres", walked.len() as u64),
        ("side", scenes::SIDE.into()),
    ];
    let mut report = Report::new(NAME, gpu.describe(), &settings);
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
            let [free, fixed] = sphere_fit::residuals(&walked, &function);
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
    let mut step = |done, total| progress("beside walks, as drawn", done, total);
    as_drawn::measure(gpu, options.rounds, &mut report, &mut step)?;
    Ok(report)
}
