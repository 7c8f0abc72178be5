//! `extras.lapidary` of a material, and of a scene: properties that glTF cannot express.
//!
//! `sellmeier` names a measured Sellmeier equation, one of [`Mineral::ALL`](crate::Mineral::ALL). It gives the
//! refractive index and the dispersion; if the file states these as well, they must agree. `sigma0`
//! is [`Material::sigma0`](crate::Material::sigma0). `scattering` and `absorption`, which require each other, and the
//! optional `anisotropy` and `veins` are [`Material::medium`](crate::Material::medium). `secondLobe` is
//! [`Material::second_lobe`](crate::Material::second_lobe). `priority` is [`Material::priority`](crate::Material::priority),
//! `normals` is [`Material::normals`](crate::Material::normals), and
//! `solver` is [`Material::solver`](crate::Material::solver).
//! Lengths are in world units: as with `attenuationDistance`, the scale of a node does not change
//! them. `environment` of a scene is [`Scene::environment`](crate::Scene::environment), by its name.

use std::borrow::Cow;
use std::collections::BTreeMap;

use ::gltf::json::material::Material as JsonMaterial;
use glam::Vec3;
use serde::{Deserialize, Deserializer};
use serde_json::value::RawValue;

use super::error::excerpt;
use crate::BuiltInEnvironment;

mod apply;

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
    priority: Option<&'a RawValue>,
    #[serde(borrow, default, deserialize_with = "present")]
    normals: Option<&'a RawValue>,
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
const MEMBERS: [&str; 10] = [
    "sellmeier",
    "sigma0",
    "solver",
    "secondLobe",
    "priority",
    "normals",
    "scattering",
    "absorption",
    "anisotropy",
    "veins",
];

/// Deserialises a member that is present, even if it is null, which some writers put in place of a
/// NaN.
fn present<'de, D: Deserializer<'de>>(member: D) -> Result<Option<&'de RawValue>, D::Error> {
    <&RawValue>::deserialize(member).map(Some)
}

/// `extras.lapidary` of a scene.
#[derive(Deserialize)]
struct OfScene<'a> {
    #[serde(borrow, default, deserialize_with = "present")]
    environment: Option<&'a RawValue>,
}

/// Text of `extras.lapidary`, or `None` if absent.
fn text(extras: Option<&RawValue>) -> Result<Option<&RawValue>, String> {
    // glTF allows any value for extras; a value that is not an object belongs to another program.
    let Some(extras) = extras.filter(|extras| is_object(extras)) else {
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

/// Reads `extras.lapidary`; `None` if absent.
fn read<'a, T: Deserialize<'a>>(extras: Option<&'a RawValue>) -> Result<Option<T>, String> {
    let read = text(extras)?.map(|text| serde_json::from_str(text.get()));
    read.transpose().map_err(|error| unreadable("extras.lapidary", &error))
}

/// The material's `extras.lapidary`, or `None` if absent.
pub(super) fn lapidary(json: &JsonMaterial) -> Result<Option<Lapidary<'_>>, String> {
    read(json.extras.as_deref())
}

/// The environment that a scene's `extras.lapidary` names, or the usual one.
pub(super) fn environment(extras: Option<&RawValue>) -> Result<BuiltInEnvironment, String> {
    let Some(json) = read(extras)?.and_then(|OfScene { environment }| environment) else {
        return Ok(BuiltInEnvironment::default());
    };
    let name: Option<String> = serde_json::from_str(json.get()).ok();
    let known = name.and_then(|name| BuiltInEnvironment::ALL.into_iter().find(|known| known.name() == name));
    known.ok_or_else(|| {
        let names = BuiltInEnvironment::ALL.map(BuiltInEnvironment::name).join(" or ");
        format!("its extras.lapidary.environment is {}, but must be {names}", excerpt(json.get()))
    })
}

/// Members of the material's `extras.lapidary` that are not in [`Lapidary`], sorted.
pub(super) fn unknown(json: &JsonMaterial) -> Vec<String> {
    let members = text(json.extras.as_deref()).ok().flatten().and_then(|text| {
        let members: Option<BTreeMap<Cow<'_, str>, &RawValue>> = serde_json::from_str(text.get()).ok();
        members
    });
    let names = members.into_iter().flat_map(BTreeMap::into_keys);
    names.filter(|name| !MEMBERS.contains(&name.as_ref())).map(Cow::into_owned).collect()
}

fn unreadable(what: &str, error: &serde_json::Error) -> String {
    format!("its {what} cannot be read: {}", excerpt(&error.to_string()))
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
