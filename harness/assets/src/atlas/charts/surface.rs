//! The surface of a mesh, on which charts grow.

use glam::DVec3;
use lapidary_scene::normals::weld;
use lapidary_scene::{Bounds, Mesh};

/// Smallest cosine between a triangle's normal and its chart's axis: that of 85°. A triangle that
/// leans further is drawn too thin for texels to represent, and at 90° it turns over.
pub(in crate::atlas) const LEAST_COSINE: f64 = 0.087_155_742_747_658_17;

/// Largest number of squares along a body's diagonal in which triangles are looked up: a bound on
/// how many one triangle touches.
const MOST_SQUARES: f64 = 512.0;

/// Start of a chart: a triangle, and the axis along which the chart is projected.
pub(super) type Seed = (u32, DVec3);

/// Mesh data for growing charts.
#[derive(Debug)]
pub(super) struct Surface {
    /// Corners of each triangle, relative to the middle of the mesh.
    pub(super) corners: Vec<[DVec3; 3]>,
    /// Unit normal of each triangle; zero for a triangle without area.
    pub(super) normals: Vec<DVec3>,
    pub(super) areas: Vec<f64>,
    /// Vertices of each triangle; vertices at the same position count as one.
    pub(super) vertices: Vec<[usize; 3]>,
    pub(super) neighbours: Vec<Vec<u32>>,
    /// Number of the connected body that each triangle belongs to.
    pub(super) bodies: Vec<u32>,
    /// Side of the squares in which triangles are looked up.
    pub(super) square: f64,
}

impl Surface {
    pub(super) fn of(mesh: &Mesh) -> Self {
        let bounds = Bounds::of(mesh.positions.iter().copied());
        let middle = bounds.centre().as_dvec3();
        let corners = mesh.triangles().map(|corners| corners.map(|corner| corner.as_dvec3() - middle));
        let corners: Vec<[DVec3; 3]> = corners.collect();
        let crosses = corners.iter().map(|[a, b, c]| (b - a).cross(c - a));
        let areas: Vec<f64> = crosses.clone().map(|cross| 0.5 * cross.length()).collect();
        let normals = crosses.map(DVec3::normalize_or_zero).collect();
        let (welded, _) = weld(&mesh.positions);
        let vertices = mesh.indices.chunks_exact(3).map(|corners| [0, 1, 2].map(|k| welded[corners[k] as usize]));
        let vertices: Vec<[usize; 3]> = vertices.collect();
        let neighbours = neighbours(&vertices);
        let bodies = patches(&neighbours, |_| true);
        // Twice the side of a triangle of mean size.
        let side = 2.0 * (areas.iter().sum::<f64>() / areas.len() as f64).sqrt();
        let square = side.max(2.0 * f64::from(bounds.radius()) / MOST_SQUARES).max(f64::MIN_POSITIVE);
        Self { corners, normals, areas, vertices, neighbours, bodies, square }
    }

    /// Returns a seed for growing these triangles again: the one that best faces their mean normal.
    pub(super) fn seed(&self, triangles: &[u32]) -> Seed {
        let axis = self.mean_normal(triangles);
        let cosine = |triangle: u32| self.normals[triangle as usize].dot(axis);
        let nearest = triangles.iter().copied().max_by(|&a, &b| cosine(a).total_cmp(&cosine(b)));
        (nearest.unwrap_or(0), axis)
    }

    pub(super) fn mean_normal(&self, triangles: &[u32]) -> DVec3 {
        let weighted =
            triangles.iter().map(|&triangle| self.areas[triangle as usize] * self.normals[triangle as usize]);
        weighted.sum::<DVec3>().normalize_or(DVec3::Y)
    }

    /// Whether a triangle leans away from the axis by no more than the limit.
    pub(super) fn faces(&self, triangle: u32, axis: DVec3) -> bool {
        let normal = self.normals[triangle as usize];
        normal == DVec3::ZERO || normal.dot(axis) >= LEAST_COSINE
    }
}

/// Returns, for each triangle given by its vertices, the triangles that share an edge with it.
fn neighbours(triangles: &[[usize; 3]]) -> Vec<Vec<u32>> {
    let mut edges: Vec<([usize; 2], u32)> = Vec::with_capacity(3 * triangles.len());
    for (corners, number) in triangles.iter().zip(0..) {
        for (k, l) in [(0, 1), (1, 2), (2, 0)] {
            let mut edge = [corners[k], corners[l]];
            edge.sort_unstable();
            edges.push((edge, number));
        }
    }
    edges.sort_unstable();
    let mut neighbours = vec![Vec::new(); triangles.len()];
    for pair in edges.windows(2) {
        let [(edge, a), (other, b)] = [pair[0], pair[1]];
        if edge == other && a != b {
            neighbours[a as usize].push(b);
            neighbours[b as usize].push(a);
        }
    }
    neighbours
}

/// Returns, for each `wanted` triangle, the number of its connected patch of such triangles;
/// `u32::MAX` for the others.
pub(super) fn patches(neighbours: &[Vec<u32>], wanted: impl Fn(u32) -> bool) -> Vec<u32> {
    let mut patch_of = vec![u32::MAX; neighbours.len()];
    let mut count = 0;
    for first in 0..neighbours.len() as u32 {
        let mut waiting = vec![first];
        let mut found = false;
        while let Some(triangle) = waiting.pop() {
            if patch_of[triangle as usize] == u32::MAX && wanted(triangle) {
                patch_of[triangle as usize] = count;
                found = true;
                waiting.extend(&neighbours[triangle as usize]);
            }
        }
        count += u32::from(found);
    }
    patch_of
}
