//! Why the pages for hosts were not written.

use lapidary_render::RenderError;
use lapidary_scene::SceneError;

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
    #[error("recipe `{recipe}`, {what} in `{frame}`: {message}; see harness/xtask/src/host/sizes.rs")]
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
