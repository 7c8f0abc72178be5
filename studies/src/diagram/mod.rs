//! Diagrams of the techniques that are geometry, drawn from the cookbook's own functions: a ray bends as
//! `refraction` bends it, and a voxel is filled if `voxelization` fills it. So a diagram cannot say what the code
//! doesn't do.

mod label;
pub mod legible;
pub mod number;
pub mod plane;
pub mod scene;

mod bvh_trace;
mod closest_point;
mod convex_trace;
mod convex_walk;
mod curvature;
mod dispersion;
mod half_space;
mod optical_path;
mod proxy_geometry;
mod ray_footprint;
mod reflective_shadow_map;
mod refraction;
mod screen_trace;
mod sheet;
mod voxelization;

pub use sheet::Diagram;

/// Every diagram.
#[must_use]
pub fn all() -> &'static [Diagram] {
    ALL
}

const ALL: &[Diagram] = &[
    refraction::DIAGRAM,
    dispersion::DIAGRAM,
    closest_point::DIAGRAM,
    proxy_geometry::DIAGRAM,
    convex_trace::DIAGRAM,
    convex_walk::DIAGRAM,
    bvh_trace::DIAGRAM,
    reflective_shadow_map::DIAGRAM,
    voxelization::DIAGRAM,
    optical_path::DIAGRAM,
    half_space::DIAGRAM,
    curvature::DIAGRAM,
    screen_trace::DIAGRAM,
    ray_footprint::DIAGRAM,
];

#[cfg(test)]
mod tests;
