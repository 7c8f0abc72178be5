//! How a scattering body reflects light: the rungs of the curvature-dependent reflectance function.

/// Texel format of a lookup table's texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// 8 bits per channel, as in the paper.
    Rgba8,
    /// Half-precision floats.
    Rgba16Float,
    /// Single-precision floats; its one channel is looked up once for each channel of the material.
    R32Float,
}

/// A rung of the ladder, from cheap to exact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reflectance {
    /// Lambert's law: no scattering.
    Lambert,
    /// Lambert's law with cast shadows, as in a renderer without scattering.
    LambertShadowed,
    /// Wrap lighting.
    Wrap,
    /// A lookup table with this many texels per side.
    Table(u32, Format),
    /// The cheap closed form.
    Cheap,
    /// The accurate closed form.
    Accurate,
    /// The convolution by quadrature.
    Quadrature,
    /// The energy-conserving form over the sphere.
    Spherical,
    /// The cheap closed form with the width of the power law that random walks through spheres follow.
    Power,
    /// The same with the drift of light below a curved surface, and its width.
    Drift,
    /// Irradiance blurred in the mesh's texture, the only rung that uses it.
    Blur,
}

/// All variants, with the names of their rungs.
pub const REFLECTANCES: [(&str, Reflectance); 13] = [
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
    ("power", Reflectance::Power),
    ("drift", Reflectance::Drift),
    ("blur", Reflectance::Blur),
];

impl Reflectance {
    /// Returns the name of the rung.
    pub fn name(self) -> &'static str {
        REFLECTANCES.iter().find(|(_, reflectance)| *reflectance == self).map_or("table", |(name, _)| name)
    }

    /// Whether this is Lambert's law, with or without shadows, so that nothing scatters.
    pub fn is_lambert(self) -> bool {
        matches!(self, Self::Lambert | Self::LambertShadowed)
    }
}
