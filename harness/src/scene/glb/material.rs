//! A material as glTF.

use glam::Vec3;
use lapidary_veins::VeinsPattern;
use serde_json::{Map, Value, json};

use crate::scene::{Bounds, Density, Dispersion, Material, Mesh};

/// The mean length of a straight way through a body, which renderers that do not trace it take as its
/// thickness: 4 V/S for a convex body (Cauchy), and for several alike that of one. A body that encloses
/// nothing gets the diagonal of its box; a 0 would call it thin-walled.
pub(super) fn thickness(mesh: &Mesh) -> f32 {
    let (volume, area) = mesh.volume_and_area();
    let mean = (4.0 * volume / area) as f32;
    let across = 2.0 * Bounds::of(mesh.positions.iter().copied()).radius();
    if mean > 0.0 && mean <= across { mean } else { across }
}

/// The material of a body of this `thickness`.
pub(super) fn material(material: &Material, thickness: f32) -> Value {
    let mut extensions = json!({"KHR_materials_ior": {"ior": material.ior}});
    let is_clear = material.sigma0.is_none() && material.medium.is_none();
    if is_clear {
        extensions["KHR_materials_transmission"] = json!({"transmissionFactor": 1.0});
    }
    let attenuates = material.attenuation_color != Vec3::ONE || material.attenuation_distance.is_finite();
    if is_clear || attenuates {
        extensions["KHR_materials_volume"] = json!({
            "thicknessFactor": thickness,
            "attenuationColor": material.attenuation_color.to_array(),
        });
    }
    // JSON has no infinity: what is left out is glTF's default, which is that.
    if material.attenuation_distance.is_finite() {
        extensions["KHR_materials_volume"]["attenuationDistance"] = json!(material.attenuation_distance);
    }
    let mut extras = Map::new();
    let dispersion = match material.dispersion {
        Dispersion::None => None,
        Dispersion::Abbe(dispersion) => Some(dispersion),
        Dispersion::Sellmeier(mineral) => {
            extras.insert("sellmeier".to_owned(), json!(mineral.name()));
            Some(20.0 / mineral.abbe_number())
        }
    };
    if let Some(dispersion) = dispersion {
        extensions["KHR_materials_dispersion"] = json!({"dispersion": dispersion});
    }
    if let Some(sigma0) = material.sigma0 {
        extras.insert("sigma0".to_owned(), json!(sigma0.to_array()));
    }
    if let Some(medium) = &material.medium {
        extras.insert("scattering".to_owned(), json!(medium.scattering.to_array()));
        extras.insert("absorption".to_owned(), json!(medium.absorption.to_array()));
        if medium.anisotropy != 0.0 {
            extras.insert("anisotropy".to_owned(), json!(medium.anisotropy));
        }
        if let Density::Veins(VeinsPattern { frequency, width, least, greatest, octaves, seed }) = medium.density {
            extras.insert(
                "veins".to_owned(),
                json!({
                    "frequency": frequency,
                    "width": width,
                    "least": least,
                    "greatest": greatest,
                    "octaves": octaves,
                    "seed": seed,
                }),
            );
        }
    }
    let mut written = json!({
        "name": material.name,
        "pbrMetallicRoughness": {
            "baseColorFactor": material.base_color.extend(1.0).to_array(),
            "metallicFactor": 0.0,
            "roughnessFactor": material.roughness,
        },
        "extensions": extensions,
    });
    if !extras.is_empty() {
        written["extras"] = json!({"lapidary": extras});
    }
    written
}
