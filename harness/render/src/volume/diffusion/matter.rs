//! Matter of a body, as the recipes of diffusion take it.

use crate::volume::voxel_grid::VoxelGrid;
use glam::Vec3;
use lapidary_scene::Material;

/// Extinction per voxel spacing that thinner matter counts as: without any, light does not diffuse.
const THINNEST: f32 = 1e-4;

/// Matter of a body as the recipes take it, in each channel; lengths are in voxel spacings.
#[derive(Clone, Copy, Debug)]
pub(super) struct Matter {
    /// Extinction per voxel spacing where the density is 1.
    pub(super) extinction: Vec3,
    /// The root of 1 - albedo.
    pub(super) gamma: Vec3,
    /// Index of refraction at the surface, relative to the medium outside.
    pub(super) index: f32,
}

impl Matter {
    /// Returns a material's matter on a grid, behind a surface of this index.
    pub(super) fn of(material: &Material, grid: VoxelGrid, index: f32) -> Self {
        let Some(medium) = &material.medium else {
            return Self { extinction: Vec3::splat(THINNEST), gamma: Vec3::ONE, index };
        };
        let extinction = medium.transport_extinction();
        // Where nothing scatters or absorbs, nothing is sent back either.
        let absorbed = Vec3::select(extinction.cmpgt(Vec3::ZERO), medium.absorption / extinction, Vec3::ONE);
        let extinction = (extinction * grid.spacing).max(Vec3::splat(THINNEST));
        Self { extinction, gamma: absorbed.map(f32::sqrt), index }
    }

    /// Milne's length in voxel spacings where the density is 1.
    pub(super) fn milne(&self) -> Vec3 {
        lapidary_diffusion::milne(self.index) / self.extinction
    }
}
