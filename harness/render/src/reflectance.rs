//! How what scatters light sends it back: the rungs of the curvature-dependent reflectance function.

use lapidary_scene::solver::Format;

/// A step of the ladder from cheap to exact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reflectance {
    /// Lambert's law: no scattering.
    Lambert,
    /// Lambert's law with cast shadows: what a renderer without scattering would show.
    LambertShadowed,
    /// Wrap lighting.
    Wrap,
    /// A lookup table of this many texels a side.
    Table(u32, Format),
    /// The cheap closed form.
    Cheap,
    /// The accurate closed form.
    Accurate,
    /// The convolution by quadrature.
    Quadrature,
    /// The form that keeps energy over the sphere.
    Spherical,
    /// Irradiance blurred in the mesh's texture, which the others do without.
    Blur,
}

/// Every one, by its rung's name.
pub(super) const REFLECTANCES: [(&str, Reflectance); 11] = [
    ("lambert", Reflectance::Lambert),
    ("lambert-shadowed", Reflectance::LambertShadowed),
    ("wrap", Reflectance::Wrap),
    ("table-256-rgba8", Reflectance::Table(256, Format::Rgba8)),
    ("table-257-rgba16f", Reflectance::Table(257, Format::Rgba16Float)),
    ("table-257-r32f", Reflectance::Table(257, Format::R32Float)),
    ("cheap", Reflectance::Cheap),
    ("accurate", Reflectance::Accurate),
    ("quadrature", Reflectance::Quadrature),
    ("spherical", Reflectance::Spherical),
    ("blur", Reflectance::Blur),
];

impl Reflectance {
    /// Its rung's name.
    pub fn name(self) -> &'static str {
        REFLECTANCES.iter().find(|(_, reflectance)| *reflectance == self).map_or("table", |(name, _)| name)
    }

    /// Whether it is Lambert's law, with shadows or without: nothing scatters.
    pub fn is_lambert(self) -> bool {
        matches!(self, Self::Lambert | Self::LambertShadowed)
    }

    /// `CDRF_FORM` of the recipe; none where it is not used.
    pub(super) fn form(self) -> Option<u32> {
        match self {
            Self::Lambert | Self::LambertShadowed | Self::Blur => None,
            Self::Wrap => Some(0),
            Self::Table(_, Format::Rgba8 | Format::Rgba16Float) => Some(1),
            Self::Table(_, Format::R32Float) => Some(2),
            Self::Cheap => Some(3),
            Self::Accurate => Some(4),
            Self::Quadrature => Some(5),
            Self::Spherical => Some(6),
        }
    }
}

/// Which curvature spreads the light.
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
    /// Every one.
    pub const ALL: [Self; 4] = [Self::Mean, Self::Towards, Self::Naive, Self::Vertex];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mean => "mean",
            Self::Towards => "towards",
            Self::Naive => "naive",
            Self::Vertex => "vertex",
        }
    }

    /// `CURVATURE_FORM` of the recipe.
    pub(super) fn form(self) -> u32 {
        match self {
            Self::Mean => 0,
            Self::Towards => 1,
            Self::Naive => 2,
            Self::Vertex => 3,
        }
    }
}
