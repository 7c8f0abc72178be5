//! Clear stones: their facets, materials and rays, and the passes that draw them.

pub(crate) mod body;
pub(crate) mod deferred;
pub(crate) mod facet_map;
pub(crate) mod footprint;
pub(crate) mod gem;
pub(crate) mod geometry;
pub(crate) mod material;
pub mod restraint;
pub(crate) mod wavelengths;
