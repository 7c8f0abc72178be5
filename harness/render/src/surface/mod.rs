//! Bodies that are shaded at their surface alone: opaque ones, and scattering ones by how far light spreads along it.

pub(crate) mod blur;
pub mod cdrf;
mod lit;
mod reflectance;
pub mod texture_diffusion;
pub(crate) mod translucent;
