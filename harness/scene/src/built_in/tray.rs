//! Stones among matte things, all near enough to one another that what leaves a stone meets them.

use glam::{DMat4, DQuat, DVec3, Vec3};

use super::{direction, framed, materials};
use crate::cuts::{BrilliantParameters, StepCutParameters, round_brilliant, step_cut};
use crate::polyhedron::Polyhedron;
use crate::surfaces::{rounded_box, sphere};
use crate::{Averaging, Bounds, Material, Mesh, Object, Scene, SceneError};

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
    let ball = sphere(0.5, 96).placed(DQuat::IDENTITY, DVec3::new(0.95, 0.5, -0.75));
    let block = rounded_box(DVec3::new(0.42, 0.6, 0.28), EDGE, 4);
    let block = block.placed(DQuat::from_rotation_y(0.6), DVec3::new(-1.2, 0.6, -0.75));
    let objects = vec![
        Object::new(
            "tray",
            rounded_box(TRAY, EDGE, 4).placed(DQuat::IDENTITY, -TRAY.y * DVec3::Y),
            matte([0.42, 0.10, 0.06]),
        ),
        Object::new("ball", ball, matte([0.05, 0.16, 0.55])),
        Object::new("block", block, matte([0.75, 0.55, 0.08])),
        Object::new("diamond", lying(&brilliant, 0.95, leaning, (-0.45, 0.2)), materials::diamond()),
        Object::new(
            "emerald",
            lying(&emerald, 0.6, on_its_table, (1.05, 0.75)),
            materials::sized(materials::emerald(), 0.6),
        ),
    ];
    Ok(framed(name, objects, direction(60.0, 12.0)))
}

/// A material that reflects by Lambert's law alone.
fn matte([red, green, blue]: [f32; 3]) -> Material {
    let base_color = Vec3::new(red, green, blue);
    Material { name: "matte".to_owned(), base_color, ior: 1.0, roughness: 1.0, ..Material::standard() }
}

/// Returns a stone of this size, turned, that touches the tray.
fn lying(stone: &Polyhedron, size: f64, turn: DQuat, (x, z): (f64, f64)) -> Mesh {
    let mesh = stone.to_mesh(Averaging::default());
    let mesh = mesh.transformed(DMat4::from_scale_rotation_translation(DVec3::splat(size), turn, DVec3::ZERO));
    let lowest = Bounds::of(mesh.positions.iter().copied()).min.y;
    // A hair above it: bodies do not overlap.
    mesh.placed(DQuat::IDENTITY, DVec3::new(x, 1e-3 - f64::from(lowest), z))
}
