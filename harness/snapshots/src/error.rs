//! Why a picture could not be compared or accepted.

use super::sizes::LARGEST_FILE;
use lapidary_render::{RenderError, file};
use lapidary_scene::SceneError;
use std::path::PathBuf;

/// Why a snapshot test failed.
#[derive(Debug, thiserror::Error)]
pub enum SnapshotError {
    /// The reference is missing; references are never generated automatically.
    #[error("{}: missing; look at the new picture, then accept it with `./cook snapshots --accept`", .0.display())]
    Missing(PathBuf),
    /// A reference cannot be decoded.
    #[error("{path}: unreadable: {reason}; restore it from version control")]
    Unreadable {
        /// Path of the reference.
        path: PathBuf,
        /// The decoder's message.
        reason: String,
    },
    /// A reference has the wrong size.
    #[error("{path}: is {found:?} pixels, expected {expected:?}; accept a new one with `./cook snapshots --accept`")]
    Size {
        /// Path of the reference.
        path: PathBuf,
        /// Width and height of the reference in pixels.
        found: (u32, u32),
        /// Width and height of the rendered picture in pixels.
        expected: (u32, u32),
    },
    /// A pixel is NaN or infinite.
    #[error(
        "{what}: pixel ({column}, {row}) is {value:?}; find out why, such a picture is never a reference nor like one"
    )]
    NotFinite {
        /// Name of the picture.
        what: String,
        /// Column of the pixel, from the left.
        column: u32,
        /// Row of the pixel, from the top.
        row: u32,
        /// Value of the pixel.
        value: [f32; 4],
    },
    /// A file is too large to commit.
    #[error("{path}: {bytes} bytes, at most {LARGEST_FILE} are committed")]
    TooLarge {
        /// Path of the file.
        path: PathBuf,
        /// Size of the file in bytes.
        bytes: u64,
    },
    /// The picture to compare could not be rendered.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The scene to render could not be made.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A picture could not be written.
    #[error(transparent)]
    File(#[from] file::FileError),
}
