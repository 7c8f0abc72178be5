//! The triangles of a mesh by the places of their corners.

use glam::{DVec3, Vec3};

use crate::Mesh;
use crate::weld::{TOLERANCE, weld};

/// Tolerances of welding, relative to the largest coordinate: rounding, and two wider ones, of which the first counts that
/// leaves fewer edges open. The widest is a quarter of the noise that counts as a dent (2^-12).
const TOLERANCES: [f64; 3] = [TOLERANCE, 1.0 / (1 << 18) as f64, 1.0 / (1 << 14) as f64];

/// A triangle, by the numbers of its places and of its vertices in the mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Face {
    pub(super) places: [u32; 3],
    pub(super) vertices: [u32; 3],
    /// Whether its winding is other than in the mesh.
    pub(super) turned: bool,
}

impl Face {
    /// Reverses the winding.
    pub(super) fn turn(&mut self) {
        self.places.swap(1, 2);
        self.vertices.swap(1, 2);
        self.turned = !self.turned;
    }
}

/// One side of a triangle, from one place to another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct HalfEdge {
    /// The smaller number of its two places.
    pub(super) low: u32,
    /// The greater one.
    pub(super) high: u32,
    pub(super) face: u32,
    /// Which side of the triangle it is, 0 to 2.
    pub(super) side: u8,
    /// Whether it runs from low to high.
    pub(super) forward: bool,
}

impl HalfEdge {
    pub(super) fn ends(&self) -> (u32, u32) {
        (self.low, self.high)
    }

    /// 1 if it runs from low to high, else -1.
    pub(super) fn sign(&self) -> i32 {
        if self.forward { 1 } else { -1 }
    }
}

/// A welded mesh: each place stands for all vertices at that position.
#[derive(Debug)]
pub(super) struct Surface {
    pub(super) places: Vec<DVec3>,
    pub(super) faces: Vec<Face>,
    /// Distance within which vertices were taken for one.
    pub(super) tolerance: f64,
}

impl Surface {
    /// Welds a mesh by the least tolerance of [`TOLERANCES`] that leaves the fewest edges open and merges no corners of a
    /// triangle but those that rounding does. Triangles without three places are left out.
    pub(super) fn of(mesh: &Mesh) -> Self {
        let mut best = Self::within(mesh, TOLERANCES[0]);
        let mut open = best.open_edges();
        for tolerance in &TOLERANCES[1..] {
            if open == 0 {
                break;
            }
            let wider = Self::within(mesh, *tolerance);
            let left = wider.open_edges();
            if left < open && wider.faces.len() == best.faces.len() {
                (best, open) = (wider, left);
            }
        }
        best
    }

    fn within(mesh: &Mesh, relative: f64) -> Self {
        let positions = || mesh.positions.iter().map(|position| position.as_dvec3());
        let largest = positions().fold(0.0, |most: f64, position| most.max(position.abs().max_element()));
        let tolerance = relative * largest;
        let (mut places, numbers) = weld(positions(), tolerance);
        if relative > TOLERANCES[0] {
            // The middle has less noise than any.
            let mut sums = vec![(DVec3::ZERO, 0.0); places.len()];
            for (position, &number) in positions().zip(&numbers) {
                sums[number].0 += position;
                sums[number].1 += 1.0;
            }
            places.iter_mut().zip(sums).for_each(|(place, (sum, count))| *place = sum / count);
        }
        let face = |corners: &[u32]| {
            let vertices = [corners[0], corners[1], corners[2]];
            let place = |vertex: u32| numbers.get(vertex as usize).map(|&number| number as u32);
            let places = [place(vertices[0])?, place(vertices[1])?, place(vertices[2])?];
            let [a, b, c] = places;
            (a != b && b != c && c != a).then_some(Face { places, vertices, turned: false })
        };
        let faces = mesh.indices.chunks_exact(3).filter_map(face).collect();
        Self { places, faces, tolerance }
    }

    /// Returns all sides of all triangles, those of one edge together.
    pub(super) fn half_edges(&self) -> Vec<HalfEdge> {
        let sides = |(number, face): (usize, &Face)| {
            let places = face.places;
            [0, 1, 2].map(|side: usize| {
                let (from, to) = (places[side], places[(side + 1) % 3]);
                HalfEdge {
                    low: from.min(to),
                    high: from.max(to),
                    face: number as u32,
                    side: side as u8,
                    forward: from < to,
                }
            })
        };
        let mut edges: Vec<HalfEdge> = self.faces.iter().enumerate().flat_map(sides).collect();
        edges.sort_unstable();
        edges
    }

    /// Returns the number of exact positions, of corners that triangles use, beyond the number of their places.
    pub(super) fn welded(&self, mesh: &Mesh) -> usize {
        let key = |vertex: u32| (mesh.positions[vertex as usize] + 0.0).to_array().map(f32::to_bits);
        let mut exact: Vec<[u32; 3]> = self.faces.iter().flat_map(|face| face.vertices).map(key).collect();
        let mut places: Vec<u32> = self.faces.iter().flat_map(|face| face.places).collect();
        exact.sort_unstable();
        exact.dedup();
        places.sort_unstable();
        places.dedup();
        exact.len() - places.len()
    }

    fn open_edges(&self) -> usize {
        let edges = self.half_edges();
        let around = edges.chunk_by(|one, other| one.ends() == other.ends());
        around.filter(|edge| edge.iter().map(HalfEdge::sign).sum::<i32>() != 0).count()
    }

    pub(super) fn corners(&self, face: u32) -> [DVec3; 3] {
        self.faces[face as usize].places.map(|place| self.places[place as usize])
    }

    /// Returns the area vector of a triangle, times two.
    pub(super) fn across(&self, face: u32) -> DVec3 {
        let [a, b, c] = self.corners(face);
        (b - a).cross(c - a)
    }

    /// Leaves out triangles.
    pub(super) fn retain(&mut self, mut keep: impl FnMut(u32) -> bool) {
        let mut number = 0;
        self.faces.retain(|_| {
            number += 1;
            keep(number - 1)
        });
    }

    /// Returns triangles as a mesh, with the vertices of `source`, at their places.
    pub(super) fn mesh(&self, source: &Mesh, faces: &[u32]) -> Mesh {
        let mut numbers = vec![u32::MAX; if faces.is_empty() { 0 } else { source.positions.len() }];
        let mut mesh = Mesh::default();
        self.append(source, faces, &mut numbers, &mut mesh);
        mesh
    }

    /// Adds triangles to `mesh`. `numbers` holds for each vertex of `source` its number there, all [`u32::MAX`] before and
    /// after.
    pub(super) fn append(&self, source: &Mesh, faces: &[u32], numbers: &mut [u32], mesh: &mut Mesh) {
        // In the order of the source.
        let mut used: Vec<u32> = faces.iter().flat_map(|&number| self.faces[number as usize].vertices).collect();
        used.sort_unstable();
        used.dedup();
        let first = mesh.positions.len() as u32;
        for (number, &vertex) in (first..).zip(&used) {
            let vertex = vertex as usize;
            numbers[vertex] = number;
            mesh.positions.push(source.positions[vertex]);
            mesh.normals.push(source.normals.get(vertex).copied().unwrap_or(Vec3::Y));
            mesh.uvs.extend(source.uvs.get(vertex));
            mesh.colors.extend(source.colors.get(vertex));
        }
        for &number in faces {
            let Face { places, vertices, turned } = self.faces[number as usize];
            let outward = self.across(number).as_vec3();
            for (place, vertex) in places.into_iter().zip(vertices) {
                let vertex = numbers[vertex as usize] as usize;
                mesh.positions[vertex] = self.places[place as usize].as_vec3();
                // A turned triangle may bring its normals along, or have had the right ones.
                if turned && mesh.normals[vertex].dot(outward) < 0.0 {
                    mesh.normals[vertex] = -mesh.normals[vertex];
                }
                mesh.indices.push(vertex as u32);
            }
        }
        used.into_iter().for_each(|vertex| numbers[vertex as usize] = u32::MAX);
    }
}
