//! The parts of a frame, in their order.

/// A part of a frame that follows light's ways through bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Bodies are made voxels, and their densities found where they differ.
    Voxels,
    /// Reflective shadow maps are drawn.
    Maps,
    /// Costs are cleared, and seeded from the maps.
    Seeds,
    /// The solver's passes.
    Solve,
    /// The bodies are drawn.
    Shade,
}

impl Stage {
    /// All of them, in their order.
    pub const ALL: [Self; 5] = [Self::Voxels, Self::Maps, Self::Seeds, Self::Solve, Self::Shade];

    /// In tables.
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
