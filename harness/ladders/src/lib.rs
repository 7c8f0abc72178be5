//! What accuracy costs in time: each rung of a technique's ladder is compared with its reference
//! and timed, all in one run.
//!
//! A ladder measures rows ([`Report`]); its tables are lists of columns over the rows ([`Table`]),
//! its plots are series of them ([`Plot`]).

pub mod builtins;
pub mod cdrf;
pub mod command;
pub mod dynamic;
pub mod effects;
pub mod gem;
pub mod optical_path;
pub mod outside;
pub mod page;
pub mod plot;
mod quality;
pub mod report;
pub mod restraint;
pub mod sphere;
pub mod table;
mod timing;
pub mod translucent;

pub use plot::Plot;
pub use report::{Report, Row};
pub use table::Table;
pub use timing::{Timed, Timing};

use lapidary_plan::Rung;
use lapidary_specialise::SpecialiseError;
use lapidary_specialise::spirv_counts::SpirvCountsError;

/// Receives the current step of a measurement, the work done and the total.
pub type Progress<'a> = &'a mut dyn FnMut(&'static str, u64, u64);

/// What to measure, and how thoroughly.
#[derive(Clone, Debug)]
pub struct Options<R = Rung> {
    /// Rounds of timing; 0 skips timing.
    pub rounds: u32,
    /// Width and height of the timed frame in pixels.
    pub frame: [u32; 2],
    /// The rungs to measure.
    pub rungs: Vec<R>,
}

/// How a ladder's report is shown.
pub struct Ladder {
    /// The ladder's name.
    pub name: &'static str,
    /// Makes the tables.
    pub tables: fn(&Report) -> Vec<Table>,
    /// Makes the plots, of which some may be empty.
    pub plots: fn(&Report) -> Vec<Plot>,
    /// Checks that a report has all that its tables show, and else says what a page would lack.
    pub whole: fn(&Report) -> Result<(), String>,
}

/// All ladders.
pub const LADDERS: [Ladder; 9] = [
    gem::LADDER,
    cdrf::LADDER,
    optical_path::LADDER,
    effects::LADDER,
    outside::LADDER,
    translucent::LADDER,
    dynamic::LADDER,
    restraint::LADDER,
    sphere::LADDER,
];

/// Why a ladder could not be measured or shown.
#[derive(Debug, thiserror::Error)]
pub enum CostError {
    /// A file is not a report of the ladder.
    #[error("not a {ladder}.json of `./cook cost {ladder} --out`: {what}; measure anew")]
    Unfit {
        /// The ladder's name.
        ladder: String,
        /// What is wrong.
        what: String,
    },
    /// The report could not be written as JSON.
    #[error("writing the report: {0}")]
    Json(#[from] serde_json::Error),
    /// A measurement failed so badly that its value is no finite number.
    #[error("{row} is infinite or not a number; this is a defect of the rung, please report it")]
    NotFinite {
        /// The measurement.
        row: String,
    },
    /// The record of spheres is missing or unusable, so there is nothing to compare with.
    #[error(
        "{}: {what}; restore it from version control, or remake it: ./cook cost sphere --out docs/measurements/random_walk",
        path.display()
    )]
    Record {
        /// Expected path of the record.
        path: std::path::PathBuf,
        /// What is wrong.
        what: String,
    },
    /// A picture or a frame could not be rendered.
    #[error(transparent)]
    Render(#[from] lapidary_render::RenderError),
    /// A view's scene could not be made.
    #[error(transparent)]
    Scene(#[from] lapidary_scene::SceneError),
    /// The reference to compare with is missing; references are never generated automatically.
    #[error("{}: missing; restore it from version control, or remake it: {command}", path.display())]
    NoReference {
        /// Expected path of the reference.
        path: std::path::PathBuf,
        /// The command that makes the reference.
        command: String,
    },
    /// A committed reference is damaged.
    #[error(transparent)]
    Reference(#[from] lapidary_snapshots::SnapshotError),
    /// The recipe could not be specialised for counting its instructions.
    #[error("counting instructions: {0}")]
    Specialise(#[from] SpecialiseError),
    /// The instructions of the specialised recipe could not be counted.
    #[error("counting instructions: {0}")]
    Counts(#[from] SpirvCountsError),
}
