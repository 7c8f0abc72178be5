//! From planes to corners and face loops.

use glam::{DMat3, DVec3};

use super::{Plane, PolyhedronError};

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

/// Returns the corners of the solid: points where three planes meet on the inner side of all
/// others. If several triples give the same corner, the one that spans the largest volume, which is
/// the most exact, is kept.
pub(super) fn corners(planes: &[Plane], tolerance: f64) -> Vec<DVec3> {
    let mut found: Vec<(DVec3, f64)> = Vec::new();
    for (i, a) in planes.iter().enumerate() {
        for (j, b) in planes.iter().enumerate().skip(i + 1) {
            for c in &planes[j + 1..] {
                let rows = DMat3::from_cols(a.normal, b.normal, c.normal).transpose();
                let volume = rows.determinant().abs();
                if volume < PARALLEL {
                    continue;
                }
                let point = rows.inverse() * DVec3::new(a.distance, b.distance, c.distance);
                if planes.iter().any(|plane| plane.height(point) > tolerance) {
                    continue;
                }
                let same = |(other, _): &&mut (DVec3, f64)| other.distance(point) <= 4.0 * tolerance;
                match found.iter_mut().find(same) {
                    Some(best) if best.1 < volume => *best = (point, volume),
                    Some(_) => {}
                    None => found.push((point, volume)),
                }
            }
        }
    }
    found.into_iter().map(|(point, _)| point).collect()
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
