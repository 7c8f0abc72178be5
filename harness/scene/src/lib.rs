//! Scenes: gem cuts made here, and glTF 2.0 files.
//!
//! A [`Scene`] is a list of triangle meshes with materials, and a camera. [`Scene::open`] takes what a
//! user types: the name of a built-in scene or the path of a file. World space is glTF's: right-handed,
//! y up.
//!
//! ```
//! use lapidary_scene::Scene;
//!
//! let scene = Scene::open("brilliant")?;
//! for object in &scene.objects {
//!     println!("{}: {} triangles, index {}", object.name, object.mesh.triangle_count(), object.material.ior);
//! }
//! # Ok::<(), lapidary_scene::SceneError>(())
//! ```

use std::ffi::{OsStr, OsString};
use std::path::Path;

use glam::Vec3;

pub mod atlas;
mod built_in;
pub mod bvh;
mod camera;
pub mod candle;
pub mod convex;
pub mod curvatures;
pub mod cuts;
pub mod deform;
pub mod environment;
pub mod environment_map;
mod error;
pub mod figure;
pub mod glb;
pub mod gltf;
pub mod implicit;
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
pub mod view;

pub use built_in::{BUILT_IN, BuiltIn, names};
pub use bvh::Bvh;
pub use camera::Camera;
pub use convex::{Convex, Shape};
pub use environment::Environment;
pub use error::SceneError;
pub use light::Light;
pub use material::{Dispersion, Material, Mineral};
pub use medium::{Density, DensityGrid, Medium};
pub use mesh::Mesh;
pub use mesh_diagnosis::MeshDiagnosis;
pub use normals::Averaging;
pub use solver::Solver;
pub use view::clip_from_world;

/// Largest width and height of a picture in pixels.
pub const LARGEST_SIDE: u32 = 8192;
/// Samples along each side of a pixel, where nothing else is asked for.
pub const SAMPLES: u32 = 4;

/// One body of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Object {
    /// The node's name, or the mesh's.
    pub name: String,
    /// Its surface in world space.
    pub mesh: Mesh,
    /// Its material.
    pub material: Material,
}

/// Bodies, lights and a camera.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// The built-in's name, the glTF scene's name, or the file's.
    pub name: String,
    /// The bodies, in the file's order.
    pub objects: Vec<Object>,
    /// The lights, beside the environment.
    pub lights: Vec<Light>,
    /// Where to look at them from.
    pub camera: Camera,
    /// What its file asks for and nothing here draws, each named once.
    pub lacking: Vec<String>,
}

/// An axis-aligned box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// The least coordinates.
    pub min: Vec3,
    /// The greatest coordinates.
    pub max: Vec3,
}

impl Bounds {
    /// The smallest box about `points`; a box without size at the origin if there are none.
    #[must_use]
    pub fn of(points: impl IntoIterator<Item = Vec3>) -> Self {
        let grow = |bounds: Self, point: Vec3| Self { min: bounds.min.min(point), max: bounds.max.max(point) };
        let box_of = |point| Self { min: point, max: point };
        let mut points = points.into_iter();
        let first = points.next().map_or(box_of(Vec3::ZERO), box_of);
        points.fold(first, grow)
    }

    /// The middle of the box.
    #[must_use]
    pub fn centre(&self) -> Vec3 {
        0.5 * self.min + 0.5 * self.max
    }

    /// Half the diagonal: the radius of a sphere about the centre that holds the box.
    #[must_use]
    pub fn radius(&self) -> f32 {
        0.5 * self.min.distance(self.max)
    }
}

impl Scene {
    /// The scene that a user names on the command line: a built-in name, or else a .glb or .gltf file.
    ///
    /// # Errors
    /// [`SceneError::UnknownName`] for a word that is neither a built-in nor looks like a file, and
    /// what [`gltf::load`] says of a file.
    pub fn open(argument: &str) -> Result<Self, SceneError> {
        if names_a_file(argument) { gltf::load(Path::new(argument)) } else { Self::named(argument) }
    }

    /// What a picture of the scene that [`Scene::open`] takes is called, without an extension: a file's own stem, whatever the file says of
    /// itself, or a built-in's name. No path leads out of the folder that it is put in.
    #[must_use]
    pub fn stem(argument: &str) -> OsString {
        if names_a_file(argument) {
            return Path::new(argument).file_stem().map_or_else(|| "scene".into(), OsStr::to_owned);
        }
        built_in::named(argument).map_or("scene", |scene| scene.name).into()
    }

    /// The built-in scene called `name`; see [`BUILT_IN`].
    ///
    /// # Errors
    /// [`SceneError::UnknownName`] with the nearest built-in name if there is none called `name`.
    pub fn named(name: &str) -> Result<Self, SceneError> {
        built_in::build(name)
    }

    /// The same scene with all that this program can make made anew, where [`Scene::named`] reads a stored copy of what takes long.
    ///
    /// # Errors
    /// As [`Scene::named`].
    pub fn made(name: &str) -> Result<Self, SceneError> {
        built_in::make(name)
    }

    /// The box about all vertices; without size at the origin if there are none.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        Bounds::of(vertices(&self.objects))
    }

    /// The same bodies seen from `polar` degrees off the vertical and `azimuth` degrees from +z towards +x, framed anew.
    #[must_use]
    pub fn seen_from(&self, polar: f32, azimuth: f32) -> Self {
        let camera =
            Camera::framing(vertices(&self.objects), built_in::direction(polar, azimuth), self.camera.vertical_fov);
        Self { camera, ..self.clone() }
    }

    /// The number of triangles of all bodies.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        let counts = self.objects.iter().map(|o| o.mesh.triangle_count());
        counts.sum()
    }
}

/// Whether a user means a file: no built-in, and it looks like one or is there.
fn names_a_file(argument: &str) -> bool {
    let path = Path::new(argument);
    let extension = path.extension().map(OsStr::to_ascii_lowercase);
    let looks_like_a_file = extension.is_some_and(|e| e == "glb" || e == "gltf") || argument.contains(['/', '\\']);
    built_in::named(argument).is_none() && (looks_like_a_file || path.is_file())
}

/// All vertex positions of `objects`.
fn vertices(objects: &[Object]) -> impl Iterator<Item = Vec3> + Clone + '_ {
    let meshes = objects.iter().map(|object| &object.mesh);
    meshes.flat_map(|mesh| mesh.positions.iter().copied())
}

#[cfg(test)]
mod tests;
