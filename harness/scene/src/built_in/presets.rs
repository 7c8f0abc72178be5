//! Materials by name, for bodies whose file has none.

use super::materials::{by_abbe, diamond, emerald, measured, quartz, ruby, sapphire, sized};
use super::{stone, translucent};
use crate::{Material, Medium, Metal, Mineral, Object};

/// A material that fits itself to a body's size.
#[derive(Debug, Clone, Copy)]
pub struct Preset {
    /// Name that a user types.
    pub name: &'static str,
    /// What it is, and where its values come from.
    pub description: &'static str,
    /// The material for a body of size `extent`.
    material: fn() -> Material,
    /// Greatest extent of the body that the material is made for.
    extent: f32,
}

/// Greatest extent of a stone with a girdle radius of 1.
const STONE: f32 = 2.0;
/// Greatest extent in millimetres of the body that a scattering preset is made for: a figure that
/// stands in a hand.
const FIGURE: f32 = 60.0;

/// Refractive index of the ordinary ray of moissanite, 6H silicon carbide.
const MOISSANITE: f32 = 2.647;
/// Abbe number of moissanite's ordinary ray: measured by Singh, Potopowicz, Van Uitert and Wemple, Appl. Phys.
/// Lett. 19, 53 (1971), by the fit n² = 1 + 5.5394 λ²/(λ² - 0.026945) of refractiveindex.info.
const MOISSANITE_ABBE: f32 = 25.5;

/// All presets: clear stones, metals, then what scatters light.
pub const PRESETS: [Preset; 19] = [
    clear("diamond", "Sellmeier equation of Peter (1923)", diamond),
    clear("ruby", "corundum's ordinary ray (Malitson), the red of pigeon's blood", ruby),
    clear("sapphire", "corundum's ordinary ray (Malitson), royal blue", sapphire),
    clear("emerald", "beryl, index 1.577, V_d 57, bluish green", emerald),
    clear("quartz", "quartz's ordinary ray (Ghosh), rock crystal", quartz),
    clear(
        "moissanite",
        "6H silicon carbide's ordinary ray, index 2.647, V_d 25.5 (Singh and others, 1971)",
        moissanite,
    ),
    clear("zirconia", "cubic zirconia (Wood)", zirconia),
    metal(Metal::Gold, "fine gold, n and k of Johnson and Christy (1972)", || Metal::Gold.material()),
    metal(Metal::YellowGold, "18 carats, 3N: the mean of its parts", || Metal::YellowGold.material()),
    metal(Metal::RoseGold, "18 carats, 5N: the mean of its parts", || Metal::RoseGold.material()),
    metal(Metal::WhiteGold, "plated with rhodium (Weaver, Olson and Lynch, 1977)", || Metal::WhiteGold.material()),
    metal(Metal::Silver, "n and k of Johnson and Christy (1972)", || Metal::Silver.material()),
    metal(Metal::Platinum, "n and k of Tselin and others (2024)", || Metal::Platinum.material()),
    metal(Metal::Copper, "n and k of Johnson and Christy (1972)", || Metal::Copper.material()),
    metal(Metal::Steel, "stainless, n and k of Karlsson and Ribbing (1982)", || Metal::Steel.material()),
    scattering("jade", "green jadeite, polished; coefficients chosen by eye", || translucent::material("jade")),
    scattering("marble", "Jensen and others (2001)", stone::marble),
    scattering("wax", "bleached wax; coefficients chosen by eye", || translucent::material("wax")),
    scattering("skin", "skin1 of Jensen and others (2001)", || translucent::material("skin")),
];

const fn clear(name: &'static str, description: &'static str, material: fn() -> Material) -> Preset {
    Preset { name, description, material, extent: STONE }
}

const fn metal(metal: Metal, description: &'static str, material: fn() -> Material) -> Preset {
    Preset { name: metal.name(), description, material, extent: STONE }
}

const fn scattering(name: &'static str, description: &'static str, material: fn() -> Material) -> Preset {
    Preset { name, description, material, extent: FIGURE }
}

fn moissanite() -> Material {
    by_abbe("moissanite", MOISSANITE, MOISSANITE_ABBE)
}

fn zirconia() -> Material {
    measured("cubic zirconia", Mineral::CubicZirconia)
}

impl Preset {
    /// Returns the preset with this name.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static Self> {
        PRESETS.iter().find(|preset| preset.name == name)
    }

    /// Returns the material for a body whose greatest extent is `extent`, above 0: a coloured stone has its
    /// colour after that length, and what scatters light does so as in a body of 60 mm.
    #[must_use]
    pub fn material(&self, extent: f32) -> Material {
        let scale = extent / self.extent;
        let material = sized((self.material)(), scale);
        let medium = material.medium.map(|medium| Medium {
            scattering: medium.scattering / scale,
            absorption: medium.absorption / scale,
            ..medium
        });
        Material { medium, sigma0: material.sigma0.map(|sigma0| scale * sigma0), ..material }
    }

    /// Returns the body with this material in place of its own; copies lose their own colours.
    #[must_use]
    pub fn on(&self, object: &Object) -> Object {
        let extent = object.extent();
        let mut dressed = object.clone();
        // A body without a size is not drawn.
        let material = self.material(if extent > 0.0 { extent } else { 1.0 });
        dressed.material = Material { name: self.name.to_owned(), ..material };
        for place in dressed.copies.iter_mut().flat_map(|copies| &mut copies.places) {
            place.base_color = glam::Vec3::ONE;
            place.attenuation_color = None;
        }
        dressed
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Dispersion, Scene};

    #[test]
    fn every_preset_is_sound_at_any_size() {
        for preset in PRESETS {
            for extent in [1e-3, 1.0, 2.0, 60.0, 1e4] {
                assert_eq!(preset.material(extent).problem(), None, "{} of {extent}", preset.name);
            }
            assert_eq!(Preset::named(preset.name).map(|found| found.name), Some(preset.name));
            let material = preset.material(1.0);
            let kinds = [material.is_clear(), material.is_all_metal(), material.scatters()];
            assert_eq!(kinds.into_iter().filter(|is_one| *is_one).count(), 1, "{}", preset.name);
        }
    }

    #[test]
    fn a_preset_looks_alike_at_any_size() {
        let small = Preset::named("marble").expect("a preset").material(0.06);
        let large = Preset::named("marble").expect("a preset").material(60.0);
        let depth = |material: &Material, extent: f32| material.medium.clone().map(|medium| extent * medium.scattering);
        assert!(depth(&small, 0.06).expect("it scatters").abs_diff_eq(depth(&large, 60.0).expect("it scatters"), 1e-3));
        let ruby = Preset::named("ruby").expect("a preset");
        let of_scene = &Scene::named("ruby").expect("a scene").objects[0];
        assert_eq!(ruby.on(of_scene).material, of_scene.material);
    }

    #[test]
    fn moissanite_has_the_abbe_number_of_its_fit() {
        let square = |wavelength: f64| wavelength * wavelength;
        let index = |um: f64| (1.0 + 5.5394 * square(um) / (square(um) - 0.026_945)).sqrt();
        let abbe = (index(0.587_561_8) - 1.0) / (index(0.486_132_7) - index(0.656_272_5));
        assert!((abbe - f64::from(MOISSANITE_ABBE)).abs() < 0.05, "{abbe}");
        assert!((index(0.587_561_8) - f64::from(MOISSANITE)).abs() < 5e-4);
        assert!(matches!(moissanite().dispersion, Dispersion::Abbe(_)));
    }
}
