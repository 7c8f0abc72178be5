//! The head: six prongs that bend over the girdle and end on the crown, and two rails that hold them together.

use glam::{DQuat, DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, TAU};

use crate::Mesh;
use crate::surfaces::{grid, torus};

use super::corner::rounded_corner;

/// Girdle radius of the stone, and height of its girdle's middle above the ring's axis.
pub(super) const STONE: f64 = 3.7;
pub(super) const GIRDLE: f64 = 13.2;
/// Half the girdle's thickness, and the steepest slope of what the crown's edges enclose, from the girdle to the stars'
/// tips, in radians.
const EDGE: f64 = 0.02 * STONE;
const CROWN: f64 = 0.70;
/// Prongs, their radius, and the room between them and the stone.
const PRONGS: u32 = 6;
const WIRE: f64 = 0.40;
const ROOM: f64 = 0.015;
/// Where a prong starts, inside the band: distance from the head's axis and height.
const FOOT: DVec2 = DVec2::new(1.25, 9.0);
/// How far below the girdle a prong turns upwards, how wide the bend is, and how far it reaches over the crown.
const BEND: f64 = 0.85;
const WIDE: f64 = 0.7;
const OVER: f64 = 0.62;
/// Heights of the rails, and the radius of their wire.
const RAILS: [f64; 2] = [11.5, 10.0];
const RAIL: f64 = 0.30;

/// Returns prongs and rails in the ring's own space.
pub(super) fn mesh() -> Mesh {
    let path = path();
    let one = prong(&path);
    let mut all = Mesh::default();
    for number in 0..PRONGS {
        let turn = TAU * (f64::from(number) + 0.5) / f64::from(PRONGS);
        all.append(&one.placed(DQuat::from_rotation_y(turn), DVec3::ZERO));
    }
    for height in RAILS {
        let rail = torus(on_slope(height), RAIL, 96, 20).without_uvs();
        all.append(&rail.placed(DQuat::IDENTITY, height * DVec3::Y));
    }
    all
}

/// Where a prong turns upwards.
fn bend() -> DVec2 {
    DVec2::new(STONE + WIRE + ROOM, GIRDLE - EDGE - BEND)
}

/// Returns the distance from the head's axis of a prong's straight part at a height.
fn on_slope(height: f64) -> f64 {
    let share = (height - FOOT.y) / (bend().y - FOOT.y);
    FOOT.x + share * (bend().x - FOOT.x)
}

/// Returns the middle line of a prong, with the directions along it: x from the head's axis, y up.
fn path() -> Vec<(DVec2, DVec2)> {
    let (foot, bend) = (FOOT, bend());
    let mut line = vec![foot];
    let (start, end) = (bend - WIDE * (bend - foot).normalize(), bend + WIDE * DVec2::Y);
    line.extend((1..12).map(|part| foot.lerp(start, f64::from(part) / 12.0)));
    line.extend((0..=10).map(|part| rounded_corner(start, bend, end, f64::from(part) / 10.0)));
    // Around the girdle's upper edge, always at the same distance, then along the crown.
    let edge = DVec2::new(STONE, GIRDLE + EDGE);
    let reach = WIRE + ROOM;
    line.extend((0..=10).map(|part| edge + reach * DVec2::from_angle((FRAC_PI_2 - CROWN) * f64::from(part) / 10.0)));
    let last = line[line.len() - 1];
    line.extend((1..=4).map(|part| last + OVER * f64::from(part) / 4.0 * DVec2::new(-CROWN.cos(), CROWN.sin())));
    let along = |number: usize| {
        let (before, after) = (number.saturating_sub(1), (number + 1).min(line.len() - 1));
        (line[after] - line[before]).normalize()
    };
    (0..line.len()).map(|number| (line[number], along(number))).collect()
}

/// Returns a prong in the plane of x and y: a wire along the line, its end round.
fn prong(path: &[(DVec2, DVec2)]) -> Mesh {
    const CAP: usize = 7;
    // The foot is inside the band, and closed by a cap as well.
    let caps = (1..=CAP).map(|part| FRAC_PI_2 * part as f64 / CAP as f64);
    let mut rings: Vec<((DVec2, DVec2), f64)> = Vec::new();
    rings.extend(caps.clone().rev().map(|angle| (path[0], -angle)));
    rings.extend(path.iter().map(|place| (*place, 0.0)));
    rings.extend(caps.map(|angle| (path[path.len() - 1], angle)));
    let rows = rings.len() as u32 - 1;
    let mesh = grid([24, rows], |uv| {
        let ((at, along), cap) = rings[(uv.y * f64::from(rows)).round() as usize];
        let (sine, cosine) = (TAU * uv.x.fract()).sin_cos();
        let aside = DVec2::new(along.y, -along.x);
        // Exactly 0 at the ends, where all vertices meet.
        let ring = if cap.abs() == FRAC_PI_2 { 0.0 } else { cap.cos() };
        let flat = ring * cosine * aside + cap.sin() * along;
        let normal = DVec3::new(flat.x, flat.y, ring * sine);
        (DVec3::new(at.x, at.y, 0.0) + WIRE * normal, normal)
    });
    mesh.without_uvs()
}
