//! Materials of a file: `baseColorFactor`, `roughnessFactor`, `KHR_materials_ior`, `KHR_materials_volume`
//! (attenuation alone), `KHR_materials_dispersion`, and `extras.lapidary` for what glTF cannot say.
//!
//! `sellmeier` there names a measured Sellmeier equation, one of [`Mineral::ALL`]. It takes the place of
//! `KHR_materials_dispersion`, and gives the refractive index too, with which the file's own, if it has one, must
//! agree. `sigma0` is [`Material::sigma0`]; `scattering` and `absorption`, which come together, and with them
//! `anisotropy` and `veins`, are [`Material::medium`]. All are lengths, or per length, of the world: as with `attenuationDistance`, the scale of
//! a node does not change them. Every body is taken as solid and traced, so `thicknessFactor`, a stand-in for tracing,
//! is not read.

use std::collections::HashMap;

use ::gltf::json::Root;
use ::gltf::json::material::Material as JsonMaterial;
use glam::Vec3;
use serde::{Deserialize, Deserializer};
use serde_json::value::RawValue;

use super::error::{GltfError, designation, excerpt, item};
use super::extension::Extension;
use super::medium::medium;
use crate::scene::{Dispersion, Material, Mineral};

/// How far a file's index may lie from its Sellmeier equation's: tables give two decimals.
const INDEX_AGREES: f32 = 0.005;

/// The materials of a file. Each is read once, when a primitive first asks for it: a small file may ask very
/// often for one with large extras.
#[derive(Debug)]
pub(super) struct Materials<'a> {
    root: &'a Root,
    known: HashMap<usize, Material>,
}

impl<'a> Materials<'a> {
    pub(super) fn new(root: &'a Root) -> Self {
        Self { root, known: HashMap::new() }
    }

    /// Material `index` of the file, which `user` refers to; glTF's default material without a number.
    pub(super) fn get(&mut self, index: Option<usize>, user: &str) -> Result<Material, GltfError> {
        let Some(index) = index else {
            return Ok(Material::standard());
        };
        if let Some(material) = self.known.get(&index) {
            return Ok(material.clone());
        }
        let json = item(&self.root.materials, "material", index, || user.to_owned())?;
        let part = || designation("material", index, json.name.as_deref());
        let mut material = read(json).map_err(|problem| GltfError::part(part(), problem))?;
        material.name = json.name.as_deref().map_or_else(|| format!("material {index}"), excerpt);
        self.known.insert(index, material.clone());
        Ok(material)
    }
}

/// A material of the file, still without its name; or what is wrong with it.
fn read(json: &JsonMaterial) -> Result<Material, String> {
    let mut material = Material::standard();
    let roughness = json.pbr_metallic_roughness.roughness_factor.0;
    if !(0.0..=1.0).contains(&roughness) {
        return Err(format!("its roughnessFactor is {roughness}, but must lie from 0 to 1"));
    }
    material.roughness = roughness;
    let [red, green, blue, _] = json.pbr_metallic_roughness.base_color_factor.0;
    let color = [red, green, blue];
    if !color.iter().all(|part| (0.0..=1.0).contains(part)) {
        return Err(format!("its baseColorFactor is {color:?}, but each part must lie from 0 to 1"));
    }
    material.base_color = Vec3::from_array(color);

    let extension = json.extensions.as_ref().and_then(|all| all.ior.as_ref());
    let ior = extension.map(|ior| ior.ior.0);
    if let Some(ior) = ior {
        check_index(ior)?;
        material.ior = ior;
    }

    let others = json.extensions.as_ref().map(|all| &all.others);
    let volume = Extension::of(others, "KHR_materials_volume")?;
    if let Some(color) = volume.color("attenuationColor")? {
        material.attenuation_color = color;
    }
    if let Some(distance) = volume.number("attenuationDistance")? {
        // A subnormal distance may count as 0 on a GPU.
        let single = distance as f32;
        if !(single.is_finite() && single >= f32::MIN_POSITIVE) {
            return Err(format!(
                "its attenuationDistance is {distance:?}, but must be above 0 and finite in single precision; \
                 leave it out if the body absorbs nothing"
            ));
        }
        material.attenuation_distance = single;
    }

    if let Some(dispersion) = Extension::of(others, "KHR_materials_dispersion")?.number("dispersion")? {
        let single = dispersion as f32;
        if !(dispersion >= 0.0 && single.is_finite()) {
            return Err(format!("its dispersion is {dispersion:?}, but must be at least 0 and finite: 20/V_d"));
        }
        if single > 0.0 {
            material.dispersion = Dispersion::Abbe(single);
        }
    }
    let Some(extras) = lapidary(json)? else {
        return Ok(material);
    };
    if let Some(mineral) = extras.sellmeier.map(mineral).transpose()? {
        let index = mineral.index();
        if let Some(ior) = ior.filter(|ior| (ior - index).abs() > INDEX_AGREES) {
            return Err(format!(
                "its ior is {ior}, but the Sellmeier equation of {} in its extras gives {index}; \
                 leave one of them out",
                mineral.name()
            ));
        }
        material.ior = index;
        material.dispersion = Dispersion::Sellmeier(mineral);
    }
    material.sigma0 = extras.sigma0.map(|json| lengths("sigma0", json)).transpose()?;
    material.medium = medium(&extras)?;
    Ok(material)
}

fn check_index(ior: f32) -> Result<(), String> {
    if ior == 0.0 {
        return Err("its ior is 0, glTF's sign for a surface that reflects like a metal; a stone needs a real \
                    refractive index, at least 1"
            .to_owned());
    }
    if !(1.0..=Material::LARGEST_INDEX).contains(&ior) {
        return Err(format!(
            "its ior is {ior}, but a stone's refractive index lies between 1 and {}",
            Material::LARGEST_INDEX
        ));
    }
    Ok(())
}

/// What `extras` hold for this program. Kept as text, so that the extras of others cost nothing.
#[derive(Deserialize)]
struct Extras<'a> {
    #[serde(borrow)]
    lapidary: Option<&'a RawValue>,
}

/// `extras.lapidary`, of which a newer program may know more.
#[derive(Deserialize)]
pub(super) struct Lapidary<'a> {
    #[serde(borrow, default, deserialize_with = "present")]
    sellmeier: Option<&'a RawValue>,
    #[serde(borrow, default, deserialize_with = "present")]
    sigma0: Option<&'a RawValue>,
    #[serde(borrow, default, deserialize_with = "present")]
    pub(super) scattering: Option<&'a RawValue>,
    #[serde(borrow, default, deserialize_with = "present")]
    pub(super) absorption: Option<&'a RawValue>,
    #[serde(borrow, default, deserialize_with = "present")]
    pub(super) anisotropy: Option<&'a RawValue>,
    #[serde(borrow, default, deserialize_with = "present")]
    pub(super) veins: Option<&'a RawValue>,
}

/// A member that is there, even where it is null: a writer that has no number for a NaN writes that.
fn present<'de, D: Deserializer<'de>>(member: D) -> Result<Option<&'de RawValue>, D::Error> {
    <&RawValue>::deserialize(member).map(Some)
}

/// The material's `extras.lapidary`, if it has them.
fn lapidary(json: &JsonMaterial) -> Result<Option<Lapidary<'_>>, String> {
    // glTF lets extras be anything; what is not an object is someone else's.
    let Some(extras) = json.extras.as_deref().filter(|extras| is_object(extras)) else {
        return Ok(None);
    };
    let unreadable =
        |what: &str, error: serde_json::Error| format!("its {what} cannot be read: {}", excerpt(&error.to_string()));
    let extras: Extras<'_> = serde_json::from_str(extras.get()).map_err(|error| unreadable("extras", error))?;
    let Some(lapidary) = extras.lapidary else {
        return Ok(None);
    };
    if !is_object(lapidary) {
        return Err(format!("its extras.lapidary is {}, but must be an object", excerpt(lapidary.get())));
    }
    let lapidary = serde_json::from_str(lapidary.get());
    lapidary.map(Some).map_err(|error| unreadable("extras.lapidary", error))
}

/// The mineral that `extras.lapidary.sellmeier` names.
fn mineral(json: &RawValue) -> Result<Mineral, String> {
    let mineral = serde_json::from_str::<String>(json.get()).ok().and_then(|name| Mineral::named(&name));
    mineral.ok_or_else(|| {
        format!(
            "its extras.lapidary.sellmeier is {}, but must be one of {}",
            excerpt(json.get()),
            Mineral::ALL.map(|mineral| format!("{:?}", mineral.name())).join(", ")
        )
    })
}

/// The member `name` of `extras.lapidary`: numbers for red, green and blue that have a length unit.
pub(super) fn lengths(name: &str, json: &RawValue) -> Result<Vec3, String> {
    let numbers = serde_json::from_str::<[f64; 3]>(json.get()).ok();
    let single = numbers.map(|numbers| Vec3::from_array(numbers.map(|number| number as f32)));
    single.filter(|single| single.is_finite() && single.cmpge(Vec3::ZERO).all()).ok_or_else(|| {
        format!(
            "its extras.lapidary.{name} is {}, but must be three numbers of at least 0, finite in single precision",
            excerpt(json.get())
        )
    })
}

fn is_object(json: &RawValue) -> bool {
    json.get().starts_with('{')
}
