//! Bodies that change with time, to test computations that are redone for each frame. Time runs
//! from 0 to 1.

use super::Mesh;
use super::implicit::{Grid, surface, union};
use glam::{DMat3, DVec2, DVec3, dvec3};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Largest rotation of the top, in radians.
const TURN: f64 = FRAC_PI_2;

/// Returns `mesh` twisted about the vertical through `axis` (its x and z): points at the height
/// `base` stay, points at `top` turn by a quarter to one side and to the other once per unit of
/// `time`, and points in between turn in proportion to their height.
#[must_use]
pub fn twisting(mesh: &Mesh, axis: DVec2, [base, top]: [f64; 2], time: f64) -> Mesh {
    twisted(mesh, axis, base, TURN * (TAU * time).sin() / (top - base))
}

/// Returns `mesh` with each point turned about the vertical through `axis` (its x and z) by `rate`
/// radians per unit of height above `base`. The volume is preserved. Normals are transformed by the
/// inverse transpose of the map's derivative.
#[must_use]
pub fn twisted(mesh: &Mesh, axis: DVec2, base: f64, rate: f64) -> Mesh {
    let foot = dvec3(axis.x, 0.0, axis.y);
    let turn = |height: f64| DMat3::from_rotation_y(rate * (height - base));
    let position = |point: DVec3| turn(point.y) * (point - foot) + foot;
    let derivative = |point: DVec3| {
        let (turn, from) = (turn(point.y), position(point) - foot);
        // The rotation grows with height, which adds the motion of a turning point to the
        // rotation's second column.
        DMat3::from_cols(turn.x_axis, turn.y_axis + rate * DVec3::Y.cross(from), turn.z_axis)
    };
    let normal = |point: DVec3, normal: DVec3| (derivative(point).inverse().transpose() * normal).normalize();
    let vertices = || mesh.positions.iter().zip(&mesh.normals).map(|(p, n)| (p.as_dvec3(), n.as_dvec3()));
    Mesh {
        positions: vertices().map(|(point, _)| position(point).as_vec3()).collect(),
        normals: vertices().map(|(point, given)| normal(point, given).as_vec3()).collect(),
        ..mesh.clone()
    }
}

/// Two drops along x that approach, meet and become one, meshed anew for each `time`: two bodies
/// until about .4, then one. 50 units wide, in triangles of about 1.2; one drop has a radius of 14,
/// the other of 10.
#[must_use]
pub fn merging(time: f64) -> Mesh {
    /// Radii, and the distance between surfaces below which they blend.
    const RADII: [f64; 2] = [14.0, 10.0];
    const WIDTH: f64 = 9.0;
    let gap = 12.0 - 20.0 * time.clamp(0.0, 1.0);
    let apart = RADII[0] + RADII[1] + gap;
    // The larger drop moves less.
    let centres = [-apart * RADII[1] / (RADII[0] + RADII[1]), apart * RADII[0] / (RADII[0] + RADII[1])];
    let drop = |k: usize, point: DVec3| point.distance(centres[k] * DVec3::X) - RADII[k];
    let field = |point: DVec3| union(drop(0, point), drop(1, point), WIDTH);
    // The same grid at all times, so that only moving parts change.
    surface(&field, &Grid::uniform(dvec3(-32.0, -17.0, -17.0), dvec3(35.0, 17.0, 17.0), 1.2))
}

#[cfg(test)]
mod tests;
