//! The recipes `optical_path_sweep` and `optical_path_tiles`: least optical depths through a body of voxels, solved on the device.

mod method;
mod solver;

pub use method::{Method, Stencil, UnknownMethod};
pub use solver::{Solver, Status};
