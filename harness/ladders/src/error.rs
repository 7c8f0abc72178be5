//! Why a ladder could not be measured or shown.

use lapidary_specialise::SpecialiseError;
use lapidary_specialise::spirv_counts::SpirvCountsError;

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
