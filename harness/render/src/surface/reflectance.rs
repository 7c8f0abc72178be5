//! The forms of the curvature-dependent reflectance function and of its spread, as the recipe
//! `cdrf_shading` numbers them.

use lapidary_scene::solver::{Format, Reflectance};

/// Returns `CDRF_FORM` of the recipe, or `None` if the recipe does not use it for this reflectance.
pub(crate) fn form(reflectance: Reflectance) -> Option<u32> {
    match reflectance {
        Reflectance::Lambert | Reflectance::LambertShadowed | Reflectance::Blur => None,
        Reflectance::Wrap => Some(0),
        Reflectance::Table(_, Format::Rgba8 | Format::Rgba16Float) => Some(1),
        Reflectance::Table(_, Format::R32Float) => Some(2),
        Reflectance::Cheap | Reflectance::Power | Reflectance::Drift => Some(3),
        Reflectance::Accurate => Some(4),
        Reflectance::Quadrature => Some(5),
        Reflectance::Spherical => Some(6),
    }
}

/// Returns `SPREAD_FORM` of the recipe.
pub(crate) fn spread(reflectance: Reflectance) -> u32 {
    match reflectance {
        Reflectance::Power => 1,
        Reflectance::Drift => 2,
        _ => 0,
    }
}
