//! The recipe `voxelize`: voxelizes a mesh on the device, anew in every frame.

mod reading;
mod voxelizer;

pub use reading::{Status, matter};
pub use voxelizer::{MOST_TRIANGLES, Voxelizer};
