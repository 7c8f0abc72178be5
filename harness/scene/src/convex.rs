//! The facet planes of a convex mesh, found from the mesh itself: a cut stone from any file, not only from a list of
//! planes.

use std::collections::HashMap;

use glam::{DVec3, Vec3, Vec4};

use super::polyhedron::{MAX_PLANES, Plane};
use super::{Mesh, MeshDiagnosis};

/// How far a vertex may lie from its facet's plane, relative to the mesh's largest coordinate: 32 times the 2^-24 by
/// which storing it in f32 moves it. A plane through one triangle carries its corners' roundings on to the rest of the
/// facet, the further the smaller the triangle; facets start from their largest triangle, so 32 is ample. Two facets
/// that differ by less are one.
pub const TOLERANCE: f64 = 1.0 / (1 << 19) as f64;

/// A convex body as a shader takes it.
#[derive(Debug, Clone, PartialEq)]
pub struct Convex {
    /// A facet's unit outward normal n and its distance d from the origin: points inside have n · x <= d.
    pub planes: Vec<Vec4>,
    /// The facet of each triangle, in the order of the mesh's indices.
    pub face_of_triangle: Vec<u32>,
}

impl Convex {
    /// The planes of `mesh` in f32, with every triangle's facet; `None` where [`planes_of_convex`] finds none.
    #[must_use]
    pub fn of_mesh(mesh: &Mesh) -> Option<Self> {
        let facets = Facets::of(mesh)?;
        let planes = facets.planes.iter().map(|plane| plane.normal.as_vec3().extend(plane.distance as f32)).collect();
        Some(Self { planes, face_of_triangle: facets.face_of_triangle })
    }
}

/// What a mesh encloses, as far as finding its facets from inside goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// Closed, and no facet sees another: at most [`MAX_PLANES`] planes bound it.
    Convex,
    /// Closed, but not so.
    Concave,
    /// An edge has no triangle on its other side.
    Open,
}

impl Shape {
    /// Of `mesh`.
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

/// The facet planes of a closed convex mesh, in the order of their first triangles.
///
/// `None` where a vertex lies outside a plane by more than [`TOLERANCE`], where an edge has no triangle on its other
/// side, where a triangle points inwards, and where there are more than [`MAX_PLANES`] facets.
#[must_use]
pub fn planes_of_convex(mesh: &Mesh) -> Option<Vec<Plane>> {
    Facets::of(mesh).map(|facets| facets.planes)
}

/// Why there are no planes of a mesh, as the end of a sentence: ``is not convex``.
#[must_use]
pub fn obstacle(mesh: &Mesh) -> String {
    let faults = MeshDiagnosis::of(mesh);
    if !faults.is_solid() {
        return format!("is no closed solid ({})", faults.clauses().join(", "));
    }
    // Facets are planes that neighbours differ by; of a smooth body each triangle is one.
    let triangles: Vec<Triangle> = mesh.triangles().map(Triangle::new).collect();
    let largest = mesh.positions.iter().fold(0.0, |most: f32, position| most.max(position.abs().max_element()));
    let tolerance = TOLERANCE * f64::from(largest);
    let dents = |triangle: &Triangle| {
        let plane = Plane::through(triangle.corners[0], triangle.area);
        !triangle.is_sliver(tolerance)
            && mesh.positions.iter().any(|corner| plane.height(corner.as_dvec3()) > DENT * f64::from(largest))
    };
    if triangles.iter().take(MOST_PROBED).any(dents) {
        return "is not convex".to_owned();
    }
    format!("has more than {MAX_PLANES} facets")
}

/// How far a vertex stands above the plane of a triangle, relative to the largest coordinate, that makes a dent and no rounding.
const DENT: f64 = 1.0 / (1 << 12) as f64;
/// Each triangle is compared with all vertices.
const MOST_PROBED: usize = 4096;

/// Triangles put together to facets.
struct Facets {
    planes: Vec<Plane>,
    face_of_triangle: Vec<u32>,
}

/// A triangle in f64.
struct Triangle {
    corners: [DVec3; 3],
    /// Its outward normal times its area.
    area: DVec3,
}

impl Triangle {
    fn new(corners: [Vec3; 3]) -> Self {
        let corners @ [a, b, c] = corners.map(Vec3::as_dvec3);
        Self { corners, area: 0.5 * (b - a).cross(c - a) }
    }

    /// The largest distance of a corner from `plane`.
    fn reach(&self, plane: &Plane) -> f64 {
        self.corners.iter().map(|&corner| plane.height(corner).abs()).fold(0.0, f64::max)
    }

    /// Whether its corners lie so nearly in one line that rounding alone gives it its normal.
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

/// Whether each directed edge has its opposite. Vertices at one position are one, whatever their normals.
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

/// The facet of each triangle, numbered by first appearance. The largest triangles come first, since their planes are
/// the best known.
fn group(triangles: &[Triangle], tolerance: f64) -> Option<Vec<u32>> {
    let mut order: Vec<usize> = (0..triangles.len()).collect();
    order.sort_by(|&a, &b| triangles[b].area.length().total_cmp(&triangles[a].area.length()));
    let mut seeds: Vec<Plane> = Vec::new();
    let mut seed_of_triangle = vec![0; triangles.len()];
    for index in order {
        let triangle = &triangles[index];
        let sliver = triangle.is_sliver(tolerance);
        // The facet opposite on a thin plate lies as near, but faces the other way.
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

/// Each facet's plane from all of its triangles: the normal of the summed areas, in the middle of the corners' heights.
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
