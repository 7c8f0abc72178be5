//! Bodies, and where rays enter and leave them, in f64.

use super::bvh::{Bvh, Extent};
use crate::scene::convex::planes_of_convex;
use crate::scene::polyhedron::{MAX_PLANES, Plane};
use crate::scene::{Mesh, Object};
use glam::DVec3;

/// How bodies are met.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Geometry {
    /// A convex body by its facets' planes, another by its triangles.
    Planes,
    /// Every body by its triangles.
    Triangles,
}

/// Where a ray meets a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Hit {
    /// In units of the direction, at least 0 up to rounding.
    pub(super) distance: f64,
    /// Unit normal, out of the body.
    pub(super) normal: DVec3,
    /// Where.
    pub(super) place: Place,
}

/// A facet or triangle of a body: a ray that sets out from it does not meet it again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Place {
    pub(super) body: usize,
    pub(super) face: usize,
}

/// All bodies of a scene. They are closed and do not overlap.
pub(super) struct Bodies {
    bodies: Vec<Body>,
    tree: Bvh,
}

enum Body {
    Convex(Planes),
    Triangles(Triangles),
}

impl Bodies {
    pub(super) fn new(objects: &[Object], geometry: Geometry) -> Self {
        let body = |object: &Object| {
            let planes = (geometry == Geometry::Planes).then(|| planes_of_convex(&object.mesh)).flatten();
            match planes {
                Some(planes) => Body::Convex(Planes::new(planes)),
                None => Body::Triangles(Triangles::new(&object.mesh)),
            }
        };
        let extents: Vec<Extent> = objects
            .iter()
            .map(|object| {
                let extent = Extent::of(object.mesh.triangles().flatten().map(|corner| corner.as_dvec3()));
                // A facet's plane may lie that far outside of its vertices.
                extent.padded(crate::scene::convex::TOLERANCE * extent.largest_coordinate().max(0.0))
            })
            .collect();
        Self { bodies: objects.iter().map(body).collect(), tree: Bvh::new(&extents) }
    }

    /// Where a ray outside enters a body first, `left` being the face that it comes from.
    pub(super) fn enter(&self, origin: DVec3, direction: DVec3, left: Option<Place>) -> Option<Hit> {
        // What leaves a convex body goes past it.
        if let (Some(place), [Body::Convex(_)]) = (left, &self.bodies[..]) {
            debug_assert_eq!(place.body, 0);
            return None;
        }
        let mut first: Option<Hit> = None;
        self.tree.visit(origin, direction, (0.0, f64::INFINITY), |body, limit| {
            let left = left.filter(|place| place.body == body).map(|place| place.face);
            let found = match &self.bodies[body] {
                Body::Convex(_) if left.is_some() => None,
                Body::Convex(planes) => planes.enter(origin, direction),
                Body::Triangles(triangles) => triangles.first(origin, direction, left, limit, Side::Front),
            };
            if let Some((distance, face, normal)) = found.filter(|(distance, ..)| *distance < limit) {
                first = Some(Hit { distance, normal, place: Place { body, face } });
            }
            first.map_or(limit, |hit| hit.distance)
        });
        first
    }

    /// Where a ray inside the body of `left`, which it comes from, leaves it. `None` where it finds no way out: the surface is not
    /// closed there.
    pub(super) fn leave(&self, origin: DVec3, direction: DVec3, left: Place) -> Option<Hit> {
        let found = match &self.bodies[left.body] {
            Body::Convex(planes) => planes.leave(origin, direction, left.face),
            Body::Triangles(triangles) => {
                triangles.first(origin, direction, Some(left.face), f64::INFINITY, Side::Back)
            }
        };
        found.map(|(distance, face, normal)| Hit { distance, normal, place: Place { body: left.body, face } })
    }
}

/// Distance, face and outward normal.
type Found = (f64, usize, DVec3);

/// The planes of a convex body, part by part, so that several are tested at once.
struct Planes {
    planes: Vec<Plane>,
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
    distance: Vec<f64>,
}

impl Planes {
    fn new(planes: Vec<Plane>) -> Self {
        let parts = |part: fn(&Plane) -> f64| planes.iter().map(part).collect();
        Self {
            x: parts(|plane| plane.normal.x),
            y: parts(|plane| plane.normal.y),
            z: parts(|plane| plane.normal.z),
            distance: parts(|plane| plane.distance),
            planes,
        }
    }

    /// The nearest plane that the ray runs towards, leaving out the face just left: no epsilon is needed.
    fn leave(&self, origin: DVec3, direction: DVec3, left: usize) -> Option<Found> {
        let count = self.planes.len();
        let mut distances = [f64::INFINITY; MAX_PLANES];
        let parts = self.x[..count].iter().zip(&self.y[..count]).zip(&self.z[..count]).zip(&self.distance[..count]);
        for (distance, (((x, y), z), d)) in distances.iter_mut().zip(parts) {
            let slope = x * direction.x + y * direction.y + z * direction.z;
            let depth = d - (x * origin.x + y * origin.y + z * origin.z);
            let quotient = depth / slope;
            *distance = if slope > 0.0 { quotient } else { f64::INFINITY };
        }
        distances[left] = f64::INFINITY;
        let mut nearest = (f64::INFINITY, None);
        for (face, &distance) in distances[..count].iter().enumerate() {
            if distance < nearest.0 {
                nearest = (distance, Some(face));
            }
        }
        // An edge, and rounding, may put the origin a hair outside of the next plane.
        let (distance, face) = nearest;
        face.map(|face| (distance.max(0.0), face, self.planes[face].normal))
    }

    /// The last plane that the ray crosses inwards, if it comes before the first that it crosses outwards.
    fn enter(&self, origin: DVec3, direction: DVec3) -> Option<Found> {
        let mut entry: Option<Found> = None;
        let mut exit = f64::INFINITY;
        for (face, plane) in self.planes.iter().enumerate() {
            let slope = plane.normal.dot(direction);
            let depth = -plane.height(origin);
            if slope > 0.0 {
                exit = exit.min(depth / slope);
            } else if slope < 0.0 {
                let distance = depth / slope;
                if entry.is_none_or(|(last, ..)| distance > last) {
                    entry = Some((distance, face, plane.normal));
                }
            } else if depth < 0.0 {
                return None;
            }
        }
        entry.filter(|(distance, ..)| (0.0..exit).contains(distance))
    }
}

/// Which side of a triangle a ray comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Front,
    Back,
}

/// A closed surface of triangles.
struct Triangles {
    corners: Vec<[DVec3; 3]>,
    normals: Vec<DVec3>,
    tree: Bvh,
    /// How far before its origin a ray may still meet a triangle: a ray that sets out beside an edge may lie, by rounding, outside of
    /// the triangle on the edge's other side. 2^12 roundings of the largest coordinate.
    reach_back: f64,
}

impl Triangles {
    fn new(mesh: &Mesh) -> Self {
        let corners: Vec<[DVec3; 3]> =
            mesh.triangles().map(|corners| corners.map(|corner| corner.as_dvec3())).collect();
        let normals = corners.iter().map(|[a, b, c]| (b - a).cross(c - a).normalize_or_zero()).collect();
        let extents: Vec<Extent> = corners.iter().map(|corners| Extent::of(*corners)).collect();
        let largest = extents.iter().map(Extent::largest_coordinate).fold(0.0, f64::max);
        let reach_back = largest * f64::EPSILON * f64::from(1 << 12);
        let padded: Vec<Extent> = extents.iter().map(|extent| extent.padded(reach_back)).collect();
        Self { tree: Bvh::new(&padded), corners, normals, reach_back }
    }

    /// The first triangle before `limit` that a ray meets from `side`, leaving out the one just left.
    fn first(&self, origin: DVec3, direction: DVec3, left: Option<usize>, limit: f64, side: Side) -> Option<Found> {
        let shear = Shear::new(direction);
        let mut found: Option<Found> = None;
        self.tree.visit(origin, direction, (-self.reach_back, limit), |item, limit| {
            let met = if left == Some(item) { None } else { shear.meet(origin, &self.corners[item], side) };
            if let Some(distance) = met.filter(|distance| (-self.reach_back..limit).contains(distance)) {
                found = Some((distance, item, self.normals[item]));
                return distance;
            }
            limit
        });
        found.map(|(distance, face, normal)| (distance.max(0.0), face, normal))
    }
}

/// Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013: corners are sheared so that the ray runs along
/// an axis; two triangles then compute the same number for the edge that they share, with opposite signs, so that nothing slips through.
struct Shear {
    axes: [usize; 3],
    shear: DVec3,
}

impl Shear {
    fn new(direction: DVec3) -> Self {
        let along = direction.abs().max_position();
        let (mut first, mut second) = ((along + 1) % 3, (along + 2) % 3);
        // Keeps the winding.
        if direction[along] < 0.0 {
            std::mem::swap(&mut first, &mut second);
        }
        let shear = DVec3::new(direction[first], direction[second], 1.0) / direction[along];
        Self { axes: [first, second, along], shear }
    }

    /// The t at which the line meets the triangle from `side`.
    fn meet(&self, origin: DVec3, corners: &[DVec3; 3], side: Side) -> Option<f64> {
        let [a, b, c] = corners.map(|corner| {
            let offset = corner - origin;
            let [first, second, along] = self.axes.map(|axis| offset[axis]);
            DVec3::new(first - self.shear.x * along, second - self.shear.y * along, self.shear.z * along)
        });
        let edges = DVec3::new(c.x * b.y - c.y * b.x, a.x * c.y - a.y * c.x, b.x * a.y - b.y * a.x);
        // Counter-clockwise from outside: the edges count positive from the front.
        let edges = if side == Side::Front { edges } else { -edges };
        let sum = edges.element_sum();
        if edges.min_element() < 0.0 || sum == 0.0 {
            return None;
        }
        Some(edges.dot(DVec3::new(a.z, b.z, c.z)) / sum)
    }
}

#[cfg(test)]
mod tests;
