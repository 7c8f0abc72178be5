//! A glass of water with a straw, before a candle behind frosted glass. Lengths are in centimetres; the table's top is at 0.

use glam::{DQuat, DVec2, DVec3, Vec3};

use super::framing::VERTICAL_FOV;
use super::{materials, translucent};
use crate::surfaces::{lathe, rounded_box};
use crate::{BuiltInEnvironment, Camera, Lacking, Light, Material, Medium, Mesh, Object, Scene, SceneError};

/// Vertices around a round body.
const AROUND: u32 = 96;
/// Height and outer radius of the glass, thickness of its wall and of its bottom.
const GLASS: DVec2 = DVec2::new(11.0, 3.6);
const WALL: f64 = 0.3;
const BOTTOM: f64 = 1.0;
/// Height of the water.
const WATER: f64 = 8.0;
/// Length, radius and lean of the straw in radians.
const STRAW: (f64, f64, f64) = (13.5, 0.35, 0.34);
/// Half sizes of the frosted pane, and where it stands.
const PANE: DVec3 = DVec3::new(4.2, 5.0, 0.2);
const PANE_AT: DVec3 = DVec3::new(8.6, 5.0, -1.0);
/// Height and radius of the candle, and where it stands.
const CANDLE: DVec2 = DVec2::new(5.6, 1.5);
const CANDLE_AT: DVec3 = DVec3::new(9.0, 0.0, -5.5);

/// Builds the scene.
pub(super) fn tumbler(name: &str) -> Result<Scene, SceneError> {
    let table = rounded_box(DVec3::new(17.0, 0.6, 12.0), 0.2, 4).placed(DQuat::IDENTITY, DVec3::new(4.0, -0.601, -1.0));
    let pane = rounded_box(PANE, 0.08, 3).placed(DQuat::from_rotation_y(-0.12), PANE_AT);
    let candle = turned(
        &[
            DVec2::new(0.0, CANDLE.x),
            DVec2::new(CANDLE.y, CANDLE.x),
            DVec2::new(CANDLE.y, 0.001),
            DVec2::new(0.0, 0.001),
        ],
        0.25,
    );
    let objects = vec![
        Object::new("table", table, materials::matte("wood", [0.30, 0.17, 0.09])),
        // Where glass and water overlap, there is glass.
        Object::new("glass", glass(), Material { priority: 1, ..clear("glass", 1.52, 2.0 * GLASS.y as f32) }),
        Object::new("water", water(), clear("water", 1.333, 2.0 * GLASS.y as f32)),
        Object::new("straw", straw(), materials::matte("painted", [0.75, 0.06, 0.05])),
        Object::new("pane", pane, Material { roughness: 0.4, ..clear("frosted glass", 1.52, 2.0 * PANE.z as f32) }),
        Object::new("candle", candle.placed(DQuat::IDENTITY, CANDLE_AT), wax()),
    ];
    let flame = (CANDLE_AT + (CANDLE.x + 1.2) * DVec3::Y).as_vec3();
    Ok(Scene {
        name: name.to_owned(),
        objects,
        lights: vec![Light::Point { position: flame, intensity: 60.0 * Vec3::new(1.0, 0.62, 0.28) }],
        light_radii: vec![Some(0.5)],
        environment: BuiltInEnvironment::Studio,
        camera: Camera::upright(Vec3::new(2.6, 13.5, 38.0), Vec3::new(3.9, 6.3, 0.0), VERTICAL_FOV),
        lacking: Lacking::default(),
    })
}

/// Returns a body turned about the y axis, its corners rounded.
fn turned(corners: &[DVec2], radius: f64) -> Mesh {
    lathe(corners, radius, AROUND).without_uvs()
}

/// Returns the tumbler: from the middle of its floor up the inner wall, over the rim and down.
fn glass() -> Mesh {
    let (height, outer) = (GLASS.x, GLASS.y);
    let inner = outer - WALL;
    turned(
        &[
            DVec2::new(0.0, BOTTOM),
            DVec2::new(inner - 0.4, BOTTOM),
            DVec2::new(inner, height),
            DVec2::new(outer, height),
            DVec2::new(outer - 0.4, 0.001),
            DVec2::new(0.0, 0.001),
        ],
        0.12,
    )
}

/// Returns the water, which reaches half into the glass.
fn water() -> Mesh {
    let (inside, lowest) = (GLASS.y - 0.5 * WALL, BOTTOM - 0.3);
    let at = |height: f64| inside - 0.4 * (GLASS.x - height) / GLASS.x;
    turned(
        &[
            DVec2::new(0.0, WATER),
            DVec2::new(at(WATER), WATER),
            DVec2::new(at(lowest), lowest),
            DVec2::new(0.0, lowest),
        ],
        0.03,
    )
}

/// Returns the straw: it leans in the glass, from near its floor to above its rim.
fn straw() -> Mesh {
    let (length, radius, lean) = STRAW;
    let corners = [DVec2::new(0.0, length), DVec2::new(radius, length), DVec2::new(radius, 0.0), DVec2::new(0.0, 0.0)];
    turned(&corners, 0.02).placed(DQuat::from_rotation_z(-lean), DVec3::new(-2.2, BOTTOM + 0.3, 0.3))
}

fn clear(name: &str, ior: f32, thickness: f32) -> Material {
    Material { name: name.to_owned(), ior, thickness, transmission: 1.0, roughness: 0.0, ..Material::standard() }
}

/// White wax, by eye: a centimetre is some thirty mean free paths.
fn wax() -> Material {
    let medium = Medium::isotropic(Vec3::splat(30.0), Vec3::new(0.06, 0.14, 0.45));
    translucent::scattering("wax", medium, Vec3::new(0.9, 0.84, 0.72), (1.44, 0.5))
}
