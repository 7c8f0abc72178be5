//! Which shells lie within which.

use std::f64::consts::PI;

use glam::DVec3;

use super::components::Component;
use super::surface::Surface;

/// Comparisons of boxes, and products of points and triangles, up to which the question is answered.
const MOST_BOXES: usize = 1 << 27;
const MOST_PRODUCTS: usize = 1 << 28;
/// Number of points of a component of which it is asked whether they lie in another.
const POINTS: usize = 16;
/// How far from a triangle's corners towards its middle a point is looked at, as a share of the way: a corner may lie on the
/// other surface.
const INWARD: f64 = 1e-2;

/// Returns for each component the outermost closed one around it; `None` if there is none. The error is that they are too
/// many to tell.
pub(super) fn outermost(surface: &Surface, components: &[Component]) -> Result<Vec<Option<usize>>, TooMany> {
    let mut order: Vec<usize> = (0..components.len()).collect();
    order.sort_by(|&one, &other| components[one].min.x.total_cmp(&components[other].min.x));
    let mut around: Vec<Option<usize>> = vec![None; components.len()];
    let mut left = Left { boxes: MOST_BOXES, products: MOST_PRODUCTS };
    // Closed ones that reach to the present x.
    let mut open: Vec<usize> = Vec::new();
    for group in order.chunk_by(|&one, &other| components[one].min.x == components[other].min.x) {
        open.retain(|&outer| components[outer].max.x >= components[group[0]].min.x);
        open.extend(group.iter().copied().filter(|&number| components[number].is_closed));
        for &inner in group {
            left.boxes = left.boxes.checked_sub(open.len()).ok_or(TooMany)?;
            let size = |number: usize| components[number].volume.abs();
            let candidates = open.iter().copied().filter(|&outer| {
                let (inner_box, outer_box) = (&components[inner], &components[outer]);
                let fits = outer_box.min.cmple(inner_box.min).all() && outer_box.max.cmpge(inner_box.max).all();
                fits && outer != inner && (!inner_box.is_closed || size(outer) > size(inner))
            });
            let mut candidates: Vec<usize> = candidates.collect();
            candidates.sort_by(|&one, &other| size(other).total_cmp(&size(one)).then(one.cmp(&other)));
            for outer in candidates {
                if left.encloses(surface, &components[outer], &components[inner])? {
                    around[inner] = Some(outer);
                    break;
                }
            }
        }
    }
    Ok(around)
}

/// Too many components, or too large ones, to look which lie within which.
#[derive(Debug)]
pub(super) struct TooMany;

struct Left {
    boxes: usize,
    products: usize,
}

impl Left {
    /// Whether all of a component that is looked at lies within a closed one.
    fn encloses(&mut self, surface: &Surface, outer: &Component, inner: &Component) -> Result<bool, TooMany> {
        let step = inner.faces.len().div_ceil(POINTS).max(1);
        for &face in inner.faces.iter().step_by(step) {
            let corners = surface.corners(face);
            let middle = corners.iter().sum::<DVec3>() / 3.0;
            for point in corners.map(|corner| corner.lerp(middle, INWARD)).into_iter().chain([middle]) {
                self.products = self.products.checked_sub(outer.faces.len()).ok_or(TooMany)?;
                if !goes_around(surface, &outer.faces, point) {
                    return Ok(false);
                }
            }
        }
        Ok(true)
    }
}

/// Whether triangles go around a point, by the solid angle under which they are seen from there (Van Oosterom and Strackee,
/// 1983).
pub(super) fn goes_around(surface: &Surface, faces: &[u32], point: DVec3) -> bool {
    let half_angle = |&face: &u32| {
        let [a, b, c] = surface.corners(face).map(|corner| corner - point);
        let [x, y, z] = [a, b, c].map(DVec3::length);
        a.dot(b.cross(c)).atan2(x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y)
    };
    faces.iter().map(half_angle).sum::<f64>().abs() > PI
}
