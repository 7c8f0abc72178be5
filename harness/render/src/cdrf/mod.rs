//! The curvature-dependent reflectance's lookup table: baked on the GPU, kept in a texture's format, looked up.

pub mod table;
