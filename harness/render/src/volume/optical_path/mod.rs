//! Translucent stone: the pass of the recipe `optical_path_shading`, and the stages that compute
//! its costs each frame on the device: voxels, reflective shadow maps, seeds and a solver.

mod bodies;
mod pass;
mod reading;
mod seeds;

pub(crate) use bodies::OpticalPaths;
pub(crate) use pass::pass;
