//! From a scene to what is compiled, bound and run for it: each material's technique, its effects with the property that calls for each or
//! rules it out, and the passes, pipelines and resources that follow.
//!
//! The decisions ([`Decisions`]) are what the renderer compiles by. What follows from them is not foretold but found: the renderer
//! itself draws the scene on a device that does nothing, and everything that it makes and runs is written down.

mod choice;
mod decision;
mod effect;
pub mod ladder;
mod notes;
mod numbers;
pub mod quality;
mod text;
pub mod thickness;

pub use choice::Scattering;
pub use decision::{Decision, Decisions};
pub use effect::{Effect, Effects, UnknownEffect};
pub use quality::{Quality, Technique};

use crate::gpu::Gpu;
use crate::gpu::capture::{Capture, capture};
use crate::render::{self, Note, RenderError, Rung, Settings};
use crate::scene::Scene;

/// What one object is drawn with.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedObject {
    /// Its name; with `#2` and so on where others before it have the same.
    pub object: String,
    /// Its material's name.
    pub material: String,
    /// What it calls for.
    pub decisions: Decisions,
}

/// What drawing a scene takes, and why.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// The scene's name.
    pub scene: String,
    /// Of the picture, in pixels.
    pub size: [u32; 2],
    /// The objects, in the scene's order.
    pub objects: Vec<PlannedObject>,
    /// Passes, pipelines and resources.
    pub capture: Capture,
    /// What should be known before the scene is drawn.
    pub notes: Vec<Note>,
    /// What the scene's file asks for and nothing here draws.
    pub lacking: Vec<String>,
}

/// What should be known of a scene before it is drawn with these settings: meshes, materials, lights and a camera that no technique can do justice
/// to, each thing once.
#[must_use]
pub fn notes(scene: &Scene, settings: &Settings) -> Vec<Note> {
    let all: Vec<Decisions> = scene.objects.iter().map(|object| Decisions::of(object, scene, settings)).collect();
    notes::of(scene, settings, &all.iter().collect::<Vec<_>>())
}

impl Plan {
    /// What drawing `scene` with these settings takes. The reference, which is computed on the CPU, takes nothing of a device.
    ///
    /// # Errors
    /// Where the scene cannot be drawn so.
    pub fn of(scene: &Scene, settings: &Settings) -> Result<Self, RenderError> {
        let planned = |(object, name): (&crate::scene::Object, String)| PlannedObject {
            object: name,
            material: object.material.name.clone(),
            decisions: Decisions::of(object, scene, settings),
        };
        let capture = if settings.rung == Rung::Reference {
            Capture::default()
        } else {
            let gpu = Gpu::without_hardware();
            let (picture, captured) = capture(|| render::render(&gpu, scene, settings));
            picture?;
            captured
        };
        let objects: Vec<PlannedObject> = scene.objects.iter().zip(render::object_names(scene)).map(planned).collect();
        let decisions: Vec<&Decisions> = objects.iter().map(|planned| &planned.decisions).collect();
        Ok(Self {
            scene: scene.name.clone(),
            size: [settings.width, settings.height],
            notes: notes::of(scene, settings, &decisions),
            objects,
            capture,
            lacking: scene.lacking.clone(),
        })
    }

    /// The material of an object; nothing for what all objects share.
    #[must_use]
    pub fn material_of(&self, object: &str) -> Option<&str> {
        self.objects.iter().find(|planned| planned.object == object).map(|planned| planned.material.as_str())
    }
}
