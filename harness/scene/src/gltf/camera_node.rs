//! Camera of a file.

use ::gltf::json::Root;
use glam::{DMat4, DVec3};

use super::error::{GltfError, designation, item};
use super::limits::MAX_COORDINATE;
use super::nodes::ShownNode;
use crate::object::vertices;
use crate::{Bounds, Camera, Object};

/// Returns the first perspective camera among the visible nodes, or `None`.
pub(super) fn first_perspective(
    root: &Root,
    nodes: &[ShownNode<'_>],
    objects: &[Object],
) -> Result<Option<Camera>, GltfError> {
    for node in nodes {
        let Some(index) = node.node.camera.map(|camera| camera.value()) else {
            continue;
        };
        let camera = item(&root.cameras, "camera", index, || node.designation())?;
        let Some(perspective) = &camera.perspective else {
            continue;
        };
        let fov = perspective.yfov;
        if !(fov > 0.0 && fov < std::f32::consts::PI) {
            return Err(GltfError::part(
                designation("camera", index, camera.name.as_deref()),
                format!("its yfov is {fov}, but must lie above 0 and below π (180°)"),
            ));
        }
        // Nothing is cut off at either, but a file that contradicts itself is told.
        if let Some(far) = perspective.zfar
            && far <= perspective.znear
        {
            return Err(GltfError::part(
                designation("camera", index, camera.name.as_deref()),
                format!("its zfar is {far}, but must be above its znear, {}", perspective.znear),
            ));
        }
        let bounds = Bounds::of(vertices(objects));
        let placed = place(node.world, fov, &bounds).ok_or_else(|| {
            GltfError::part(
                node.designation(),
                "its camera has no direction or place; give its node a transform without zero scale",
            )
        })?;
        return Ok(Some(placed));
    }
    Ok(None)
}

/// A glTF camera looks along its node's -z with +y up; the scale of its node has no effect.
fn place(world: DMat4, vertical_fov: f32, bounds: &Bounds) -> Option<Camera> {
    let eye = world.w_axis.truncate();
    let forward = (-world.z_axis.truncate()).try_normalize()?;
    let upright = world.y_axis.truncate().try_normalize()?;
    let up = (upright - forward * forward.dot(upright)).try_normalize()?;
    let in_reach = |x: f64| x.abs() <= f64::from(MAX_COORDINATE);
    if !eye.to_array().into_iter().all(in_reach) {
        return None;
    }
    // glTF has no target: the point on the line of sight closest to the scene's centre is a
    // suitable pivot. If that point is behind the camera, or too close to keep the direction in
    // f32, the scene's size is used as the distance.
    let radius = f64::from(bounds.radius());
    let ahead = (bounds.centre().as_dvec3() - eye).dot(forward);
    let floor = (0.01 * radius).max(1e-3 * eye.length()).max(1e-6);
    let distance = if ahead > floor { ahead } else { radius.max(floor) };
    let point = |v: DVec3| v.as_vec3();
    Some(Camera { eye: point(eye), target: point(eye + forward * distance), up: point(up), vertical_fov })
}
