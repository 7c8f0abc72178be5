//! What a scene calls for: each material's technique and rung, and its effects, each with the property that calls for it or rules it out.
//!
//! The words of rendering are here ([`Rung`], [`Effect`], [`Quality`], [`Note`]), and the decisions ([`Decisions`]) that the renderer compiles by.
//!
//! ```
//! use lapidary_plan::{Decisions, Request};
//! use lapidary_scene::Scene;
//!
//! let scene = Scene::open("brilliant")?;
//! let request = Request::of_size([640, 480]);
//! for object in &scene.objects {
//!     println!("{}: {}", object.name, Decisions::of(object, &scene, &request).rung);
//! }
//! # Ok::<(), lapidary_scene::SceneError>(())
//! ```

mod choice;
mod decision;
mod effect;
pub mod ladder;
mod note;
mod notes;
mod numbers;
pub mod quality;
mod rung;
pub mod thickness;

pub use choice::Scattering;
pub use decision::{Decision, Decisions};
pub use effect::{Effect, Effects, UnknownEffect};
pub use note::{Note, Objects};
pub use notes::of as notes;
pub use quality::{Quality, Technique};
pub use rung::{GRAMMAR, Geometry, MOST_HITS, MOST_WAVELENGTHS, NAMES, Rung, Spectrum};

use lapidary_scene::Environment;

/// What a picture is asked to be, as far as decisions go by it.
#[derive(Clone, Copy, Debug)]
pub struct Request<'a> {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// How much of the light's way is followed.
    pub rung: Rung,
    /// Where that is each material's own: how much time it may take.
    pub quality: Quality,
    /// What is left out though a material calls for it.
    pub without: Effects,
    /// How bodies that scatter light are drawn whatever their thickness, where the rung is each material's own.
    pub scattering: Option<Scattering>,
    /// Whether lights cast shadows on what is drawn by its surface alone.
    pub shadows: bool,
    /// The light around the scene.
    pub environment: &'a Environment,
    /// Radiance is multiplied by this before the tone curve.
    pub exposure: f32,
}

impl Request<'_> {
    /// Each material by its own rung in the studio.
    #[must_use]
    pub fn of_size(size: [u32; 2]) -> Self {
        Self {
            size,
            rung: Rung::ByMaterial,
            quality: Quality::default(),
            without: Effects::NONE,
            scattering: None,
            shadows: false,
            environment: &Environment::Studio,
            exposure: 1.0,
        }
    }
}
