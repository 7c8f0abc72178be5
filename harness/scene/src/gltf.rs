//! Loader for glTF 2.0: .glb files, and .gltf files with external or embedded buffers.
//!
//! The gltf crate is used only to deserialise the JSON into its types. Its validation refuses
//! extensions that we support, and its readers trust validated input, so every reference, range and
//! number is checked here instead. [`MAX_FILE_BYTES`], [`MAX_SCENE_BYTES`], [`MAX_TRIANGLES`] and
//! [`MAX_OBJECTS`] bound what a file can make the loader allocate, however small the file is: a few
//! instances of a large mesh can need as much memory as a large file.
//!
//! Numbers may be quantised or compressed by meshoptimizer (`gltf/meshopt.rs`) or Draco (`gltf/draco.rs`); what takes more memory
//! unpacked than in the file is bounded by [`MAX_FILE_BYTES`] as well.
//!
//! The loader reads triangles (also strips and fans) with their first texture coordinates and
//! colours, node transforms, at rest or at a time of the animations (`gltf/animation.rs`), instances
//! (`gltf/instances.rs`), a camera (`gltf/camera_node.rs`), directional, point and spot lights (`gltf/light_node.rs`), materials (`gltf/material.rs`) and some
//! of their textures (`gltf/texture.rs`). Anything else in the file is listed in [`Scene::lacking`]
//! (`gltf/survey.rs`): other textures, skins, morph targets and more.

use std::path::Path;

use glam::Vec3;

use super::camera::Camera;
use super::lacking::Matter;
use super::object::vertices;
use super::{Object, Opening, Scene, SceneError};

mod accessor;
mod animation;
mod arrangement;
mod budget;
mod buffers;
mod camera_node;
mod container;
mod decode;
mod diamond;
mod draco;
mod error;
mod extension;
mod extras;
mod head;
mod instances;
mod json;
mod kind;
mod light_node;
mod limits;
mod material;
mod medium;
mod meshopt;
mod nodes;
mod primitive;
mod requirement;
mod sources;
mod sparse;
mod specular_glossiness;
mod stored;
mod survey;
mod texture;
mod uri;

pub use error::GltfError;
pub(super) use instances::{COLORING, NAME as INSTANCING};
pub use limits::{
    KNOWN_EXTENSIONS, MAX_COORDINATE, MAX_FILE_BYTES, MAX_IMAGE_BYTES, MAX_OBJECTS, MAX_SCENE_BYTES, MAX_TRIANGLES,
};
pub(super) use sources::sources;
pub(super) use texture::TRANSFORM as TEXTURE_TRANSFORM;

/// Default camera for a scene without one: vertical field of view in radians, and direction towards
/// the eye.
const DEFAULT_VIEW: (f32, Vec3) = (0.47, Vec3::new(0.35, 0.45, 1.0));

/// Loads a .glb or .gltf file. External buffers and images are resolved relative to it.
///
/// # Errors
/// [`SceneError::File`] with the path and the problem.
pub fn load(path: &Path) -> Result<Scene, SceneError> {
    load_as(path, &Opening::default())
}

/// Loads a file with the camera, and at the time, that were chosen.
///
/// # Errors
/// [`SceneError::File`] with the path and the problem.
pub fn load_as(path: &Path, opening: &Opening) -> Result<Scene, SceneError> {
    let in_file = |problem| SceneError::File { path: path.to_owned(), problem };
    let base = path.parent().unwrap_or(Path::new(""));
    let mut scene = uri::read_file(path, MAX_FILE_BYTES)
        .and_then(|bytes| parse_scene(&bytes, Some(base), opening))
        .map_err(in_file)?;
    if scene.name.is_empty() {
        let stem = path.file_stem().unwrap_or_default();
        scene.name = stem.to_string_lossy().into_owned();
    }
    Ok(scene)
}

/// Parses the bytes of a .glb or .gltf file. External buffers and images are read from the
/// folder `base`; if it is `None`, an external one is an error. A scene without a name is called `scene`.
///
/// # Errors
/// [`SceneError::Gltf`] with the problem.
pub fn parse(bytes: &[u8], base: Option<&Path>) -> Result<Scene, SceneError> {
    parse_as(bytes, base, &Opening::default())
}

/// Parses the bytes of a file, with the camera, and at the time, that were chosen.
///
/// # Errors
/// [`SceneError::Gltf`] with the problem.
pub fn parse_as(bytes: &[u8], base: Option<&Path>, opening: &Opening) -> Result<Scene, SceneError> {
    let mut scene = parse_scene(bytes, base, opening)?;
    if scene.name.is_empty() {
        "scene".clone_into(&mut scene.name);
    }
    Ok(scene)
}

fn parse_scene(bytes: &[u8], base: Option<&Path>, opening: &Opening) -> Result<Scene, GltfError> {
    let container::Container { json, binary } = container::split(bytes)?;
    head::check(json)?;
    let mut root = json::root(json)?;
    requirement::check(&root)?;
    let buffers = buffers::Buffers::load(&root, binary, base)?;
    if let Some(time) = opening.time {
        animation::pose(&mut root, &buffers, time)?;
    }
    let shown = nodes::Shown::of(&root)?;

    let mut budget = budget::Budget::new();
    let textures = texture::Textures::new(&root, json, &buffers, base);
    let mut materials = material::Materials::new(&root, textures);
    let mut bodies = Vec::new();
    for node in &shown.nodes {
        primitive::add_objects(&root, &buffers, node, &mut materials, &mut budget, &mut bodies)?;
    }
    let (of_bodies, objects): (Vec<Matter>, Vec<Object>) = bodies.into_iter().unzip();
    if objects.iter().all(|object| object.mesh.indices.is_empty()) {
        return Err(GltfError::NoTriangles);
    }
    let camera = match camera_node::chosen(&root, &shown.nodes, &objects, opening.camera.as_deref())? {
        Some(camera) => camera,
        None => {
            let (vertical_fov, toward_eye) = DEFAULT_VIEW;
            Camera::framing(vertices(&objects), toward_eye, vertical_fov)
        }
    };
    let (lights, light_radii) = light_node::lights(&root, &shown.nodes)?.into_iter().unzip();
    let lacking = survey::lacking(&root, &shown.nodes, &materials, of_bodies, opening);
    let nodes::Shown { name, environment, .. } = shown;
    Ok(Scene { name, objects, lights, light_radii, environment, camera, lacking })
}

#[cfg(test)]
mod tests;
