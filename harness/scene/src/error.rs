//! What goes wrong when a scene is opened.

use std::path::PathBuf;

use thiserror::Error;

use super::built_in::names;
use super::cuts::CutError;
use super::gltf::GltfError;

/// Why there is no scene. Each message is one line that says where, what, and what to do.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SceneError {
    /// Neither a built-in scene nor a file.
    #[error("no scene is called {name:?}; did you mean {nearest}? Give one of {} or a .glb or .gltf file", names())]
    UnknownName {
        /// What was asked for.
        name: String,
        /// The built-in name that is most like it.
        nearest: &'static str,
    },
    /// A file cannot be used.
    #[error("{}: {problem}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        problem: GltfError,
    },
    /// Bytes that did not come from a file cannot be used.
    #[error(transparent)]
    Gltf(#[from] GltfError),
    /// A cut's parameters do not make a stone.
    #[error(transparent)]
    Cut(#[from] CutError),
}
