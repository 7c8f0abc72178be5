//! Lamps that stand inside a body.

use lapidary_scene::{Light, Object};

/// Returns for each light whether it is a lamp or a spot inside the body.
#[must_use]
pub fn lamps(object: &Object, lights: &[Light]) -> Vec<bool> {
    let encloses = |light: &Light| match light {
        Light::Directional { .. } => false,
        Light::Point { position, .. } | Light::Spot { position, .. } => object.mesh.encloses(*position),
    };
    lights.iter().map(encloses).collect()
}

/// Returns how many lamps stand inside the body.
#[must_use]
pub fn count(object: &Object, lights: &[Light]) -> usize {
    lamps(object, lights).into_iter().filter(|inside| *inside).count()
}
