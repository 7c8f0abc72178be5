//! What of a mesh is compared: its corners about their middle, in units of their mean distance from it.

use glam::DVec3;

use crate::Mesh;
use crate::weld::{TOLERANCE, weld};

/// Number of corners up to which a mesh is compared with others.
const MOST_CORNERS: usize = 1 << 16;
/// Noise, as a share of the unit, above which any two small shapes would be alike.
const MOST_NOISE: f64 = 1.0 / 32.0;

/// The corners of a mesh.
#[derive(Debug, Clone)]
pub(super) struct Form {
    /// Corners about their middle, in units of length `unit`.
    pub(super) points: Vec<DVec3>,
    /// Number of the corner at which each vertex stands.
    pub(super) place_of_vertex: Vec<usize>,
    /// Mean normal of the vertices at each corner; none if they are not interpolated.
    pub(super) normals: Vec<DVec3>,
    /// Numbers of the corners by distance from the middle, and these distances.
    pub(super) order: Vec<usize>,
    pub(super) radii: Vec<f64>,
    /// Triangles by corners, each from its smallest number on, in order.
    pub(super) triangles: Vec<[usize; 3]>,
    /// Middle of the corners, in world space.
    pub(super) centre: DVec3,
    /// Root mean square of the distances, in units of world space.
    pub(super) unit: f64,
    /// Distance by which a corner may be off, in units of `unit`, above 0.
    pub(super) noise: f64,
}

impl Form {
    /// Returns `None` for a mesh that is not compared: without a size, too large, or too coarse.
    pub(super) fn of(mesh: &Mesh, noise: f64, is_smooth: bool) -> Option<Self> {
        let positions = || mesh.positions.iter().map(|position| position.as_dvec3());
        let largest = positions().fold(0.0, |most: f64, position| most.max(position.abs().max_element()));
        let (mut points, place_of_vertex) = weld(positions(), TOLERANCE * largest);
        let count = points.len();
        if !(4..=MOST_CORNERS).contains(&count) {
            return None;
        }
        let centre = points.iter().sum::<DVec3>() / count as f64;
        let unit = (points.iter().map(|point| point.distance_squared(centre)).sum::<f64>() / count as f64).sqrt();
        let relative = noise / unit;
        // Written so that NaN fails.
        if !(relative > 0.0 && relative <= MOST_NOISE) {
            return None;
        }
        points.iter_mut().for_each(|point| *point = (*point - centre) / unit);
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by(|&one, &other| points[one].length_squared().total_cmp(&points[other].length_squared()));
        let radii = order.iter().map(|&number| points[number].length()).collect();
        let triangle = |corners: &[u32]| {
            let mut places = [0, 1, 2].map(|k| place_of_vertex[corners[k] as usize]);
            let least = (0..3).min_by_key(|&k| places[k]).unwrap_or_default();
            places.rotate_left(least);
            places
        };
        let mut triangles: Vec<[usize; 3]> = mesh.indices.chunks_exact(3).map(triangle).collect();
        triangles.sort_unstable();
        let normals = if is_smooth { normals(mesh, &place_of_vertex, count) } else { Vec::new() };
        Some(Self { points, place_of_vertex, normals, order, radii, triangles, centre, unit, noise: relative })
    }

    /// Returns the numbers of the corners at a distance from the middle, within a tolerance: in the mesh's order, since in that
    /// of the distances the one whose noise is least would come first, and the mean of many such ones would be off.
    pub(super) fn at_radius(&self, radius: f64, tolerance: f64) -> Vec<usize> {
        let mut found = self.order[self.within(radius, tolerance)].to_vec();
        found.sort_unstable();
        found
    }

    /// Returns the places in the order of distances that are within a tolerance of one.
    pub(super) fn within(&self, radius: f64, tolerance: f64) -> std::ops::Range<usize> {
        let first = self.radii.partition_point(|other| *other < radius - tolerance);
        let end = self.radii.partition_point(|other| *other <= radius + tolerance);
        first..end.max(first)
    }

    /// Returns the enclosed volume, the area, and the length of all edges, in units of `unit`.
    pub(super) fn measures(&self) -> [f64; 3] {
        let of_triangle = |triangle: &[usize; 3]| {
            let [a, b, c] = triangle.map(|place| self.points[place]);
            let across = (b - a).cross(c - a);
            [across.dot(a) / 6.0, 0.5 * across.length(), a.distance(b) + b.distance(c) + c.distance(a)]
        };
        let all = self.triangles.iter().map(of_triangle);
        all.fold([0.0; 3], |[x, y, z], [dx, dy, dz]| [x + dx, y + dy, z + dz])
    }
}

fn normals(mesh: &Mesh, place_of_vertex: &[usize], count: usize) -> Vec<DVec3> {
    let mut sums = vec![(DVec3::ZERO, 0.0); count];
    for (normal, &place) in mesh.normals.iter().zip(place_of_vertex) {
        sums[place].0 += normal.as_dvec3();
        sums[place].1 += 1.0;
    }
    sums.into_iter().map(|(sum, vertices): (DVec3, f64)| sum / vertices.max(1.0)).collect()
}
