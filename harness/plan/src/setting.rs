//! Whether a body that shares space with a cut stone only holds it, or stands beside it.

use crate::remembered::Remembered;
use crate::shape;
use glam::DVec3;
use lapidary_scene::convex::planes_of_convex;
use lapidary_scene::polyhedron::Plane;
use lapidary_scene::{Bounds, Mesh, Object, Place};

/// Depth, as a share of a stone's radius, up to which the prongs and the seat of a setting are modelled into it.
const DEEPEST: f64 = 0.25;
/// The same up to which a body only touches a stone: a hundredth of what a picture of 512 pixels shows.
const TOUCHES: f64 = 2e-5;

/// Whether `other` is opaque or a cut stone, and reaches into a convex stone, or any of its copies, no deeper than a setting does:
/// light inside that would meet it there meets it where it leaves the stone. If rays inside meet opaque bodies, `met`, these may
/// reach as deep as they do.
pub(crate) fn holds(other: &Object, stone: &Object, met: bool) -> bool {
    static FOUND: Remembered<bool> = Remembered::new();
    let material = &other.material;
    let is_opaque = !material.is_clear() && !material.scatters();
    if is_opaque && met {
        return shape::is_convex(stone);
    }
    let is_cut = material.has_clear_inside() && shape::is_convex(other) && !shape::is_smooth(other);
    (is_cut || is_opaque) && FOUND.of_both(&stone.mesh, &other.mesh, |_, other| stays_out(stone, other, DEEPEST))
}

/// Whether `other` is not clear, and a part of it lies within a convex stone or one of its copies.
pub(crate) fn enters(other: &Object, stone: &Object) -> bool {
    static FOUND: Remembered<bool> = Remembered::new();
    !other.material.is_clear() && FOUND.of_both(&stone.mesh, &other.mesh, |_, other| !stays_out(stone, other, TOUCHES))
}

/// Whether no triangle of `other` meets the inside of a stone or of its copies, deeper than a share of their radius.
fn stays_out(stone: &Object, other: &Mesh, deepest: f64) -> bool {
    let Some(planes) = planes_of_convex(stone.shape()) else { return false };
    let Bounds { min, max } = Bounds::of(stone.shape().positions.iter().copied());
    let places = stone.copies.as_ref().map_or(&[Place::IDENTITY][..], |copies| &copies.places);
    let (middle, radius) = (0.5 * (min + max).as_dvec3(), 0.5 * f64::from((max - min).length()));
    places.iter().all(|place| {
        let to_world = place.transform();
        let scale = f64::from(place.scale);
        let (middle, radius) = (to_world.transform_point3(middle), scale * radius);
        let inner = |plane: &Plane| {
            let normal = to_world.transform_vector3(plane.normal) / scale;
            let distance = scale * plane.distance + normal.dot(to_world.w_axis.truncate());
            Plane { normal, distance: distance - deepest * radius }
        };
        let inner: Vec<Plane> = planes.iter().map(inner).collect();
        let (least, most) = (middle - radius, middle + radius);
        let is_near =
            |[a, b, c]: &[DVec3; 3]| a.max(*b).max(*c).cmpge(least).all() && a.min(*b).min(*c).cmple(most).all();
        let triangles = other.triangles().map(|corners| corners.map(|corner| corner.as_dvec3()));
        !triangles.filter(is_near).any(|triangle| is_cut_by(triangle.to_vec(), &inner))
    })
}

/// Whether anything of a flat, convex ring of corners lies below all planes.
fn is_cut_by(mut ring: Vec<DVec3>, planes: &[Plane]) -> bool {
    // Most triangles lie above one plane.
    if planes.iter().any(|plane| ring.iter().all(|corner| plane.height(*corner) >= 0.0)) {
        return false;
    }
    for plane in planes {
        let mut left = Vec::with_capacity(ring.len() + 1);
        for (number, corner) in ring.iter().enumerate() {
            let next = ring[(number + 1) % ring.len()];
            let [from, to] = [plane.height(*corner), plane.height(next)];
            if from < 0.0 {
                left.push(*corner);
            }
            if (from < 0.0) != (to < 0.0) {
                left.push(corner.lerp(next, from / (from - to)));
            }
        }
        if left.is_empty() {
            return false;
        }
        ring = left;
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DQuat, Vec3};
    use lapidary_scene::surfaces::rounded_box;
    use lapidary_scene::{Material, Scene};

    fn bar(half: [f64; 3], at: [f64; 3]) -> Object {
        let mesh = rounded_box(DVec3::from_array(half), 0.01, 2).placed(DQuat::IDENTITY, DVec3::from_array(at));
        Object::new("bar", mesh, Material::standard())
    }

    /// The brilliant is 2 wide.
    #[test]
    fn a_prong_holds_and_a_rod_through_does_not() {
        let stone = Scene::named("brilliant").unwrap().objects.remove(0);
        let girdle = stone.mesh.positions.iter().copied().max_by(|a, b| a.x.total_cmp(&b.x)).unwrap();
        let Vec3 { x, y, .. } = girdle;
        let [x, y] = [x, y].map(f64::from);
        assert!(holds(&bar([0.1, 0.5, 0.1], [x, y, 0.0]), &stone, false));
        assert!(holds(&bar([0.1, 0.5, 0.1], [3.0 * x, y, 0.0]), &stone, false));
        // All corners of the rod lie outside.
        for deep in [bar([5.0, 0.05, 0.05], [0.0, y - 0.2, 0.0]), bar([0.05; 3], [0.0, y - 0.2, 0.0])] {
            assert!(!holds(&deep, &stone, false) && holds(&deep, &stone, true));
            // A body that is clear, but not cut.
            let clear = Object { material: stone.material.clone(), ..deep };
            assert!(!holds(&clear, &stone, true));
        }
    }
}
