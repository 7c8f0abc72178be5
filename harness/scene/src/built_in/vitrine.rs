//! One scene with a body for each technique. Lengths are in millimetres; the top of the table is at
//! 0.

use glam::{DQuat, DVec3, Vec3};

use super::{VERTICAL_FOV, materials, prisms, stone, translucent};
use crate::cuts::{BrilliantParameters, CutError, round_brilliant};
use crate::surfaces::rounded_box;
use crate::{
    Averaging, Bounds, Camera, Dispersion, Light, Material, Mesh, Object, Scene, SceneError, candle, figure, gltf,
};

/// Stored output of [`made`], which takes a second or two.
const VITRINE: &[u8] = include_bytes!("../../../assets/vitrine.glb");

/// Girdle radii of the stones.
const DIAMOND: f32 = 17.0;
const RUBY: f32 = 13.5;
/// Scale of the chain relative to the built-in one: a link is 18 mm wide.
const CHAIN: f32 = 18.0;
/// Gap between the table and the bodies on it, so that no two surfaces coincide.
const GAP: f64 = 0.02;

/// Builds the scene with the meshes of the stored file.
pub(super) fn stored(name: &str) -> Result<Scene, SceneError> {
    let objects = gltf::parse(VITRINE, None)?.objects;
    Ok(scene(name, objects.into_iter().map(|object| object.mesh)))
}

/// Builds the scene with all meshes generated anew.
pub(super) fn made(name: &str) -> Result<Scene, SceneError> {
    Ok(scene(name, meshes()?))
}

fn scene(name: &str, meshes: impl IntoIterator<Item = Mesh>) -> Scene {
    let bodies = bodies().into_iter().zip(meshes);
    let objects = bodies.map(|((name, material), mesh)| Object { name: name.to_owned(), mesh, material }).collect();
    Scene { name: name.to_owned(), objects, lights: lights(), camera: camera(), lacking: Vec::new() }
}

/// Returns names and materials, in the order of [`meshes`].
fn bodies() -> [(&'static str, Material); 6] {
    let ruby = Material { dispersion: Dispersion::None, ..materials::ruby() };
    // All but its rim is this thick.
    let wax = Material { thickness: 2.0 * candle::RADIUS as f32, ..translucent::material("wax") };
    [
        ("table", materials::slate()),
        ("diamond", materials::sized(materials::diamond(), DIAMOND)),
        ("ruby", materials::sized(ruby, RUBY)),
        ("candle", wax),
        ("figure", stone::marble()),
        ("prism_chain", materials::sized(materials::clear_glass(), CHAIN)),
    ]
}

fn meshes() -> Result<[Mesh; 6], CutError> {
    let (half, rounding) = (DVec3::new(150.0, 7.0, 100.0), 2.5);
    let table = rounded_box(half, rounding, 2).placed(DQuat::IDENTITY, DVec3::NEG_Y * half.y);
    let brilliant = round_brilliant(&BrilliantParameters::TOLKOWSKY)?.to_mesh(Averaging::default());
    let chain = prisms::chain()?.scaled(CHAIN);
    Ok([
        table,
        standing(&brilliant.scaled(DIAMOND), lying(18.0), [-14.0, 42.0]),
        standing(&brilliant.scaled(RUBY), lying(-38.0), [37.0, 36.0]),
        standing(&candle::mesh(), turned(0.0), [-54.0, 12.0]),
        standing(&figure::mesh(), turned(8.0), [10.0, -28.0]),
        // Its uppermost link extends past the picture's edge.
        chain.placed(DQuat::IDENTITY, DVec3::new(62.0, 131.0, 6.0)),
    ])
}

/// Rotation about the vertical, in degrees from +z towards +x.
fn turned(azimuth: f64) -> DQuat {
    DQuat::from_rotation_y(azimuth.to_radians())
}

/// Rotation of a brilliant that rests on one of its pavilion's main facets, as a loose stone does,
/// with its table facing this azimuth.
fn lying(azimuth: f64) -> DQuat {
    // The first of these facets is the one towards +x.
    let leaning = DQuat::from_rotation_z(-BrilliantParameters::TOLKOWSKY.pavilion_degrees.to_radians());
    turned(azimuth - 90.0) * leaning
}

/// Returns the mesh rotated, and moved to this x and z with its lowest point just above the table.
fn standing(mesh: &Mesh, rotation: DQuat, [x, z]: [f64; 2]) -> Mesh {
    let lowest = Bounds::of(mesh.placed(rotation, DVec3::ZERO).positions).min.y;
    mesh.placed(rotation, DVec3::new(x, GAP - f64::from(lowest), z))
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
