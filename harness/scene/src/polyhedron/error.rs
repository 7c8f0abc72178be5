//! Why planes do not make a polyhedron.

use thiserror::Error;

/// Largest number of planes that [`Polyhedron::from_planes`](super::Polyhedron::from_planes) takes: as many as a map of facets can
/// number.
pub const MAX_PLANES: usize = lapidary_convex_walk::CONVEX_WALK_FACE as usize + 1;

/// Why planes do not make a polyhedron.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum PolyhedronError {
    /// A plane without a direction, or with a component that is not a number.
    #[error("plane {plane} has a zero or non-finite normal or distance; give it a direction")]
    BadPlane {
        /// Index of the plane in the list, from 0.
        plane: usize,
    },
    /// Too many planes: the time grows with the square of their number.
    #[error("{planes} planes are too many for one stone; use at most {MAX_PLANES}")]
    TooManyPlanes {
        /// Number of planes given.
        planes: usize,
    },
    /// No corner lies on the inner side of all planes, or all corners lie in one plane.
    #[error(
        "the planes enclose nothing: they leave no volume or never meet at a corner; \
         move them outwards or add the missing sides"
    )]
    Empty,
    /// A face has an edge without a neighbouring face.
    #[error("the planes leave an open side; add planes until the solid is closed")]
    Unbounded,
}
