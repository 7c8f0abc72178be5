//! Solvers of paths of least cost through voxels.

mod lone;
mod passes;
mod status;

pub use lone::LoneSolver;
pub use passes::{Solve, Solved, Solver};
pub use status::Status;
