//! Opens what a user types: the name of a built-in scene, or the path of a file.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use crate::built_in::{self, list};
use crate::{Opening, Scene, SceneError, gltf};

impl Scene {
    /// Opens the scene that a user names on the command line: a built-in name, or a .glb or .gltf
    /// file.
    ///
    /// # Errors
    /// Returns [`SceneError::UnknownName`] for a word that is neither a built-in nor looks like a
    /// file, and the error of [`gltf::load`] for a file.
    pub fn open(argument: &str) -> Result<Self, SceneError> {
        Self::open_as(argument, &Opening::default())
    }

    /// Opens the same with the camera, and at the time, that were chosen. A built-in scene has neither choice.
    ///
    /// # Errors
    /// As [`Scene::open`], and [`SceneError::NoChoice`] if a built-in scene is asked for another camera or a time.
    pub fn open_as(argument: &str, opening: &Opening) -> Result<Self, SceneError> {
        if names_a_file(argument) {
            return gltf::load_as(Path::new(argument), opening);
        }
        let scene = Self::named(argument)?;
        if *opening == Opening::default() { Ok(scene) } else { Err(SceneError::NoChoice { name: scene.name }) }
    }

    /// Returns the file name, without an extension, for a picture of the scene that [`Scene::open`]
    /// would open: the file's own stem, whatever name the file states, or the built-in's name. The
    /// result is never a path that leads out of the output folder.
    #[must_use]
    pub fn stem(argument: &str) -> OsString {
        if names_a_file(argument) {
            return Path::new(argument).file_stem().map_or_else(|| "scene".into(), OsStr::to_owned);
        }
        list::named(argument).map_or("scene", |scene| scene.name).into()
    }

    /// Returns the files that [`Scene::open`] reads: the file itself, and those that its buffers and images name.
    #[must_use]
    pub fn sources(argument: &str) -> Vec<PathBuf> {
        if names_a_file(argument) { gltf::sources(Path::new(argument)) } else { Vec::new() }
    }

    /// Returns the built-in scene called `name`; see [`BUILT_IN`](crate::BUILT_IN).
    ///
    /// # Errors
    /// Returns [`SceneError::UnknownName`] with the nearest built-in name if there is none called
    /// `name`.
    pub fn named(name: &str) -> Result<Self, SceneError> {
        built_in::build(name)
    }
}

/// Whether a user means a file: the argument is no built-in name, and it looks like a file or
/// exists.
fn names_a_file(argument: &str) -> bool {
    let path = Path::new(argument);
    let extension = path.extension().map(OsStr::to_ascii_lowercase);
    let looks_like_a_file = extension.is_some_and(|e| e == "glb" || e == "gltf") || argument.contains(['/', '\\']);
    list::named(argument).is_none() && (looks_like_a_file || path.is_file())
}
