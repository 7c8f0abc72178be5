//! What materials of all bodies have in common: their images, and the law by which scattering matter sends light back.

pub(crate) mod scattering_law;
pub(crate) mod textures;
