//! What a scene requires: each material's technique and rung, and its effects, each with the
//! property that requires it or rules it out.
//!
//! This crate holds the vocabulary of rendering ([`Rung`], [`Effect`], [`Quality`], [`Note`]) and
//! the decisions ([`Decisions`]) by which the renderer compiles.
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

mod among;
pub mod casting;
mod choice;
mod chosen;
mod decision;
mod effect;
pub mod enclosed;
pub mod ladder;
mod note;
mod notes;
mod numbers;
mod outside;
pub mod quality;
mod remembered;
mod request;
mod rung;
mod setting;
mod shape;
pub mod thickness;
mod through;

pub use among::IMAGES_MET;
pub use decision::{Decision, Decisions};
pub use effect::{Effect, Effects, UnknownEffect};
pub use note::{Gravity, Note, Objects};
pub use notes::of as notes;
pub use outside::{MOST_BODIES, Outside};
pub use quality::{Quality, Technique};
pub use request::{Request, Scattering};
pub use rung::{GRAMMAR, Geometry, MOST_HITS, MOST_WAVELENGTHS, NAMES, Rung, Spectrum};
pub use shape::is_smooth;
