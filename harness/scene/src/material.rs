//! Materials: those of glTF, with a few extensions.

use super::normals::Normals;
use super::{Medium, Mesh, Solver, Texture, TextureSlot};
use glam::Vec3;
use lapidary_dispersion::{channels, oracle as dispersion};

mod metal;
mod mineral;

pub use metal::Metal;
pub use mineral::Mineral;

/// Optical properties of a body.
///
/// Textures multiply their factors. They are looked up by the body's own texture coordinates,
/// [`Mesh::uvs`](crate::Mesh::uvs): a material with textures belongs on a mesh that has some.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// Name of the material, or `default`.
    pub name: String,
    /// Base colour factor, linear RGB, each 0 to 1. Light that crosses the surface is multiplied by
    /// it.
    pub base_color: Vec3,
    /// How much of what is behind the surface it covers; `None` if all of it.
    pub coverage: Option<Coverage>,
    /// Factor of the base colour, in red, green and blue, and of the coverage, in alpha.
    pub base_color_texture: Option<Texture>,
    /// Direction of the surface normal in tangent space, 2 · RGB - 1: x along u, y against v (which
    /// is down), z out of the surface.
    pub normal_texture: Option<Texture>,
    /// Factor of the normal texture's x and y, finite; without a texture it has no effect.
    pub normal_scale: f32,
    /// Refractive index relative to air at the helium d line, 587.6 nm, from 1 to
    /// [`LARGEST_INDEX`](Self::LARGEST_INDEX).
    pub ior: f32,
    /// How the refractive index depends on the wavelength.
    pub dispersion: Dispersion,
    /// Colour of white light after `attenuation_distance` inside, linear RGB, each 0 to 1. A 0,
    /// which glTF allows, has no finite extinction, so code that takes the logarithm must clamp it
    /// first.
    pub attenuation_color: Vec3,
    /// Distance in world units, above 0 and not subnormal; infinite if the body absorbs nothing.
    pub attenuation_distance: f32,
    /// Fraction of the light at the surface that passes straight through it, 0 (opaque) to 1
    /// (clear): `KHR_materials_transmission`.
    pub transmission: f32,
    /// Factor of the transmission, in red.
    pub transmission_texture: Option<Texture>,
    /// Fraction that passes through it diffusely, 0 to 1: `KHR_materials_diffuse_transmission`.
    pub diffuse_transmission: f32,
    /// Factor of the diffuse transmission, in alpha.
    pub diffuse_transmission_texture: Option<Texture>,
    /// Colour that the diffusely transmitted light is multiplied by, linear RGB, each 0 to 1.
    pub diffuse_transmission_color: Vec3,
    /// Thickness of the body beneath the surface, in world units, at least 0:
    /// `KHR_materials_volume`. 0 is a thin wall, without an interior that would refract or absorb
    /// light.
    pub thickness: f32,
    /// Factor of the thickness, in green.
    pub thickness_texture: Option<Texture>,
    /// Roughness of the surface, 0 (a mirror) to 1, as in glTF: its square is the width of the
    /// distribution of microfacet slopes.
    pub roughness: f32,
    /// How much of the surface of an opaque body is a metal's, 0 to 1, as in glTF: that share has no diffuse light, and
    /// the base colour for what it reflects head on.
    pub metallic: f32,
    /// Factors of the roughness, in green, and of `metallic`, in blue.
    pub metallic_roughness_texture: Option<Texture>,
    /// A second distribution of slopes, mixed with that of `roughness`; `None` if there is one only.
    pub second_lobe: Option<Lobe>,
    /// Which of several bodies that share space is there: the one of the greatest number, and of equal ones the body of the
    /// smaller volume, such as one that lies wholly inside the other.
    pub priority: i32,
    /// Which normals refract and reflect in a clear body.
    pub normals: Normals,
    /// Whether both sides of the surface are meant to be seen, as glTF's `doubleSided`. A solid
    /// shows only one.
    pub double_sided: bool,
    /// Width coefficient of the curvature-dependent reflectance function: the Gaussian's width in
    /// radians is this times the curvature. In world units, for red, green and blue, at least 0 and
    /// finite. `None` if the material does not define it.
    pub sigma0: Option<Vec3>,
    /// How the inside scatters light; `None` if the material does not define it.
    pub medium: Option<Medium>,
    /// Technique that draws the body; `None` if the material does not define it. Only a scattering
    /// body has one.
    pub solver: Option<Solver>,
}

/// How much of what is behind a surface it covers: glTF's `alphaMode` MASK and BLEND.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coverage {
    /// Share of it, 0 to 1, the alpha of the base colour factor.
    pub share: f32,
    /// The share from which on a point covers all, and below which it covers nothing, at least 0; `None` to mix.
    pub cutoff: Option<f32>,
}

impl Coverage {
    /// Whether share and cutoff are in range.
    #[must_use]
    pub fn is_sound(self) -> bool {
        (0.0..=1.0).contains(&self.share) && self.cutoff.is_none_or(|cutoff| (0.0..=f32::MAX).contains(&cutoff))
    }

    /// Returns the share that is covered, without an image.
    #[must_use]
    pub fn without_image(self) -> f32 {
        self.cutoff.map_or(self.share, |cutoff| if self.share >= cutoff { 1.0 } else { 0.0 })
    }
}

/// A lobe of a highlight that has two, as skin's has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lobe {
    /// Roughness, above 0 and at most 1.
    pub roughness: f32,
    /// Share of the facets that have it, above 0 and below 1.
    pub weight: f32,
}

impl Lobe {
    /// Whether roughness and weight are in range.
    #[must_use]
    pub fn is_sound(self) -> bool {
        self.roughness > 0.0 && self.roughness <= 1.0 && self.weight > 0.0 && self.weight < 1.0
    }
}

/// How a refractive index depends on the wavelength.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Dispersion {
    /// No dispersion.
    None,
    /// glTF's `KHR_materials_dispersion`: 20 / V_d, above 0, together with the index at the d line.
    Abbe(f32),
    /// A measured Sellmeier equation, which also gives the index at the d line: the material's
    /// `ior` is then [`Mineral::index`].
    Sellmeier(Mineral),
}

impl Material {
    /// Returns glTF's default material, though not as a metal: white, opaque, refractive index 1.5, no dispersion or
    /// absorption.
    #[must_use]
    pub fn standard() -> Self {
        Self {
            name: "default".to_owned(),
            base_color: Vec3::ONE,
            coverage: None,
            base_color_texture: None,
            normal_texture: None,
            normal_scale: 1.0,
            ior: 1.5,
            dispersion: Dispersion::None,
            attenuation_color: Vec3::ONE,
            attenuation_distance: f32::INFINITY,
            transmission: 0.0,
            transmission_texture: None,
            diffuse_transmission: 0.0,
            diffuse_transmission_texture: None,
            diffuse_transmission_color: Vec3::ONE,
            thickness: 0.0,
            thickness_texture: None,
            roughness: 1.0,
            metallic: 0.0,
            metallic_roughness_texture: None,
            second_lobe: None,
            priority: 0,
            normals: Normals::Decided,
            double_sided: false,
            sigma0: None,
            medium: None,
            solver: None,
        }
    }

    /// Largest refractive index; the formulas are tested up to it. Germanium reaches it in the
    /// infrared, and no visibly clear material comes near.
    pub const LARGEST_INDEX: f32 = 4.0;

    /// Largest roughness of a surface that counts as polished: the facets of a rougher one are steeper than 0.001.
    pub const POLISHED: f32 = 0.0316;

    /// Returns which field is invalid and what to do, or `None` if the material is valid.
    #[must_use]
    pub fn problem(&self) -> Option<&'static str> {
        // Written so that NaN fails every check.
        let is_color = |color: Vec3| color.to_array().iter().all(|part| (0.0..=1.0).contains(part));
        let is_length = |length: Vec3| length.is_finite() && length.cmpge(Vec3::ZERO).all();
        let disperses = match self.dispersion {
            Dispersion::None => true,
            Dispersion::Abbe(dispersion) => dispersion > 0.0 && dispersion.is_finite(),
            Dispersion::Sellmeier(mineral) => self.ior == mineral.index(),
        };
        if !is_color(self.base_color) {
            Some("its material's base colour has a part outside 0 to 1; mend it")
        } else if !(1.0..=Self::LARGEST_INDEX).contains(&self.ior) {
            Some("its material's refractive index is not between 1 and 4; mend it")
        } else if !disperses {
            Some(
                "its material's dispersion is not finite and above 0, or its refractive index is not the one of \
                 its Sellmeier equation; mend it",
            )
        } else if !is_color(self.attenuation_color) {
            Some("its material's attenuation colour has a part outside 0 to 1; mend it")
        } else if !(f32::MIN_POSITIVE..).contains(&self.attenuation_distance) {
            Some("its material's attenuation distance is not above 0; mend it")
        } else if ![self.transmission, self.diffuse_transmission].iter().all(|share| (0.0..=1.0).contains(share)) {
            Some("its material's transmission is not between 0 and 1; mend it")
        } else if !is_color(self.diffuse_transmission_color) {
            Some("its material's colour of diffuse transmission has a part outside 0 to 1; mend it")
        } else if !(0.0..=f32::MAX).contains(&self.thickness) {
            Some("its material's thickness is not finite and at least 0; mend it")
        } else if !(0.0..=1.0).contains(&self.roughness) {
            Some("its material's roughness is not between 0 and 1; mend it")
        } else if !(0.0..=1.0).contains(&self.metallic) {
            Some("its material's metallic share is not between 0 and 1; mend it")
        } else if !self.coverage.is_none_or(Coverage::is_sound) {
            Some("its material's alpha is not between 0 and 1, or its cutoff not at least 0; mend it")
        } else if !self.second_lobe.is_none_or(Lobe::is_sound) {
            Some(
                "its material's second lobe has a roughness that is not above 0 and at most 1, or a weight that is not between 0 and 1; mend it",
            )
        } else if !self.sigma0.is_none_or(is_length) {
            Some("its material's sigma0 is not finite and at least 0; mend it")
        } else if self.solver.is_some() && !self.scatters() {
            Some("its material has a solver, but does not scatter light; remove the solver")
        } else if !self.normal_scale.is_finite() {
            Some("its material's normal scale is not finite; mend it")
        } else {
            let medium = self.medium.as_ref().and_then(Medium::problem);
            medium.or_else(|| self.textures().find_map(|(_, texture)| texture.problem()))
        }
    }
}

impl Material {
    /// Returns the texture in a slot.
    #[must_use]
    pub fn texture(&self, slot: TextureSlot) -> Option<&Texture> {
        match slot {
            TextureSlot::BaseColor => self.base_color_texture.as_ref(),
            TextureSlot::Normal => self.normal_texture.as_ref(),
            TextureSlot::MetallicRoughness => self.metallic_roughness_texture.as_ref(),
            TextureSlot::Thickness => self.thickness_texture.as_ref(),
            TextureSlot::Transmission => self.transmission_texture.as_ref(),
            TextureSlot::DiffuseTransmission => self.diffuse_transmission_texture.as_ref(),
        }
    }

    /// Returns the texture in a slot if it has an effect: its factor is other than 0.
    #[must_use]
    pub fn effective(&self, slot: TextureSlot) -> Option<&Texture> {
        self.texture(slot).filter(|_| self.calls_for(slot))
    }

    /// Returns the place of the texture in a slot.
    pub fn texture_mut(&mut self, slot: TextureSlot) -> &mut Option<Texture> {
        match slot {
            TextureSlot::BaseColor => &mut self.base_color_texture,
            TextureSlot::Normal => &mut self.normal_texture,
            TextureSlot::MetallicRoughness => &mut self.metallic_roughness_texture,
            TextureSlot::Thickness => &mut self.thickness_texture,
            TextureSlot::Transmission => &mut self.transmission_texture,
            TextureSlot::DiffuseTransmission => &mut self.diffuse_transmission_texture,
        }
    }

    /// Returns the slots that have a texture, with their textures.
    pub fn textures(&self) -> impl Iterator<Item = (TextureSlot, &Texture)> {
        TextureSlot::ALL.into_iter().filter_map(|slot| Some((slot, self.texture(slot)?)))
    }

    /// Whether the factor of a slot is other than 0, so that a texture there has an effect.
    #[must_use]
    pub fn calls_for(&self, slot: TextureSlot) -> bool {
        match slot {
            TextureSlot::BaseColor => self.base_color != Vec3::ZERO || self.coverage.is_some(),
            TextureSlot::Normal => self.normal_scale != 0.0,
            TextureSlot::MetallicRoughness => self.roughness > 0.0 || self.metallic > 0.0,
            TextureSlot::Thickness => self.thickness > 0.0,
            TextureSlot::Transmission => self.transmission > 0.0,
            TextureSlot::DiffuseTransmission => self.diffuse_transmission > 0.0,
        }
    }

    /// Whether the inside scatters light, as given by `sigma0` or by a medium.
    #[must_use]
    pub fn scatters(&self) -> bool {
        self.sigma0.is_some() || self.medium.is_some()
    }

    /// Returns the share of the light that enters a scattering body, without its image. A body may scatter by its medium
    /// alone: then all of it enters.
    #[must_use]
    pub fn share_that_enters(&self) -> f32 {
        if self.diffuse_transmission > 0.0 { self.diffuse_transmission } else { 1.0 }
    }

    /// Whether light passes straight through, unscattered.
    #[must_use]
    pub fn is_clear(&self) -> bool {
        self.transmission > 0.0 && !self.scatters()
    }

    /// Whether the body is clear and has no inside.
    #[must_use]
    pub fn is_thin_wall(&self) -> bool {
        self.is_clear() && self.thickness == 0.0
    }

    /// Whether the body is clear and has an inside.
    #[must_use]
    pub fn has_clear_inside(&self) -> bool {
        self.is_clear() && !self.is_thin_wall()
    }

    /// Returns the width of the slopes of a clear body's facets; 0 if it is polished, as it counts below
    /// [`POLISHED`](Self::POLISHED).
    #[must_use]
    pub fn facet_slope(&self) -> f32 {
        if self.is_clear() && self.roughness > Self::POLISHED { self.roughness * self.roughness } else { 0.0 }
    }

    /// Whether the surface covers all that is behind it, by its image too.
    #[must_use]
    pub fn covers_all(&self) -> bool {
        let image = self.base_color_texture.as_ref().is_none_or(|texture| texture.texels.is_opaque());
        self.coverage.is_none() || self.covered_share() == 1.0 && image
    }

    /// Returns the share of what is behind the surface that it covers, without an image.
    #[must_use]
    pub fn covered_share(&self) -> f32 {
        self.coverage.map_or(1.0, Coverage::without_image)
    }

    /// Whether the normals between a triangle's corners reflect and refract in a clear body.
    #[must_use]
    pub fn is_smooth(&self, mesh: &Mesh) -> bool {
        self.has_clear_inside() && self.normals.are_smooth(mesh)
    }

    /// Returns the share of the light that comes to the surface, and is not reflected, that enters: 0 for an opaque body, 1
    /// for one that scatters inside.
    #[must_use]
    pub fn clear_share(&self) -> f32 {
        if self.scatters() { 1.0 } else { self.transmission }
    }

    /// Whether no light enters: neither clear nor scattering.
    #[must_use]
    pub fn is_opaque(&self) -> bool {
        !self.is_clear() && !self.scatters()
    }

    /// Whether a share of the surface, somewhere, is a metal's.
    #[must_use]
    pub fn is_metal(&self) -> bool {
        self.is_opaque() && self.metallic > 0.0
    }

    /// Whether all of the surface is a metal's, which has no diffuse light.
    #[must_use]
    pub fn is_all_metal(&self) -> bool {
        self.is_opaque() && self.metallic == 1.0 && self.metallic_roughness_texture.is_none()
    }

    /// Whether light is absorbed on its way through the body.
    #[must_use]
    pub fn absorbs(&self) -> bool {
        self.attenuation_color != Vec3::ONE && self.attenuation_distance.is_finite()
    }

    /// Returns the refractive indices at the wavelengths that represent the three channels.
    #[must_use]
    pub fn channel_indices(&self) -> Vec3 {
        channels::of(|wavelength| self.index_at(wavelength))
    }

    /// Returns the refractive index at a wavelength in nanometres.
    #[must_use]
    pub fn index_at(&self, wavelength: f64) -> f64 {
        match self.dispersion {
            Dispersion::None => f64::from(self.ior),
            Dispersion::Abbe(abbe) => dispersion::abbe(f64::from(self.ior), f64::from(abbe), wavelength),
            Dispersion::Sellmeier(mineral) => dispersion::sellmeier(mineral.sellmeier(), wavelength),
        }
    }
}

#[cfg(test)]
mod tests;
