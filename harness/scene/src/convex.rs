//! The facet planes of a convex mesh in the form that shaders and references use.

use glam::{DVec4, Vec3, Vec4};
pub use lapidary_convex_trace::facets::TOLERANCE;
use lapidary_convex_trace::{Facets, NoFacets};

use super::polyhedron::{MAX_PLANES, Plane};
use super::{Mesh, MeshDiagnosis};

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
        Self::about(Vec3::ZERO, mesh)
    }

    /// Returns the same with distances from `centre`, which are as exact as the stone is large,
    /// however far it lies from the origin.
    #[must_use]
    pub fn about(centre: Vec3, mesh: &Mesh) -> Option<Self> {
        let facets = facets(mesh)?;
        let centre = centre.as_dvec3();
        let about = |plane: &DVec4| plane.truncate().extend(plane.w - plane.truncate().dot(centre)).as_vec4();
        let planes = facets.planes.iter().map(about).collect();
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
        } else if Facets::of_closed(&mesh.positions, &mesh.indices, MAX_PLANES).is_some() {
            Self::Convex
        } else {
            Self::Concave
        }
    }
}

/// Returns the facets of a closed convex mesh.
fn facets(mesh: &Mesh) -> Option<Facets> {
    Facets::of_mesh(&mesh.positions, &mesh.indices, MAX_PLANES)
}

/// Returns the facet planes of a closed convex mesh, in the order of their first triangles.
///
/// `None` if a vertex lies outside a plane by more than [`TOLERANCE`], an edge has no triangle on
/// its other side, a triangle points inwards, or there are more than [`MAX_PLANES`] facets.
#[must_use]
pub fn planes_of_convex(mesh: &Mesh) -> Option<Vec<Plane>> {
    let plane = |plane: &DVec4| Plane { normal: plane.truncate(), distance: plane.w };
    facets(mesh).map(|facets| facets.planes.iter().map(plane).collect())
}

/// Returns why a mesh has no planes, as the end of a sentence: ``is not convex``.
#[must_use]
pub fn obstacle(mesh: &Mesh) -> String {
    let faults = MeshDiagnosis::of(mesh);
    let obstacle = Facets::obstacle(&mesh.positions, &mesh.indices, MAX_PLANES);
    if faults.is_solid() {
        return obstacle.to_string();
    }
    let place = match obstacle {
        NoFacets::Open { edge: [from, to] } if !faults.is_flat => format!("; see the edge from {from} to {to}"),
        _ => String::new(),
    };
    format!("is no closed solid ({}{place})", faults.clauses().join(", "))
}

/// Whether each directed edge has its opposite. Vertices at one position count as one, whatever
/// their normals.
pub(super) fn is_closed(mesh: &Mesh) -> bool {
    lapidary_convex_trace::facets::is_closed(&mesh.positions, &mesh.indices)
}

#[cfg(test)]
mod tests;
