//! What restraint saves: work that is left out because a pixel or a tile has no use for it, beside the same work done.

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
/// The rungs whose rays are ended by what they carry: few hits and many, by each geometry.
pub const RUNGS: [&str; 6] = ["proxy-4", "proxy-8", "convex-8", "convex-16", "convex-64", "bvh-16"];
/// The scenes: a stone that reflects totally, one that absorbs, and one with few facets.
pub const SCENES: [&str; 3] = ["brilliant", "ruby", "prism"];

/// What is measured, and how carefully.
#[derive(Clone, Debug)]
pub struct Options {
    /// Rounds of timing, at least 1.
    pub rounds: u32,
    /// Width and height of the timed frame.
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

/// Each restraint, measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RestraintReport {
    /// The device and its driver.
    pub adapter: String,
    /// The size of the timed frame.
    pub frame: [u32; 2],
    /// Rounds of timing.
    pub rounds: u32,
    /// Rays that end by what they carry, by scene and rung.
    pub limited: Vec<Limited>,
    /// Ways through a body by tiles, by grid.
    pub tiles: Vec<Tiles>,
    /// Stones of several materials, each by its own variant of the recipe.
    pub variants: Variants,
}

/// Measures all of them. `progress` is told what is done, and how much of it.
///
/// # Errors
///
/// Where a scene cannot be made, or the device refuses.
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
    /// A row for each way of each restraint. The error is the largest difference from the work without it.
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

    /// For people.
    pub fn text(&self) -> String {
        tables::text(self)
    }
}
