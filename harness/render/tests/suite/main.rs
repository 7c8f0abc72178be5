//! Tests of the renderer on a device.

mod among;
mod antialiasing;
mod bvh;
mod curvature;
mod effects_off;
mod environment_harmonics;
mod frame;
mod furnace;
mod instances;
mod metal;
mod optical_path;
mod optical_path_shading;
mod parity;
mod plan;
mod random_walk;
mod shadows;
mod texture_diffusion;
mod textures;
mod tiles;
mod vitrine;
mod voxelization;
