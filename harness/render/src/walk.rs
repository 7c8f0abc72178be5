//! The facets of a convex stone about a point inside it, and their map by direction.

use glam::{DVec3, Vec3, Vec4Swizzles as _};
use lapidary_convex_walk::FacetMap;
use lapidary_scene::{Convex, Mesh};

/// A convex stone in its own coordinates, in which a walk is exact to its own last places however
/// far it lies from the world's origin.
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
        let mut convex = Convex::of_mesh(mesh).ok_or_else(|| lapidary_scene::convex::obstacle(mesh))?;
        let sum: DVec3 = mesh.positions.iter().map(|position| position.as_dvec3()).sum();
        let centre = (sum / mesh.positions.len().max(1) as f64).as_vec3();
        for plane in &mut convex.planes {
            let height = f64::from(plane.w) - plane.xyz().as_dvec3().dot(centre.as_dvec3());
            plane.w = height as f32;
        }
        let side = FacetMap::usual_side(convex.planes.len());
        let map =
            FacetMap::of_planes(&convex.planes, side).map_err(|error| format!("has no map of facets: {error}"))?;
        Ok(Self { convex, map, centre })
    }
}
