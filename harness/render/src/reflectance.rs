//! The forms of the curvature-dependent reflectance function and of curvature, as the recipe
//! `cdrf_shading` numbers them.

use lapidary_scene::solver::{Format, Reflectance};

/// Returns `CDRF_FORM` of the recipe, or `None` if the recipe does not use it for this reflectance.
pub(super) fn form(reflectance: Reflectance) -> Option<u32> {
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
pub(super) fn spread(reflectance: Reflectance) -> u32 {
    match reflectance {
        Reflectance::Power => 1,
        Reflectance::Drift => 2,
        _ => 0,
    }
}

/// The curvature that determines how far light spreads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Curvature {
    /// The mean curvature.
    Mean,
    /// The normal curvature of the section towards each light.
    Towards,
    /// The usual |dN| / |dP|.
    Naive,
    /// The mean curvature of the mesh, given for each vertex.
    Vertex,
}

impl Curvature {
    /// All curvatures.
    pub const ALL: [Self; 4] = [Self::Mean, Self::Towards, Self::Naive, Self::Vertex];

    /// Name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mean => "mean",
            Self::Towards => "towards",
            Self::Naive => "naive",
            Self::Vertex => "vertex",
        }
    }

    /// Returns `CURVATURE_FORM` of the recipe.
    pub(super) fn form(self) -> u32 {
        match self {
            Self::Mean => 0,
            Self::Towards => 1,
            Self::Naive => 2,
            Self::Vertex => 3,
        }
    }
}

/// How far the shadows of bodies that scatter follow their light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ShadowForm {
    /// Edges of one width for all colours.
    Soft,
    /// Edges of each colour's width.
    Colors,
    /// These, and light that comes through thin parts.
    #[default]
    Through,
}

impl ShadowForm {
    /// All forms, each with more than the one before.
    pub const ALL: [Self; 3] = [Self::Soft, Self::Colors, Self::Through];

    /// Name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Soft => "soft",
            Self::Colors => "colors",
            Self::Through => "through",
        }
    }

    /// Returns `SHADOW_FORM` of the recipe.
    pub(super) fn form(self) -> u32 {
        match self {
            Self::Soft => 0,
            Self::Colors => 1,
            Self::Through => 2,
        }
    }
}
