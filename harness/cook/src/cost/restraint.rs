//! What restraint saves: work that is skipped because a pixel or a tile does not need it, compared
//! with doing all of it.

mod limit;
mod tables;
mod tiles;
mod variants;

pub use limit::{Limited, facets};
pub use tiles::{TileWay, Tiles};
pub use variants::{VariantWay, Variants};

use super::{CostError, Row};
use lapidary_gpu::Gpu;
use lapidary_plan::Rung;
use serde::{Deserialize, Serialize};

/// The ladder's name.
pub const TECHNIQUE: &str = "restraint";
/// The rungs whose rays end once they carry too little light: few hits and many, with each
/// geometry.
pub const RUNGS: [&str; 6] = ["proxy-4", "proxy-8", "convex-8", "convex-16", "convex-64", "bvh-16"];
/// The scenes: a stone with total reflection, an absorbing one, and one with few facets.
pub const SCENES: [&str; 3] = ["brilliant", "ruby", "prism"];

/// What to measure, and how thoroughly.
#[derive(Clone, Debug)]
pub struct Options {
    /// Rounds of timing, at least 1.
    pub rounds: u32,
    /// Width and height of the timed frame in pixels.
    pub frame: [u32; 2],
    /// Rungs for clear stones.
    pub rungs: Vec<Rung>,
}

impl Default for Options {
    fn default() -> Self {
        let rungs = RUNGS.iter().filter_map(|name| name.parse().ok()).collect();
        Self { rounds: 5, frame: [480, 270], rungs }
    }
}

/// The results for each kind of restraint.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RestraintReport {
    /// The device and its driver.
    pub adapter: String,
    /// Width and height of the timed frame in pixels.
    pub frame: [u32; 2],
    /// Rounds of timing.
    pub rounds: u32,
    /// Rays that end once they carry too little light, by scene and rung.
    pub limited: Vec<Limited>,
    /// Optical paths solved by tiles, by grid.
    pub tiles: Vec<Tiles>,
    /// Stones of several materials, each with its own variant of the recipe.
    pub variants: Variants,
}

/// Measures all kinds of restraint. `progress` receives the current step, the work done and the
/// total.
///
/// # Errors
///
/// Returns an error if a scene cannot be made or if the device fails.
pub fn run(
    gpu: &Gpu,
    options: &Options,
    progress: &mut dyn FnMut(&'static str, u64, u64),
) -> Result<RestraintReport, CostError> {
    let limited = limit::measure(gpu, options, progress)?;
    let tiles = tiles::measure(gpu, options.rounds, &mut |done, total| progress("solving by tiles", done, total))?;
    let variants = variants::measure(gpu, options.frame, options.rounds, &mut |done, total| {
        progress("drawing stones", done, total);
    })?;
    let (adapter, frame, rounds) = (gpu.describe(), options.frame, options.rounds);
    Ok(RestraintReport { adapter, frame, rounds, limited, tiles, variants })
}

impl RestraintReport {
    /// Returns one row per variant of each restraint. The error is the largest difference from the
    /// result without restraint.
    pub fn rows(&self) -> Vec<Row> {
        let row = |rung: String, view: &str, error: f64, error_measure, ms| Row {
            technique: TECHNIQUE,
            rung,
            view: view.to_owned(),
            error: Some(error),
            error_measure,
            ms: Some(ms),
            dominated: false,
            adapter: self.adapter.clone(),
        };
        let rays = self.limited.iter().flat_map(|limited| {
            limited.ways().map(|(way, error, timing)| {
                row(format!("{} {way}", limited.rung), &limited.scene, error, "radiance", timing.ms)
            })
        });
        let tiles = self.tiles.iter().flat_map(|tiles| {
            tiles.ways.iter().map(|way| {
                let rung = format!("{}-{} {}", tiles.method, tiles.cells, way.way);
                row(rung, &tiles.scene, f64::from(way.differing), "voxels", way.ms)
            })
        });
        let variants = self.variants.ways.iter().map(|way| {
            let rung = format!("{}, {}", self.variants.rung, way.way);
            row(rung, &self.variants.scene, way.largest, "radiance", way.timing.ms)
        });
        rays.chain(tiles).chain(variants).collect()
    }

    /// Returns the report as text.
    pub fn text(&self) -> String {
        tables::text(self)
    }
}
