//! What a host has to know to run a recipe: entry points, bindings with their layouts, overrides, and, from frames
//! that the renderer makes, passes and sizes. `docs/recipes/` holds a page for each recipe.

mod frames;
mod page;
mod recipe;
mod sizes;

use crate::cookbook::marks;
use lapidary_render::RenderError;
use lapidary_scene::SceneError;
use lapidary_wgsl::RECIPES;

/// Why the pages could not be made.
#[derive(Debug, thiserror::Error)]
pub enum HostError {
    /// A recipe is not sound.
    #[error("recipe `{recipe}`: {message}")]
    Recipe {
        /// The recipe.
        recipe: &'static str,
        /// What is wrong.
        message: String,
    },
    /// A size or a number of workgroups has no formula, or another one.
    #[error("recipe `{recipe}`, {what} in `{frame}`: {message}; see harness/cook/src/host/sizes.rs")]
    Size {
        /// The recipe.
        recipe: String,
        /// The binding or the entry point.
        what: String,
        /// The frame's command.
        frame: &'static str,
        /// What is wrong.
        message: String,
    },
    /// A frame's settings are not sound.
    #[error("frame `{command}`: {message}")]
    Example {
        /// The frame's command.
        command: &'static str,
        /// What is wrong.
        message: String,
    },
    /// A scene cannot be opened.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A frame cannot be made.
    #[error(transparent)]
    Render(#[from] RenderError),
}

/// Returns the pages: the names of files in `docs/recipes/` with their texts.
///
/// # Errors
/// Returns an error if a recipe is not sound, or if a frame holds a size that no formula gives.
pub fn pages() -> Result<Vec<(String, String)>, HostError> {
    let mut all = Vec::new();
    for recipe in RECIPES {
        let failed = |message: String| HostError::Recipe { recipe: recipe.name, message };
        let source = marks::without(recipe, &[]).map_err(|fault| failed(fault.message))?;
        all.push(recipe::Description::of(recipe, &source).map_err(failed)?);
    }
    let (uses, frames) = frames::all(&all)?;
    let own = |name: &str| uses.iter().filter(|of| of.recipe == name).collect::<Vec<_>>();
    let rows = all.iter().map(|described| page::row(described, &own(described.name))).collect();
    let pages = all.iter().map(|of| (format!("{}.md", of.name), page::of(of, &own(of.name))));
    Ok(std::iter::once(("README.md".to_owned(), page::index(rows, &frames))).chain(pages).collect())
}
