//! The facet planes of a convex mesh, found from the mesh itself, so that a cut stone can come from
//! any file and not only from a list of planes.

use std::collections::{HashMap, HashSet};

use glam::{DVec3, Vec3, Vec4};

use super::polyhedron::{MAX_PLANES, Plane};
use super::{Mesh, MeshDiagnosis};

/// Largest distance of a vertex from its facet's plane, relative to the mesh's largest coordinate:
/// 32 times the 2^-24 by which storing it in f32 moves it. A plane through one triangle carries its
/// corners' rounding errors on to the rest of the facet, the further the smaller the triangle;
/// facets start from their largest triangle, so 32 is ample. Two facets that differ by less count
/// as one.
pub const TOLERANCE: f64 = 1.0 / (1 << 19) as f64;

/// A convex body in the form that a shader uses.
#[derive(Debug, Clone, PartialEq)]
pub struct Convex {
    /// Unit outward normal n of each facet and its distance d from the origin: points inside have n
    /// · x <= d.
    pub planes: Vec<Vec4>,
    /// Facet of each triangle, in the order of the mesh's indices.
    pub face_of_triangle: Vec<u32>,
}

impl Convex {
    /// Returns the planes of `mesh` in f32, with every triangle's facet; `None` if
    /// [`planes_of_convex`] finds none.
    #[must_use]
    pub fn of_mesh(mesh: &Mesh) -> Option<Self> {
        let facets = Facets::of(mesh)?;
        let planes = facets.planes.iter().map(|plane| plane.normal.as_vec3().extend(plane.distance as f32)).collect();
        Some(Self { planes, face_of_triangle: facets.face_of_triangle })
    }
}

/// Kind of body that a mesh encloses, as far as it matters for finding its facets from inside.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// Closed, and no facet sees another: at most [`MAX_PLANES`] planes bound it.
    Convex,
    /// Closed, but not convex in this sense.
    Concave,
    /// An edge has no triangle on its other side.
    Open,
}

impl Shape {
    /// Returns the shape of `mesh`.
    #[must_use]
    pub fn of(mesh: &Mesh) -> Self {
        if !is_closed(mesh) {
            Self::Open
        } else if Facets::of_closed(mesh).is_some() {
            Self::Convex
        } else {
            Self::Concave
        }
    }
}

/// Returns the facet planes of a closed convex mesh, in the order of their first triangles.
///
/// `None` if a vertex lies outside a plane by more than [`TOLERANCE`], an edge has no triangle on
/// its other side, a triangle points inwards, or there are more than [`MAX_PLANES`] facets.
#[must_use]
pub fn planes_of_convex(mesh: &Mesh) -> Option<Vec<Plane>> {
    Facets::of(mesh).map(|facets| facets.planes)
}

/// Returns why a mesh has no planes, as the end of a sentence: ``is not convex``.
#[must_use]
pub fn obstacle(mesh: &Mesh) -> String {
    let faults = MeshDiagnosis::of(mesh);
    if !faults.is_solid() {
        let edge = if faults.is_flat { None } else { open_edge(mesh) };
        let place = edge.map_or(String::new(), |[from, to]| format!("; see the edge from {from} to {to}"));
        return format!("is no closed solid ({}{place})", faults.clauses().join(", "));
    }
    if let Some([from, to]) = dented_edge(mesh) {
        return format!("is not convex: it bends inwards at the edge from {from} to {to}");
    }
    if is_dented(mesh) {
        return "is not convex: it has several parts, or passes through itself".to_owned();
    }
    let triangles: Vec<Triangle> = mesh.triangles().map(Triangle::new).collect();
    match group(&triangles, TOLERANCE * largest(mesh)) {
        Some(_) => format!("is not convex, though by less than 1/{} of its size", 1.0 / DENT),
        None => format!("has more than {MAX_PLANES} facets"),
    }
}

/// Returns the first edge without a triangle on its other side.
fn open_edge(mesh: &Mesh) -> Option<[Vec3; 2]> {
    let key = |position: Vec3| position.to_array().map(|part| (part + 0.0).to_bits());
    let edges = || mesh.triangles().flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]);
    let known: HashSet<_> = edges().map(|edge| edge.map(key)).collect();
    edges().find(|[from, to]| key(*from) != key(*to) && !known.contains(&[key(*to), key(*from)]))
}

/// Returns the first edge whose two triangles enclose more than half a turn, by more than rounding.
fn dented_edge(mesh: &Mesh) -> Option<[Vec3; 2]> {
    let most = DENT * largest(mesh);
    let key = |position: Vec3| position.to_array().map(|part| (part + 0.0).to_bits());
    let edges = || mesh.triangles().flat_map(|[a, b, c]| [([a, b], c), ([b, c], a), ([c, a], b)]);
    let opposite: HashMap<_, Vec3> = edges().map(|([from, to], corner)| ([key(from), key(to)], corner)).collect();
    let dents = |([from, to], corner): &([Vec3; 2], Vec3)| {
        let triangle = Triangle::new([*from, *to, *corner]);
        let plane = Plane::through(triangle.corners[0], triangle.area);
        let beyond = opposite.get(&[key(*to), key(*from)]);
        !triangle.is_sliver(most) && beyond.is_some_and(|beyond| plane.height(beyond.as_dvec3()) > most)
    };
    edges().find(dents).map(|(edge, _)| edge)
}

/// Whether a vertex lies above the plane of a triangle by more than rounding.
fn is_dented(mesh: &Mesh) -> bool {
    let most = DENT * largest(mesh);
    mesh.triangles().take(MOST_PROBED).map(Triangle::new).any(|triangle| {
        let plane = Plane::through(triangle.corners[0], triangle.area);
        !triangle.is_sliver(most) && mesh.positions.iter().any(|corner| plane.height(corner.as_dvec3()) > most)
    })
}

/// Returns the largest coordinate of a mesh.
fn largest(mesh: &Mesh) -> f64 {
    f64::from(mesh.positions.iter().fold(0.0, |most: f32, position| most.max(position.abs().max_element())))
}

/// Height of a vertex above the plane of a triangle, relative to the largest coordinate, beyond
/// which it is a dent and not a rounding error.
const DENT: f64 = 1.0 / (1 << 12) as f64;
/// Largest number of triangles to probe, because each is compared with all vertices.
const MOST_PROBED: usize = 4096;

/// Triangles grouped into facets.
struct Facets {
    planes: Vec<Plane>,
    face_of_triangle: Vec<u32>,
}

/// A triangle in f64.
struct Triangle {
    corners: [DVec3; 3],
    /// Outward normal times the area.
    area: DVec3,
}

impl Triangle {
    fn new(corners: [Vec3; 3]) -> Self {
        let corners @ [a, b, c] = corners.map(Vec3::as_dvec3);
        Self { corners, area: 0.5 * (b - a).cross(c - a) }
    }

    /// Returns the largest distance of a corner from `plane`.
    fn reach(&self, plane: &Plane) -> f64 {
        self.corners.iter().map(|&corner| plane.height(corner).abs()).fold(0.0, f64::max)
    }

    /// Whether the corners are so nearly collinear that the normal is only rounding error.
    fn is_sliver(&self, tolerance: f64) -> bool {
        let [a, b, c] = self.corners;
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        2.0 * self.area.length() <= tolerance * longest
    }
}

impl Facets {
    fn of(mesh: &Mesh) -> Option<Self> {
        is_closed(mesh).then(|| Self::of_closed(mesh)).flatten()
    }

    fn of_closed(mesh: &Mesh) -> Option<Self> {
        let triangles: Vec<Triangle> = mesh.triangles().map(Triangle::new).collect();
        let corners = || triangles.iter().flat_map(|triangle| triangle.corners);
        let tolerance = TOLERANCE * corners().fold(0.0, |largest: f64, corner| largest.max(corner.abs().max_element()));
        let face_of_triangle = group(&triangles, tolerance)?;
        let planes = fit(&triangles, &face_of_triangle);
        let fits = triangles.iter().zip(&face_of_triangle).all(|(triangle, &face)| {
            let plane = &planes[face as usize];
            triangle.reach(plane) <= tolerance
        });
        let convex = planes.iter().all(|plane| corners().all(|corner| plane.height(corner) <= tolerance));
        (fits && convex && planes.len() >= 4).then_some(Self { planes, face_of_triangle })
    }
}

/// Whether each directed edge has its opposite. Vertices at one position count as one, whatever
/// their normals.
pub(super) fn is_closed(mesh: &Mesh) -> bool {
    let mut number_at = HashMap::new();
    // Adding 0 makes -0 and 0 the same bits.
    let key = |position: &Vec3| position.to_array().map(|part| (part + 0.0).to_bits());
    let numbers: Vec<usize> = mesh
        .positions
        .iter()
        .map(|position| {
            let next = number_at.len();
            *number_at.entry(key(position)).or_insert(next)
        })
        .collect();
    let triangles = mesh.indices.chunks_exact(3);
    let edges = triangles.flat_map(|t| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])]);
    let edges = edges.map(|(from, to)| (numbers[from as usize], numbers[to as usize])).filter(|(from, to)| from != to);
    let mut edges: Vec<(usize, usize)> = edges.collect();
    let mut opposite: Vec<(usize, usize)> = edges.iter().map(|&(from, to)| (to, from)).collect();
    edges.sort_unstable();
    opposite.sort_unstable();
    edges == opposite
}

/// Returns the facet of each triangle, numbered by first appearance. The largest triangles come
/// first, because their planes are the most accurate.
fn group(triangles: &[Triangle], tolerance: f64) -> Option<Vec<u32>> {
    let mut order: Vec<usize> = (0..triangles.len()).collect();
    order.sort_by(|&a, &b| triangles[b].area.length().total_cmp(&triangles[a].area.length()));
    let mut seeds: Vec<Plane> = Vec::new();
    let mut seed_of_triangle = vec![0; triangles.len()];
    for index in order {
        let triangle = &triangles[index];
        let sliver = triangle.is_sliver(tolerance);
        // The opposite facet of a thin plate lies as near, but faces the other way.
        let alike = |plane: &Plane| sliver || plane.normal.dot(triangle.area) > 0.5 * triangle.area.length();
        let near = seeds.iter().enumerate().map(|(seed, plane)| (seed, plane, triangle.reach(plane)));
        let fitting = near.filter(|(_, plane, reach)| *reach <= tolerance && alike(plane));
        seed_of_triangle[index] = match fitting.min_by(|a, b| a.2.total_cmp(&b.2)) {
            Some((seed, ..)) => seed,
            None if sliver || seeds.len() == MAX_PLANES => return None,
            None => {
                seeds.push(Plane::through(triangle.corners[0], triangle.area));
                seeds.len() - 1
            }
        };
    }
    let mut numbers = vec![None; seeds.len()];
    let mut count = 0;
    let renumbered = seed_of_triangle.into_iter().map(|seed| {
        *numbers[seed].get_or_insert_with(|| {
            count += 1;
            count - 1
        })
    });
    Some(renumbered.collect())
}

/// Returns each facet's plane, fitted to all of its triangles: the normal of the summed areas, at
/// the middle of the corners' heights.
fn fit(triangles: &[Triangle], face_of_triangle: &[u32]) -> Vec<Plane> {
    let count = face_of_triangle.iter().max().map_or(0, |last| *last as usize + 1);
    let mut planes = vec![Plane { normal: DVec3::ZERO, distance: 0.0 }; count];
    for (triangle, &face) in triangles.iter().zip(face_of_triangle) {
        planes[face as usize].normal += triangle.area;
    }
    let mut heights = vec![(f64::INFINITY, f64::NEG_INFINITY); count];
    planes.iter_mut().for_each(|plane| plane.normal = plane.normal.normalize_or_zero());
    for (triangle, &face) in triangles.iter().zip(face_of_triangle) {
        let face = face as usize;
        for corner in triangle.corners {
            let height = planes[face].normal.dot(corner);
            heights[face] = (heights[face].0.min(height), heights[face].1.max(height));
        }
    }
    for (plane, (least, greatest)) in planes.iter_mut().zip(heights) {
        plane.distance = 0.5 * (least + greatest);
    }
    planes
}

#[cfg(test)]
mod tests;
