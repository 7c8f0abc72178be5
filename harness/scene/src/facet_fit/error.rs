//! Why a mesh is no cut stone whose facets can be recovered.

use thiserror::Error;

use crate::polyhedron::MAX_PLANES;

/// Why the facets of a mesh cannot be recovered, as the end of a sentence about it.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum NotRecovered {
    /// The points span no volume.
    #[error("is flat")]
    Flat,
    /// The mesh has colours or texture coordinates that the recovered facets would lose.
    #[error("has colours or images, which new facets would lose")]
    Painted,
    /// The convex hull holds more than the mesh.
    #[error("is not convex: {:.1} % of its convex hull is outside it", 100.0 * share)]
    Hollowed {
        /// Share of the hull's volume outside the mesh.
        share: f64,
    },
    /// A corner lies deep inside the convex hull.
    #[error("is not convex: a corner lies {:.1} % of its size below its convex hull", 100.0 * depth)]
    Dented {
        /// Depth of the corner, as a share of the diagonal of the bounds.
        depth: f64,
    },
    /// The mesh is larger than that of any cut stone.
    #[error("has more triangles than a cut stone")]
    Large,
    /// No tolerance groups the triangles into few facets.
    #[error("has no facets that are few and plane: it is round, or has more than {MAX_PLANES}")]
    Round,
    /// The facets differ more from the mesh than from planes.
    #[error("is no solid of its facets: a corner would move by {:.2} % of its size", 100.0 * moved)]
    Unlike {
        /// Distance by which a corner would move, as a share of the diagonal of the bounds.
        moved: f64,
    },
    /// The planes enclose nothing.
    #[error("is no solid of its facets: they leave a side open")]
    Open,
    /// Tolerances do not agree on the facets, which are not those of the mesh.
    #[error("has no certain facets: {:.0} % of its area would be turned by more than 5°", 100.0 * share)]
    Turned {
        /// Share of the mesh's area.
        share: f64,
    },
}

impl NotRecovered {
    /// Whether the mesh is nearly convex, with facets.
    #[must_use]
    pub fn is_nearly(&self) -> bool {
        matches!(self, Self::Dented { .. } | Self::Unlike { .. } | Self::Turned { .. })
    }
}
