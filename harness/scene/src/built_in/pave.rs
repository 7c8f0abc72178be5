//! A ring set all round with small brilliants: copies of one shape.

use std::f32::consts::TAU;

use glam::{Mat3, Quat, Vec3};

use super::framing::framed;
use super::materials;
use crate::camera::direction;
use crate::cuts::{BrilliantParameters, round_brilliant};
use crate::{Averaging, Copies, Object, Place, Scene, SceneError};

/// Stones around the ring, and rows of them.
const AROUND: usize = 40;
const ROWS: usize = 5;
/// Radius of the ring at its widest, in units of the ring; and the radius of the band's round
/// cross-section.
const RADIUS: f32 = 1.0;
const BAND: f32 = 0.34;
/// Angle between rows as seen from the middle of the cross-section, in radians.
const ROW: f32 = 0.42;
/// Girdle radius of a stone in the middle row.
const STONE: f32 = 0.072;

/// Builds the ring, standing upright.
pub(super) fn ring(name: &str) -> Result<Scene, SceneError> {
    let stone = round_brilliant(&BrilliantParameters::TOLKOWSKY)?;
    let places = (0..ROWS).flat_map(|row| (0..AROUND).map(move |number| place(row, number)));
    let copies = Copies { shape: stone.to_mesh(Averaging::default()), places: places.collect() };
    let material = materials::sized(materials::ruby(), STONE);
    let object = Object::of_copies("stones", copies, material);
    Ok(framed(name, vec![object], direction(72.0, 34.0)))
}

/// Returns the place of a stone: on the band, its table outwards, each row turned by half a stone
/// against the next.
fn place(row: usize, number: usize) -> Place {
    let offset = row as f32 - 0.5 * (ROWS - 1) as f32;
    let turn = TAU * (number as f32 + 0.5 * (row % 2) as f32) / AROUND as f32;
    let lean = ROW * offset;
    // The ring stands in the plane of x and y; its axis is z.
    let outwards = Vec3::new(turn.sin(), turn.cos(), 0.0);
    let up = outwards * lean.cos() + Vec3::Z * lean.sin();
    let along = outwards.cross(Vec3::Z);
    let middle = (RADIUS - BAND) * outwards;
    // Rows at the sides are a little shorter, and so are their stones.
    let scale = STONE * (RADIUS - BAND + BAND * lean.cos()) / RADIUS;
    Place {
        rotation: Quat::from_mat3(&Mat3::from_cols(along, up, along.cross(up))).normalize(),
        scale,
        translation: middle + BAND * up,
        base_color: Vec3::ONE,
        attenuation_color: Some(color(turn / TAU + 0.03 * offset)),
    }
}

/// The colours of corundum round the ring, as transmitted colours in linear RGB: ruby, padparadscha,
/// yellow, green, blue and violet sapphire, and pink.
const COLORS: [Vec3; 7] = [
    Vec3::new(0.72, 0.018, 0.06),
    Vec3::new(0.90, 0.25, 0.10),
    Vec3::new(0.92, 0.68, 0.06),
    Vec3::new(0.10, 0.55, 0.20),
    Vec3::new(0.03, 0.12, 0.62),
    Vec3::new(0.28, 0.08, 0.60),
    Vec3::new(0.85, 0.16, 0.42),
];

/// Returns the colour at a part of the way round.
fn color(part: f32) -> Vec3 {
    let position = part.rem_euclid(1.0) * COLORS.len() as f32;
    let index = position as usize % COLORS.len();
    COLORS[index].lerp(COLORS[(index + 1) % COLORS.len()], position.fract())
}
