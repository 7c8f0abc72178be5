//! Shared vertex normals of a triangle list.
//!
//! The proxy geometry of a gem is built from these normals, so how they are averaged is part of its
//! result, not a matter of taste: the centre of curvature of a brilliant's table moves from -1.2 to
//! -3.8 girdle radii with it.

use std::collections::HashMap;

use glam::{DMat3, DVec3, Vec3};

mod hard_edges;
mod smooth;

pub use hard_edges::{has_hard_edges, soft_normals};
pub use smooth::{Normals, is_bent, is_smooth};

/// How the normals of the faces around a vertex are weighted in its shared normal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Averaging {
    /// Each face counts once. On a triangle list each *triangle* is a face, so the result depends
    /// on how facets were cut into triangles.
    Plain,
    /// Each face counts by its interior angle at the vertex. The triangles of a flat facet add up
    /// to the facet's own angle, so the result does not depend on the triangulation.
    #[default]
    Angle,
    /// Each face counts by its area. On a triangle list only the area of the triangles that touch
    /// the vertex counts, so the result depends on the triangulation.
    Area,
}

/// Normal of a vertex that has no proper triangle, or whose faces cancel: straight up.
pub const FALLBACK_NORMAL: Vec3 = Vec3::Y;

/// Length of the sum of weighted unit normals, relative to the sum of weights, below which only
/// rounding error is left: f64 accumulation of n terms keeps about n · 1e-16, and a vertex with 10⁴
/// faces is beyond any mesh here.
const CANCELLED: f64 = 1e-12;

/// A weighted sum of unit normals, kept in f64 so that the result does not depend on the order of
/// the faces in any digit that f32 shows.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct NormalSum {
    sum: DVec3,
    weight: f64,
}

impl NormalSum {
    pub(super) fn add(&mut self, unit_normal: DVec3, weight: f64) {
        self.sum += unit_normal * weight;
        self.weight += weight;
    }

    /// Returns the unit mean, or [`FALLBACK_NORMAL`] if nothing was added or everything cancelled.
    pub(super) fn normal(self) -> Vec3 {
        let length = self.sum.length();
        if length > CANCELLED * self.weight { (self.sum / length).as_vec3() } else { FALLBACK_NORMAL }
    }
}

/// Returns a normal for each of `positions`, averaged over the triangles that touch it.
///
/// Vertices at exactly equal positions (0 and -0 are equal) share one normal, whichever index a
/// triangle uses. A triangle without area, with a non-finite corner or with an index past the end
/// of `positions` contributes nothing. A vertex without any contribution gets [`FALLBACK_NORMAL`].
/// Every result has unit length.
#[must_use]
pub fn shared_normals(positions: &[Vec3], indices: &[u32], averaging: Averaging) -> Vec<Vec3> {
    let (welded, count) = weld(positions);
    let mut sums = vec![NormalSum::default(); count];
    for triangle in indices.chunks_exact(3) {
        let vertices = [0, 1, 2].map(|k| triangle[k] as usize);
        if vertices.iter().any(|&vertex| vertex >= positions.len()) {
            continue;
        }
        let corners = vertices.map(|vertex| positions[vertex].as_dvec3());
        let Some((normal, area)) = plane_of(corners) else {
            continue;
        };
        for k in 0..3 {
            let weight = match averaging {
                Averaging::Plain => 1.0,
                Averaging::Angle => interior_angle(corners[(k + 2) % 3], corners[k], corners[(k + 1) % 3]),
                Averaging::Area => area,
            };
            sums[welded[vertices[k]]].add(normal, weight);
        }
    }
    welded.into_iter().map(|vertex| sums[vertex].normal()).collect()
}

/// Returns, for each position, the number of its first exact equal, and how many different ones
/// there are.
#[must_use]
pub fn weld(positions: &[Vec3]) -> (Vec<usize>, usize) {
    let mut seen = HashMap::with_capacity(positions.len());
    let welded = positions
        .iter()
        .map(|position| {
            // Adding zero turns -0 into 0 and nothing else, so that equal bits mean equal values.
            let key = position.to_array().map(|x| (x + 0.0).to_bits());
            let next = seen.len();
            *seen.entry(key).or_insert(next)
        })
        .collect();
    (welded, seen.len())
}

/// Returns the unit normal and the area of a triangle, or `None` if it has no area.
fn plane_of([a, b, c]: [DVec3; 3]) -> Option<(DVec3, f64)> {
    let (u, v) = (b - a, c - a);
    let cross = u.cross(v);
    let length = cross.length();
    // Differences of f32 are exact to 1e-16 in f64, so a sine below 1e-12 has no direction left.
    let proper = length > 1e-12 * u.length() * v.length() && length.is_finite();
    proper.then(|| (cross / length, 0.5 * length))
}

/// Returns the angle at `vertex` between its two neighbours, in radians, 0 to π. The arctangent
/// keeps it exact near 0 and π, where an arccosine loses half its digits.
pub(super) fn interior_angle(previous: DVec3, vertex: DVec3, next: DVec3) -> f64 {
    let (u, v) = (previous - vertex, next - vertex);
    u.cross(v).length().atan2(u.dot(v))
}

/// Transform of normals for points transformed by a matrix: its inverse transpose. The cofactor
/// matrix is the same up to the magnitude of the determinant, and also exists if the matrix is
/// singular.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cofactors {
    matrix: DMat3,
    is_identity: bool,
}

impl Cofactors {
    pub(super) fn of(linear: DMat3) -> Self {
        let [x, y, z] = [linear.x_axis, linear.y_axis, linear.z_axis];
        let sign = if linear.determinant() < 0.0 { -1.0 } else { 1.0 };
        Self {
            matrix: DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y)) * sign,
            is_identity: linear == DMat3::IDENTITY,
        }
    }

    /// Returns the unit normal, or `None` if it has no direction.
    pub(super) fn apply(self, normal: Vec3) -> Option<Vec3> {
        // A normal that f32 cannot bring closer to unit length is kept to the last bit.
        if self.is_identity && (normal.length_squared() - 1.0).abs() < 4.0 * f32::EPSILON {
            return Some(normal);
        }
        let moved: DVec3 = self.matrix * normal.as_dvec3();
        let unit = moved.try_normalize()?.as_vec3();
        unit.is_finite().then_some(unit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A unit cube as twelve triangles, each face cut along the diagonal from its first corner.
    pub(super) fn cube() -> (Vec<Vec3>, Vec<u32>) {
        let positions =
            (0..8u8).map(|k| Vec3::new(f32::from(k & 1), f32::from(k >> 1 & 1), f32::from(k >> 2))).collect();
        let faces: [[u32; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let indices = faces.iter().flat_map(|&[a, b, c, d]| [a, b, c, a, c, d]).collect();
        (positions, indices)
    }

    #[test]
    fn angle_weights_do_not_see_the_diagonals_of_a_cube() {
        let (positions, indices) = cube();
        let centre = Vec3::splat(0.5);
        let by_angle = shared_normals(&positions, &indices, Averaging::Angle);
        for (position, normal) in positions.iter().zip(&by_angle) {
            assert!(normal.distance((position - centre).normalize()) < 1e-6);
        }
        let plain = shared_normals(&positions, &indices, Averaging::Plain);
        assert!(
            positions
                .iter()
                .zip(&plain)
                .any(|(position, normal)| normal.distance((position - centre).normalize()) > 0.1),
            "counting triangles plainly must show the diagonals, or this test proves nothing"
        );
    }

    #[test]
    fn coincident_vertices_share_one_normal() {
        let (positions, indices) = cube();
        let soup: Vec<Vec3> = indices.iter().map(|&k| positions[k as usize]).collect();
        let order: Vec<u32> = (0..soup.len() as u32).collect();
        let welded = shared_normals(&positions, &indices, Averaging::Angle);
        let split = shared_normals(&soup, &order, Averaging::Angle);
        for (corner, &index) in split.iter().zip(&indices) {
            assert_eq!(*corner, welded[index as usize]);
        }
    }

    #[test]
    fn signs_of_zero_are_one_position() {
        let positions = [Vec3::ZERO, Vec3::X, Vec3::Y, -Vec3::ZERO, Vec3::Y, Vec3::Z];
        let normals = shared_normals(&positions, &[0, 1, 2, 3, 4, 5], Averaging::Plain);
        assert_eq!(normals[0], normals[3]);
    }

    #[test]
    fn degenerate_triangles_say_nothing() {
        let positions = [Vec3::ZERO, Vec3::X, Vec3::Z, Vec3::splat(9.0), Vec3::NAN];
        let indices = [0, 1, 2, 0, 1, 1, 0, 0, 0, 3, 3, 3, 0, 1, 4, 0, 1, 99];
        let normals = shared_normals(&positions, &indices, Averaging::Area);
        assert_eq!(normals[0], -Vec3::Y);
        assert_eq!(normals[3], FALLBACK_NORMAL);
        assert!(normals.iter().all(|normal| normal.is_normalized()));
    }

    #[test]
    fn a_two_sided_sheet_falls_back() {
        let positions = [Vec3::ZERO, Vec3::X, Vec3::Z];
        let normals = shared_normals(&positions, &[0, 1, 2, 0, 2, 1], Averaging::Angle);
        assert_eq!(normals, [FALLBACK_NORMAL; 3]);
    }

    #[test]
    fn area_weights_favour_the_larger_face() {
        let positions = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z * 3.0];
        let indices = [0, 2, 1, 0, 1, 3];
        let normal = shared_normals(&positions, &indices, Averaging::Area)[0];
        assert!(normal.distance(Vec3::new(0.0, -3.0, -1.0).normalize()) < 1e-6);
    }
}
