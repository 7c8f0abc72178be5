//! The band: a rounded section that tapers, with a channel in each shoulder for the side stones.

use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

use crate::Mesh;
use crate::smoothstep::smoothstep;
use crate::surfaces::grid;

use super::corner::rounded_corner;

/// Radius of the finger.
const INNER: f64 = 8.5;
/// Vertices around the band.
const AROUND: u32 = 320;
/// Girdle radii of a shoulder's stones, from the head downwards.
pub(super) const STONES: [f64; 5] = [0.98, 0.93, 0.88, 0.83, 0.78];
/// Angle of the first of them from the head, in radians; gap between two, and between a stone and the channel's wall.
const FIRST: f64 = 0.47;
const GAP: f64 = 0.05;
const PLAY: f64 = 0.03;
/// How deep girdles lie below the walls' tops.
const SET: f64 = 0.2;
/// Depth of a stone below its girdle's middle, in girdle radii; and room under it.
const PAVILION: f64 = 0.885;
const ROOM: f64 = 0.06;
/// Rounding of outer edges, of the inner ones, and of the channel's.
const EDGES: [f64; 3] = [0.42, 0.40, 0.06];
/// How much lower the outside is at a distance of 1 from its middle, and how much wider the inside: a comfort fit.
const DOME: f64 = 0.17;
const FIT: f64 = 0.16;

/// Thickness at an angle from the head, 0 to π: thin below the stone, thick at the shoulders.
fn thickness(angle: f64) -> f64 {
    1.3 + 0.8 * smoothstep(0.12, 0.38, angle) - 0.5 * smoothstep(1.0, 2.4, angle)
}

fn half_width(angle: f64) -> f64 {
    1.42 - 0.4 * smoothstep(0.7, 2.4, angle)
}

/// Returns the band's greatest radius at an angle from the head, 0 to π.
pub(super) fn outer_radius(angle: f64) -> f64 {
    INNER + thickness(angle)
}

/// Returns the distance of a side stone's girdle from the ring's axis.
pub(super) fn girdle_radius(angle: f64) -> f64 {
    outer_radius(angle) - SET
}

/// Returns angle from the head and girdle radius of one shoulder's stones.
pub(super) fn side_stones() -> Vec<(f64, f64)> {
    let mut placed: Vec<(f64, f64)> = Vec::new();
    for radius in STONES {
        let next = |(angle, before): &(f64, f64)| angle + (before + radius + GAP) / girdle_radius(*angle);
        placed.push((placed.last().map_or(FIRST, next), radius));
    }
    placed
}

/// Depth and half width of the channel at an angle from the head, 0 to π; hardly any where there are no stones.
fn channel(stones: &[(f64, f64)], angle: f64) -> (f64, f64) {
    let (first, last) = (stones[0], stones[stones.len() - 1]);
    let share = ((angle - first.0) / (last.0 - first.0)).clamp(0.0, 1.0);
    let radius = first.1 + share * (last.1 - first.1);
    let reach = |(at, radius): (f64, f64)| (radius + PLAY) / girdle_radius(at);
    let (from, to) = (first.0 - reach(first), last.0 + reach(last));
    // Its ends are as steep as a stone's pavilion leaves room for.
    let within = smoothstep(from - 0.045, from, angle) * smoothstep(to + 0.045, to, angle);
    ((SET + PAVILION * radius + ROOM) * within + 2e-3, radius + PLAY)
}

/// Returns the mesh in the ring's own space: about the origin, its axis along z, the head towards +y.
pub(super) fn mesh() -> Mesh {
    let stones = side_stones();
    let outline_at = |angle: f64| outline(&stones, angle);
    let rows = outline_at(0.0).len() as u32 - 1;
    let place = |angle: f64, row: usize| {
        let (point, normal) = outline_at((angle - TAU * (angle / TAU).round()).abs())[row];
        let outwards = DVec3::new(angle.sin(), angle.cos(), 0.0);
        (point.y * outwards + point.x * DVec3::Z, normal.y * outwards + normal.x * DVec3::Z)
    };
    let mesh = grid([AROUND, rows], |uv| {
        let (angle, row) = (TAU * uv.x.fract(), (uv.y * f64::from(rows)).round() as usize);
        let (point, normal) = place(angle, row);
        // The section changes along the band, and its normal leans with it.
        let along = place(angle + 2e-3, row).0 - place(angle - 2e-3, row).0;
        (point, (normal - normal.dot(along) / along.length_squared() * along).normalize())
    });
    mesh.without_uvs()
}

/// Returns points and normals around the section at an angle from the head, 0 to π: x along the ring's axis, y from it.
/// Their number is the same everywhere.
fn outline(stones: &[(f64, f64)], angle: f64) -> Vec<(DVec2, DVec2)> {
    let (thickness, half) = (thickness(angle), half_width(angle));
    let (depth, channel) = channel(stones, angle);
    let [outer, inner, fine] = EDGES;
    let corners = [
        (DVec2::new(-half, thickness), outer.min(0.9 * (half - channel))),
        (DVec2::new(-channel, thickness), fine),
        (DVec2::new(-channel, thickness - depth), fine),
        (DVec2::new(channel, thickness - depth), fine),
        (DVec2::new(channel, thickness), fine),
        (DVec2::new(half, thickness), outer.min(0.9 * (half - channel))),
        (DVec2::new(half, 0.0), inner),
        (DVec2::new(-half, 0.0), inner),
    ];
    let points = rounded(&corners);
    let domed = |(point, normal): (DVec2, DVec2)| {
        let (across, share) = (point.x, point.y / thickness);
        let shift = across * across * (FIT * (1.0 - share) - DOME * share);
        // The normal by the inverse transpose of the shift's derivatives.
        let slope = 2.0 * across * (FIT * (1.0 - share) - DOME * share);
        let stretch = 1.0 - across * across * (FIT + DOME) / thickness;
        let normal = DVec2::new(normal.x - slope * normal.y / stretch, normal.y / stretch).normalize();
        (DVec2::new(across, INNER + point.y + shift), normal)
    };
    points.into_iter().map(domed).collect()
}

/// Returns points and normals around a closed polygon that runs clockwise, each corner rounded by its radius.
fn rounded(corners: &[(DVec2, f64)]) -> Vec<(DVec2, DVec2)> {
    const STEPS: usize = 5;
    const PARTS: usize = 4;
    let count = corners.len();
    let mut points: Vec<(DVec2, DVec2)> = Vec::new();
    for (number, (at, radius)) in corners.iter().enumerate() {
        let (before, after) = (at - corners[(number + count - 1) % count].0, corners[(number + 1) % count].0 - at);
        let normal = |edge: DVec2| DVec2::new(-edge.y, edge.x).normalize();
        let reach = radius.min(0.49 * before.length()).min(0.49 * after.length());
        let (start, end) = (at - reach * before.normalize(), at + reach * after.normalize());
        if let Some((last, _)) = points.last().copied() {
            // A long edge is parted, since it is domed later.
            points.extend((1..PARTS).map(|part| (last.lerp(start, part as f64 / PARTS as f64), normal(before))));
        }
        for step in 0..=STEPS {
            let share = step as f64 / STEPS as f64;
            let place = rounded_corner(start, *at, end, share);
            points.push((place, normal(before).lerp(normal(after), share).normalize()));
        }
    }
    let (first, normal) = points[0];
    let last = points[points.len() - 1].0;
    points.extend((1..PARTS).map(|part| (last.lerp(first, part as f64 / PARTS as f64), normal)));
    points.push((first, normal));
    points
}
