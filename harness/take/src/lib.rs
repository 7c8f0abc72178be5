//! Shaders to take: copied, as text or in another language, and listed. Needs no device, no scene and no picture, so that
//! one who only copies builds little.

pub mod copy;
pub mod list;
