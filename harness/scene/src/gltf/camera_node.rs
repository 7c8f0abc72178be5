//! Camera of a file.

use ::gltf::json::Root;
use ::gltf::json::camera::Camera as JsonCamera;
use glam::{DMat4, DVec3};

use super::error::{GltfError, designation, excerpt, item, shortened};
use super::limits::MAX_COORDINATE;
use super::nodes::ShownNode;
use crate::object::vertices;
use crate::{Bounds, Camera, Object};

/// Distance of the eye that stands for an orthographic camera, in radii of what is seen. Half a picture from the middle, a point one
/// radius off the plane through the middle is seen a 2000th of the picture's height from its place.
const ORTHOGRAPHIC_DISTANCE: f64 = 1000.0;

/// Returns the camera called `which` among the visible nodes, or else the first one; `None` if there is no camera.
pub(super) fn chosen(
    root: &Root,
    nodes: &[ShownNode<'_>],
    objects: &[Object],
    which: Option<&str>,
) -> Result<Option<Camera>, GltfError> {
    let of_nodes = nodes.iter().filter_map(|node| Some((node, node.node.camera?.value())));
    let mut cameras = Vec::new();
    for (node, index) in of_nodes {
        cameras.push((node, index, item(&root.cameras, "camera", index, || node.designation())?));
    }
    let Some(which) = which else {
        return cameras.first().map(|&(node, index, camera)| seen_through(node, index, camera, objects)).transpose();
    };
    let named = |name: Option<&String>| name.is_some_and(|name| name == which);
    let by_name = cameras.iter().find(|(_, _, camera)| named(camera.name.as_ref()));
    let by_node = || cameras.iter().find(|(node, ..)| named(node.node.name.as_ref()));
    let by_number = || cameras.iter().find(|(_, index, _)| which.parse() == Ok(*index));
    let found = by_name.or_else(by_node).or_else(by_number);
    let Some(&(node, index, camera)) = found else {
        let known = cameras.iter().map(|(_, index, camera)| designation("camera", *index, camera.name.as_deref()));
        return Err(GltfError::NoCamera { which: excerpt(which), known: shortened(known) });
    };
    seen_through(node, index, camera, objects).map(Some)
}

/// Returns a camera of the file at its node.
fn seen_through(
    node: &ShownNode<'_>,
    index: usize,
    camera: &JsonCamera,
    objects: &[Object],
) -> Result<Camera, GltfError> {
    let wrong = |problem| GltfError::part(designation("camera", index, camera.name.as_deref()), problem);
    let (lens, near, far) = match (&camera.perspective, &camera.orthographic) {
        (Some(perspective), _) => {
            let fov = perspective.yfov;
            if !(fov > 0.0 && fov < std::f32::consts::PI) {
                return Err(wrong(format!("its yfov is {fov}, but must lie above 0 and below π (180°)")));
            }
            (Lens::Perspective(fov), perspective.znear, perspective.zfar)
        }
        (None, Some(orthographic)) => {
            let half_height = orthographic.ymag.abs();
            if !(half_height > 0.0 && half_height <= MAX_COORDINATE) {
                return Err(wrong(format!(
                    "its ymag is {}, but must be another number than 0 of at most {MAX_COORDINATE}",
                    orthographic.ymag
                )));
            }
            (Lens::Orthographic(f64::from(half_height)), orthographic.znear, Some(orthographic.zfar))
        }
        (None, None) => {
            return Err(wrong("it has neither perspective nor orthographic; export it again".to_owned()));
        }
    };
    // Nothing is cut off at either, but a file that contradicts itself is told.
    if let Some(far) = far
        && far <= near
    {
        return Err(wrong(format!("its zfar is {far}, but must be above its znear, {near}")));
    }
    place(node.world, lens, &Bounds::of(vertices(objects))).ok_or_else(|| {
        GltfError::part(
            node.designation(),
            "its camera has no direction or place; give its node a transform without zero scale",
        )
    })
}

/// What of the scene fills the picture's height.
#[derive(Debug, Clone, Copy)]
enum Lens {
    /// An angle in radians.
    Perspective(f32),
    /// Twice this length.
    Orthographic(f64),
}

/// A glTF camera looks along its node's -z with +y up; the scale of its node has no effect.
fn place(world: DMat4, lens: Lens, bounds: &Bounds) -> Option<Camera> {
    let eye = world.w_axis.truncate();
    let forward = (-world.z_axis.truncate()).try_normalize()?;
    let upright = world.y_axis.truncate().try_normalize()?;
    let up = (upright - forward * forward.dot(upright)).try_normalize()?;
    let in_reach = |point: DVec3| point.to_array().into_iter().all(|x| x.abs() <= f64::from(MAX_COORDINATE));
    if !in_reach(eye) {
        return None;
    }
    let radius = f64::from(bounds.radius());
    let ahead = (bounds.centre().as_dvec3() - eye).dot(forward);
    let camera = |eye: DVec3, distance: f64, vertical_fov: f32| Camera {
        eye: eye.as_vec3(),
        target: (eye + forward * distance).as_vec3(),
        up: up.as_vec3(),
        vertical_fov,
    };
    match lens {
        Lens::Perspective(vertical_fov) => {
            // glTF has no target: the point on the line of sight closest to the scene's centre is a
            // suitable pivot. If that point is behind the camera, or too close to keep the direction in
            // f32, the scene's size is used as the distance.
            let floor = (0.01 * radius).max(1e-3 * eye.length()).max(1e-6);
            let distance = if ahead > floor { ahead } else { radius.max(floor) };
            Some(camera(eye, distance, vertical_fov))
        }
        Lens::Orthographic(half_height) => {
            let distance = ORTHOGRAPHIC_DISTANCE * radius.max(half_height);
            let far_eye = eye + forward * (ahead - distance);
            let vertical_fov = 2.0 * (half_height / distance).atan();
            in_reach(far_eye).then(|| camera(far_eye, distance, vertical_fov as f32))
        }
    }
}
