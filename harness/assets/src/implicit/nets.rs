//! Surface nets: one vertex in each cell that the surface passes through, and one quadrilateral
//! around each grid edge that it crosses.

use super::{Grid, gradient};
use glam::DVec3;
use lapidary_scene::Mesh;
use rayon::prelude::*;
use std::collections::HashMap;

/// Number of passes that move vertices along the surface towards the mean of their neighbours.
const RELAXATIONS: usize = 12;
/// Fraction of the way to that mean.
const STRENGTH: f64 = 0.5;
/// Largest number of steps of Newton's method back to the surface. From within a cell three or four
/// suffice.
const STEPS: usize = 10;
/// Step length, in cell widths, below which the iteration stops.
const CONVERGED: f64 = 1e-7;
/// Half the distance over which a gradient is taken, in cell widths.
const DIFFERENCE: f64 = 1e-3;

/// Returns the surface where `field` is 0, in triangles about as wide as the grid's cells. Vertices
/// lie on it to the precision of f32 and carry its normals.
///
/// Anything that reaches the outermost corners of the grid is cut off there. The mesh is closed. If
/// several surfaces pass through one cell, each has its own vertex there, so that hardly any edge
/// is shared by more than two triangles. The same field and grid give the same mesh.
#[must_use]
pub fn surface(field: &(dyn Fn(DVec3) -> f64 + Sync), grid: &Grid) -> Mesh {
    let mut net = Net::new(field, grid);
    net.project(field);
    for _ in 0..RELAXATIONS {
        net.relax(field);
        net.project(field);
    }
    net.mesh(field)
}

type Field<'a> = &'a (dyn Fn(DVec3) -> f64 + Sync);

struct Net {
    /// Vertices, in the order of the cells.
    vertices: Vec<Vertex>,
    /// Vertex indices, counter-clockwise seen from outside.
    quads: Vec<[usize; 4]>,
}

struct Vertex {
    position: DVec3,
    /// Width of the cell that the vertex belongs to.
    width: f64,
}

impl Net {
    fn new(field: Field<'_>, grid: &Grid) -> Self {
        let corners = grid.corners();
        let number = |[x, y, z]: [usize; 3]| (y * corners[2] + z) * corners[0] + x;
        let outermost = |place: [usize; 3]| (0..3).any(|k| place[k] == 0 || place[k] + 1 == corners[k]);
        let value = |place| if outermost(place) { f64::INFINITY } else { field(grid.place(place)) };
        let values: Vec<f64> = all(corners).collect::<Vec<_>>().into_par_iter().map(value).collect();
        let inside = |place| values[number(place)] < 0.0;

        let mut net = Self { vertices: Vec::new(), quads: Vec::new() };
        // By cell number: for each edge of the cell, the vertex of the surface that crosses it.
        let mut vertex_of: HashMap<usize, [usize; 12]> = HashMap::new();
        for cell in all(corners.map(|count| count - 1)) {
            let corner = |corner: usize| [0, 1, 2].map(|k| cell[k] + (corner >> k & 1));
            let within = [0, 1, 2, 3, 4, 5, 6, 7].map(|number| inside(corner(number)));
            let surfaces = surfaces(within);
            let mut vertices = [usize::MAX; 12];
            for first in (0..12).filter(|&edge| surfaces[edge] == Some(edge)) {
                let edges = (0..12).filter(|&edge| surfaces[edge] == Some(first));
                let crossings = edges.clone().map(|edge| {
                    let [from, to] = EDGES[edge].map(corner);
                    let (a, b) = (values[number(from)], values[number(to)]);
                    // Next to the outermost corners, which count as infinitely far outside: the
                    // inner corner itself.
                    let share = if b.is_infinite() {
                        0.0
                    } else if a.is_infinite() {
                        1.0
                    } else {
                        a / (a - b)
                    };
                    grid.place(from).lerp(grid.place(to), share)
                });
                let position = crossings.sum::<DVec3>() / edges.clone().count() as f64;
                edges.for_each(|edge| vertices[edge] = net.vertices.len());
                net.vertices.push(Vertex { position, width: grid.width(cell) });
            }
            if surfaces.iter().any(Option::is_some) {
                vertex_of.insert(number(cell), vertices);
            }
        }
        for from in all(corners) {
            for axis in (0..3).filter(|&axis| from[axis] + 1 < corners[axis]) {
                let mut to = from;
                to[axis] += 1;
                if inside(from) == inside(to) {
                    continue;
                }
                // Edges on the grid's boundary are never crossed, so this edge has four cells
                // around it, here counter-clockwise as seen from its far end.
                let about = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[across, beyond]| {
                    let (second, third) = ((axis + 1) % 3, (axis + 2) % 3);
                    let mut cell = from;
                    cell[second] -= 1 - across;
                    cell[third] -= 1 - beyond;
                    let corner = (1 - across) << second | (1 - beyond) << third;
                    vertex_of[&number(cell)][4 * axis + place_of(corner, axis)]
                });
                let [a, b, c, d] = about;
                net.quads.push(if inside(from) { about } else { [d, c, b, a] });
            }
        }
        net
    }

    /// Moves all vertices onto the surface, none by more than a cell's width.
    fn project(&mut self, field: Field<'_>) {
        self.vertices.par_iter_mut().for_each(|Vertex { position, width }| {
            let start = *position;
            for _ in 0..STEPS {
                let slope = gradient(field, *position, DIFFERENCE * *width);
                let step = field(*position) / slope.length_squared().max(f64::MIN_POSITIVE) * slope;
                *position = start + (*position - step.clamp_length_max(0.5 * *width) - start).clamp_length_max(*width);
                if step.length() < CONVERGED * *width {
                    break;
                }
            }
        });
    }

    /// Moves all vertices along the surface towards the mean of their neighbours.
    fn relax(&mut self, field: Field<'_>) {
        let mut sums = vec![(DVec3::ZERO, 0.0); self.vertices.len()];
        for quad in &self.quads {
            for k in 0..4 {
                let neighbours = [quad[(k + 1) % 4], quad[(k + 3) % 4]];
                for neighbour in neighbours {
                    let (sum, count) = &mut sums[quad[k]];
                    *sum += self.vertices[neighbour].position;
                    *count += 1.0;
                }
            }
        }
        for (Vertex { position, width }, (sum, count)) in self.vertices.iter_mut().zip(sums) {
            let normal = gradient(field, *position, DIFFERENCE * *width).normalize_or_zero();
            let way = sum / count - *position;
            *position += STRENGTH * (way - way.dot(normal) * normal);
        }
    }

    fn mesh(&self, field: Field<'_>) -> Mesh {
        let normal = |vertex: &Vertex| {
            let slope = gradient(field, vertex.position, DIFFERENCE * vertex.width);
            slope.try_normalize().unwrap_or(DVec3::Y).as_vec3()
        };
        let mut mesh = Mesh {
            positions: self.vertices.iter().map(|vertex| vertex.position.as_vec3()).collect(),
            normals: self.vertices.iter().map(normal).collect(),
            ..Mesh::default()
        };
        for &[a, b, c, d] in &self.quads {
            let place = |vertex: usize| self.vertices[vertex].position;
            let sharpest = |triangles: [[usize; 3]; 2]| {
                triangles.iter().map(|corners| least_angle(corners.map(place))).fold(f64::INFINITY, f64::min)
            };
            let (one, other) = ([[a, b, c], [a, c, d]], [[b, c, d], [b, d, a]]);
            let chosen = if sharpest(one) >= sharpest(other) { one } else { other };
            mesh.indices.extend(chosen.as_flattened().iter().map(|&vertex| vertex as u32));
        }
        mesh
    }
}

/// Returns the smallest angle of a triangle, in radians.
fn least_angle(corners: [DVec3; 3]) -> f64 {
    let angle = |k: usize| (corners[(k + 1) % 3] - corners[k]).angle_between(corners[(k + 2) % 3] - corners[k]);
    angle(0).min(angle(1)).min(angle(2))
}

/// Edges of a cell, four along each axis, as pairs of corners whose bits are x, y and z.
const EDGES: [[usize; 2]; 12] =
    [[0, 1], [2, 3], [4, 5], [6, 7], [0, 2], [1, 3], [4, 6], [5, 7], [0, 4], [1, 5], [2, 6], [3, 7]];

/// Returns which of the four edges along an axis begins at this corner.
fn place_of(corner: usize, axis: usize) -> usize {
    let [low, high] = [[1, 2], [0, 2], [0, 1]][axis];
    (corner >> low & 1) | (corner >> high & 1) << 1
}

/// Returns all triples below the given counts; x varies fastest, then z.
fn all([columns, levels, rows]: [usize; 3]) -> impl Iterator<Item = [usize; 3]> {
    (0..levels).flat_map(move |y| (0..rows).flat_map(move |z| (0..columns).map(move |x| [x, y, z])))
}

/// For each edge of a cell that a surface crosses, returns the first edge that the same surface
/// crosses, given which corners are `within` the body. Across a face whose corners alternate
/// between inside and outside, the inside corners are kept apart, so that both cells agree on their
/// common face.
fn surfaces(within: [bool; 8]) -> [Option<usize>; 12] {
    let crossed = |edge: usize| within[EDGES[edge][0]] != within[EDGES[edge][1]];
    let mut first: [Option<usize>; 12] = std::array::from_fn(|edge| crossed(edge).then_some(edge));
    for face in 0..6 {
        let (axis, side) = (face / 2, face % 2);
        let on_face = |edge: &usize| EDGES[*edge].iter().all(|corner| corner >> axis & 1 == side);
        let edges: Vec<usize> = (0..12).filter(on_face).filter(|&edge| crossed(edge)).collect();
        for (k, &one) in edges.iter().enumerate() {
            for &other in &edges[k + 1..] {
                let common = EDGES[one].iter().any(|corner| within[*corner] && EDGES[other].contains(corner));
                if edges.len() == 2 || common {
                    let (kept, gone) = (first[one].min(first[other]), first[one].max(first[other]));
                    first.iter_mut().filter(|surface| **surface == gone).for_each(|surface| *surface = kept);
                }
            }
        }
    }
    first
}
