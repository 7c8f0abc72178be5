//! Why the folder of all texts was not written.

use lapidary_files::folder::FolderError;
use lapidary_translate::TranslateError;

/// Why the folder was not written. Anything that existed at its path is unchanged.
#[derive(Debug, thiserror::Error)]
pub enum DistError {
    /// The folder was not written.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// A module cannot be translated.
    #[error(transparent)]
    Translate(#[from] TranslateError),
    /// A recipe cannot be written.
    #[error("recipe `{recipe}`: {message}")]
    Recipe {
        /// The recipe.
        recipe: &'static str,
        /// What is wrong.
        message: String,
    },
}
