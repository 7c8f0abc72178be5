//! The materials of the built-in scenes.
//!
//! For a uniaxial crystal (corundum, quartz, beryl) the ordinary ray stands for both. Colours are
//! chosen by eye, as the transmitted colour of white light after two girdle radii of stone: about
//! one path down to the pavilion and up again.

use glam::Vec3;

use crate::{Dispersion, Material, Mineral};

/// Path length inside after which a coloured stone shows its colour, in girdle radii (half lengths
/// of the step cut).
const COLOR_DEPTH: f32 = 2.0;

/// A vivid royal blue, linear RGB.
const ROYAL_BLUE: Vec3 = Vec3::new(0.03, 0.10, 0.60);
/// The red of pigeon's blood: vivid, with a trace of blue.
const PIGEON_BLOOD: Vec3 = Vec3::new(0.72, 0.018, 0.06);
/// A vivid bluish green.
const EMERALD_GREEN: Vec3 = Vec3::new(0.16, 0.72, 0.42);

/// Refractive index of beryl's ordinary ray, in the middle of the range for emeralds.
const BERYL: f32 = 1.577;
/// Abbe number of beryl. Schumann (Gemstones of the World, 2009) gives a dispersion of 0.009 to
/// 0.013 between the C and F lines, and so 44 to 64 with the index above; this corresponds to
/// 0.0101.
const BERYL_ABBE: f32 = 57.0;

/// Refractive index of Schott's flint glass F2, the lead glass of chandeliers and of prisms for
/// spectra.
const FLINT_GLASS: f32 = 1.62004;
/// Abbe number of F2.
const FLINT_GLASS_ABBE: f32 = 36.37;

pub(super) fn diamond() -> Material {
    measured("diamond", Mineral::Diamond)
}

pub(super) fn sapphire() -> Material {
    tinted(measured("sapphire", Mineral::Corundum), ROYAL_BLUE)
}

pub(super) fn ruby() -> Material {
    tinted(measured("ruby", Mineral::Corundum), PIGEON_BLOOD)
}

pub(super) fn quartz() -> Material {
    measured("quartz", Mineral::Quartz)
}

pub(super) fn emerald() -> Material {
    tinted(by_abbe("beryl", BERYL, BERYL_ABBE), EMERALD_GREEN)
}

pub(super) fn crown_glass() -> Material {
    measured("glass", Mineral::CrownGlass)
}

pub(super) fn flint_glass() -> Material {
    by_abbe("flint glass", FLINT_GLASS, FLINT_GLASS_ABBE)
}

/// Crown glass without dispersion.
pub(super) fn clear_glass() -> Material {
    Material { name: "clear glass".to_owned(), dispersion: Dispersion::None, ..crown_glass() }
}

/// Slate with an even, honed surface.
pub(super) fn slate() -> Material {
    let base_color = Vec3::new(0.072, 0.08, 0.092);
    Material { name: "slate".to_owned(), base_color, roughness: 0.35, ..Material::standard() }
}

/// Dark patina on bronze: opaque, with a highlight of its own.
pub(super) fn bronze() -> Material {
    let base_color = Vec3::new(0.11, 0.06, 0.028);
    Material { name: "bronze".to_owned(), base_color, roughness: 0.3, ..Material::standard() }
}

/// Scales a material to a stone with this girdle radius.
pub(super) fn sized(material: Material, radius: f32) -> Material {
    let [attenuation_distance, thickness] = [material.attenuation_distance, material.thickness].map(|l| radius * l);
    Material { attenuation_distance, thickness, ..material }
}

pub(super) fn measured(name: &str, mineral: Mineral) -> Material {
    let dispersion = Dispersion::Sellmeier(mineral);
    Material { name: name.to_owned(), ior: mineral.index(), dispersion, ..polished() }
}

pub(super) fn by_abbe(name: &str, ior: f32, abbe_number: f32) -> Material {
    let dispersion = Dispersion::Abbe(20.0 / abbe_number);
    Material { name: name.to_owned(), ior, dispersion, ..polished() }
}

/// A material that reflects by Lambert's law alone.
pub(super) fn matte(name: &str, [red, green, blue]: [f32; 3]) -> Material {
    let base_color = Vec3::new(red, green, blue);
    Material { name: name.to_owned(), base_color, ior: 1.0, roughness: 1.0, ..Material::standard() }
}

fn polished() -> Material {
    // One girdle radius: about as thick as the stone, and enough not to be a thin wall.
    Material { roughness: 0.0, transmission: 1.0, thickness: 1.0, ..Material::standard() }
}

fn tinted(material: Material, color: Vec3) -> Material {
    Material { attenuation_color: color, attenuation_distance: COLOR_DEPTH, ..material }
}
