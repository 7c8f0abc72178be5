//! One scene with a body for each technique. Lengths are in millimetres; the top of the table is at
//! 0.

use glam::Vec3;

use super::{VERTICAL_FOV, materials, stone, translucent};
use crate::{Camera, Dispersion, Light, Material, Object, Scene, SceneError, gltf};

/// The meshes, made by the program in `harness/assets/`.
const VITRINE: &[u8] = include_bytes!("../../../assets/vitrine.glb");

/// Girdle radii of the stones.
const DIAMOND: f32 = 17.0;
const RUBY: f32 = 13.5;
/// Scale of the chain relative to the built-in one: a link is 18 mm wide.
const CHAIN: f32 = 18.0;
/// Thickness of the candle, all but its rim.
const CANDLE: f32 = 30.0;

/// Builds the scene.
pub(super) fn stored(name: &str) -> Result<Scene, SceneError> {
    let meshes = gltf::parse(VITRINE, None)?.objects.into_iter().map(|object| object.mesh);
    let bodies = bodies().into_iter().zip(meshes);
    let objects = bodies.map(|((name, material), mesh)| Object::new(name, mesh, material)).collect();
    Ok(Scene { name: name.to_owned(), objects, lights: lights(), camera: camera(), lacking: Vec::new() })
}

/// Returns names and materials, in the order of the file.
fn bodies() -> [(&'static str, Material); 6] {
    let ruby = Material { dispersion: Dispersion::None, ..materials::ruby() };
    let wax = Material { thickness: CANDLE, ..translucent::material("wax") };
    [
        ("table", materials::slate()),
        ("diamond", materials::sized(materials::diamond(), DIAMOND)),
        ("ruby", materials::sized(ruby, RUBY)),
        ("candle", wax),
        ("figure", stone::marble()),
        ("prism_chain", materials::sized(materials::clear_glass(), CHAIN)),
    ]
}

fn lights() -> Vec<Light> {
    let lamp = Light::Point { position: Vec3::new(60.0, 170.0, 150.0), intensity: 1_000.0 * Vec3::new(1.0, 0.8, 0.6) };
    vec![stone::sun(Vec3::new(-0.8, 0.35, -0.7), 3.0), lamp]
}

/// A camera that suits pictures of 4:3 and square ones.
fn camera() -> Camera {
    Camera::upright(Vec3::new(15.3, 126.2, 349.5), Vec3::new(3.0, 49.5, 0.0), VERTICAL_FOV)
}

#[cfg(test)]
mod tests;
