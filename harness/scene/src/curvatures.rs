//! Mean curvature at each vertex of a mesh.

use super::Mesh;
use super::normals::weld;

/// Returns, for each vertex, the mean curvature of the surface that the normals belong to, in the
/// inverse of the mesh's unit; 0 at vertices without a proper triangle.
///
/// Over a triangle the normal changes linearly, and so has one mean curvature there, by the same
/// formula as a pixel's derivatives: Rusinkiewicz, "Estimating Curvatures and Their Derivatives on
/// Triangle Meshes" (2004), with both sides in place of the screen's axes. A vertex has the
/// area-weighted mean over its triangles. Vertices at one place, as on the borders of charts, share
/// it.
#[must_use]
pub fn vertex_curvatures(mesh: &Mesh) -> Vec<f32> {
    let (welded, count) = weld(&mesh.positions);
    let mut sums = vec![(0.0, 0.0); count];
    for triangle in mesh.indices.chunks_exact(3) {
        let vertices = [0, 1, 2].map(|k| triangle[k] as usize);
        let [a, b, c] = vertices.map(|vertex| mesh.positions[vertex]);
        let [normal_a, normal_b, normal_c] = vertices.map(|vertex| mesh.normals[vertex]);
        let mean = lapidary_curvature::mean(b - a, c - a, normal_b - normal_a, normal_c - normal_a);
        let area = f64::from((b - a).cross(c - a).length());
        for vertex in vertices {
            let (sum, weight) = &mut sums[welded[vertex]];
            *sum += area * f64::from(mean);
            *weight += area;
        }
    }
    let mean = |&(sum, weight): &(f64, f64)| if weight > 0.0 { (sum / weight) as f32 } else { 0.0 };
    welded.into_iter().map(|place| mean(&sums[place])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surfaces::{sphere, torus};
    use glam::Vec3;

    #[test]
    fn a_sphere_has_one_curvature() {
        let mesh = sphere(4.0, 96);
        for (curvature, position) in vertex_curvatures(&mesh).into_iter().zip(&mesh.positions) {
            assert!((curvature * 4.0 - 1.0).abs() < 2e-3, "{curvature} at {position}");
        }
    }

    #[test]
    fn a_torus_has_that_of_its_tube_and_of_its_ring() {
        let (major, minor) = (3.0f32, 1.0f32);
        let mesh = torus(major.into(), minor.into(), 256, 128);
        for (curvature, position) in vertex_curvatures(&mesh).into_iter().zip(&mesh.positions) {
            let from_axis = Vec3::new(position.x, 0.0, position.z).length();
            let expected = 0.5 * (1.0 / minor + (from_axis - major) / minor / from_axis);
            assert!((curvature - expected).abs() < 5e-3, "{curvature}, expected {expected} at {position}");
        }
    }

    #[test]
    fn nothing_has_none() {
        let mut mesh = sphere(1.0, 16);
        mesh.positions.push(Vec3::splat(9.0));
        mesh.normals.push(Vec3::Y);
        assert_eq!(vertex_curvatures(&mesh).last(), Some(&0.0));
        assert!(vertex_curvatures(&Mesh::default()).is_empty());
    }
}
