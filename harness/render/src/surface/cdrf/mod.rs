//! The lookup table of the curvature-dependent reflectance: baked on the GPU, stored in a texture's
//! format, looked up.

mod bake;
pub mod table;
