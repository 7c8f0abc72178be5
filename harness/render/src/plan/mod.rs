//! Lists what is compiled, bound and run for a scene: each material's technique, its effects with
//! the property that requires or rules out each, and the resulting passes, pipelines and resources.
//!
//! The renderer compiles by the decisions ([`Decisions`]). The rest is a listing of the frame that
//! it runs.

mod listing;
mod text;

use crate::drawing::copies::with_copies_apart;
use crate::drawing::scene_frame;
use crate::error::RenderError;
use crate::frame::Frame;
use crate::objects::part::names;
use crate::settings::Settings;
use lapidary_plan::{Decisions, Note};
use lapidary_scene::Scene;
pub use listing::{Kind, Listing, Pipeline, Resource, Step};

/// One object of a plan.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedObject {
    /// Name of the object, with `#2` and so on if earlier objects have the same name.
    pub object: String,
    /// Name of its material.
    pub material: String,
    /// Its rung and effects, with reasons.
    pub decisions: Decisions,
}

/// Everything that drawing a scene takes, and why.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Name of the scene.
    pub scene: String,
    /// Width and height of the picture in pixels.
    pub size: [u32; 2],
    /// The objects, in the scene's order.
    pub objects: Vec<PlannedObject>,
    /// Everything created and run; empty for the reference, which is computed on the CPU.
    pub frame: Frame,
    /// The frame, summarised by name.
    pub listing: Listing,
    /// Notes to read before the scene is drawn.
    pub notes: Vec<Note>,
    /// Features that the scene's file asks for and this renderer does not draw.
    pub lacking: Vec<String>,
}

impl Plan {
    /// Plans the drawing of `scene` with these settings. Needs no device.
    ///
    /// # Errors
    /// If the scene cannot be drawn with these settings.
    pub fn of(scene: &Scene, settings: &Settings) -> Result<Self, RenderError> {
        let scene = &*with_copies_apart(scene, settings);
        let frame = scene_frame::frame(None, scene, settings)?;
        let decided = Decisions::all(scene, &settings.request()).into_iter();
        let planned = scene.objects.iter().zip(names(scene)).zip(decided);
        let planned = planned.map(|((object, name), decisions)| PlannedObject {
            object: name,
            material: object.material.name.clone(),
            decisions,
        });
        let objects: Vec<PlannedObject> = planned.collect();
        let decisions: Vec<&Decisions> = objects.iter().map(|planned| &planned.decisions).collect();
        Ok(Self {
            scene: scene.name.clone(),
            size: [settings.width, settings.height],
            notes: lapidary_plan::notes(scene, &settings.request(), &decisions),
            objects,
            listing: Listing::of(&frame),
            frame,
            lacking: scene.lacking.clauses(),
        })
    }

    /// Returns the material of an object; `None` for the name of resources that all objects share.
    #[must_use]
    pub fn material_of(&self, object: &str) -> Option<&str> {
        self.objects.iter().find(|planned| planned.object == object).map(|planned| planned.material.as_str())
    }
}
