//! Smooth closed surfaces with exact normals and texture coordinates.

use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

use super::Mesh;

/// A sphere about the origin by longitude and latitude, its poles on the y axis: `columns` around, half as many from pole to pole.
/// u runs around once, v from the upper pole to the lower; the first and last column of vertices are at one place.
#[must_use]
pub fn sphere(radius: f64, columns: u32) -> Mesh {
    grid([columns, columns / 2], |uv| {
        // Exactly 0 at both poles and once around, so that what meets there has one position.
        let (across, azimuth) = ((PI * uv.y.min(1.0 - uv.y)).sin(), TAU * uv.x.fract());
        let normal = DVec3::new(across * azimuth.sin(), (PI * uv.y).cos(), across * azimuth.cos());
        (radius * normal, normal)
    })
}

/// A torus about the y axis: a tube of radius `minor` about a circle of radius `major`. u runs around the axis, v around the tube.
#[must_use]
pub fn torus(major: f64, minor: f64, columns: u32, rows: u32) -> Mesh {
    grid([columns, rows], |uv| {
        let (around, azimuth) = (-TAU * uv.y.fract(), TAU * uv.x.fract());
        let outward = DVec3::new(azimuth.sin(), 0.0, azimuth.cos());
        let normal = around.cos() * outward + around.sin() * DVec3::Y;
        (major * outward + minor * normal, normal)
    })
}

/// A grid of `size` quadrilaterals over the unit square, u to the right and v down as seen from outside, by position and unit normal.
/// Triangles without area, as at a pole, are left out.
fn grid([columns, rows]: [u32; 2], surface: impl Fn(DVec2) -> (DVec3, DVec3)) -> Mesh {
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
                // Vertices at a pole are apart by rounding alone.
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
        // Texture coordinates turn over no triangle: clockwise with v down is counter-clockwise from outside.
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

    #[test]
    fn a_torus_has_its_volume_and_area() {
        check(&torus(2.0, 0.5, 128, 64), 2.0 * PI * PI * 2.0 * 0.25, 4.0 * PI * PI * 2.0 * 0.5);
    }
}
