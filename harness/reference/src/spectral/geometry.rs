//! Bodies and their intersections with rays, in f64.

use super::bvh::{Bvh, Extent};
use super::cells::Cells;
use super::face::{Face, faces};
use super::hit::{Hit, Place};
use super::matte::Mattes;
use super::paint::{Paint, Painted};
use super::within::Within;
use glam::{DVec3, Mat4, Vec4};
use lapidary_scene::convex::{TOLERANCE, planes_of_convex};
use lapidary_scene::polyhedron::Plane;
use lapidary_scene::{Mesh, Object};
use std::sync::OnceLock;

/// Representation of bodies for ray intersection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Geometry {
    /// Convex bodies by the planes of their facets, all others by their triangles.
    Planes,
    /// All bodies by their triangles.
    Triangles,
}

/// All bodies of a scene, closed.
pub(crate) struct Bodies {
    bodies: Vec<Body>,
    tree: Bvh,
    /// Whether another body may lie within each, or share space with it: their boxes meet.
    shares: Vec<bool>,
    mattes: Mattes,
    /// For each body its images and colours of vertices, if it has any.
    paints: Vec<Option<Paint>>,
    /// For each smooth clear body its faces, numbered like its triangles; empty if no body is smooth.
    smooth: Vec<Option<Vec<Face>>>,
    /// How far apart two surfaces still lie in one place: 2^12 roundings of the largest coordinate.
    touching: f64,
}

/// Which way a ray crosses a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    In,
    Out,
}

enum Body {
    Convex(Planes),
    Triangles(Triangles),
}

impl Bodies {
    /// Takes all bodies as clear, whatever their materials are, and as flat.
    pub(crate) fn new(objects: &[Object], geometry: Geometry) -> Self {
        Self::with_faces(objects, geometry, (Mattes::default(), Vec::new()), Vec::new())
    }

    /// Matte and smooth bodies are always met by their triangles, whose corners have the normals.
    pub(super) fn with_mattes(objects: &[Object], geometry: Geometry, mattes: Mattes) -> Self {
        let is_smooth = |object: &Object| object.material.is_smooth(&object.mesh);
        let smooth = objects.iter().map(|object| is_smooth(object).then(|| faces(&object.mesh))).collect();
        let paints = objects.iter().map(Paint::of).collect();
        Self::with_faces(objects, geometry, (mattes, paints), smooth)
    }

    fn with_faces(
        objects: &[Object],
        geometry: Geometry,
        (mattes, paints): (Mattes, Vec<Option<Paint>>),
        smooth: Vec<Option<Vec<Face>>>,
    ) -> Self {
        let extents: Vec<Extent> = objects
            .iter()
            .map(|object| {
                let extent = Extent::of(object.mesh.triangles().flatten().map(|corner| corner.as_dvec3()));
                // A facet's plane may lie that far outside its vertices.
                extent.padded(TOLERANCE * extent.largest_coordinate())
            })
            .collect();
        let body = |(number, (object, extent)): (usize, (&Object, &Extent))| {
            let is_smooth = matches!(smooth.get(number), Some(Some(_)));
            let is_painted = matches!(paints.get(number), Some(Some(_)));
            let by_planes = geometry == Geometry::Planes && !mattes.has(number) && !is_smooth && !is_painted;
            match by_planes.then(|| planes_of_convex(&object.mesh)).flatten() {
                Some(planes) => Body::Convex(Planes::new(planes, extent)),
                None => Body::Triangles(Triangles::new(&object.mesh)),
            }
        };
        let bodies = objects.iter().zip(&extents).enumerate().map(body).collect();
        let touching = reach_back(&extents);
        Self { bodies, tree: Bvh::new(&extents), shares: sharing(&extents), mattes, paints, smooth, touching }
    }

    /// Finds the next surface that a ray within some bodies crosses, and which way; `left` is the face that it comes from.
    /// Returns `None` outside if it meets no body, and within bodies if the surface of one is not closed there.
    ///
    /// Where surfaces lie in one place, a body is entered before another one is left: no air is between bodies that touch.
    pub(super) fn cross(
        &self,
        origin: DVec3,
        direction: DVec3,
        left: Option<Place>,
        within: &Within,
    ) -> Option<(Hit, Way)> {
        if within.is_empty() {
            return Some((self.enter(origin, direction, left)?, Way::In));
        }
        let mut first: Option<Hit> = None;
        for body in within.bodies() {
            let left = left.filter(|place| place.body == body).map(|place| place.face);
            let limit = first.map_or(f64::INFINITY, |hit| hit.distance);
            first = self.leave_body(origin, direction, body, left, limit).or(first);
        }
        let out = first?;
        if within.bodies().any(|body| self.shares[body]) {
            let entered = self.enter_before(origin, direction, left, out.distance + self.touching, within);
            if let Some(into) = entered {
                return Some((into, Way::In));
            }
        }
        Some((out, Way::Out))
    }

    /// Returns the radiance that a matte body sends from `hit`, which lies at `point`; `None` if
    /// the body is clear.
    pub(super) fn sent(&self, hit: &Hit, point: DVec3) -> Option<DVec3> {
        self.mattes.sent(hit, point, self.paint(hit.place))
    }

    /// Returns the radiance that the matte share of a partly clear surface adds; `flat` is the face's normal.
    pub(super) fn sent_in_part(&self, (place, painted): (Place, Painted), flat: DVec3, point: DVec3) -> DVec3 {
        self.mattes.sent_in_part((place, painted), flat, point, self.paint(place))
    }

    /// Returns the matte bodies and metals, and the light on them.
    pub(super) fn mattes(&self) -> &Mattes {
        &self.mattes
    }

    /// Returns the images and colours of vertices of a body, if it has any.
    pub(super) fn paint(&self, place: Place) -> Option<&Paint> {
        self.paints.get(place.body).and_then(Option::as_ref)
    }

    /// Whether a body's surface is curved between the corners of its faces.
    pub(super) fn is_smooth(&self, body: usize) -> bool {
        matches!(self.smooth.get(body), Some(Some(_)))
    }

    /// Returns where a ray that comes to `hit` at `point` meets the body's surface, and the outward unit normal that reflects
    /// and refracts there: those of the curved surface if the body is smooth.
    pub(super) fn curved(&self, hit: &Hit, point: DVec3, direction: DVec3) -> (DVec3, DVec3) {
        let Place { body, face } = hit.place;
        let face = self.smooth.get(body).and_then(|faces| faces.as_ref()?.get(face));
        face.map_or((point, hit.normal), |face| face.curved(point, direction, hit.normal))
    }

    /// Returns the corners and outward unit normal of each triangle of a body, in the order of its
    /// faces; the normal is 0 if the triangle has no area. Nothing for a body made of planes.
    pub(crate) fn triangles(&self, body: usize) -> impl Iterator<Item = (&[DVec3; 3], &DVec3)> {
        let (corners, normals) = match &self.bodies[body] {
            Body::Convex(_) => (&[][..], &[][..]),
            Body::Triangles(triangles) => (&triangles.corners[..], &triangles.normals[..]),
        };
        corners.iter().zip(normals)
    }

    /// Finds where a ray from outside first enters a body; `left` is the face that it comes from.
    pub(crate) fn enter(&self, origin: DVec3, direction: DVec3, left: Option<Place>) -> Option<Hit> {
        // A ray that leaves a convex body does not meet it again.
        if let (Some(place), [Body::Convex(_)]) = (left, &self.bodies[..]) {
            debug_assert_eq!(place.body, 0);
            return None;
        }
        self.enter_before(origin, direction, left, f64::INFINITY, &Within::default())
    }

    /// Finds where a ray first enters a body before `limit`, of those that it is not `within`.
    fn enter_before(
        &self,
        origin: DVec3,
        direction: DVec3,
        left: Option<Place>,
        limit: f64,
        within: &Within,
    ) -> Option<Hit> {
        let mut first: Option<Hit> = None;
        self.tree.visit(origin, direction, (0.0, limit), |body, limit| {
            let left = left.filter(|place| place.body == body).map(|place| place.face);
            let found = match &self.bodies[body] {
                _ if within.holds(body) => None,
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

    /// Finds where a ray that starts inside `body`, or on its face `left`, leaves it before
    /// `limit`.
    pub(crate) fn leave_body(
        &self,
        origin: DVec3,
        direction: DVec3,
        body: usize,
        left: Option<usize>,
        limit: f64,
    ) -> Option<Hit> {
        let found = match &self.bodies[body] {
            Body::Convex(planes) => planes.leave(origin, direction, left).filter(|(distance, ..)| *distance < limit),
            Body::Triangles(triangles) => triangles.first(origin, direction, left, limit, Side::Back),
        };
        found.map(|(distance, face, normal)| Hit { distance, normal, place: Place { body, face } })
    }
}

/// How far before its origin a ray may still meet a surface, and how far apart two surfaces are one: 2^12 roundings of the
/// largest coordinate. A ray that starts beside an edge may, by rounding, lie outside the triangle on the edge's other side.
fn reach_back(extents: &[Extent]) -> f64 {
    let largest = extents.iter().map(Extent::largest_coordinate).fold(0.0, f64::max);
    largest * f64::EPSILON * f64::from(1 << 12)
}

/// Returns for each body whether its box meets another one's.
fn sharing(extents: &[Extent]) -> Vec<bool> {
    let mut order: Vec<usize> = (0..extents.len()).collect();
    order.sort_by(|&a, &b| extents[a].least.x.total_cmp(&extents[b].least.x));
    let mut shares = vec![false; extents.len()];
    for (place, &body) in order.iter().enumerate() {
        let of_these = |other: &&usize| extents[**other].least.x <= extents[body].greatest.x;
        for &other in
            order[place + 1..].iter().take_while(of_these).filter(|other| extents[**other].meets(&extents[body]))
        {
            shares[body] = true;
            shares[other] = true;
        }
    }
    shares
}

/// Distance, face and outward normal.
type Found = (f64, usize, DVec3);

/// The planes of a convex body.
struct Planes {
    planes: Vec<Plane>,
    sieve: Sieve,
    /// See [`reach_back`].
    reach_back: f64,
}

impl Planes {
    /// `extent` must contain the body.
    fn new(planes: Vec<Plane>, extent: &Extent) -> Self {
        Self { sieve: Sieve::new(&planes, extent), planes, reach_back: reach_back(std::slice::from_ref(extent)) }
    }

    /// Finds the nearest plane that the ray runs towards, except the face just left: no epsilon is
    /// needed.
    fn leave(&self, origin: DVec3, direction: DVec3, left: Option<usize>) -> Option<Found> {
        let mut nearest: Option<Found> = None;
        self.sieve.candidates(origin, direction, |face| {
            let Some(plane) = self.planes.get(face).filter(|_| Some(face) != left) else { return };
            let slope = plane.normal.dot(direction);
            let distance = -plane.height(origin) / slope;
            if slope > 0.0 && nearest.is_none_or(|(least, ..)| distance < least) {
                nearest = Some((distance, face, plane.normal));
            }
        });
        // At an edge, rounding may put the origin slightly outside the next plane.
        nearest.map(|(distance, face, normal)| (distance.max(0.0), face, normal))
    }

    /// Finds the last plane that the ray crosses inwards, if it comes before the first that it
    /// crosses outwards.
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
        let (distance, face, normal) = entry.filter(|(distance, ..)| (-self.reach_back..exit).contains(distance))?;
        Some((distance.max(0.0), face, normal))
    }
}

/// Rows of four planes whose distances stay on the stack.
const FEW: usize = 64;

/// Selects, from all planes of a convex body, the one or two through which a ray may leave. Works
/// in f32 and allows for its errors. Most of an image's render time goes into this search.
struct Sieve {
    /// Four planes per row: x, y and z of the normal, and the distance from the centre.
    rows: Vec<[Vec4; 4]>,
    centre: DVec3,
    /// Bounds of the errors of n · direction and of a depth below a plane. Rounding a vector from
    /// f64 costs 2^-24 of it, a product of two vectors 5 · 2^-24, and a depth is the difference of
    /// two numbers of the body's size. The bounds are twice as large.
    slope_error: f32,
    depth_error: f32,
}

impl Sieve {
    fn new(planes: &[Plane], extent: &Extent) -> Self {
        let centre = 0.5 * (extent.least + extent.greatest);
        let parts = |plane: &Plane| plane.normal.extend(-plane.height(centre)).as_vec4();
        // Planes missing from the last row have no direction and lie far away.
        let lane = |planes: &[Plane], lane: usize| planes.get(lane).map_or(Vec4::W * 1e30, parts);
        let row =
            |planes: &[Plane]| Mat4::from_cols(lane(planes, 0), lane(planes, 1), lane(planes, 2), lane(planes, 3));
        let rows = planes.chunks(4).map(|planes| {
            let transposed = row(planes).transpose();
            [transposed.x_axis, transposed.y_axis, transposed.z_axis, transposed.w_axis]
        });
        let radius = extent.greatest.distance(centre) as f32;
        Self { rows: rows.collect(), centre, slope_error: 5.0 * f32::EPSILON, depth_error: 8.0 * f32::EPSILON * radius }
    }

    /// Calls `visit` with each plane that may be the nearest one ahead of a ray.
    fn candidates(&self, origin: DVec3, direction: DVec3, mut visit: impl FnMut(usize)) {
        let from = (origin - self.centre).as_vec3();
        let towards = direction.as_vec3();
        let (slope_error, depth_error) = (Vec4::splat(self.slope_error), Vec4::splat(self.depth_error));
        // Lower bound of the distance to each plane.
        let (mut few, mut many) = ([Vec4::INFINITY; FEW], Vec::new());
        let least = match self.rows.len() {
            ..=FEW => &mut few[..],
            rows => {
                many.resize(rows, Vec4::INFINITY);
                &mut many
            }
        };
        // Upper bound of the distance to the nearest plane.
        let mut most = Vec4::INFINITY;
        for ([x, y, z, distance], least) in self.rows.iter().zip(&mut *least) {
            let slope = *x * towards.x + *y * towards.y + *z * towards.z;
            let depth = *distance - (*x * from.x + *y * from.y + *z * from.z);
            let (least_slope, greatest_slope) = (slope - slope_error, slope + slope_error);
            let sure = least_slope.cmpgt(Vec4::ZERO);
            most = most.min(Vec4::select(sure, (depth + depth_error) / least_slope, Vec4::INFINITY));
            let possible = greatest_slope.cmpgt(Vec4::ZERO);
            *least = Vec4::select(possible, (depth - depth_error) / greatest_slope, Vec4::INFINITY);
        }
        // The quotients are rounded as well.
        let most = Vec4::splat(most.min_element() * (1.0 + 4.0 * f32::EPSILON)).min(Vec4::MAX);
        for (row, least) in least[..self.rows.len()].iter().enumerate() {
            let mut lanes = least.cmple(most).bitmask();
            while lanes != 0 {
                visit(4 * row + lanes.trailing_zeros() as usize);
                lanes &= lanes - 1;
            }
        }
    }
}

/// Side of a triangle from which a ray comes.
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
    /// Grid for short rays that start inside, built by the first of them: most images have none.
    cells: OnceLock<Cells>,
    /// See [`reach_back`].
    reach_back: f64,
}

impl Triangles {
    fn new(mesh: &Mesh) -> Self {
        // A ray would go back and forth between the two sides of a fold for ever.
        let mesh = mesh.without_folds();
        let corners: Vec<[DVec3; 3]> =
            mesh.triangles().map(|corners| corners.map(|corner| corner.as_dvec3())).collect();
        let normals = corners.iter().map(|[a, b, c]| (b - a).cross(c - a).normalize_or_zero()).collect();
        let extents: Vec<Extent> = corners.iter().map(|corners| Extent::of(*corners)).collect();
        let reach_back = reach_back(&extents);
        let padded: Vec<Extent> = extents.iter().map(|extent| extent.padded(reach_back)).collect();
        Self { tree: Bvh::new(&padded), cells: OnceLock::new(), corners, normals, reach_back }
    }

    /// Builds a grid with cells as wide as a triangle of the mean area.
    fn cells(&self) -> Cells {
        let extents = self.corners.iter().map(|corners| Extent::of(*corners).padded(self.reach_back));
        let area: f64 = self.corners.iter().map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum();
        Cells::new(&extents.collect::<Vec<_>>(), (area / self.corners.len() as f64).sqrt())
    }

    /// Finds the first triangle before `limit` that a ray meets from `side`, except the one just
    /// left.
    fn first(&self, origin: DVec3, direction: DVec3, left: Option<usize>, limit: f64, side: Side) -> Option<Found> {
        let shear = Shear::new(direction);
        let mut found: Option<Found> = None;
        let mut visit = |item, limit| {
            let met = if left == Some(item) { None } else { shear.meet(origin, &self.corners[item], side) };
            if let Some(distance) = met.filter(|distance| (-self.reach_back..limit).contains(distance)) {
                found = Some((distance, item, self.normals[item]));
                return distance;
            }
            limit
        };
        let is_short = limit.is_finite();
        if !(is_short && self.cells.get_or_init(|| self.cells()).visit(origin, direction, limit, &mut visit)) {
            self.tree.visit(origin, direction, (-self.reach_back, limit), visit);
        }
        found.map(|(distance, face, normal)| (distance.max(0.0), face, normal))
    }
}

/// Watertight intersection (Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT
/// 2(1), 2013).
///
/// Corners are sheared so that the ray runs along an axis. Two triangles then compute the same
/// number, with opposite signs, for the edge that they share, so that nothing slips through.
struct Shear {
    axes: [usize; 3],
    shear: DVec3,
}

impl Shear {
    fn new(direction: DVec3) -> Self {
        let along = direction.abs().max_position();
        let (mut first, mut second) = ((along + 1) % 3, (along + 2) % 3);
        // Preserves the winding.
        if direction[along] < 0.0 {
            std::mem::swap(&mut first, &mut second);
        }
        let shear = DVec3::new(direction[first], direction[second], 1.0) / direction[along];
        Self { axes: [first, second, along], shear }
    }

    /// Returns the t at which the line meets the triangle from `side`; `None` if it misses.
    fn meet(&self, origin: DVec3, corners: &[DVec3; 3], side: Side) -> Option<f64> {
        let [a, b, c] = corners.map(|corner| {
            let offset = corner - origin;
            let [first, second, along] = self.axes.map(|axis| offset[axis]);
            DVec3::new(first - self.shear.x * along, second - self.shear.y * along, self.shear.z * along)
        });
        let edges = DVec3::new(c.x * b.y - c.y * b.x, a.x * c.y - a.y * c.x, b.x * a.y - b.y * a.x);
        // Counter-clockwise from outside: the edges are positive from the front.
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
