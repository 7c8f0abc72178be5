//! Bodies through which light is followed on voxels, by paths of least cost or by diffusion.

mod density;
pub(crate) mod diffusion;
mod light_maps;
pub(crate) mod optical_path;
pub mod solver;
pub(crate) mod stage;
pub mod voxel_grid;
pub mod voxelization;
