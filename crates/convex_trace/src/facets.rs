//! The facet planes of a closed convex mesh, found from its triangles, so that a stone can come from
//! any file and not only from a list of planes.

use glam::{DVec3, DVec4, Vec3};
use std::collections::{HashMap, HashSet};
use std::fmt;

/// Largest distance of a vertex from its facet's plane, relative to the mesh's largest coordinate:
/// 32 times the 2^-24 by which storing it in f32 moves it. A plane through one triangle carries its
/// corners' rounding errors on to the rest of the facet, the further the smaller the triangle;
/// facets start from their largest triangle, so 32 is ample. Two facets that differ by less count
/// as one.
pub const TOLERANCE: f64 = 1.0 / (1 << 19) as f64;
/// Height of a vertex above the plane of a triangle, relative to the largest coordinate, beyond
/// which it is a dent and not a rounding error.
const DENT: f64 = 1.0 / (1 << 12) as f64;
/// Largest number of triangles to probe for dents, because each is compared with all vertices.
const MOST_PROBED: usize = 4096;

/// The facets of a closed convex mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Facets {
    /// Unit outward normal n of each facet and its distance d from the origin: points inside have n
    /// · x <= d. In the order of their first triangles.
    pub planes: Vec<DVec4>,
    /// Facet of each triangle, in the order of the mesh's indices.
    pub face_of_triangle: Vec<u32>,
}

/// Why a mesh has no facets to trace.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NoFacets {
    /// An edge has no triangle on its other side.
    Open {
        /// The first such edge, from and to.
        edge: [Vec3; 2],
    },
    /// The mesh bends inwards.
    Dented {
        /// The first edge at which it does, from and to.
        edge: [Vec3; 2],
    },
    /// A vertex lies outside a facet's plane, though no edge bends inwards.
    Parts,
    /// The mesh is not convex by less than a visible dent, or it is flat.
    Slightly,
    /// There are more facets than this.
    TooMany(usize),
}

impl fmt::Display for NoFacets {
    /// Writes the end of a sentence: "is not convex".
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Open { edge: [from, to] } => write!(f, "is open at the edge from {from} to {to}"),
            Self::Dented { edge: [from, to] } => {
                write!(f, "is not convex: it bends inwards at the edge from {from} to {to}")
            }
            Self::Parts => write!(f, "is not convex: it has several parts, or passes through itself"),
            Self::Slightly => write!(f, "is not convex, though by less than 1/{} of its size", 1.0 / DENT),
            Self::TooMany(most) => write!(f, "has more than {most} facets"),
        }
    }
}

impl std::error::Error for NoFacets {}

impl Facets {
    /// Returns the facets of a mesh with at most `most` of them. `indices` are three per triangle,
    /// counter-clockwise from outside.
    ///
    /// `None` if a vertex lies outside a plane by more than [`TOLERANCE`], an edge has no triangle on
    /// its other side, a triangle points inwards, or there are more than `most` facets;
    /// [`Facets::obstacle`] says which.
    ///
    /// # Panics
    /// If an index has no position.
    #[must_use]
    pub fn of_mesh(positions: &[Vec3], indices: &[u32], most: usize) -> Option<Self> {
        is_closed(positions, indices).then(|| Self::of_closed(positions, indices, most)).flatten()
    }

    /// Returns the facets of a mesh that is known to be closed, as [`Facets::of_mesh`] does.
    ///
    /// # Panics
    /// If an index has no position.
    #[must_use]
    pub fn of_closed(positions: &[Vec3], indices: &[u32], most: usize) -> Option<Self> {
        let triangles: Vec<Triangle> = corners(positions, indices).map(Triangle::new).collect();
        let tolerance = TOLERANCE * largest(positions, indices);
        let face_of_triangle = group(&triangles, tolerance, most)?;
        let planes = fit(&triangles, &face_of_triangle);
        let fits = triangles.iter().zip(&face_of_triangle).all(|(triangle, &face)| {
            let plane = &planes[face as usize];
            triangle.reach(plane) <= tolerance
        });
        let all = || triangles.iter().flat_map(|triangle| triangle.corners);
        let convex = planes.iter().all(|plane| all().all(|corner| height(plane, corner) <= tolerance));
        (fits && convex && planes.len() >= 4).then_some(Self { planes, face_of_triangle })
    }

    /// Returns why [`Facets::of_mesh`] found no facets of this mesh.
    ///
    /// # Panics
    /// If an index has no position.
    #[must_use]
    pub fn obstacle(positions: &[Vec3], indices: &[u32], most: usize) -> NoFacets {
        if let Some(edge) = open_edge(positions, indices) {
            return NoFacets::Open { edge };
        }
        if let Some(edge) = dented_edge(positions, indices) {
            return NoFacets::Dented { edge };
        }
        if is_dented(positions, indices) {
            return NoFacets::Parts;
        }
        let triangles: Vec<Triangle> = corners(positions, indices).map(Triangle::new).collect();
        match group(&triangles, TOLERANCE * largest(positions, indices), most) {
            Some(_) => NoFacets::Slightly,
            None => NoFacets::TooMany(most),
        }
    }
}

/// Returns the corners of each triangle.
fn corners<'a>(positions: &'a [Vec3], indices: &'a [u32]) -> impl Iterator<Item = [Vec3; 3]> + 'a {
    let corner = |index: u32| positions[index as usize];
    indices.chunks_exact(3).map(move |corners| [corner(corners[0]), corner(corners[1]), corner(corners[2])])
}

/// Returns the largest coordinate of a corner.
fn largest(positions: &[Vec3], indices: &[u32]) -> f64 {
    let all = corners(positions, indices).flatten();
    all.fold(0.0, |largest: f64, corner| largest.max(corner.as_dvec3().abs().max_element()))
}

/// Returns the signed distance of `point` from a plane, positive outside.
fn height(plane: &DVec4, point: DVec3) -> f64 {
    plane.truncate().dot(point) - plane.w
}

/// Returns the plane through `point` with the outward `normal`.
fn through(point: DVec3, normal: DVec3) -> DVec4 {
    let normal = normal.normalize_or_zero();
    normal.extend(normal.dot(point))
}

/// A position as bits, by which equal positions are found. Adding 0 makes -0 and 0 the same.
fn key(position: Vec3) -> [u32; 3] {
    position.to_array().map(|part| (part + 0.0).to_bits())
}

/// Whether each directed edge has its opposite. Vertices at one position count as one.
///
/// # Panics
/// If an index has no position.
#[must_use]
pub fn is_closed(positions: &[Vec3], indices: &[u32]) -> bool {
    let mut number_at = HashMap::new();
    let numbers: Vec<usize> = positions
        .iter()
        .map(|position| {
            let next = number_at.len();
            *number_at.entry(key(*position)).or_insert(next)
        })
        .collect();
    let triangles = indices.chunks_exact(3);
    let edges = triangles.flat_map(|t| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])]);
    let edges = edges.map(|(from, to)| (numbers[from as usize], numbers[to as usize])).filter(|(from, to)| from != to);
    let mut edges: Vec<(usize, usize)> = edges.collect();
    let mut opposite: Vec<(usize, usize)> = edges.iter().map(|&(from, to)| (to, from)).collect();
    edges.sort_unstable();
    opposite.sort_unstable();
    edges == opposite
}

/// Returns the first edge without a triangle on its other side.
fn open_edge(positions: &[Vec3], indices: &[u32]) -> Option<[Vec3; 2]> {
    let edges = || corners(positions, indices).flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]);
    let known: HashSet<_> = edges().map(|edge| edge.map(key)).collect();
    edges().find(|[from, to]| key(*from) != key(*to) && !known.contains(&[key(*to), key(*from)]))
}

/// Returns the first edge whose two triangles enclose more than half a turn, by more than rounding.
fn dented_edge(positions: &[Vec3], indices: &[u32]) -> Option<[Vec3; 2]> {
    let most = DENT * largest(positions, indices);
    let edges = || corners(positions, indices).flat_map(|[a, b, c]| [([a, b], c), ([b, c], a), ([c, a], b)]);
    let opposite: HashMap<_, Vec3> = edges().map(|([from, to], corner)| ([key(from), key(to)], corner)).collect();
    let dents = |([from, to], corner): &([Vec3; 2], Vec3)| {
        let triangle = Triangle::new([*from, *to, *corner]);
        let beyond = opposite.get(&[key(*to), key(*from)]);
        !triangle.is_sliver(most) && beyond.is_some_and(|beyond| height(&triangle.plane(), beyond.as_dvec3()) > most)
    };
    edges().find(dents).map(|(edge, _)| edge)
}

/// Whether a vertex lies above the plane of a triangle by more than rounding.
fn is_dented(positions: &[Vec3], indices: &[u32]) -> bool {
    let most = DENT * largest(positions, indices);
    corners(positions, indices).take(MOST_PROBED).map(Triangle::new).any(|triangle| {
        let plane = triangle.plane();
        let above = |corner: Vec3| height(&plane, corner.as_dvec3()) > most;
        !triangle.is_sliver(most) && corners(positions, indices).flatten().any(above)
    })
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
    fn reach(&self, plane: &DVec4) -> f64 {
        self.corners.iter().map(|&corner| height(plane, corner).abs()).fold(0.0, f64::max)
    }

    /// Returns the plane through the first corner.
    fn plane(&self) -> DVec4 {
        through(self.corners[0], self.area)
    }

    /// Whether the corners are so nearly collinear that the normal is only rounding error.
    fn is_sliver(&self, tolerance: f64) -> bool {
        let [a, b, c] = self.corners;
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        2.0 * self.area.length() <= tolerance * longest
    }
}

/// Returns the facet of each triangle, numbered by first appearance. The largest triangles come
/// first, because their planes are the most accurate.
fn group(triangles: &[Triangle], tolerance: f64, most: usize) -> Option<Vec<u32>> {
    let mut order: Vec<usize> = (0..triangles.len()).collect();
    order.sort_by(|&a, &b| triangles[b].area.length().total_cmp(&triangles[a].area.length()));
    let mut seeds: Vec<DVec4> = Vec::new();
    let mut seed_of_triangle = vec![0; triangles.len()];
    for index in order {
        let triangle = &triangles[index];
        let sliver = triangle.is_sliver(tolerance);
        // The opposite facet of a thin plate lies as near, but faces the other way.
        let alike = |plane: &DVec4| sliver || plane.truncate().dot(triangle.area) > 0.5 * triangle.area.length();
        let near = seeds.iter().enumerate().map(|(seed, plane)| (seed, plane, triangle.reach(plane)));
        let fitting = near.filter(|(_, plane, reach)| *reach <= tolerance && alike(plane));
        seed_of_triangle[index] = match fitting.min_by(|a, b| a.2.total_cmp(&b.2)) {
            Some((seed, ..)) => seed,
            None if sliver || seeds.len() == most => return None,
            None => {
                seeds.push(triangle.plane());
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
fn fit(triangles: &[Triangle], face_of_triangle: &[u32]) -> Vec<DVec4> {
    let count = face_of_triangle.iter().max().map_or(0, |last| *last as usize + 1);
    let mut normals = vec![DVec3::ZERO; count];
    for (triangle, &face) in triangles.iter().zip(face_of_triangle) {
        normals[face as usize] += triangle.area;
    }
    normals.iter_mut().for_each(|normal| *normal = normal.normalize_or_zero());
    let mut heights = vec![(f64::INFINITY, f64::NEG_INFINITY); count];
    for (triangle, &face) in triangles.iter().zip(face_of_triangle) {
        let face = face as usize;
        for corner in triangle.corners {
            let height = normals[face].dot(corner);
            heights[face] = (heights[face].0.min(height), heights[face].1.max(height));
        }
    }
    let planes = normals.into_iter().zip(heights);
    planes.map(|(normal, (least, greatest))| normal.extend(0.5 * (least + greatest))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a cube from -1 to 1, two triangles a side.
    fn cube() -> (Vec<Vec3>, Vec<u32>) {
        let corner = |index: u32| {
            let sign = |bit: u32| if index >> bit & 1 == 0 { -1.0 } else { 1.0 };
            Vec3::new(sign(0), sign(1), sign(2))
        };
        let sides = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let indices = sides.iter().flat_map(|[a, b, c, d]| [*a, *b, *c, *a, *c, *d]);
        ((0..8).map(corner).collect(), indices.collect())
    }

    #[test]
    fn a_cube_has_six_facets_of_two_triangles() {
        let (positions, indices) = cube();
        let facets = Facets::of_mesh(&positions, &indices, 6).expect("convex");
        assert_eq!(facets.face_of_triangle, [0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5]);
        let expected = [DVec3::NEG_X, DVec3::X, DVec3::NEG_Y, DVec3::Y, DVec3::NEG_Z, DVec3::Z];
        assert_eq!(facets.planes, expected.map(|normal| normal.extend(1.0)));
        assert_eq!(Facets::of_mesh(&positions, &indices, 5), None);
        assert_eq!(Facets::obstacle(&positions, &indices, 5), NoFacets::TooMany(5));
    }

    #[test]
    fn what_has_no_facets_says_where() {
        let (mut positions, mut indices) = cube();
        // The diagonal of the first side, drawn inwards at one end.
        positions[0] = Vec3::splat(-0.5);
        assert_eq!(Facets::of_mesh(&positions, &indices, 64), None);
        let NoFacets::Dented { edge } = Facets::obstacle(&positions, &indices, 64) else { panic!("a dent") };
        assert!(edge.iter().all(|end| positions.contains(end)), "{edge:?}");
        positions[0] = Vec3::splat(-1.0);
        indices.truncate(33);
        let NoFacets::Open { edge } = Facets::obstacle(&positions, &indices, 64) else { panic!("open") };
        assert!(edge.iter().all(|end| end.z == 1.0), "{edge:?}");
        let (far, twice) = cube();
        positions.extend(far.iter().map(|corner| *corner + 4.0));
        indices = twice.iter().chain(twice.iter().map(|index| index + 8).collect::<Vec<_>>().iter()).copied().collect();
        assert_eq!(Facets::obstacle(&positions, &indices, 64), NoFacets::Parts);
        assert!(NoFacets::Parts.to_string().contains("several parts"));
    }
}
