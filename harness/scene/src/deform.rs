//! Bodies that change with time, to test computations that are redone for each frame. Time runs
//! from 0 to 1.

use super::Mesh;
use super::surfaces::grid;
use glam::{DMat3, DVec2, DVec3, dvec2, dvec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

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

/// Radii of two drops, and the distance between their surfaces below which they blend.
const RADII: [f64; 2] = [14.0, 10.0];
const WIDTH: f64 = 9.0;

/// Two drops along x that approach, meet and become one, meshed anew for each `time`: two bodies
/// until about .4, then one. 50 units wide; one drop has a radius of 14, the other of 10.
///
/// The bodies are surfaces of revolution about the x axis: the points where the smooth union of two
/// balls has the value 0.
#[must_use]
pub fn merging(time: f64) -> Mesh {
    let gap = 12.0 - 20.0 * time.clamp(0.0, 1.0);
    let distance = RADII[0] + RADII[1] + gap;
    // The larger drop moves less.
    let centres = [-distance * RADII[1] / (RADII[0] + RADII[1]), distance * RADII[0] / (RADII[0] + RADII[1])];
    // Negative inside; `place` is the way along x, and the distance from the axis.
    let field = |place: DVec2| {
        let [a, b] = [0, 1].map(|k: usize| place.distance(dvec2(centres[k], 0.0)) - RADII[k]);
        let overlap = (WIDTH - (a - b).abs()).max(0.0);
        a.min(b) - overlap * overlap / (4.0 * WIDTH)
    };
    let on_axis = |inside: f64, outside: f64| root(inside, outside, |x| field(dvec2(x, 0.0)));
    let ends = [on_axis(centres[0], centres[0] - 2.0 * RADII[0]), on_axis(centres[1], centres[1] + 2.0 * RADII[1])];
    // As far from either drop.
    let middle = 0.5 * (centres[0] + RADII[0] + centres[1] - RADII[1]);
    let mut mesh = Mesh::default();
    if field(dvec2(middle, 0.0)) < 0.0 {
        mesh.append(&revolved(ends, field));
    } else {
        mesh.append(&revolved([ends[0], on_axis(centres[0], middle)], field));
        mesh.append(&revolved([on_axis(centres[1], middle), ends[1]], field));
    }
    mesh.without_uvs()
}

/// Returns the place between `inside`, where `value` is negative, and `outside` where it is 0.
fn root(mut inside: f64, mut outside: f64, value: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (inside + outside);
        *(if value(middle) < 0.0 { &mut inside } else { &mut outside }) = middle;
    }
    inside
}

/// Returns the body of revolution about the x axis between two places on it.
fn revolved([low, high]: [f64; 2], field: impl Fn(DVec2) -> f64) -> Mesh {
    const DIFFERENCE: f64 = 1e-5;
    grid([64, 64], |uv| {
        // The upper pole is towards +x; exactly on the axis at both poles.
        let along = 0.5 * (low + high) + 0.5 * (high - low) * (PI * uv.y).cos();
        let at_pole = uv.y <= 0.0 || uv.y >= 1.0;
        let radius = if at_pole { 0.0 } else { root(0.0, RADII[0] + WIDTH, |radius| field(dvec2(along, radius))) };
        let place = dvec2(along, radius);
        let slope = |axis: DVec2| field(place + DIFFERENCE * axis) - field(place - DIFFERENCE * axis);
        let normal =
            if at_pole { dvec2(1.0 - 2.0 * uv.y, 0.0) } else { dvec2(slope(DVec2::X), slope(DVec2::Y)).normalize() };
        let (sine, cosine) = (TAU * uv.x.fract()).sin_cos();
        let turned = |vector: DVec2| dvec3(vector.x, vector.y * cosine, vector.y * sine);
        (turned(place), turned(normal))
    })
}

#[cfg(test)]
mod tests;
