//! Translucent stone by diffusion: the pass of the recipe `diffusion_shading`, and those that compute
//! the fluence that it looks up, each frame on the device: cells, the lights' maps, the source, and
//! multigrid.

mod bodies;
mod cells;
mod levels;
mod matter;
mod pass;
mod reading;
mod source;
mod tiles;

pub(crate) use bodies::Diffusions;
pub(crate) use pass::pass;

#[cfg(test)]
mod tests;
