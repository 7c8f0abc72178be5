//! A ring as a jeweller shows it: a brilliant in six prongs on a band of gold with side stones, on a dark cloth.
//! Lengths are in millimetres; the cloth lies at height 0.

use glam::{DMat4, DQuat, DVec3, Vec3};
use std::f64::consts::PI;

use super::framing::VERTICAL_FOV;
use super::materials;
use crate::cuts::{BrilliantParameters, round_brilliant};
use crate::{Averaging, BuiltInEnvironment, Camera, Lacking, Light, Metal, Object, Scene, SceneError};

mod band;
mod cloth;
mod corner;
mod head;

/// How much of the band sinks into the cloth.
const SUNK: f64 = 0.9;
/// How far the ring is turned about the vertical, and leans towards who looks at it, in radians.
const TURN: f64 = -0.62;
const LEAN: f64 = 0.16;

/// Builds the scene.
pub(super) fn ring(name: &str) -> Result<Scene, SceneError> {
    let brilliant = round_brilliant(&BrilliantParameters::TOLKOWSKY)?.to_mesh(Averaging::default());
    // From the ring's own space, about its middle with the stone upwards and the axis along z.
    let turn = DQuat::from_rotation_y(TURN) * DQuat::from_rotation_x(LEAN);
    let shift = turn * (band::outer_radius(PI) * DVec3::Y) - SUNK * DVec3::Y;
    let gold = || Metal::YellowGold.material();
    let placed = |local: DMat4| brilliant.transformed(DMat4::from_rotation_translation(turn, shift) * local);
    let head_stone = DMat4::from_translation(head::GIRDLE * DVec3::Y) * DMat4::from_scale(DVec3::splat(head::STONE));
    let mut objects = vec![
        Object::new("cloth", cloth::mesh(TURN), materials::matte("cloth", CLOTH)),
        Object::new("band", band::mesh().placed(turn, shift), gold()),
        Object::new("setting", head::mesh().placed(turn, shift), gold()),
        Object::new("diamond", placed(head_stone), materials::sized(materials::diamond(), head::STONE as f32)),
    ];
    // Each a body of its own: beside lights and metal, the stage that draws copies would read one storage buffer more than every
    // device offers.
    for (number, (local, radius)) in side_stones().into_iter().enumerate() {
        let material = materials::sized(materials::diamond(), radius as f32);
        objects.push(Object::new(format!("side stone {}", number + 1), placed(local), material));
    }
    Ok(Scene {
        name: name.to_owned(),
        objects,
        lights: lights(),
        light_radii: vec![Some(9.0), Some(5.0)],
        environment: BuiltInEnvironment::Jeweller,
        camera: Camera::upright(Vec3::new(14.0, 61.0, 66.0), Vec3::new(0.4, 10.7, 1.0), 0.72 * VERTICAL_FOV),
        lacking: Lacking::default(),
    })
}

/// A dark blue, linear RGB: gold and clear stones stand out from it.
const CLOTH: [f32; 3] = [0.013, 0.017, 0.032];

/// Returns where the small stones of both shoulders are in the ring's own space, tables outwards, and their girdle radii.
fn side_stones() -> Vec<(DMat4, f64)> {
    let place = |(angle, radius): (f64, f64)| {
        let out = DMat4::from_translation(band::girdle_radius(angle.abs()) * DVec3::Y);
        (DMat4::from_rotation_z(-angle) * out * DMat4::from_scale(DVec3::splat(radius)), radius)
    };
    band::side_stones().into_iter().flat_map(|(angle, radius)| [(angle, radius), (-angle, radius)]).map(place).collect()
}

/// Two small lamps where the environment has its lights: they draw the shadows on the cloth, and sparks in the stones.
fn lights() -> Vec<Light> {
    vec![
        Light::Point { position: Vec3::new(-150.0, 190.0, 30.0), intensity: 330_000.0 * Vec3::new(1.0, 0.95, 0.86) },
        Light::Point { position: Vec3::new(120.0, 170.0, -90.0), intensity: 90_000.0 * Vec3::new(0.88, 0.94, 1.0) },
    ]
}

#[cfg(test)]
mod tests;
