//! Every formula of the cookbook, one file a module: WGSL function, mirror and oracle bound by name, with the domain,
//! its edges, invariants and hard cases.

mod absorption;
mod bvh_trace;
mod cdrf;
mod closest_point;
mod convex_trace;
mod curvature;
mod dispersion;
mod environment;
mod fresnel;
mod microfacet;
mod optical_path;
pub mod outside;
mod proxy_geometry;
mod random_walk;
mod reflective_shadow_map;
mod refraction;
mod srgb;
mod texture_diffusion;
mod veins;
mod voxelization;

use lapidary_assay::formula::Formula;
use std::sync::OnceLock;

/// All formulas, in the order of their modules' names and of each file.
pub fn all() -> &'static [Formula] {
    static FORMULAS: OnceLock<Vec<Formula>> = OnceLock::new();
    FORMULAS.get_or_init(|| {
        [
            absorption::formulas(),
            bvh_trace::formulas(),
            cdrf::formulas(),
            closest_point::formulas(),
            convex_trace::formulas(),
            curvature::formulas(),
            dispersion::formulas(),
            environment::formulas(),
            fresnel::formulas(),
            microfacet::formulas(),
            optical_path::formulas(),
            proxy_geometry::formulas(),
            random_walk::formulas(),
            reflective_shadow_map::formulas(),
            refraction::formulas(),
            srgb::formulas(),
            texture_diffusion::formulas(),
            veins::formulas(),
            voxelization::formulas(),
        ]
        .into_iter()
        .flatten()
        .collect()
    })
}

/// The formula of a WGSL function.
pub fn of_function(function: &str) -> Option<&'static Formula> {
    all().iter().find(|formula| formula.function == function)
}

/// Passes where `value` lies within `bound` of `wanted`; the message says by how much it does not.
fn near(what: &str, value: f64, wanted: f64, bound: f64) -> Result<(), String> {
    // Written so that a NaN does not pass.
    if (value - wanted).abs() <= bound { Ok(()) } else { Err(format!("{what} is {value}, not {wanted} ± {bound:e}")) }
}
