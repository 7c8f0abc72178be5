//! Bodies that are shaded at their surface alone: opaque ones, and scattering ones by how far light spreads along it.

pub(crate) mod blur;
pub mod cdrf;
mod lit;
mod reflectance;
pub(crate) mod scattering_law;
pub mod texture_diffusion;
pub(crate) mod textures;
pub(crate) mod translucent;
