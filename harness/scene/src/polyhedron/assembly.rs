//! From planes to corners and face loops.

use glam::{DMat3, DVec3, DVec4};
use lapidary_convex_walk::facet_corners;

use super::error::PolyhedronError;
use super::plane::Plane;

/// Distance, relative to the largest plane distance, below which two corners count as one. Solving
/// three planes in f64 loses at most 1e-16/[`PARALLEL`]; the facets of real cuts are larger than
/// 1e-3.
const MERGE: f64 = 1e-8;

/// Triples whose unit normals span less volume than this do not define a corner. Adjoining facets
/// of a stone span more, and a corner skipped here is always defined by a better triple.
const PARALLEL: f64 = 1e-7;

/// Returns the largest distance between two computed corners of a solid with these planes that
/// still count as one.
pub(super) fn tolerance(planes: &[Plane]) -> f64 {
    let largest = |so_far: f64, plane: &Plane| so_far.max(plane.distance.abs());
    MERGE * planes.iter().fold(0.0, largest)
}

/// Returns the planes with unit normals.
pub(super) fn unit_planes(planes: &[Plane]) -> Result<Vec<Plane>, PolyhedronError> {
    let unit = planes.iter().enumerate().map(|(index, plane)| {
        let length = plane.normal.length();
        let unit = Plane { normal: plane.normal / length, distance: plane.distance / length };
        let proper = length > 0.0 && unit.normal.is_finite() && unit.distance.is_finite();
        proper.then_some(unit).ok_or(PolyhedronError::BadPlane { plane: index })
    });
    unit.collect()
}

/// Returns the planes without repeats, each at its first position.
pub(super) fn without_repeats(planes: Vec<Plane>, tolerance: f64) -> Vec<Plane> {
    let mut kept: Vec<Plane> = Vec::with_capacity(planes.len());
    for plane in planes {
        let repeated = |other: &Plane| {
            other.normal.distance(plane.normal) <= MERGE && (other.distance - plane.distance).abs() <= tolerance
        };
        if !kept.iter().any(repeated) {
            kept.push(plane);
        }
    }
    kept
}

/// Largest number of planes through one corner of which all triples are tried. Of the many facets
/// around an apex, an even selection spans nearly as large a volume.
const MOST_AT_A_CORNER: usize = 64;

/// Returns the corners of the solid: points where three planes meet on the inner side of all
/// others. If several triples give the same corner, the one that spans the largest volume, which is
/// the most exact, is kept. The order is that of each corner's first triple.
pub(super) fn corners(planes: &[Plane], tolerance: f64) -> Vec<DVec3> {
    let bounds: Vec<DVec4> = planes.iter().map(|plane| plane.normal.extend(plane.distance)).collect();
    // Where about the corners are: those of each face, cut out of its plane by all the others.
    let mut places: Vec<DVec3> = Vec::new();
    for place in (0..planes.len()).flat_map(|face| facet_corners(&bounds, face)) {
        if !places.iter().any(|other| other.distance(place) <= 4.0 * tolerance) {
            places.push(place);
        }
    }
    let mut found: Vec<Corner> = Vec::new();
    for place in places {
        for corner in corners_at(planes, place, tolerance) {
            // Places a little more than the tolerance apart may lead to one corner.
            match found.iter_mut().find(|other| other.point.distance(corner.point) <= 4.0 * tolerance) {
                Some(best) => best.merge(&corner),
                None => found.push(corner),
            }
        }
    }
    found.sort_by_key(|corner| corner.first);
    found.into_iter().map(|corner| corner.point).collect()
}

/// A corner, with the volume that the normals of its triple span and its first triple.
struct Corner {
    point: DVec3,
    volume: f64,
    first: [usize; 3],
}

impl Corner {
    /// Takes the point of the larger volume, and the earlier first triple.
    fn merge(&mut self, other: &Self) {
        if self.volume < other.volume {
            (self.point, self.volume) = (other.point, other.volume);
        }
        self.first = self.first.min(other.first);
    }
}

/// Returns the corners near a place, of all triples of the planes that pass by it.
fn corners_at(planes: &[Plane], place: DVec3, tolerance: f64) -> Vec<Corner> {
    let near: Vec<usize> = (0..planes.len()).filter(|&k| planes[k].height(place).abs() <= 64.0 * tolerance).collect();
    let stride = near.len().div_ceil(MOST_AT_A_CORNER).max(1);
    let tried: Vec<usize> = near.iter().copied().step_by(stride).collect();
    let mut found: Vec<Corner> = Vec::new();
    for (first, &i) in tried.iter().enumerate() {
        for (second, &j) in tried.iter().enumerate().skip(first + 1) {
            for &k in &tried[second + 1..] {
                let [a, b, c] = [i, j, k].map(|index| &planes[index]);
                let rows = DMat3::from_cols(a.normal, b.normal, c.normal).transpose();
                let volume = rows.determinant().abs();
                if volume < PARALLEL {
                    continue;
                }
                let point = rows.inverse() * DVec3::new(a.distance, b.distance, c.distance);
                // Further off, planes that do not pass by this place may cut the point off.
                let is_here = point.distance(place) <= 16.0 * tolerance;
                if !is_here || near.iter().any(|&other| planes[other].height(point) > tolerance) {
                    continue;
                }
                let corner = Corner { point, volume, first: [i, j, k] };
                match found.iter_mut().find(|other| other.point.distance(point) <= 4.0 * tolerance) {
                    Some(best) => best.merge(&corner),
                    None => found.push(corner),
                }
            }
        }
    }
    found
}

/// Returns `touched` in counter-clockwise order about `normal`, starting from the highest corner.
/// Among several equally high corners, the first in that order starts; on a level face, the one
/// with the smallest angle.
pub(super) fn ordered_loop(normal: DVec3, mut touched: Vec<usize>, corners: &[DVec3], tolerance: f64) -> Vec<usize> {
    let centre = touched.iter().map(|&k| corners[k]).sum::<DVec3>() / touched.len() as f64;
    // A fixed frame for level faces, so that they too start alike on every machine.
    let across = if normal.x.abs() < 0.9 { DVec3::X } else { DVec3::Y };
    let right = (across - normal * normal.dot(across)).normalize_or_zero();
    let ahead = normal.cross(right);
    let angle = |k: usize| {
        let offset = corners[k] - centre;
        offset.dot(ahead).atan2(offset.dot(right))
    };
    touched.sort_by(|&a, &b| angle(a).total_cmp(&angle(b)));
    let top = touched.iter().fold(f64::NEG_INFINITY, |z, &k| z.max(corners[k].z));
    let is_top = |k: usize| corners[k].z >= top - tolerance;
    let start = (0..touched.len()).find(|&k| {
        let before = touched[(k + touched.len() - 1) % touched.len()];
        is_top(touched[k]) && !is_top(before)
    });
    touched.rotate_left(start.unwrap_or(0));
    touched
}
