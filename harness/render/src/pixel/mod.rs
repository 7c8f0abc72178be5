//! The gem recipes' whole computation of one pixel in Rust, from the mirrors:
//! `wgsl/recipes/parts/gem_shading.wgsl` line by line.
//!
//! A GPU picture is compared with it pixel by pixel (`harness/cook/tests/suite/parity`). The facets
//! that each ray met are also returned, because a difference is allowed only where rays part at a
//! facet's edge.

pub mod display;
mod geometry;
mod ray;
mod seen;
mod shading;
mod surface;
mod tracing;

pub use geometry::Stone;
pub use ray::Event;
pub use seen::Pixel;
pub use shading::Shading;
pub use surface::{SurfacePoint, Viewer};
