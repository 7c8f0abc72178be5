//! The live pages: scenes drawn in the visitor's browser, by the very frames of `cook frame`.
//!
//! [`write()`] exports, for each rung of each scene and each choice of its effects, a frame, and for each slider the
//! values of all fields that it moves, as the renderer itself makes them. A page knows buffers, fields and passes; all
//! that is of a technique is data.

mod again;
mod copying;
mod error;
mod export;
mod fields;
mod part;
mod scenes;
mod slider;
mod store;
#[cfg(test)]
mod tests;

pub use error::LiveError;
pub use export::settings;
pub use part::section;
pub use scenes::{LiveScene, SAMPLES, SCENES, SIDE, page_of};

use lapidary_gpu::Gpu;
use lapidary_scene::Scene;
use std::path::Path;
use store::Store;

/// The path of the picture that stands in a live scene's place before it runs, from the site's folder.
#[must_use]
pub fn poster(live: &LiveScene) -> String {
    format!("images/live/{}.png", live.scene)
}

/// Writes the data of all live scenes to `data/live` of a site's folder, and the pictures that stand in their place
/// before they run to `images/live`.
///
/// # Errors
/// If a scene cannot be drawn or a file not be written.
pub fn write(folder: &Path, gpu: &Gpu) -> Result<(), LiveError> {
    let mut store = Store::new(folder);
    let images = folder.join("images/live");
    std::fs::create_dir_all(&images).map_err(|error| LiveError::Folder { path: images, error })?;
    for live in &SCENES {
        write_scene(live, &mut store)?;
        let settings = settings(live, live.rungs[0], |toggle| toggle.on)?;
        let picture = lapidary_render::render(gpu, &Scene::named(live.scene)?, &settings)?;
        lapidary_render::file::write(&picture, &folder.join(poster(live)))?;
    }
    Ok(())
}

fn write_scene(live: &LiveScene, store: &mut Store) -> Result<export::Manifest, LiveError> {
    let manifest = export::manifest(live, store)?;
    store.deliver(live.scene, &manifest)?;
    Ok(manifest)
}
