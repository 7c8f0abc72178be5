//! Lights as glTF: `KHR_lights_punctual`.

use glam::{DVec3, Vec3};
use serde_json::{Value, json};

use crate::Light;

/// The extension's name.
pub(super) const EXTENSION: &str = "KHR_lights_punctual";

/// The light, still without its place.
pub(super) fn light(light: &Light) -> Value {
    let (kind, radiometric) = match *light {
        Light::Directional { irradiance, .. } => ("directional", irradiance),
        Light::Point { intensity, .. } => ("point", intensity),
        Light::Spot { intensity, .. } => ("spot", intensity),
    };
    // glTF's colours lie from 0 to 1. In f64, so that the product of the two is the f32 that it was.
    let radiometric = radiometric.as_dvec3();
    let intensity = radiometric.max_element();
    let color = if intensity > 0.0 { radiometric / intensity } else { DVec3::ONE };
    let mut json = json!({"type": kind, "color": color.to_array(), "intensity": intensity});
    if let Light::Spot { inner_angle, outer_angle, .. } = *light {
        json["spot"] = json!({"innerConeAngle": f64::from(inner_angle), "outerConeAngle": f64::from(outer_angle)});
    }
    json
}

/// The node that places light `number`.
pub(super) fn node(light: &Light, number: usize) -> Value {
    let mut node = json!({"name": format!("light {number}"), "extensions": {EXTENSION: {"light": number}}});
    match *light {
        Light::Directional { toward, .. } => node["matrix"] = matrix(toward, Vec3::ZERO),
        Light::Spot { position, direction, .. } => node["matrix"] = matrix(-direction, position),
        Light::Point { position, .. } => node["translation"] = json!(position.to_array()),
    }
    node
}

/// The matrix of a node at a place that shines along its -z, away from `backward`. It holds that direction to the last bit, which a rotation
/// would not.
fn matrix(backward: Vec3, place: Vec3) -> Value {
    let right = backward.any_orthonormal_vector();
    let columns = [right, backward.cross(right), backward, place];
    let fourth = [0.0, 0.0, 0.0, 1.0];
    columns.iter().zip(fourth).flat_map(|(c, w)| c.extend(w).to_array()).collect()
}
