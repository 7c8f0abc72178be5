//! Turns and mirrors that take a solid's facets to one another, and planes averaged over them.

use std::f64::consts::TAU;

use glam::{DMat2, DMat3, DQuat, DVec2, DVec3};

use crate::polyhedron::Plane;

/// Largest number of turns about an axis that is looked for.
const MOST_FOLD: u32 = 32;
/// Number of facets, the largest first, whose normals are tried as the axis.
const AXES: usize = 6;

/// A facet as symmetries see it.
#[derive(Debug, Clone)]
pub(super) struct Facet {
    pub(super) plane: Plane,
    /// Points that the plane was fitted to.
    pub(super) points: Vec<DVec3>,
    pub(super) area: f64,
}

impl Facet {
    fn moved(&self, by: DVec3) -> Self {
        let Plane { normal, distance } = self.plane;
        let plane = Plane { normal, distance: distance + normal.dot(by) };
        Self { plane, points: self.points.iter().map(|point| *point + by).collect(), area: self.area }
    }
}

/// The symmetry of a solid about an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Symmetry {
    /// Number of turns about it, the whole one included.
    pub fold: u32,
    /// Whether as many mirrors hold it.
    pub has_mirrors: bool,
}

impl Symmetry {
    /// Returns the number of maps that take the solid to itself.
    #[must_use]
    pub fn order(self) -> u32 {
        self.fold * if self.has_mirrors { 2 } else { 1 }
    }
}

/// A map about the origin, and the facet to which it takes each facet.
struct Map {
    matrix: DMat3,
    to: Vec<usize>,
}

impl Map {
    /// Matches each facet with the one whose plane its turned points lie nearest; `None` if they are farther than `tolerance`, or two
    /// facets are taken to one.
    fn of(matrix: DMat3, facets: &[Facet], tolerance: f64) -> Option<Self> {
        let mut taken = vec![false; facets.len()];
        let mut to = Vec::with_capacity(facets.len());
        for facet in facets {
            let normal = matrix * facet.plane.normal;
            let off = |other: &Facet| {
                let heights = facet.points.iter().map(|point| other.plane.height(matrix * *point).abs());
                heights.fold(0.0, f64::max)
            };
            let near = facets.iter().enumerate().filter(|(_, other)| other.plane.normal.dot(normal) > 0.9);
            let (best, off) = near.map(|(k, other)| (k, off(other))).min_by(|a, b| a.1.total_cmp(&b.1))?;
            if off > tolerance || std::mem::replace(&mut taken[best], true) {
                return None;
            }
            to.push(best);
        }
        Some(Self { matrix, to })
    }
}

/// Returns the facets' planes averaged over a symmetry of the solid, which lies about the origin, and the symmetry: that of the most
/// maps that take each facet's points to within `tolerance` of another facet. `None` if there is none.
pub(super) fn averaged(facets: &[Facet], tolerance: f64) -> Option<(Vec<Plane>, Symmetry)> {
    let (axis, fold) = rough_axis(facets, tolerance)?;
    let axis = refined_axis(axis, fold, facets, tolerance)?;
    let centre = centre(axis, facets);
    let facets: Vec<Facet> = facets.iter().map(|facet| facet.moved(-centre)).collect();
    let turns = turns(axis, fold, &facets, tolerance)?;
    let mirror = mirror(axis, &facets, tolerance);
    let mirrors: Option<Vec<Map>> = mirror.map_or(Some(Vec::new()), |mirror| {
        turns.iter().map(|turn| Map::of(turn.matrix * mirror, &facets, tolerance)).collect()
    });
    let maps: Vec<Map> = turns.into_iter().chain(mirrors?).collect();
    if maps.len() == 1 {
        return None;
    }
    let mean = |facet: usize| {
        let (mut normal, mut distance) = (DVec3::ZERO, 0.0);
        for map in &maps {
            let plane = &facets[map.to[facet]].plane;
            normal += map.matrix.transpose() * plane.normal;
            distance += plane.distance / maps.len() as f64;
        }
        let normal = normal.normalize();
        Plane { normal, distance: distance + normal.dot(centre) }
    };
    let planes = (0..facets.len()).map(mean).collect();
    Some((planes, Symmetry { fold, has_mirrors: mirror.is_some() }))
}

fn turn(axis: DVec3, step: u32, fold: u32) -> DMat3 {
    DMat3::from_quat(DQuat::from_axis_angle(axis, TAU * f64::from(step) / f64::from(fold)))
}

fn turns(axis: DVec3, fold: u32, facets: &[Facet], tolerance: f64) -> Option<Vec<Map>> {
    (0..fold).map(|step| Map::of(turn(axis, step, fold), facets, tolerance)).collect()
}

/// Returns the axis of most turns among the normals of large facets, and their number; of a solid that has none but mirrors, 1.
fn rough_axis(facets: &[Facet], tolerance: f64) -> Option<(DVec3, u32)> {
    let mut by_area: Vec<&Facet> = facets.iter().collect();
    by_area.sort_by(|a, b| b.area.total_cmp(&a.area));
    let axes = || by_area.iter().take(AXES).map(|facet| facet.plane.normal);
    let turned = (2..=MOST_FOLD).rev().find_map(|fold| {
        let found = axes().find(|axis| Map::of(turn(*axis, 1, fold), facets, tolerance).is_some());
        found.map(|axis| (axis, fold))
    });
    turned.or_else(|| axes().find(|axis| mirror(*axis, facets, tolerance).is_some()).map(|axis| (axis, 1)))
}

/// Returns the axis that the normals of all facets give: their mean over the turns lies along it.
fn refined_axis(axis: DVec3, fold: u32, facets: &[Facet], tolerance: f64) -> Option<DVec3> {
    if fold == 1 {
        return Some(axis);
    }
    let maps = turns(axis, fold, facets, tolerance)?;
    let mut sum = DVec3::ZERO;
    for (number, facet) in facets.iter().enumerate() {
        let mean = maps.iter().map(|map| facets[map.to[number]].plane.normal).sum::<DVec3>() / f64::from(fold);
        sum += facet.area * mean.dot(axis) * mean;
    }
    sum.try_normalize()
}

/// Returns the point nearest the origin through which the axis goes: about it, the distances of facets that are alike are equal.
fn centre(axis: DVec3, facets: &[Facet]) -> DVec3 {
    let [right, up] = [axis.any_orthonormal_vector(), axis.cross(axis.any_orthonormal_vector())];
    let (mut square, mut moment) = (DMat2::ZERO, DVec2::ZERO);
    for Facet { plane, area, .. } in facets {
        let across = DVec2::new(plane.normal.dot(right), plane.normal.dot(up));
        square += *area * DMat2::from_cols(across.x * across, across.y * across);
        moment += *area * plane.distance * across;
    }
    let place = square.inverse() * moment;
    if place.is_finite() { place.x * right + place.y * up } else { DVec3::ZERO }
}

/// Returns a mirror that holds the axis, at the angle that all pairs of facets give together.
fn mirror(axis: DVec3, facets: &[Facet], tolerance: f64) -> Option<DMat3> {
    let [right, up] = [axis.any_orthonormal_vector(), axis.cross(axis.any_orthonormal_vector())];
    let angle = |normal: DVec3| normal.dot(up).atan2(normal.dot(right));
    // The mirror's own direction, across the axis.
    let reflection = |angle: f64| {
        let (sine, cosine) = angle.sin_cos();
        let normal = axis.cross(cosine * right + sine * up);
        DMat3::IDENTITY - 2.0 * DMat3::from_cols(normal * normal.x, normal * normal.y, normal * normal.z)
    };
    // A facet is its own image, or is taken to another one.
    let steep = |facet: &&Facet| facet.plane.normal.cross(axis).length() > 0.1;
    let first = facets.iter().find(steep)?;
    let candidates =
        facets.iter().filter(steep).map(|other| 0.5 * (angle(first.plane.normal) + angle(other.plane.normal)));
    let (start, map) = candidates
        .flat_map(|start| [start, start + 0.25 * TAU])
        .find_map(|start| Some((start, Map::of(reflection(start), facets, tolerance)?)))?;
    let (mut sum, mut weight) = (0.0, 0.0);
    for (number, facet) in facets.iter().enumerate().filter(|(_, facet)| steep(facet)) {
        let other = &facets[map.to[number]];
        let both = angle(facet.plane.normal) + angle(other.plane.normal) - 2.0 * start;
        let share = facet.area * facet.plane.normal.cross(axis).length_squared();
        sum += share * 0.5 * (both - TAU * (both / TAU).round());
        weight += share;
    }
    Some(reflection(start + sum / weight))
}
