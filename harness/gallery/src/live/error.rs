//! Why the live pages' data was not written.

use super::super::data::DataError;
use lapidary_render::RenderError;
use lapidary_render::file::FileError;
use lapidary_scene::SceneError;
use std::path::PathBuf;

/// Why the live pages' data was not written.
#[derive(Debug, thiserror::Error)]
pub enum LiveError {
    /// A scene does not load.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A frame cannot be made.
    #[error(transparent)]
    Render(Box<RenderError>),
    /// A shader cannot be written.
    #[error(transparent)]
    Wgsl(#[from] naga::back::wgsl::Error),
    /// A description cannot be written.
    #[error(transparent)]
    Json(#[from] serde_json::Error),
    /// A picture cannot be written.
    #[error(transparent)]
    Picture(#[from] FileError),
    /// A rung's name is unknown.
    #[error("no rung is named `{0}`")]
    Rung(String),
    /// A resource's contents are computed by a device.
    #[error("the contents of `{0}` are computed by a device; take another rung")]
    LeftOut(String),
    /// A slider changes more than fields of structs.
    #[error("slider `{slider}` at {value}: the frame differs in more than fields of structs: {what}; narrow its range")]
    Structure {
        /// Name of the slider.
        slider: &'static str,
        /// Its value.
        value: f32,
        /// What differs.
        what: String,
    },
    /// A frame cannot be written.
    #[error(transparent)]
    Data(#[from] DataError),
    /// A folder cannot be made.
    #[error("{}: cannot be made: {error}", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// The system's error.
        error: std::io::Error,
    },
}

impl From<RenderError> for LiveError {
    fn from(error: RenderError) -> Self {
        Self::Render(Box::new(error))
    }
}
