//! The surfaces of bodies.

/// How a body's surface acts on light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Boundary {
    /// Light passes unchanged.
    #[default]
    Matched,
    /// Light is refracted by the material's refractive index and reflected by the Fresnel
    /// reflectance, from outside and from inside, as at a polished surface. Mirror reflections of
    /// the surroundings were not scattered and are left out.
    ///
    /// Each scattering is connected with each light, or with the eye, by all paths that are
    /// refracted once and meet no other surface. Light that meets several surfaces before it is
    /// scattered for the first time is found by as many walks from the other end. Left out are paths
    /// that begin in this way at both ends; their share is about the product of the shares of such
    /// light at the two ends, 0.03 % in a picture of the bunny and less in those of smooth bodies.
    /// The environment is found by walks that leave; nothing of it is left out.
    Dielectric,
}
