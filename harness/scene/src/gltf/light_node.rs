//! Lights of a file: `KHR_lights_punctual`, placed by the nodes that refer to them.
//!
//! Directional, point and spot lights are supported. glTF states their intensity in lux and
//! candela; here the numbers are interpreted as radiometric, without a luminous efficacy: W/m² and
//! W/sr, matching the environment's W/(m² sr). `range`, at which a renderer may cut off a point or
//! spot light, is ignored: the light only falls off with the square of the distance. As glTF
//! specifies, the scale of a node does not affect intensity.

use ::gltf::json::Root;
use glam::{DMat4, DVec3, Vec3};
use serde_json::Value;
use std::f64::consts::FRAC_PI_4;

use super::error::{GltfError, designation, excerpt, item};
use super::extension::Extension;
use super::limits::MAX_COORDINATE;
use super::nodes::ShownNode;
use crate::Light;
use crate::light::are_cone_angles;

const NAME: &str = "KHR_lights_punctual";

/// Lights of the visible nodes, in the order of the nodes, with their radii as far as they are given.
pub(super) fn lights(root: &Root, nodes: &[ShownNode<'_>]) -> Result<Vec<(Light, Option<f32>)>, GltfError> {
    let in_file = |problem: String| GltfError::part("the file".to_owned(), problem);
    let all = root.extensions.as_ref().map(|all| &all.others);
    let list = Extension::of(all, NAME).and_then(|extension| extension.list("lights")).map_err(in_file)?;
    let mut lights = Vec::new();
    for node in nodes {
        let Some(index) = reference(node).map_err(|problem| GltfError::part(node.designation(), problem))? else {
            continue;
        };
        let json = item(list, "light", index, || node.designation())?;
        let name = json.get("name").and_then(Value::as_str);
        let kind = read(json).map_err(|problem| GltfError::part(designation("light", index, name), problem))?;
        let radius = radius(json).map_err(|problem| GltfError::part(designation("light", index, name), problem))?;
        let light = place(kind, node.world).ok_or_else(|| {
            GltfError::part(
                node.designation(),
                format!(
                    "its light has no direction or place; give its node a transform without zero scale and within \
                     {MAX_COORDINATE:e}"
                ),
            )
        })?;
        lights.push((light, radius));
    }
    Ok(lights)
}

/// Light that a node refers to, with its index; `None` if there is no such reference.
pub(super) fn of_node<'a>(root: &'a Root, node: &ShownNode<'_>) -> Option<(usize, &'a Value)> {
    let index = reference(node).ok()??;
    let all = root.extensions.as_ref().map(|all| &all.others);
    let list = Extension::of(all, NAME).and_then(|extension| extension.list("lights")).ok()?;
    Some((index, list.get(index)?))
}

/// Index of the light that a node refers to; `None` if there is no such reference.
fn reference(node: &ShownNode<'_>) -> Result<Option<usize>, String> {
    let all = node.node.extensions.as_ref().map(|all| &all.others);
    if !all.is_some_and(|all| all.contains_key(NAME)) {
        return Ok(None);
    }
    let index = Extension::of(all, NAME)?.member("light").and_then(Value::as_u64);
    let index = index.and_then(|index| usize::try_from(index).ok());
    index.map(Some).ok_or_else(|| format!("its {NAME} names no light by number; export it again"))
}

/// A light without its position.
enum Kind {
    Directional(Vec3),
    Point(Vec3),
    Spot { intensity: Vec3, inner_angle: f32, outer_angle: f32 },
}

fn read(json: &Value) -> Result<Kind, String> {
    let light = Extension::inside(json);
    let color = light.three_numbers("color")?.unwrap_or([1.0; 3]);
    let is_positive = |number: &f64| *number >= 0.0;
    if !color.iter().all(is_positive) {
        return Err(format!("its color is {color:?}, but each part must be at least 0"));
    }
    let intensity = light.number("intensity")?.unwrap_or(1.0);
    let product = Vec3::from_array(color.map(|part| (part * intensity) as f32));
    if !(is_positive(&intensity) && product.is_finite()) {
        return Err(format!(
            "its intensity is {intensity:?}, but must be at least 0 and, times its color, finite in single precision"
        ));
    }
    let kind = light.member("type").unwrap_or(&Value::Null);
    match kind.as_str() {
        Some("directional") => Ok(Kind::Directional(product)),
        Some("point") => Ok(Kind::Point(product)),
        Some("spot") => {
            let (inner_angle, outer_angle) = cone(json)?;
            Ok(Kind::Spot { intensity: product, inner_angle, outer_angle })
        }
        _ => {
            let found = excerpt(&kind.to_string());
            Err(format!("its type is {found}, but must be \"directional\", \"point\" or \"spot\""))
        }
    }
}

/// `extras.lapidary.radius` of a light: of a lamp in units of length, of a sun the sine of the angle that it takes up.
fn radius(json: &Value) -> Result<Option<f32>, String> {
    let Some(given) = json.pointer("/extras/lapidary/radius") else { return Ok(None) };
    let most = if json.get("type").and_then(Value::as_str) == Some("directional") { 1.0 } else { f32::MAX };
    let radius = given.as_f64().map(|radius| radius as f32).filter(|radius| *radius > 0.0 && *radius <= most);
    let limit = if most == 1.0 { " and at most 1, the sine of an angle" } else { "" };
    radius.map(Some).ok_or_else(|| {
        format!("its extras.lapidary.radius is {}, but must be above 0{limit}", excerpt(&given.to_string()))
    })
}

/// Inner and outer cone angle of a spot light.
fn cone(json: &Value) -> Result<(f32, f32), String> {
    let spot = Extension::of(json.as_object(), "spot")?;
    let inner = spot.number("innerConeAngle")?.unwrap_or(0.0);
    let outer = spot.number("outerConeAngle")?.unwrap_or(FRAC_PI_4);
    if !are_cone_angles(inner as f32, outer as f32) {
        return Err(format!(
            "its cone angles are {inner:?} and {outer:?}, but the inner must be at least 0, less than the outer in single precision, and \
             the outer at most pi/2"
        ));
    }
    Ok((inner as f32, outer as f32))
}

/// Places a light, which in glTF shines along its node's -z. Returns `None` if the node's direction
/// or position is undefined.
fn place(kind: Kind, world: DMat4) -> Option<Light> {
    match kind {
        Kind::Directional(irradiance) => {
            Some(Light::Directional { toward: unit(world.z_axis.truncate())?, irradiance })
        }
        Kind::Point(intensity) => Some(Light::Point { position: origin(world)?, intensity }),
        Kind::Spot { intensity, inner_angle, outer_angle } => {
            let direction = -unit(world.z_axis.truncate())?;
            Some(Light::Spot { position: origin(world)?, direction, intensity, inner_angle, outer_angle })
        }
    }
}

fn origin(world: DMat4) -> Option<Vec3> {
    let position = world.w_axis.truncate().as_vec3();
    let in_reach = position.to_array().iter().all(|x| x.abs() <= MAX_COORDINATE);
    in_reach.then_some(position)
}

fn unit(direction: DVec3) -> Option<Vec3> {
    // A direction that f32 cannot bring closer to unit length is kept to the last bit.
    if (direction.length_squared() - 1.0).abs() < 4.0 * f64::from(f32::EPSILON) {
        return Some(direction.as_vec3());
    }
    direction.try_normalize().map(|unit| unit.as_vec3())
}
