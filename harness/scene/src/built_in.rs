//! The scenes that come with the program.

use super::{Scene, SceneError};
use list::{ALIASES, BUILT_IN, named, names};

mod cut;
pub(crate) mod framing;
pub(crate) mod list;
mod materials;
mod pave;
pub mod presets;
mod prisms;
mod ring;
mod stone;
mod translucent;
mod tray;
mod tumbler;
mod vitrine;

/// Builds the scene called `name`.
pub(super) fn build(name: &str) -> Result<Scene, SceneError> {
    match named(name) {
        Some(scene) => (scene.make)(scene.name),
        None => Err(SceneError::UnknownName { name: name.to_owned(), hint: hint(name), known: names() }),
    }
}

/// Returns the built-in whose name, or alias, is most like `name`.
fn hint(name: &str) -> String {
    let known = BUILT_IN.iter().map(|scene| scene.name).chain(ALIASES.iter().map(|(alias, _)| *alias));
    let near = lapidary_files::nearest::close(name, known).and_then(named);
    near.map_or(String::new(), |scene| format!(" (did you mean `{}`?)", scene.name))
}
