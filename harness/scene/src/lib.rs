//! Scenes: built-in gem cuts, and glTF 2.0 files.
//!
//! A [`Scene`] is a list of triangle meshes with materials, and a camera. [`Scene::open`] takes
//! what a user types: the name of a built-in scene or the path of a file. World space follows glTF:
//! right-handed, y up.
//!
//! ```
//! use lapidary_scene::Scene;
//!
//! let scene = Scene::open("brilliant")?;
//! for object in &scene.objects {
//!     let triangles = object.mesh.triangle_count();
//!     println!("{}: {triangles} triangles, index {}", object.name, object.material.ior);
//! }
//! # Ok::<(), lapidary_scene::SceneError>(())
//! ```

use std::ffi::{OsStr, OsString};
use std::path::Path;

use glam::Vec3;

mod built_in;
mod camera;
pub mod convex;
pub mod copies;
pub mod curvatures;
pub mod cuts;
pub mod deform;
pub mod environment;
pub mod environment_map;
mod error;
pub mod glb;
pub mod gltf;
pub mod harmonics;
pub mod layout;
pub mod light;
pub mod material;
pub mod medium;
pub mod mesh;
pub mod mesh_diagnosis;
pub mod nearest;
pub mod normals;
pub mod polyhedron;
pub mod solver;
pub mod spectrum;
pub mod surfaces;
pub mod texture;
pub mod view;

pub use built_in::presets::{PRESETS, Preset};
pub use built_in::{BUILT_IN, BuiltIn, names};
pub use camera::Camera;
pub use convex::{Convex, Shape};
pub use copies::{Copies, Place};
pub use environment::Environment;
pub use error::SceneError;
pub use lapidary_bvh_trace::Bvh;
pub use light::Light;
pub use material::{Dispersion, Lobe, Material, Mineral};
pub use medium::{Density, DensityGrid, Medium};
pub use mesh::Mesh;
pub use mesh_diagnosis::MeshDiagnosis;
pub use normals::Averaging;
pub use solver::Solver;
pub use texture::{Encoding, Texels, Texture, TextureSlot, TextureTransform, Wrap};
pub use view::clip_from_world;

/// Returns what is wrong with a path whose `metadata` is not that of a regular file, as the end of a
/// sentence.
#[must_use]
pub fn not_a_file(metadata: &std::fs::Metadata) -> &'static str {
    if metadata.is_dir() { "it is a folder" } else { "it is not a regular file" }
}

/// Largest width and height of a picture in pixels.
pub const LARGEST_SIDE: u32 = 8192;
/// Default number of samples along each side of a pixel.
pub const SAMPLES: u32 = 4;

/// A body in a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Object {
    /// Name of the node, or of its mesh if the node has none.
    pub name: String,
    /// Surface in world space.
    pub mesh: Mesh,
    /// Material of the whole body.
    pub material: Material,
    /// The copies of one shape of which the body consists; `None` if it is shown once.
    pub copies: Option<Copies>,
}

/// Bodies, lights and a camera.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// Name of the built-in scene, of the glTF scene, or of the file.
    pub name: String,
    /// Bodies, in the file's order.
    pub objects: Vec<Object>,
    /// Lights other than the environment.
    pub lights: Vec<Light>,
    /// Camera that looks at the bodies.
    pub camera: Camera,
    /// Features that the file asks for and this renderer does not draw, each listed once.
    pub lacking: Vec<String>,
}

/// An axis-aligned box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Smallest coordinates.
    pub min: Vec3,
    /// Largest coordinates.
    pub max: Vec3,
}

impl Bounds {
    /// Returns the smallest box around `points`, or a box of zero size at the origin if there are
    /// none.
    #[must_use]
    pub fn of(points: impl IntoIterator<Item = Vec3>) -> Self {
        let grow = |bounds: Self, point: Vec3| Self { min: bounds.min.min(point), max: bounds.max.max(point) };
        let box_of = |point| Self { min: point, max: point };
        let mut points = points.into_iter();
        let first = points.next().map_or(box_of(Vec3::ZERO), box_of);
        points.fold(first, grow)
    }

    /// Returns the smallest box around both.
    #[must_use]
    pub fn joined(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Returns the centre of the box.
    #[must_use]
    pub fn centre(&self) -> Vec3 {
        0.5 * self.min + 0.5 * self.max
    }

    /// Returns half the diagonal: the radius of the bounding sphere about the centre.
    #[must_use]
    pub fn radius(&self) -> f32 {
        0.5 * self.min.distance(self.max)
    }
}

impl Scene {
    /// Opens the scene that a user names on the command line: a built-in name, or a .glb or .gltf
    /// file.
    ///
    /// # Errors
    /// Returns [`SceneError::UnknownName`] for a word that is neither a built-in nor looks like a
    /// file, and the error of [`gltf::load`] for a file.
    pub fn open(argument: &str) -> Result<Self, SceneError> {
        if names_a_file(argument) { gltf::load(Path::new(argument)) } else { Self::named(argument) }
    }

    /// Returns the file name, without an extension, for a picture of the scene that [`Scene::open`]
    /// would open: the file's own stem, whatever name the file states, or the built-in's name. The
    /// result is never a path that leads out of the output folder.
    #[must_use]
    pub fn stem(argument: &str) -> OsString {
        if names_a_file(argument) {
            return Path::new(argument).file_stem().map_or_else(|| "scene".into(), OsStr::to_owned);
        }
        built_in::named(argument).map_or("scene", |scene| scene.name).into()
    }

    /// Returns the built-in scene called `name`; see [`BUILT_IN`].
    ///
    /// # Errors
    /// Returns [`SceneError::UnknownName`] with the nearest built-in name if there is none called
    /// `name`.
    pub fn named(name: &str) -> Result<Self, SceneError> {
        built_in::build(name)
    }

    /// Returns the box around all vertices, of zero size at the origin if there are none.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        Bounds::of(vertices(&self.objects))
    }

    /// Returns the same bodies seen from `polar` degrees off the vertical and `azimuth` degrees
    /// from +z towards +x, with a newly framed camera.
    #[must_use]
    pub fn seen_from(&self, polar: f32, azimuth: f32) -> Self {
        let camera =
            Camera::framing(vertices(&self.objects), built_in::direction(polar, azimuth), self.camera.vertical_fov);
        Self { camera, ..self.clone() }
    }

    /// Returns the bodies that light may meet when it leaves a clear stone: those with triangles that are
    /// no clear stones themselves.
    pub fn beside_stones(&self) -> impl Iterator<Item = &Object> {
        self.objects.iter().filter(|object| !object.material.is_clear() && !object.mesh.indices.is_empty())
    }

    /// Returns the number of triangles in all bodies.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        let counts = self.objects.iter().map(|o| o.mesh.triangle_count());
        counts.sum()
    }
}

/// Whether a user means a file: the argument is no built-in name, and it looks like a file or
/// exists.
fn names_a_file(argument: &str) -> bool {
    let path = Path::new(argument);
    let extension = path.extension().map(OsStr::to_ascii_lowercase);
    let looks_like_a_file = extension.is_some_and(|e| e == "glb" || e == "gltf") || argument.contains(['/', '\\']);
    built_in::named(argument).is_none() && (looks_like_a_file || path.is_file())
}

/// Returns all vertex positions of `objects`.
fn vertices(objects: &[Object]) -> impl Iterator<Item = Vec3> + Clone + '_ {
    let meshes = objects.iter().map(|object| &object.mesh);
    meshes.flat_map(|mesh| mesh.positions.iter().copied())
}

#[cfg(test)]
mod tests;
