//! The stages of a frame, in order.

/// A stage of a frame that follows light's paths through bodies.
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
