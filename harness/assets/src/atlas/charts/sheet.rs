//! A chart while it grows.

use super::chart::Axis;
use super::surface::Surface;
use glam::{DVec2, DVec3};
use std::collections::HashMap;

/// A chart that takes no triangle that would overlap another.
#[derive(Debug)]
pub(super) struct Sheet {
    pub(super) axis: Axis,
    pub(super) triangles: Vec<u32>,
    drawn: Vec<[DVec2; 3]>,
    /// Indices into `drawn` of the triangles that touch each square.
    squares: HashMap<[i32; 2], Vec<u32>>,
}

impl Sheet {
    pub(super) fn new(toward_eye: DVec3) -> Self {
        Self { axis: Axis::new(toward_eye), triangles: Vec::new(), drawn: Vec::new(), squares: HashMap::new() }
    }

    /// Takes a triangle, unless it leans too far away or would overlap another.
    pub(super) fn take(&mut self, surface: &Surface, triangle: u32) -> bool {
        if !surface.faces(triangle, self.axis.toward_eye) {
            return false;
        }
        let corners = surface.corners[triangle as usize].map(|corner| self.axis.draw(corner));
        let [a, b, c] = corners.map(|corner| (corner / surface.square).floor().as_ivec2());
        let (lower, upper) = (a.min(b).min(c), a.max(b).max(c));
        let touched = || (lower.y..=upper.y).flat_map(move |y| (lower.x..=upper.x).map(move |x| [x, y]));
        let mut near = touched().filter_map(|square| self.squares.get(&square)).flatten();
        if near.any(|&other| overlap(&corners, &self.drawn[other as usize])) {
            return false;
        }
        for square in touched() {
            self.squares.entry(square).or_default().push(self.drawn.len() as u32);
        }
        self.triangles.push(triangle);
        self.drawn.push(corners);
        true
    }
}

/// Whether the interiors of two triangles have a point in common. Both are drawn clockwise with the
/// second axis down. A triangle that only touches an edge, up to f64 rounding, does not overlap.
fn overlap(a: &[DVec2; 3], b: &[DVec2; 3]) -> bool {
    let separates = |a: &[DVec2; 3], b: &[DVec2; 3]| {
        [(0, 1), (1, 2), (2, 0)].into_iter().any(|(k, l)| {
            let along = a[l] - a[k];
            b.iter().all(|&point| {
                let across = point - a[k];
                along.perp_dot(across) >= -1e-12 * along.length() * across.length()
            })
        })
    };
    !separates(a, b) && !separates(b, a)
}
