//! The camera of a built-in scene, placed so that the bodies fill the picture.

use glam::Vec3;

use crate::object::vertices;
use crate::{BuiltInEnvironment, Camera, Lacking, Object, Scene};

/// A short portrait lens: about 27° from edge to edge.
pub(super) const VERTICAL_FOV: f32 = 0.47;

/// Builds a scene without lights whose camera sees all `objects` from the direction `toward_eye`.
pub(crate) fn framed(name: &str, objects: Vec<Object>, toward_eye: Vec3) -> Scene {
    let camera = Camera::framing(vertices(&objects), toward_eye, VERTICAL_FOV);
    Scene {
        name: name.to_owned(),
        objects,
        lights: Vec::new(),
        light_radii: Vec::new(),
        environment: BuiltInEnvironment::Studio,
        camera,
        lacking: Lacking::default(),
    }
}
