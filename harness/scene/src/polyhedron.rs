//! A convex polyhedron from the planes of its facets, in f64 and z up.

use glam::{DVec3, Vec3, Vec4};

use super::mesh::Mesh;
use super::normals::{Averaging, NormalSum, interior_angle};
use assembly::{corners, ordered_loop, tolerance, unit_planes, without_repeats};

mod assembly;
mod error;
mod plane;
mod triangulation;

pub use error::{MAX_PLANES, PolyhedronError};
pub use plane::Plane;
pub use triangulation::Triangulation;

/// A bounded convex polyhedron. Faces wind counter-clockwise seen from outside.
#[derive(Debug, Clone, PartialEq)]
pub struct Polyhedron {
    planes: Vec<Plane>,
    vertices: Vec<DVec3>,
    faces: Vec<Vec<usize>>,
}

impl Polyhedron {
    /// Returns the intersection of the half-spaces of `planes`.
    ///
    /// Planes that bound no face, and repeated planes, are dropped; the others keep their order.
    /// The tolerance is relative to the largest distance of a plane from the origin, so the solid
    /// should lie around the origin.
    ///
    /// # Errors
    /// Returns a [`PolyhedronError`] if the planes are invalid, enclose nothing or leave a side
    /// open.
    pub fn from_planes(planes: &[Plane]) -> Result<Self, PolyhedronError> {
        if planes.len() > MAX_PLANES {
            return Err(PolyhedronError::TooManyPlanes { planes: planes.len() });
        }
        let planes = unit_planes(planes)?;
        let tolerance = tolerance(&planes);
        let planes = without_repeats(planes, tolerance);
        let corners = corners(&planes, tolerance);

        let mut faces = Vec::new();
        let mut facets = Vec::new();
        for plane in planes {
            let touched: Vec<usize> =
                (0..corners.len()).filter(|&k| plane.height(corners[k]).abs() <= tolerance).collect();
            if touched.len() >= 3 {
                faces.push(ordered_loop(plane.normal, touched, &corners, tolerance));
                facets.push(plane);
            }
        }
        if faces.is_empty() {
            return Err(PolyhedronError::Empty);
        }
        let polyhedron = Self::with_used_vertices(facets, &corners, faces);
        match polyhedron.is_closed() {
            false => Err(PolyhedronError::Unbounded),
            true if polyhedron.faces.len() < 4 => Err(PolyhedronError::Empty),
            true => Ok(polyhedron),
        }
    }

    fn with_used_vertices(planes: Vec<Plane>, corners: &[DVec3], faces: Vec<Vec<usize>>) -> Self {
        let mut new_index = vec![None; corners.len()];
        let mut vertices = Vec::new();
        let faces = faces
            .into_iter()
            .map(|face| {
                let renumbered = face.into_iter().map(|corner| {
                    *new_index[corner].get_or_insert_with(|| {
                        vertices.push(corners[corner]);
                        vertices.len() - 1
                    })
                });
                renumbered.collect()
            })
            .collect();
        Self { planes, vertices, faces }
    }

    /// Returns the planes that bound a face, in the order of [`Polyhedron::faces`], with unit
    /// normals.
    #[must_use]
    pub fn planes(&self) -> &[Plane] {
        &self.planes
    }

    /// Returns the corners, each once.
    #[must_use]
    pub fn vertices(&self) -> &[DVec3] {
        &self.vertices
    }

    /// Returns the faces as loops of indices into [`Polyhedron::vertices`], counter-clockwise seen
    /// from outside. A loop starts at its highest corner, so that equal facets all round a stone
    /// start alike and a kite is later cut along its axis.
    #[must_use]
    pub fn faces(&self) -> &[Vec<usize>] {
        &self.faces
    }

    /// Returns the number of edges; each belongs to two faces.
    #[must_use]
    pub fn edge_count(&self) -> usize {
        self.faces.iter().map(Vec::len).sum::<usize>() / 2
    }

    /// Returns the planes as `(normal, distance)` in f32, in the coordinates of
    /// [`Polyhedron::to_mesh`].
    #[must_use]
    pub fn mesh_planes(&self) -> Vec<Vec4> {
        let to_mesh = |plane: &Plane| y_up(plane.normal).extend(plane.distance as f32);
        self.planes.iter().map(to_mesh).collect()
    }

    /// Returns a mesh with shared normals, turned to glTF's y up: (x, y, z) becomes (x, z, -y).
    ///
    /// Shared normals are averaged over *faces*, so the triangulation does not change them. Each
    /// face is weighted by its interior angle, equally, or by its whole area. A face of three or
    /// four corners becomes a fan from its first corner, a larger one a fan from its centroid
    /// ([`Triangulation::Centroid`]).
    #[must_use]
    pub fn to_mesh(&self, averaging: Averaging) -> Mesh {
        self.to_mesh_with(averaging, Triangulation::Centroid)
    }

    /// [`Polyhedron::to_mesh`] with another triangulation of faces with five or more corners.
    ///
    /// The surface is the same, and so are the shared normals; vertices inside a face carry the
    /// normal of its plane. No triangulation puts a vertex on an edge, so all of them give closed
    /// meshes.
    #[must_use]
    pub fn to_mesh_with(&self, averaging: Averaging, triangulation: Triangulation) -> Mesh {
        let mut mesh = Mesh {
            positions: self.vertices.iter().copied().map(y_up).collect(),
            normals: self.vertex_normals(averaging),
            ..Mesh::default()
        };
        for (face, plane) in self.faces.iter().zip(&self.planes) {
            let ring: Vec<DVec3> = face.iter().map(|&k| self.vertices[k]).collect();
            let cut = triangulation.cut(&ring, || self.centroid(face));
            let first_inner = mesh.positions.len();
            mesh.positions.extend(cut.inner.iter().copied().map(y_up));
            mesh.normals.resize(mesh.positions.len(), y_up(plane.normal));
            let vertex = |&k: &usize| face.get(k).copied().unwrap_or_else(|| first_inner + k - face.len()) as u32;
            mesh.indices.extend(cut.triangles.iter().flatten().map(vertex));
        }
        mesh
    }

    fn vertex_normals(&self, averaging: Averaging) -> Vec<Vec3> {
        let mut sums = vec![NormalSum::default(); self.vertices.len()];
        for (face, plane) in self.faces.iter().zip(&self.planes) {
            let area = self.area_vector(face).dot(plane.normal);
            for (k, &vertex) in face.iter().enumerate() {
                let weight = match averaging {
                    Averaging::Plain => 1.0,
                    Averaging::Area => area,
                    Averaging::Angle => {
                        let previous = face[(k + face.len() - 1) % face.len()];
                        let next = face[(k + 1) % face.len()];
                        let corner = |vertex: usize| self.vertices[vertex];
                        interior_angle(corner(previous), corner(vertex), corner(next))
                    }
                };
                sums[vertex].add(y_up(plane.normal).as_dvec3(), weight);
            }
        }
        sums.into_iter().map(NormalSum::normal).collect()
    }

    /// Returns the normal of a face times its area.
    fn area_vector(&self, face: &[usize]) -> DVec3 {
        let origin = self.vertices[face[0]];
        let fan =
            face.windows(2).map(|edge| (self.vertices[edge[0]] - origin).cross(self.vertices[edge[1]] - origin) * 0.5);
        fan.sum()
    }

    /// Returns the centroid of a face's area.
    fn centroid(&self, face: &[usize]) -> DVec3 {
        let origin = self.vertices[face[0]];
        let direction = self.area_vector(face).normalize_or_zero();
        let (mut moment, mut total) = (DVec3::ZERO, 0.0);
        for edge in face.windows(2) {
            let (u, v) = (self.vertices[edge[0]] - origin, self.vertices[edge[1]] - origin);
            let area = 0.5 * u.cross(v).dot(direction);
            moment += (u + v) * (area / 3.0);
            total += area;
        }
        origin + moment / total
    }

    /// Whether each directed edge has its opposite in exactly one other face.
    fn is_closed(&self) -> bool {
        let mut edges: Vec<(usize, usize)> = Vec::with_capacity(2 * self.edge_count());
        for face in &self.faces {
            let ends = face.iter().cycle().skip(1);
            edges.extend(face.iter().copied().zip(ends.copied()).take(face.len()));
        }
        let mut opposite: Vec<_> = edges.iter().map(|&(from, to)| (to, from)).collect();
        edges.sort_unstable();
        opposite.sort_unstable();
        edges == opposite && edges.windows(2).all(|pair| pair[0] != pair[1])
    }
}

/// Converts z up to glTF's y up in f32: a quarter turn about x.
fn y_up(v: DVec3) -> Vec3 {
    Vec3::new(v.x as f32, v.z as f32, -v.y as f32)
}

#[cfg(test)]
mod tests;
