//! Why the ladders could not be shown.

use lapidary_ladders::CostError;
use lapidary_render::{RenderError, file::FileError};
use lapidary_snapshots::SnapshotError;
use std::path::PathBuf;

/// Why the ladders could not be shown.
#[derive(Debug, thiserror::Error)]
pub enum LadderError {
    /// A committed report or reference is missing or damaged.
    #[error(transparent)]
    Cost(#[from] CostError),
    /// A committed reference is damaged.
    #[error(transparent)]
    Reference(#[from] SnapshotError),
    /// A picture could not be drawn.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// A picture could not be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// A folder could not be made.
    #[error("{}: cannot be made: {error}", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// The system's error.
        error: std::io::Error,
    },
}
