//! The lights of a file: `KHR_lights_punctual`, placed by the nodes that refer to them.
//!
//! Read are directional and point lights. glTF states them in lux and candela; here the numbers are taken as
//! radiometric, without a luminous efficacy: W/m² and W/sr, as the environment's are W/(m² sr). `range`, at which a
//! renderer may cut a point light off, is not read: the light falls off by the square of the distance alone. As glTF has
//! it, the scale of a node changes no intensity.

use ::gltf::json::Root;
use glam::{DMat4, DVec3, Vec3};
use serde_json::Value;

use super::MAX_COORDINATE;
use super::error::{GltfError, designation, excerpt, item};
use super::extension::Extension;
use super::nodes::ShownNode;
use crate::scene::Light;

const NAME: &str = "KHR_lights_punctual";

/// The lights of the shown nodes, in the nodes' order.
pub(super) fn lights(root: &Root, nodes: &[ShownNode<'_>]) -> Result<Vec<Light>, GltfError> {
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
        let light = place(kind, node.world).ok_or_else(|| {
            GltfError::part(
                node.designation(),
                format!(
                    "its light has no direction or place; give its node a transform without zero scale and within \
                     {MAX_COORDINATE:e}"
                ),
            )
        })?;
        lights.push(light);
    }
    Ok(lights)
}

/// The number of the light that a node refers to, if it does.
fn reference(node: &ShownNode<'_>) -> Result<Option<usize>, String> {
    let all = node.node.extensions.as_ref().map(|all| &all.others);
    if !all.is_some_and(|all| all.contains_key(NAME)) {
        return Ok(None);
    }
    let index = Extension::of(all, NAME)?.member("light").and_then(Value::as_u64);
    let index = index.and_then(|index| usize::try_from(index).ok());
    index.map(Some).ok_or_else(|| format!("its {NAME} names no light by number; export it again"))
}

/// A light without its place.
enum Kind {
    Directional(Vec3),
    Point(Vec3),
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
        Some("spot") => Err("spot lights are not read; use point or directional lights".to_owned()),
        _ => {
            let found = excerpt(&kind.to_string());
            Err(format!("its type is {found}, but must be \"directional\" or \"point\""))
        }
    }
}

/// A glTF light shines along its node's -z. Nothing where the node has no such direction or is nowhere.
fn place(kind: Kind, world: DMat4) -> Option<Light> {
    match kind {
        Kind::Directional(irradiance) => {
            Some(Light::Directional { toward: unit(world.z_axis.truncate())?, irradiance })
        }
        Kind::Point(intensity) => {
            let position = world.w_axis.truncate().as_vec3();
            let in_reach = position.to_array().iter().all(|x| x.abs() <= MAX_COORDINATE);
            in_reach.then_some(Light::Point { position, intensity })
        }
    }
}

fn unit(direction: DVec3) -> Option<Vec3> {
    // A direction that f32 cannot bring closer to unit length stays as it is, to the last bit.
    if (direction.length_squared() - 1.0).abs() < 4.0 * f64::from(f32::EPSILON) {
        return Some(direction.as_vec3());
    }
    direction.try_normalize().map(|unit| unit.as_vec3())
}
