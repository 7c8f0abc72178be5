//! Connected components of a surface. Where more than two triangles meet at an edge, those are neighbours that bound the
//! same solid there, so that bodies which touch along an edge or at a face stay apart.

use std::f64::consts::TAU;

use glam::DVec3;

use super::surface::{HalfEdge, Surface};

/// Angles nearer than this count as one, in radians: of two walls that touch, cut into triangles differently.
const SAME_ANGLE: f64 = 1e-5;

/// A connected component.
#[derive(Debug, Clone)]
pub(super) struct Component {
    /// Its triangles, in the mesh's order.
    pub(super) faces: Vec<u32>,
    /// Whether each of its edges has as many triangles on one side as on the other.
    pub(super) is_closed: bool,
    /// Enclosed volume, positive if the triangles wind counter-clockwise seen from outside.
    pub(super) volume: f64,
    /// Box around it.
    pub(super) min: DVec3,
    pub(super) max: DVec3,
}

impl Component {
    /// Returns the component of these triangles.
    fn of(surface: &Surface, faces: Vec<u32>, is_closed: bool) -> Self {
        let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let mut volume = 0.0;
        // About a corner of its own, so that rounding counts little.
        let about = faces.first().map_or(DVec3::ZERO, |&face| surface.corners(face)[0]);
        let mut area = 0.0;
        for &face in &faces {
            let corners = surface.corners(face);
            volume += surface.across(face).dot(corners[0] - about) / 6.0;
            area += 0.5 * surface.across(face).length();
            corners.iter().for_each(|corner| (min, max) = (min.min(*corner), max.max(*corner)));
        }
        // What encloses no more than rounding moves its walls is a sheet with two sides.
        let is_closed = is_closed && volume.abs() > surface.tolerance * area;
        Self { faces, is_closed, volume, min, max }
    }
}

/// Sets of numbers that are joined step by step.
pub(super) struct Sets(Vec<u32>);

impl Sets {
    /// Returns as many sets of one number each.
    pub(super) fn new(count: usize) -> Self {
        Self((0..count as u32).collect())
    }

    pub(super) fn root(&mut self, mut number: u32) -> u32 {
        while self.0[number as usize] != number {
            let above = self.0[self.0[number as usize] as usize];
            self.0[number as usize] = above;
            number = above;
        }
        number
    }

    /// Joins two sets; the smaller number stands for both.
    pub(super) fn join(&mut self, one: u32, other: u32) {
        let (one, other) = (self.root(one), self.root(other));
        self.0[one.max(other) as usize] = one.min(other);
    }
}

/// Returns the components of a surface, in the order of their first triangles.
pub(super) fn of(surface: &Surface) -> Vec<Component> {
    let mut edges = surface.half_edges();
    let mut sets = Sets::new(surface.faces.len());
    for edge in edges.chunk_by(|one, other| one.ends() == other.ends()) {
        match edge {
            [_] => {}
            [one, other] => sets.join(one.face, other.face),
            many => pairs(surface, many).into_iter().for_each(|[one, other]| sets.join(one, other)),
        }
    }
    let roots: Vec<u32> = (0..surface.faces.len() as u32).map(|face| sets.root(face)).collect();
    edges.sort_by_key(|edge| (roots[edge.face as usize], edge.ends()));
    let mut is_open = vec![false; surface.faces.len()];
    let of_one = |edge: &HalfEdge| (roots[edge.face as usize], edge.ends());
    for edge in edges.chunk_by(|one, other| of_one(one) == of_one(other)) {
        is_open[roots[edge[0].face as usize] as usize] |= edge.iter().map(HalfEdge::sign).sum::<i32>() != 0;
    }
    let mut faces: Vec<u32> = (0..surface.faces.len() as u32).collect();
    faces.sort_by_key(|&face| (roots[face as usize], face));
    let components = faces.chunk_by(|&one, &other| roots[one as usize] == roots[other as usize]);
    components.map(|faces| Component::of(surface, faces.to_vec(), !is_open[faces[0] as usize])).collect()
}

/// Returns the pairs of triangles that bound the same solid at an edge of many; none if as many do not begin as end there.
fn pairs(surface: &Surface, edge: &[HalfEdge]) -> Vec<[u32; 2]> {
    if edge.iter().map(HalfEdge::sign).sum::<i32>() != 0 {
        return Vec::new();
    }
    let (from, to) = (surface.places[edge[0].low as usize], surface.places[edge[0].high as usize]);
    let along = (to - from).normalize_or_zero();
    let first = along.any_orthonormal_vector();
    let second = along.cross(first);
    let angle = |half: &HalfEdge| {
        let face = &surface.faces[half.face as usize];
        let third = face.places.into_iter().find(|place| *place != half.low && *place != half.high);
        let beyond = third.map_or(DVec3::ZERO, |place| surface.places[place as usize] - from);
        let angle = second.dot(beyond).atan2(first.dot(beyond)).rem_euclid(TAU);
        // A full turn is none.
        ((angle / SAME_ANGLE).round() as i64).rem_euclid((TAU / SAME_ANGLE).round() as i64)
    };
    // Seen along the edge and counter-clockwise around it, a triangle that runs forward ends a solid. At one angle one ends
    // before the next begins.
    let mut around: Vec<(i64, bool, u32)> = edge.iter().map(|half| (angle(half), !half.forward, half.face)).collect();
    around.sort_unstable();
    let mut begun: Vec<u32> = Vec::new();
    let mut found = Vec::new();
    // Twice around, since a solid may reach over the first angle.
    let mut is_done = vec![false; around.len()];
    for number in (0..around.len()).chain(0..around.len()) {
        let (_, begins, face) = around[number];
        if is_done[number] {
            continue;
        }
        if begins {
            is_done[number] = true;
            begun.push(face);
        } else if let Some(other) = begun.pop() {
            is_done[number] = true;
            found.push([face, other]);
        }
    }
    found
}
