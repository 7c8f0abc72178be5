//! `extras.lapidary` of a material: properties that glTF cannot express.
//!
//! `sellmeier` names a measured Sellmeier equation, one of [`Mineral::ALL`]. It gives the
//! refractive index and the dispersion; if the file states these as well, they must agree. `sigma0`
//! is [`Material::sigma0`]. `scattering` and `absorption`, which require each other, and the
//! optional `anisotropy` and `veins` are [`Material::medium`]. `secondLobe` is
//! [`Material::second_lobe`]. `solver` is [`Material::solver`].
//! Lengths are in world units: as with `attenuationDistance`, the scale of a node does not change
//! them.

use std::borrow::Cow;
use std::collections::BTreeMap;

use ::gltf::json::material::Material as JsonMaterial;
use glam::Vec3;
use serde::{Deserialize, Deserializer};
use serde_json::value::RawValue;

use super::error::excerpt;
use super::medium::medium;
use crate::{Dispersion, Lobe, Material, Mineral, Solver};

/// Maximum distance of a file's index from that of its Sellmeier equation: tables give two
/// decimals.
const INDEX_AGREES: f64 = 0.005;
/// Maximum relative difference between a file's dispersion and that of its Sellmeier equation:
/// measured Abbe numbers of one mineral differ by a few percent.
const DISPERSION_AGREES: f64 = 0.05;

/// The part of `extras` for this program. Kept as text, so that the extras of other programs cost
/// nothing.
#[derive(Deserialize)]
struct Extras<'a> {
    #[serde(borrow)]
    lapidary: Option<&'a RawValue>,
}

/// `extras.lapidary`. A newer program may write further members: see [`unknown`].
#[derive(Deserialize)]
pub(super) struct Lapidary<'a> {
    #[serde(borrow, default, deserialize_with = "present")]
    sellmeier: Option<&'a RawValue>,
    #[serde(borrow, default, deserialize_with = "present")]
    sigma0: Option<&'a RawValue>,
    #[serde(borrow, default, deserialize_with = "present")]
    solver: Option<&'a RawValue>,
    #[serde(borrow, default, rename = "secondLobe", deserialize_with = "present")]
    second_lobe: Option<&'a RawValue>,
    #[serde(borrow, default, deserialize_with = "present")]
    pub(super) scattering: Option<&'a RawValue>,
    #[serde(borrow, default, deserialize_with = "present")]
    pub(super) absorption: Option<&'a RawValue>,
    #[serde(borrow, default, deserialize_with = "present")]
    pub(super) anisotropy: Option<&'a RawValue>,
    #[serde(borrow, default, deserialize_with = "present")]
    pub(super) veins: Option<&'a RawValue>,
}

/// Names of the members of [`Lapidary`].
const MEMBERS: [&str; 8] =
    ["sellmeier", "sigma0", "solver", "secondLobe", "scattering", "absorption", "anisotropy", "veins"];

/// Deserialises a member that is present, even if it is null, which some writers put in place of a
/// NaN.
fn present<'de, D: Deserializer<'de>>(member: D) -> Result<Option<&'de RawValue>, D::Error> {
    <&RawValue>::deserialize(member).map(Some)
}

impl Lapidary<'_> {
    /// Applies the extras to `material`, whose extensions state `ior` and `dispersion`.
    pub(super) fn apply(
        &self,
        material: &mut Material,
        ior: Option<f64>,
        dispersion: Option<f64>,
    ) -> Result<(), String> {
        if let Some(mineral) = self.sellmeier.map(mineral).transpose()? {
            agree(mineral, ior, dispersion)?;
            material.ior = mineral.index();
            material.dispersion = Dispersion::Sellmeier(mineral);
        }
        material.sigma0 = self.sigma0.map(|json| lengths("sigma0", json)).transpose()?;
        material.medium = medium(self)?;
        material.second_lobe = self.second_lobe.map(lobe).transpose()?;
        material.solver = self.solver.map(solver).transpose()?;
        if material.solver.is_some() && !material.scatters() {
            return Err("its extras.lapidary has a solver, but nothing there scatters light; give scattering and absorption, or \
                        sigma0, or remove the solver"
                .to_owned());
        }
        if matches!(material.solver, Some(Solver::OpticalPath(_) | Solver::Diffusion(_))) && material.medium.is_none() {
            return Err("its extras.lapidary has a solver that follows light through the body, but no scattering and absorption to follow light by; give \
                        them, or another solver"
                .to_owned());
        }
        Ok(())
    }
}

/// Checks that the file's own values, if present, agree with those of the mineral.
fn agree(mineral: Mineral, ior: Option<f64>, dispersion: Option<f64>) -> Result<(), String> {
    let (name, index) = (mineral.name(), mineral.index());
    if let Some(ior) = ior.filter(|ior| (ior - f64::from(index)).abs() > INDEX_AGREES) {
        return Err(format!(
            "its ior is {ior}, but the Sellmeier equation of {name} in its extras gives {index}; leave one of them out"
        ));
    }
    let measured = 20.0 / f64::from(mineral.abbe_number());
    if let Some(dispersion) = dispersion.filter(|given| (given / measured - 1.0).abs() > DISPERSION_AGREES) {
        return Err(format!(
            "its dispersion is {dispersion:?}, but the Sellmeier equation of {name} in its extras gives {measured:.3}; leave one of \
             them out"
        ));
    }
    Ok(())
}

/// Text of the material's `extras.lapidary`, or `None` if absent.
fn text(json: &JsonMaterial) -> Result<Option<&RawValue>, String> {
    // glTF allows any value for extras; a value that is not an object belongs to another program.
    let Some(extras) = json.extras.as_deref().filter(|extras| is_object(extras)) else {
        return Ok(None);
    };
    let extras: Extras<'_> = serde_json::from_str(extras.get()).map_err(|error| unreadable("extras", &error))?;
    match extras.lapidary {
        Some(lapidary) if !is_object(lapidary) => {
            Err(format!("its extras.lapidary is {}, but must be an object", excerpt(lapidary.get())))
        }
        lapidary => Ok(lapidary),
    }
}

/// The material's `extras.lapidary`, or `None` if absent.
pub(super) fn lapidary(json: &JsonMaterial) -> Result<Option<Lapidary<'_>>, String> {
    let lapidary = text(json)?.map(|text| serde_json::from_str(text.get()));
    lapidary.transpose().map_err(|error| unreadable("extras.lapidary", &error))
}

/// Members of the material's `extras.lapidary` that are not in [`Lapidary`], sorted.
pub(super) fn unknown(json: &JsonMaterial) -> Vec<String> {
    let members = text(json).ok().flatten().and_then(|text| {
        let members: Option<BTreeMap<Cow<'_, str>, &RawValue>> = serde_json::from_str(text.get()).ok();
        members
    });
    let names = members.into_iter().flat_map(BTreeMap::into_keys);
    names.filter(|name| !MEMBERS.contains(&name.as_ref())).map(Cow::into_owned).collect()
}

fn unreadable(what: &str, error: &serde_json::Error) -> String {
    format!("its {what} cannot be read: {}", excerpt(&error.to_string()))
}

/// Mineral named by `sellmeier`.
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

/// The members of `secondLobe`; both are required, so that a misspelt name is an error.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct LobeMembers {
    roughness: f32,
    weight: f32,
}

/// Lobe given by `secondLobe`.
fn lobe(json: &RawValue) -> Result<Lobe, String> {
    let read = is_object(json).then(|| serde_json::from_str::<LobeMembers>(json.get()).ok()).flatten();
    let lobe = read.map(|LobeMembers { roughness, weight }| Lobe { roughness, weight });
    lobe.filter(|lobe| lobe.is_sound()).ok_or_else(|| {
        format!(
            "its extras.lapidary.secondLobe is {}, but must be an object with a roughness above 0 and at most 1, and a weight \
             above 0 and below 1",
            excerpt(json.get())
        )
    })
}

/// Solver named by `solver`.
fn solver(json: &RawValue) -> Result<Solver, String> {
    let solver = serde_json::from_str::<String>(json.get()).ok().and_then(|name| name.parse().ok());
    solver.ok_or_else(|| {
        format!(
            "its extras.lapidary.solver is {}, but must be a rung for what scatters light, such as lambert, accurate, blur or \
             godunov-64; `./cook render --help` says which there are",
            excerpt(json.get())
        )
    })
}

/// Red, green and blue values of the member `name`, which have a unit of length.
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
