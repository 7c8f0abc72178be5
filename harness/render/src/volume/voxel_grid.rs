//! A cube of cubic voxels around a body, shared by the passes over voxels.

use crate::frame::record::Record;
use glam::{UVec3, Vec3};
use lapidary_scene::Bounds;
use lapidary_scene::solver::{LEAST_CELLS, MOST_CELLS, MULTIPLE};

/// A cube of `cells`³ voxels. Voxel (x, y, z) has the number x + `cells` (y + `cells` z).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VoxelGrid {
    /// The corner with the smallest coordinates, in world units.
    pub origin: Vec3,
    /// Edge of a voxel in world units, above 0.
    pub spacing: f32,
    /// Voxels along each edge: a multiple of [`MULTIPLE`] from [`LEAST_CELLS`] to [`MOST_CELLS`].
    pub cells: u32,
}

impl VoxelGrid {
    /// Returns a grid centred on a body in `bounds`, with one voxel free on each side of its
    /// longest extent.
    ///
    /// # Panics
    /// If `cells` is not a value that [`VoxelGrid::cells`] allows.
    #[must_use]
    pub fn about(bounds: Bounds, cells: u32) -> Self {
        assert!((LEAST_CELLS..=MOST_CELLS).contains(&cells) && cells.is_multiple_of(MULTIPLE), "{cells} voxels");
        let extent = (bounds.max - bounds.min).max_element();
        // A point, or an empty body, still gets voxels of some size.
        let extent = if extent > 0.0 { extent } else { 1.0 };
        let spacing = extent / (cells - 2) as f32;
        // Far from the origin, corners are rounded. If the rounding is a large part of the voxel
        // that must stay free, the grid is enlarged by that much.
        let rounded = 4.0 * f32::EPSILON * bounds.min.abs().max(bounds.max.abs()).max_element();
        let spacing = if rounded > 0.25 * spacing { (extent + rounded) / (cells - 2) as f32 } else { spacing };
        Self { origin: bounds.centre() - 0.5 * cells as f32 * spacing, spacing, cells }
    }

    /// Fills a `VoxelizationGrid` of the recipes.
    pub(crate) fn fill(&self, record: Record) -> Record {
        let Self { origin, spacing, cells } = *self;
        record.with("origin", origin).with("spacing", spacing).with("cells", cells)
    }

    /// Number of voxels.
    #[must_use]
    pub fn count(&self) -> usize {
        (self.cells as usize).pow(3)
    }

    /// Returns a voxel's number.
    #[must_use]
    pub fn index(&self, voxel: UVec3) -> usize {
        let [x, y, z] = voxel.to_array().map(|part| part as usize);
        x + self.cells as usize * (y + self.cells as usize * z)
    }

    /// Returns the voxel with this number.
    #[must_use]
    pub fn voxel(&self, index: usize) -> UVec3 {
        let index = index as u32;
        UVec3::new(index % self.cells, index / self.cells % self.cells, index / self.cells / self.cells)
    }

    /// Returns a voxel's centre, in world units.
    #[must_use]
    pub fn centre(&self, voxel: UVec3) -> Vec3 {
        self.origin + (voxel.as_vec3() + 0.5) * self.spacing
    }

    /// Number of words in a row along x, one bit per voxel, the lowest bit first: row (y, z) begins
    /// at this times (y + `cells` z).
    #[must_use]
    pub fn words_per_row(&self) -> u32 {
        self.cells.div_ceil(u32::BITS)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_body_has_a_voxel_free_about_it() {
        let bounds = Bounds { min: Vec3::new(-1.0, 2.0, 3.0), max: Vec3::new(6.0, 4.0, 3.5) };
        let grid = VoxelGrid::about(bounds, 16);
        assert_eq!((grid.spacing, grid.count(), grid.words_per_row()), (0.5, 4096, 1));
        assert_eq!(grid.origin, Vec3::new(-1.5, -1.0, -0.75));
        let voxel = UVec3::new(3, 14, 9);
        assert_eq!(grid.voxel(grid.index(voxel)), voxel);
        assert_eq!(grid.centre(UVec3::ZERO), Vec3::new(-1.25, -0.75, -0.5));
    }

    #[test]
    fn a_point_has_a_grid() {
        assert!(VoxelGrid::about(Bounds { min: Vec3::ONE, max: Vec3::ONE }, 64).spacing > 0.0);
    }
}
