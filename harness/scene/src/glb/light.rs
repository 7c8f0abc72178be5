//! Lights as glTF: `KHR_lights_punctual`.

use glam::{DVec3, Vec3};
use serde_json::{Value, json};

use crate::Light;

/// Name of the extension.
pub(super) const EXTENSION: &str = "KHR_lights_punctual";

/// JSON of a light, without its position, with the radius of its disc if it is given.
pub(super) fn light(light: &Light, radius: Option<f32>) -> Value {
    let (kind, radiometric) = match *light {
        Light::Directional { irradiance, .. } => ("directional", irradiance),
        Light::Point { intensity, .. } => ("point", intensity),
        Light::Spot { intensity, .. } => ("spot", intensity),
    };
    // glTF's colours lie between 0 and 1. Computed in f64, so that the product of colour and
    // intensity gives back the original f32.
    let radiometric = radiometric.as_dvec3();
    let intensity = radiometric.max_element();
    let color = if intensity > 0.0 { radiometric / intensity } else { DVec3::ONE };
    let mut json = json!({"type": kind, "color": color.to_array(), "intensity": intensity});
    if let Light::Spot { inner_angle, outer_angle, .. } = *light {
        json["spot"] = json!({"innerConeAngle": f64::from(inner_angle), "outerConeAngle": f64::from(outer_angle)});
    }
    if let Some(radius) = radius {
        json["extras"] = json!({"lapidary": {"radius": radius}});
    }
    json
}

/// JSON of the node that places light `number`.
pub(super) fn node(light: &Light, number: usize) -> Value {
    let mut node = json!({"name": format!("light {number}"), "extensions": {EXTENSION: {"light": number}}});
    match *light {
        Light::Directional { toward, .. } => node["matrix"] = matrix(toward, Vec3::ZERO),
        Light::Spot { position, direction, .. } => node["matrix"] = matrix(-direction, position),
        Light::Point { position, .. } => node["translation"] = json!(position.to_array()),
    }
    node
}

/// Matrix of a node at `place` whose -z axis points away from `backward`. Unlike a rotation, it
/// keeps that direction to the last bit.
fn matrix(backward: Vec3, place: Vec3) -> Value {
    let right = backward.any_orthonormal_vector();
    let columns = [right, backward.cross(right), backward, place];
    let fourth = [0.0, 0.0, 0.0, 1.0];
    columns.iter().zip(fourth).flat_map(|(c, w)| c.extend(w).to_array()).collect()
}
