//! Errors when opening a scene.

use std::path::PathBuf;

use thiserror::Error;

use super::cuts::CutError;
use super::gltf::GltfError;

/// Why a scene cannot be opened. Each message is one line that says where, what, and what to do.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SceneError {
    /// Neither a built-in scene nor a file.
    #[error("no scene is called `{}`{hint}; give one of {known} or a .glb or .gltf file", name.escape_debug())]
    UnknownName {
        /// The name that was asked for.
        name: String,
        /// ` (did you mean ...?)` if a built-in scene's name is close, otherwise empty.
        hint: String,
        /// The built-in scenes' names.
        known: String,
    },
    /// A built-in scene is asked for what only files have.
    #[error("scene `{name}` is built in: it has one camera and no animation; leave the camera and the time out")]
    NoChoice {
        /// Name of the scene.
        name: String,
    },
    /// A file cannot be used.
    #[error("{}: {problem}", path.display())]
    File {
        /// Path of the file.
        path: PathBuf,
        /// What is wrong with the file.
        problem: GltfError,
    },
    /// Bytes that did not come from a file cannot be used.
    #[error(transparent)]
    Gltf(#[from] GltfError),
    /// The parameters of a cut do not make a stone.
    #[error(transparent)]
    Cut(#[from] CutError),
}
