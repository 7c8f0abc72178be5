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

mod bounds;
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
pub mod facet_fit;
pub mod glb;
pub mod gltf;
pub mod harmonics;
pub mod hull;
pub mod jewellery;
mod lacking;
pub mod layout;
pub mod light;
pub mod material;
pub mod medium;
pub mod mesh;
pub mod mesh_diagnosis;
pub mod normals;
mod object;
mod open;
mod opening;
pub mod polyhedron;
pub mod registration;
mod scene;
pub mod shells;
mod smoothstep;
pub mod solver;
pub mod spectrum;
pub mod stones;
pub mod surfaces;
pub mod texture;
mod turntable;
pub mod view;
mod weld;

pub use bounds::Bounds;
pub use built_in::list::{BUILT_IN, BuiltIn, names};
pub use built_in::presets::{PRESETS, Preset};
pub use camera::Camera;
pub use convex::{Convex, Shape};
pub use copies::{Copies, Place};
pub use environment::{BuiltInEnvironment, Environment};
pub use error::SceneError;
pub use lacking::Lacking;
pub use lapidary_bvh_trace::Bvh;
pub use light::Light;
pub use material::{Coverage, Dispersion, Lobe, Material, Metal, Mineral};
pub use medium::{Density, DensityGrid, Medium};
pub use mesh::Mesh;
pub use mesh_diagnosis::MeshDiagnosis;
pub use normals::Averaging;
pub use object::{Object, precedence};
pub use opening::Opening;
pub use scene::Scene;
pub use solver::Solver;
pub use texture::{Encoding, Texels, Texture, TextureSlot, TextureTransform, Wrap};
pub use view::clip_from_world;

/// Largest width and height of a picture in pixels.
pub const LARGEST_SIDE: u32 = 8192;
/// Default number of samples along each side of a pixel.
pub const SAMPLES: u32 = 4;

#[cfg(test)]
mod tests;
