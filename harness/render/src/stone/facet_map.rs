//! The facets of a convex stone about a point inside it, and their map by direction.

use glam::{DVec3, Vec3};
use lapidary_convex_walk::FacetMap;
use lapidary_scene::{Convex, Mesh};

/// A convex stone with planes about its centre.
pub(crate) struct Walked {
    /// Planes about the centre.
    pub(crate) convex: Convex,
    pub(crate) map: FacetMap,
    /// The mean of the corners, which lies inside.
    pub(crate) centre: Vec3,
}

impl Walked {
    /// Returns the stone that `mesh` encloses, or why it has none: the end of a sentence.
    pub(crate) fn of_mesh(mesh: &Mesh) -> Result<Self, String> {
        let sum: DVec3 = mesh.positions.iter().map(|position| position.as_dvec3()).sum();
        let centre = (sum / mesh.positions.len().max(1) as f64).as_vec3();
        let convex = Convex::about(centre, mesh).ok_or_else(|| lapidary_scene::convex::obstacle(mesh))?;
        let map = FacetMap::of_stone(&convex.planes).map_err(|error| format!("has no map of facets: {error}"))?;
        Ok(Self { convex, map, centre })
    }
}
