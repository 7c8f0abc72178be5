//! From a scene to what is compiled, bound and run for it: each material's technique, its effects with the property that calls for each or
//! rules it out, and the passes, pipelines and resources that follow.
//!
//! The decisions ([`Decisions`]) are what the renderer compiles by. What follows from them is the frame that it runs, listed.

mod listing;
mod text;

use crate as render;
use crate::frame::Frame;
use crate::{RenderError, Settings};
use lapidary_plan::{Decisions, Note};
use lapidary_scene::Scene;
pub use listing::{Kind, Listing, Pipeline, Resource, Step};

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
#[derive(Clone, Debug)]
pub struct Plan {
    /// The scene's name.
    pub scene: String,
    /// Of the picture, in pixels.
    pub size: [u32; 2],
    /// The objects, in the scene's order.
    pub objects: Vec<PlannedObject>,
    /// What is made and run: nothing for the reference, which is computed on the CPU.
    pub frame: Frame,
    /// The same, summed up by name.
    pub listing: Listing,
    /// What should be known before the scene is drawn.
    pub notes: Vec<Note>,
    /// What the scene's file asks for and nothing here draws.
    pub lacking: Vec<String>,
}

impl Plan {
    /// What drawing `scene` with these settings takes. Needs no device.
    ///
    /// # Errors
    /// Where the scene cannot be drawn so.
    pub fn of(scene: &Scene, settings: &Settings) -> Result<Self, RenderError> {
        let planned = |(object, name): (&lapidary_scene::Object, String)| PlannedObject {
            object: name,
            material: object.material.name.clone(),
            decisions: Decisions::of(object, scene, &settings.request()),
        };
        let frame = render::frame(None, scene, settings)?;
        let objects: Vec<PlannedObject> = scene.objects.iter().zip(render::object_names(scene)).map(planned).collect();
        let decisions: Vec<&Decisions> = objects.iter().map(|planned| &planned.decisions).collect();
        Ok(Self {
            scene: scene.name.clone(),
            size: [settings.width, settings.height],
            notes: lapidary_plan::notes(scene, &settings.request(), &decisions),
            objects,
            listing: Listing::of(&frame),
            frame,
            lacking: scene.lacking.clone(),
        })
    }

    /// The material of an object; nothing for what all objects share.
    #[must_use]
    pub fn material_of(&self, object: &str) -> Option<&str> {
        self.objects.iter().find(|planned| planned.object == object).map(|planned| planned.material.as_str())
    }
}
