//! Smooth closed surfaces with exact normals; the round ones have texture coordinates.

use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_4, PI, TAU};

use super::Mesh;

/// Returns a sphere about the origin by longitude and latitude, its poles on the y axis, with
/// `columns` quadrilaterals around and half as many from pole to pole. u runs around once, v from
/// the upper pole to the lower; the first and last column of vertices coincide.
#[must_use]
pub fn sphere(radius: f64, columns: u32) -> Mesh {
    grid([columns, columns / 2], |uv| {
        // Exactly 0 at both poles and after one turn, so that vertices that meet there have one
        // position.
        let (across, azimuth) = ((PI * uv.y.min(1.0 - uv.y)).sin(), TAU * uv.x.fract());
        let normal = DVec3::new(across * azimuth.sin(), (PI * uv.y).cos(), across * azimuth.cos());
        (radius * normal, normal)
    })
}

/// Returns a torus about the y axis: a tube of radius `minor` around a circle of radius `major`. u
/// runs around the axis, v around the tube.
#[must_use]
pub fn torus(major: f64, minor: f64, columns: u32, rows: u32) -> Mesh {
    grid([columns, rows], |uv| {
        let (around, azimuth) = (-TAU * uv.y.fract(), TAU * uv.x.fract());
        let outward = DVec3::new(azimuth.sin(), 0.0, azimuth.cos());
        let normal = around.cos() * outward + around.sin() * DVec3::Y;
        (major * outward + minor * normal, normal)
    })
}

/// Returns a body turned about the y axis: `corners` are radius and height along its outline, from one end on the axis to the
/// other, with the body to the right. Corners are rounded by `radius`, or by half the shorter edge there, in a few steps. u runs
/// around the axis.
#[must_use]
pub fn lathe(corners: &[DVec2], radius: f64, columns: u32) -> Mesh {
    let outline = rounded(corners, radius);
    let rows = outline.len() as u32 - 1;
    grid([columns, rows], |uv| {
        let (place, normal) = outline[(uv.y * f64::from(rows)).round() as usize];
        let azimuth = TAU * uv.x.fract();
        let outward = DVec3::new(azimuth.sin(), 0.0, azimuth.cos());
        (place.x * outward + place.y * DVec3::Y, normal.x * outward + normal.y * DVec3::Y)
    })
}

/// Returns the places and normals along a line whose inner corners are rounded.
fn rounded(corners: &[DVec2], radius: f64) -> Vec<(DVec2, DVec2)> {
    const STEPS: u32 = 6;
    let normal = |edge: DVec2| edge.perp().normalize();
    let mut outline = vec![(corners[0], normal(corners[1] - corners[0]))];
    for corner in corners.windows(3) {
        let [from, at, to] = [corner[0], corner[1], corner[2]];
        let (before, after) = (at - from, to - at);
        let reach = radius.min(0.5 * before.length()).min(0.5 * after.length());
        let (start, end) = (at - reach * before.normalize(), at + reach * after.normalize());
        for step in 0..=STEPS {
            let share = f64::from(step) / f64::from(STEPS);
            let place = start.lerp(at, share).lerp(at.lerp(end, share), share);
            outline.push((place, normal(before).lerp(normal(after), share).normalize()));
        }
    }
    let [before, end] = [corners[corners.len() - 2], corners[corners.len() - 1]];
    outline.push((end, normal(end - before)));
    outline
}

/// Returns a box about the origin with half sizes `half`, its edges and corners rounded with
/// `radius`, by `steps` quadrilaterals from the middle of an edge to each of its two faces. Its
/// faces are flat up to their borders. It has no texture coordinates.
#[must_use]
pub fn rounded_box(half: DVec3, radius: f64, steps: u32) -> Mesh {
    // Tangent of the angle from a face's normal, at most exactly 1, so that two faces meet in the
    // same positions.
    let tangent = |step: u32| if step == steps { 1.0 } else { (FRAC_PI_4 * f64::from(step) / f64::from(steps)).tan() };
    // Across a face: around the edge on one side, then around the one on the other.
    let lower = (0..=steps).rev().map(|step| (-1.0, -tangent(step)));
    let places: Vec<(f64, f64)> = lower.chain((0..=steps).map(|step| (1.0, tangent(step)))).collect();
    let mut mesh = Mesh::default();
    for (axis, sign) in (0..3).flat_map(|axis| [(axis, 1.0), (axis, -1.0)]) {
        let (second, third) = ((axis + 1) % 3, (axis + 2) % 3);
        let first_vertex = mesh.positions.len() as u32;
        for (side, tangent) in &places {
            for (other_side, other_tangent) in &places {
                let (mut corner, mut normal) = (DVec3::ZERO, DVec3::ZERO);
                (corner[axis], normal[axis]) = (sign, sign);
                (corner[second], normal[second]) = (*side, *tangent);
                (corner[third], normal[third]) = (*other_side, *other_tangent);
                let normal = normal.normalize();
                mesh.positions.push((corner * (half - radius) + radius * normal).as_vec3());
                mesh.normals.push(normal.as_vec3());
            }
        }
        let count = places.len() as u32;
        for (row, column) in (0..count - 1).flat_map(|row| (0..count - 1).map(move |column| (row, column))) {
            let vertex = |down: u32, right: u32| first_vertex + (row + down) * count + column + right;
            let [mut one, mut other] =
                [[vertex(0, 0), vertex(1, 0), vertex(1, 1)], [vertex(0, 0), vertex(1, 1), vertex(0, 1)]];
            if sign < 0.0 {
                one.reverse();
                other.reverse();
            }
            mesh.indices.extend([one, other].concat());
        }
    }
    mesh
}

/// Returns a grid of `columns` × `rows` quadrilaterals over the unit square, u to the right and v
/// down as seen from outside; `surface` gives position and unit normal. Triangles without area, as
/// at a pole, are left out.
#[must_use]
pub fn grid([columns, rows]: [u32; 2], surface: impl Fn(DVec2) -> (DVec3, DVec3)) -> Mesh {
    let mut mesh = Mesh::default();
    for row in 0..=rows {
        for column in 0..=columns {
            let uv = DVec2::new(f64::from(column) / f64::from(columns), f64::from(row) / f64::from(rows));
            let (position, normal) = surface(uv);
            mesh.positions.push(position.as_vec3());
            mesh.normals.push(normal.as_vec3());
            mesh.uvs.push(uv.as_vec2());
        }
    }
    for row in 0..rows {
        for column in 0..columns {
            let upper_left = row * (columns + 1) + column;
            let lower_left = upper_left + columns + 1;
            for corners in [[upper_left, lower_left, upper_left + 1], [upper_left + 1, lower_left, lower_left + 1]] {
                let [a, b, c] = corners.map(|corner| mesh.positions[corner as usize]);
                // Vertices at a pole differ only by rounding.
                let least = 1e-6 * (a - b).length_squared().max((c - b).length_squared());
                if (b - a).cross(c - a).length() > least {
                    mesh.indices.extend(corners);
                }
            }
        }
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Vec2, Vec3};

    fn check(mesh: &Mesh, volume: f64, area: f64) {
        let (found_volume, found_area) = mesh.volume_and_area();
        assert!((found_volume / volume - 1.0).abs() < 5e-3, "{found_volume}, {volume}");
        assert!((found_area / area - 1.0).abs() < 5e-3, "{found_area}, {area}");
        assert!(mesh.uvs.len() == mesh.positions.len() && mesh.normals.len() == mesh.positions.len());
        // No triangle is flipped in texture space: clockwise with v down is counter-clockwise from
        // outside.
        for triangle in mesh.indices.chunks_exact(3) {
            let [a, b, c]: [Vec2; 3] = [0, 1, 2].map(|k| mesh.uvs[triangle[k] as usize]);
            assert!((b - a).perp_dot(c - a) < 0.0);
            let [a, b, c]: [Vec3; 3] = [0, 1, 2].map(|k| mesh.positions[triangle[k] as usize]);
            assert!((b - a).cross(c - a).dot(mesh.normals[triangle[0] as usize]) > 0.0);
        }
    }

    #[test]
    fn a_sphere_has_its_volume_and_area() {
        check(&sphere(2.0, 128), 4.0 / 3.0 * PI * 8.0, 4.0 * PI * 4.0);
    }

    /// Steiner's formula: the volume within `r` of a box with edges a, b, c is
    /// abc + 2r(ab + bc + ca) + πr²(a + b + c) + 4/3πr³, and the area is its derivative with
    /// respect to r.
    #[test]
    fn a_rounded_box_has_its_volume_its_area_and_flat_faces() {
        let (half, r) = (DVec3::new(7.0, 2.0, 4.0), 0.75);
        let mesh = rounded_box(half, r, 8);
        assert!(crate::convex::is_closed(&mesh));
        let [a, b, c] = (2.0 * (half - r)).to_array();
        let (sides, edges) = (a * b + b * c + c * a, a + b + c);
        let (volume, area) = mesh.volume_and_area();
        let expected = a * b * c + 2.0 * r * sides + PI * r * r * edges + 4.0 / 3.0 * PI * r.powi(3);
        assert!(volume < expected && volume > 0.999 * expected, "{volume}, {expected}");
        let expected = 2.0 * sides + TAU * r * edges + 4.0 * PI * r * r;
        assert!(area < expected && area > 0.999 * expected, "{area}, {expected}");
        for (position, normal) in mesh.positions.iter().zip(&mesh.normals) {
            let inner = position.as_dvec3().clamp(r - half, half - r);
            assert!((position.as_dvec3() - inner).distance(r * normal.as_dvec3()) < 1e-6);
        }
        let top = mesh.triangles().zip(mesh.indices.chunks_exact(3));
        let top: Vec<_> = top.filter(|(corners, _)| corners.iter().all(|corner| corner.y == 2.0)).collect();
        assert_eq!(top.len(), 2);
        for (corners, triangle) in top {
            assert!((corners[1] - corners[0]).cross(corners[2] - corners[0]).y > 0.0);
            assert!(triangle.iter().all(|&vertex| mesh.normals[vertex as usize] == Vec3::Y));
        }
    }

    #[test]
    fn a_turned_outline_is_closed_and_has_its_volume() {
        let corners = [DVec2::new(0.0, 2.0), DVec2::new(1.0, 2.0), DVec2::new(1.0, 0.0), DVec2::new(0.0, 0.0)];
        check(&lathe(&corners, 1e-4, 128), 2.0 * PI, 6.0 * PI);
        let mesh = lathe(&corners, 0.2, 64);
        assert!(crate::convex::is_closed(&mesh));
        // A corner that is rounded loses less than its square.
        let (volume, _) = mesh.volume_and_area();
        assert!(volume < 2.0 * PI && volume > 2.0 * PI - 2.0 * TAU * 0.2 * 0.2, "{volume}");
    }

    #[test]
    fn a_torus_has_its_volume_and_area() {
        check(&torus(2.0, 0.5, 128, 64), 2.0 * PI * PI * 2.0 * 0.25, 4.0 * PI * PI * 2.0 * 0.5);
    }
}
