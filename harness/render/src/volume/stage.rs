//! The stages of a frame that follows light through bodies on voxels, in order.

use crate::frame::Builder;
use std::ops::Range;

/// A stage of a frame that follows light through bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Voxelizes the bodies and computes their densities where these vary.
    Voxels,
    /// Draws the reflective shadow maps.
    Maps,
    /// Clears the costs and seeds them from the maps.
    Seeds,
    /// Runs the solver's passes.
    Solve,
    /// Draws the bodies.
    Shade,
}

impl Stage {
    /// All stages, in order.
    pub const ALL: [Self; 5] = [Self::Voxels, Self::Maps, Self::Seeds, Self::Solve, Self::Shade];

    /// Encodes all stages before the bodies are drawn: the maps once by `draw_maps`, each other stage by `encode` for
    /// every body, as passes of its object. Returns the range of passes of each stage.
    pub(crate) fn before_shading<B>(
        builder: &mut Builder<'_>,
        draw_maps: impl Fn(&mut Builder<'_>),
        bodies: &[B],
        name: impl Fn(&B) -> &str,
        encode: impl Fn(&B, &mut Builder<'_>, Self),
    ) -> [Range<usize>; Self::ALL.len() - 1] {
        [Self::Voxels, Self::Maps, Self::Seeds, Self::Solve].map(|stage| {
            let start = builder.frame().passes.len();
            if stage == Self::Maps {
                draw_maps(builder);
            } else {
                for body in bodies {
                    builder.of_object(name(body), |builder| encode(body, builder, stage));
                }
            }
            start..builder.frame().passes.len()
        })
    }

    /// Name of the stage in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Voxels => "voxels",
            Self::Maps => "maps",
            Self::Seeds => "seeds",
            Self::Solve => "solve",
            Self::Shade => "shade",
        }
    }
}
