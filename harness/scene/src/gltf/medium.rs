//! Scattering medium of a material, from its `extras.lapidary`, or else from its diffuse
//! transmission.

use glam::Vec3;
use lapidary_veins::VeinsPattern;
use serde::Deserialize;
use serde_json::value::RawValue;

use super::error::excerpt;
use super::extras::{Lapidary, lengths};
use crate::{Density, Material, Medium};

/// `extras.lapidary.veins`; every member is required, so that a misspelt name is an error.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Veins {
    frequency: f32,
    width: f32,
    least: f32,
    greatest: f32,
    octaves: u32,
    seed: u32,
}

/// The medium of `extras.lapidary`. Scattering and absorption require each other.
pub(super) fn medium(extras: &Lapidary<'_>) -> Result<Option<Medium>, String> {
    let checked = |scattering: Vec3, absorption: Vec3| -> Result<Medium, String> {
        let mut medium = Medium::isotropic(scattering, absorption);
        if let Some(json) = extras.anisotropy {
            medium.anisotropy = anisotropy(json)?;
        }
        if let Some(json) = extras.veins {
            medium.density = Density::Veins(veins(json)?);
        }
        if (scattering + absorption).max_element() > Medium::MOST_EXTINCTION {
            return Err(
                "its extras.lapidary.scattering and .absorption together are above 1e18; give smaller ones".to_owned()
            );
        }
        // Each member passed its own check, but the medium as a whole must be valid too.
        medium.problem().map_or(Ok(medium), |_| Err(unfit("veins", extras.veins)))
    };
    match (extras.scattering, extras.absorption) {
        (None, None) if extras.anisotropy.is_some() || extras.veins.is_some() => {
            Err("its extras.lapidary has anisotropy or veins but neither scattering nor absorption; give both"
                .to_owned())
        }
        (None, None) => Ok(None),
        (Some(scattering), Some(absorption)) => {
            checked(lengths("scattering", scattering)?, lengths("absorption", absorption)?).map(Some)
        }
        (Some(_), None) => Err("its extras.lapidary has scattering but no absorption; give both or neither".to_owned()),
        (None, Some(_)) => Err("its extras.lapidary has absorption but no scattering; give both or neither".to_owned()),
    }
}

/// Medium behind a diffusely transmitting surface whose volume attenuates: uniform and isotropic.
/// Its extinction is that of the volume, and its albedo the one that gives a half space the
/// surface's colour.
pub(super) fn derived(material: &Material) -> Result<Option<Medium>, String> {
    let goes_in = material.diffuse_transmission > 0.0 && material.transmission == 0.0;
    if !(goes_in && material.thickness > 0.0 && material.absorbs()) {
        return Ok(None);
    }
    // The darkest colour with a finite logarithm, as in the module `absorption`.
    let darkest = f64::from(f32::MIN_POSITIVE);
    let distance = f64::from(material.attenuation_distance);
    let extinction = material.attenuation_color.as_dvec3().map(|color| 0.0 - color.max(darkest).ln() / distance);
    let shown = (material.base_color * material.diffuse_transmission_color).as_dvec3();
    let albedo = shown.map(single_scattering_albedo);
    let scattering = extinction * albedo;
    let medium = Medium::isotropic(scattering.as_vec3(), (extinction - scattering).as_vec3());
    medium.problem().map_or(Ok(Some(medium)), |_| {
        Err("its attenuationColor and attenuationDistance give an extinction that is not finite in single precision; make the distance \
             longer"
            .to_owned())
    })
}

/// Single-scattering albedo of an isotropic medium whose half space reflects the share `multiple`
/// of diffuse light. Kulla and Conty, "Revisiting Physically Based Shading at Imageworks" (2017),
/// as in the draft of `KHR_materials_volume_scatter`.
fn single_scattering_albedo(multiple: f64) -> f64 {
    let root = (9.59217 + 41.6808 * multiple + 17.7126 * multiple * multiple).sqrt();
    let s = 4.09712 + 4.20863 * multiple - root;
    1.0 - s * s
}

fn anisotropy(json: &RawValue) -> Result<f32, String> {
    let most = Medium::MOST_ANISOTROPY;
    let number = serde_json::from_str::<f64>(json.get()).ok().map(|number| number as f32);
    number.filter(|number| (-most..=most).contains(number)).ok_or_else(|| {
        let found = excerpt(json.get());
        format!("its extras.lapidary.anisotropy is {found}, but must be a number between -{most} and {most}")
    })
}

fn veins(json: &RawValue) -> Result<VeinsPattern, String> {
    let Veins { frequency, width, least, greatest, octaves, seed } =
        serde_json::from_str(json.get()).map_err(|_| unfit("veins", Some(json)))?;
    Ok(VeinsPattern { frequency, width, least, greatest, octaves, seed })
}

fn unfit(name: &str, json: Option<&RawValue>) -> String {
    format!(
        "its extras.lapidary.{name} is {}, but must have a frequency above 0, a width from 0.0009765625 to 4, least and greatest from 0 to 1000, \
         octaves from 0 to 8 and a whole seed of at least 0",
        excerpt(json.map_or("missing", RawValue::get))
    )
}
