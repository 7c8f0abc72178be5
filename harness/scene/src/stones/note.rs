//! What was done to the clear bodies of a scene, in words.

use std::fmt;

use crate::facet_fit::{NotRecovered, Recovered};
use crate::shells::{MOST_TRIANGLES, Mends};

/// A change to clear bodies. Each names the first body concerned, by the name in the file, and how many there are.
#[derive(Debug, Clone, PartialEq)]
pub enum StoneNote {
    /// Faults of meshes that were mended.
    Mended {
        /// Name of the first body.
        first: String,
        /// Number of bodies.
        objects: usize,
        /// What was mended of all together.
        mends: Mends,
    },
    /// Primitives of one mesh that close one another, of materials equal in all but name.
    Closed {
        /// Name of the first body.
        first: String,
        /// Number of bodies.
        objects: usize,
    },
    /// Meshes of several parts that became bodies of their own.
    Parted {
        /// Name of the first body.
        first: String,
        /// Number of bodies that were parted.
        objects: usize,
        /// Number of closed parts.
        solids: usize,
        /// Number of bodies that they became.
        bodies: usize,
        /// Whether something is left that is not closed, or of too many shapes.
        rest: bool,
    },
    /// Bodies of one shape and material that became copies.
    Joined {
        /// Name of the first body.
        first: String,
        /// Number of bodies in the file.
        bodies: usize,
        /// Number of copies that they became.
        copies: usize,
    },
    /// Stones that were convex but for rounding, and have exact facets now.
    Recovered {
        /// Name of the first body.
        first: String,
        /// Number of bodies.
        objects: usize,
        /// Fewest and most facets.
        facets: [usize; 2],
        /// Largest share of a hull's volume outside the mesh.
        volume: f64,
        /// Greatest distance by which a corner moved, as a share of the diagonal of the body's bounds.
        moved: f64,
        /// Largest angle in radians by which a facet may be turned.
        uncertainty: f64,
        /// Number of bodies whose facets were averaged over a symmetry.
        symmetric: usize,
        /// Number of bodies whose facets rounding may have parted: they are too small for its step.
        unsteady: usize,
    },
    /// Bodies whose facets were not made exact, though they are nearly convex.
    AsModelled {
        /// Name of the first body.
        first: String,
        /// Number of bodies.
        objects: usize,
        /// Why the first one was not.
        why: NotRecovered,
    },
    /// Meshes that are too large to be looked at.
    TooLarge {
        /// Name of the first body.
        first: String,
        /// Number of bodies.
        objects: usize,
    },
}

impl StoneNote {
    /// Returns the note on one recovered stone.
    pub(super) fn recovered(name: &str, recovered: &Recovered) -> Self {
        Self::Recovered {
            first: name.to_owned(),
            objects: 1,
            facets: [recovered.facets.len(); 2],
            volume: recovered.volume.max(0.0),
            moved: recovered.moved,
            uncertainty: recovered.uncertainty(),
            symmetric: usize::from(recovered.symmetry.is_some()),
            unsteady: usize::from(!recovered.is_steady),
        }
    }
}

/// Adds a note, to one of its kind if there is one; joined bodies have a note for each shape.
pub(super) fn add(notes: &mut Vec<StoneNote>, new: StoneNote) {
    if matches!(&new, StoneNote::Mended { mends, .. } if mends.is_none()) {
        return;
    }
    for note in notes.iter_mut() {
        match (note, &new) {
            (StoneNote::Mended { objects, mends, .. }, StoneNote::Mended { mends: more, .. }) => {
                *objects += 1;
                *mends += *more;
                return;
            }
            (
                StoneNote::Recovered { objects, facets, volume, moved, uncertainty, symmetric, unsteady, .. },
                StoneNote::Recovered {
                    facets: more_facets,
                    volume: more_volume,
                    moved: more_moved,
                    uncertainty: more_uncertainty,
                    symmetric: more_symmetric,
                    unsteady: more_unsteady,
                    ..
                },
            ) => {
                *objects += 1;
                *facets = [facets[0].min(more_facets[0]), facets[1].max(more_facets[1])];
                *volume = volume.max(*more_volume);
                *moved = moved.max(*more_moved);
                *uncertainty = uncertainty.max(*more_uncertainty);
                *symmetric += more_symmetric;
                *unsteady += more_unsteady;
                return;
            }
            (StoneNote::TooLarge { objects, .. }, StoneNote::TooLarge { .. })
            | (StoneNote::AsModelled { objects, .. }, StoneNote::AsModelled { .. }) => {
                *objects += 1;
                return;
            }
            (StoneNote::Closed { objects, .. }, StoneNote::Closed { objects: more, .. }) => {
                *objects += more;
                return;
            }
            (
                StoneNote::Parted { objects, solids, bodies, rest, .. },
                StoneNote::Parted { solids: more, bodies: more_bodies, rest: more_rest, .. },
            ) => {
                *objects += 1;
                *solids += more;
                *bodies += more_bodies;
                *rest |= more_rest;
                return;
            }
            _ => {}
        }
    }
    notes.push(new);
}

/// Formats ``object `ring` ``, or ``3 objects, first `ring` ``.
fn named(first: &str, count: usize) -> String {
    if count == 1 { format!("object `{first}`") } else { format!("{count} objects, first `{first}`") }
}

impl fmt::Display for StoneNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Mended { first, objects, mends } => write!(f, "{}: mesh mended: {mends}", named(first, *objects)),
            Self::Closed { first, objects } => write!(
                f,
                "{}: open, of materials equal in all but name, and closed by one another, so drawn as one",
                named(first, *objects)
            ),
            Self::Parted { first, objects, solids, bodies, rest } => {
                let rest = if *rest { ", one of them what is not closed or has no copies" } else { "" };
                let drawn = if *bodies == 1 { "1 body".to_owned() } else { format!("{bodies} bodies") };
                write!(
                    f,
                    "{}: {solids} closed part{} in one mesh, drawn as {drawn}, those of one shape as copies{rest}",
                    named(first, *objects),
                    if *solids == 1 { "" } else { "s" }
                )
            }
            Self::Joined { first, bodies, copies } => write!(
                f,
                "{}: one shape and material, turned and scaled, drawn as {copies} copies",
                named(first, *bodies)
            ),
            Self::Recovered {
                first,
                objects,
                facets: [fewest, most],
                volume,
                moved,
                uncertainty,
                symmetric,
                unsteady,
            } => {
                let facets = if fewest == most { most.to_string() } else { format!("{fewest} to {most}") };
                let by_symmetry = match symmetric {
                    0 => String::new(),
                    _ if symmetric == objects => ", averaged over its symmetry".to_owned(),
                    _ => format!(", averaged over a symmetry for {symmetric}"),
                };
                let parted = match unsteady {
                    0 => String::new(),
                    _ if unsteady == objects => ", some of which rounding may have parted".to_owned(),
                    _ => format!(", some of which rounding may have parted in {unsteady}"),
                };
                write!(
                    f,
                    "{}: convex but for rounding, drawn with {facets} exact facets{by_symmetry}{parted}: each turned by at most {:.2}°, corners \
                     moved by {:.1e} of its size, {:.2} % of the hull's volume filled",
                    named(first, *objects),
                    uncertainty.to_degrees(),
                    moved,
                    100.0 * volume
                )
            }
            Self::AsModelled { first, objects, why } => {
                write!(
                    f,
                    "{}: nearly convex, but drawn as modelled, at several times the time: {why}",
                    named(first, *objects)
                )
            }
            Self::TooLarge { first, objects } => write!(
                f,
                "{}: neither mended nor parted: more than {MOST_TRIANGLES} triangles, or too many parts; part the mesh in the program \
                 that made it",
                named(first, *objects)
            ),
        }
    }
}
