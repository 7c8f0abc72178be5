//! Every formula of the cookbook, by module.

use lapidary_assay::formula::Formula;
use std::sync::OnceLock;

/// All formulas, in the order of their modules' names and of each file.
pub fn all() -> &'static [Formula] {
    static FORMULAS: OnceLock<Vec<Formula>> = OnceLock::new();
    FORMULAS.get_or_init(|| {
        [
            lapidary_absorption::formulas::formulas(),
            lapidary_bvh_trace::formulas::formulas(),
            lapidary_cdrf::formulas::formulas(),
            lapidary_closest_point::formulas::formulas(),
            lapidary_convex_trace::formulas::formulas(),
            lapidary_curvature::formulas::formulas(),
            lapidary_dispersion::formulas::formulas(),
            lapidary_environment::formulas::formulas(),
            lapidary_fresnel::formulas::formulas(),
            lapidary_microfacet::formulas::formulas(),
            lapidary_optical_path::formulas::formulas(),
            lapidary_proxy_geometry::formulas::formulas(),
            lapidary_random_walk::formulas::formulas(),
            lapidary_reflective_shadow_map::formulas::formulas(),
            lapidary_refraction::formulas::formulas(),
            lapidary_srgb::formulas::formulas(),
            lapidary_texture_diffusion::formulas::formulas(),
            lapidary_veins::formulas::formulas(),
            lapidary_voxelization::formulas::formulas(),
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
