//! Stones among matte things, all near enough to one another that what leaves a stone meets them: on a
//! tray, and in a ring.

use glam::{DMat4, DQuat, DVec3};

use super::framing::framed;
use super::materials;
use crate::camera::direction;
use crate::cuts::{BrilliantParameters, StepCutParameters, round_brilliant, step_cut};
use crate::polyhedron::Polyhedron;
use crate::surfaces::{rounded_box, sphere, torus};
use crate::{Averaging, Bounds, Mesh, Object, Scene, SceneError};

/// Half sizes of the tray, whose top is at height 0; and its edges' radius.
const TRAY: DVec3 = DVec3::new(1.85, 0.1, 1.45);
const EDGE: f64 = 0.04;
/// Slope of a brilliant that lies on its pavilion, in degrees.
const PAVILION: f64 = 40.75;

/// Builds the scene.
pub(super) fn tray(name: &str) -> Result<Scene, SceneError> {
    let brilliant = round_brilliant(&BrilliantParameters::TOLKOWSKY)?;
    let emerald = step_cut(&StepCutParameters::EMERALD)?;
    let leaning = DQuat::from_rotation_y(0.4) * DQuat::from_rotation_x(PAVILION.to_radians());
    let on_its_table = DQuat::from_rotation_y(-0.5) * DQuat::from_rotation_x(180f64.to_radians());
    let ball = sphere(0.5, 96).without_uvs().placed(DQuat::IDENTITY, DVec3::new(0.95, 0.5, -0.75));
    let block = rounded_box(DVec3::new(0.42, 0.6, 0.28), EDGE, 4);
    let block = block.placed(DQuat::from_rotation_y(0.6), DVec3::new(-1.2, 0.6, -0.75));
    let objects = vec![
        Object::new(
            "tray",
            rounded_box(TRAY, EDGE, 4).placed(DQuat::IDENTITY, -TRAY.y * DVec3::Y),
            materials::matte("matte", [0.42, 0.10, 0.06]),
        ),
        Object::new("ball", ball, materials::matte("matte", [0.05, 0.16, 0.55])),
        Object::new("block", block, materials::matte("matte", [0.75, 0.55, 0.08])),
        Object::new("diamond", lying(&brilliant, 0.95, leaning, (-0.45, 0.2)), materials::diamond()),
        Object::new(
            "emerald",
            lying(&emerald, 0.6, on_its_table, (1.05, 0.75)),
            materials::sized(materials::emerald(), 0.6),
        ),
    ];
    Ok(framed(name, objects, direction(60.0, 12.0)))
}

/// Radius of the solitaire's band and of its round cross-section, and height of the stone's culet
/// above the band.
const BAND: f64 = 1.25;
const WIRE: f64 = 0.16;
const LIFT: f64 = 0.06;
/// Half sizes of a prong, and its distance from the pavilion that it runs along.
const PRONG: DVec3 = DVec3::new(0.06, 0.63, 0.06);
const PRONGS: f64 = 0.11;

/// Builds a stone on a band, with four prongs, on a plate.
pub(super) fn solitaire(name: &str) -> Result<Scene, SceneError> {
    let brilliant = round_brilliant(&BrilliantParameters::TOLKOWSKY)?;
    let upright = DQuat::from_rotation_x(90f64.to_radians());
    let mut ring = torus(BAND, WIRE, 96, 24).without_uvs().placed(upright, (BAND + WIRE) * DVec3::Y);
    let top = 2.0 * (BAND + WIRE) + LIFT;
    for quarter in 0..4 {
        // From the culet outwards and up, below the pavilion.
        let turn = DQuat::from_rotation_y((45.0 + 90.0 * f64::from(quarter)).to_radians())
            * DQuat::from_rotation_z((PAVILION - 90.0).to_radians());
        let middle = turn * DVec3::new(PRONGS, PRONG.y, 0.0) + top * DVec3::Y;
        ring.append(&rounded_box(PRONG, EDGE, 3).placed(turn, middle));
    }
    let plate = rounded_box(DVec3::new(2.0, 0.08, 1.4), EDGE, 4).placed(DQuat::IDENTITY, -0.08 * DVec3::Y);
    let stone = brilliant.to_mesh(Averaging::default());
    let lowest = Bounds::of(stone.positions.iter().copied()).min.y;
    let objects = vec![
        Object::new("plate", plate, materials::matte("matte", [0.10, 0.13, 0.20])),
        Object::new("ring", ring, materials::matte("matte", [0.80, 0.52, 0.20])),
        Object::new(
            "diamond",
            stone.placed(DQuat::IDENTITY, (top - f64::from(lowest)) * DVec3::Y),
            materials::diamond(),
        ),
    ];
    Ok(framed(name, objects, direction(58.0, 24.0)))
}

/// Returns a stone of this size, turned, that touches the tray.
fn lying(stone: &Polyhedron, size: f64, turn: DQuat, (x, z): (f64, f64)) -> Mesh {
    let mesh = stone.to_mesh(Averaging::default());
    let mesh = mesh.transformed(DMat4::from_scale_rotation_translation(DVec3::splat(size), turn, DVec3::ZERO));
    let lowest = Bounds::of(mesh.positions.iter().copied()).min.y;
    // A hair above it: bodies do not overlap.
    mesh.placed(DQuat::IDENTITY, DVec3::new(x, 1e-3 - f64::from(lowest), z))
}
