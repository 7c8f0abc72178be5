//! Why the gallery was not written.

use super::data::DataError;
use super::ladder::LadderError;
use super::live::LiveError;
use super::rows::RowsError;
use super::take::TakeError;
use lapidary_files::folder::FolderError;
use std::io;
use std::path::PathBuf;

/// Why the gallery was not written. Anything that existed at its path is unchanged.
#[derive(Debug, thiserror::Error)]
pub enum GalleryError {
    /// A picture's file is missing or damaged.
    #[error("picture `{title}`: {} cannot be shown: {source}; render it again with `{command}`", file.display())]
    Picture {
        /// The picture's title.
        title: String,
        /// Expected path of its file.
        file: PathBuf,
        /// The command that renders it.
        command: String,
        /// The underlying file system error.
        source: io::Error,
    },
    /// A file of the repository cannot be read.
    #[error("{}: cannot be read: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The underlying file system error.
        source: io::Error,
    },
    /// The ladders were not drawn.
    #[error(transparent)]
    Ladder(#[from] LadderError),
    /// A shader to take was not made.
    #[error(transparent)]
    Take(#[from] TakeError),
    /// The live scenes were not written.
    #[error(transparent)]
    Live(#[from] LiveError),
    /// The property rows were not written.
    #[error(transparent)]
    Rows(#[from] RowsError),
    /// What pages load on demand was not written.
    #[error(transparent)]
    Data(#[from] DataError),
    /// The folder was not written.
    #[error(transparent)]
    Folder(#[from] FolderError),
}
