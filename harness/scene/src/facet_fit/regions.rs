//! Triangles of a hull grouped into facets: those whose corners lie within a tolerance of one plane.

use std::collections::{HashMap, HashSet, VecDeque};

use glam::DVec3;

use super::plane::{fitted, reach, width};
use crate::polyhedron::Plane;

/// A facet: its plane and the points that it was fitted to.
#[derive(Debug, Clone)]
pub(super) struct Region {
    pub(super) plane: Plane,
    /// Numbers of the hull's corners in it.
    pub(super) corners: Vec<usize>,
    pub(super) area: f64,
}

/// A hull's triangles, as they are grouped again and again.
pub(super) struct Triangles<'a> {
    points: &'a [DVec3],
    corners: &'a [[usize; 3]],
    /// Normal times twice the area.
    normals: Vec<DVec3>,
    /// Triangles across each side.
    neighbours: Vec<[usize; 3]>,
    /// By area, the largest first: their planes are the most exact.
    order: Vec<usize>,
}

impl<'a> Triangles<'a> {
    pub(super) fn new(points: &'a [DVec3], corners: &'a [[usize; 3]]) -> Self {
        let normal = |&[a, b, c]: &[usize; 3]| (points[b] - points[a]).cross(points[c] - points[a]);
        let normals: Vec<DVec3> = corners.iter().map(normal).collect();
        let mut order: Vec<usize> = (0..corners.len()).collect();
        order.sort_by(|&a, &b| normals[b].length_squared().total_cmp(&normals[a].length_squared()));
        let sides = |[a, b, c]: [usize; 3]| [[a, b], [b, c], [c, a]];
        let left: HashMap<[usize; 2], usize> =
            corners.iter().enumerate().flat_map(|(k, corners)| sides(*corners).map(|side| (side, k))).collect();
        let across = |[from, to]: [usize; 2]| left.get(&[to, from]).copied().unwrap_or(0);
        let neighbours = corners.iter().map(|corners| sides(*corners).map(across)).collect();
        Self { points, corners, normals, neighbours, order }
    }

    /// Returns the facets, each grown from the largest triangle that no other holds yet, over the neighbours with which all its
    /// corners stay within `tolerance` of the plane fitted to them. Those not wider than twice the tolerance are left out: their
    /// planes are those of rounding. `None` if there are more than `most`.
    pub(super) fn grouped(&self, tolerance: f64, most: usize) -> Option<Vec<Region>> {
        let mut taken = vec![false; self.corners.len()];
        let mut regions = Vec::new();
        for &seed in &self.order {
            if taken[seed] {
                continue;
            }
            let (region, members) = self.grown(seed, tolerance, &taken);
            members.iter().for_each(|&member| taken[member] = true);
            let Some(region) = region else { continue };
            if regions.len() == most {
                return None;
            }
            regions.push(region);
        }
        Some(regions)
    }

    fn grown(&self, seed: usize, tolerance: f64, taken: &[bool]) -> (Option<Region>, Vec<usize>) {
        let mut members = HashSet::from([seed]);
        let mut corners: Vec<usize> = self.corners[seed].to_vec();
        let mut points: Vec<DVec3> = corners.iter().map(|&corner| self.points[corner]).collect();
        let mut area = self.normals[seed];
        let Some(mut plane) = fitted(&points, area) else { return (None, vec![seed]) };
        let mut waiting = VecDeque::from(self.neighbours[seed]);
        while let Some(next) = waiting.pop_front() {
            if taken[next] || members.contains(&next) {
                continue;
            }
            let new: Vec<usize> =
                self.corners[next].iter().copied().filter(|corner| !corners.contains(corner)).collect();
            // A first look saves most of the fits.
            let far = |corner: &usize| plane.height(self.points[*corner]).abs() > 4.0 * tolerance;
            if new.iter().any(far) {
                continue;
            }
            let count = points.len();
            points.extend(new.iter().map(|&corner| self.points[corner]));
            if !new.is_empty() {
                match fitted(&points, area + self.normals[next]).filter(|plane| reach(&points, plane) <= tolerance) {
                    Some(fit) => plane = fit,
                    None => {
                        points.truncate(count);
                        continue;
                    }
                }
            }
            corners.extend(new);
            area += self.normals[next];
            members.insert(next);
            waiting.extend(self.neighbours[next]);
        }
        let is_wide = width(&points, plane.normal) > 2.0 * tolerance;
        (is_wide.then_some(Region { plane, corners, area: 0.5 * area.length() }), members.into_iter().collect())
    }
}
