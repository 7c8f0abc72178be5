//! Materials as glTF.

use glam::Vec3;
use lapidary_veins::VeinsPattern;
use serde_json::{Map, Value, json};

use super::texture::Textures;
use crate::{Coverage, Density, Dispersion, Lobe, Material, TextureSlot};

/// JSON of a material, with the extensions that it needs. Its textures that have an effect are added
/// to `textures`.
pub(super) fn material(material: &Material, textures: &mut Textures) -> Value {
    let mut reference = |slot: TextureSlot| {
        let texture = material.texture(slot).filter(|_| material.calls_for(slot));
        texture.map(|texture| (slot.name(), textures.reference(texture)))
    };
    let mut extensions = json!({"KHR_materials_ior": {"ior": material.ior}});
    if material.transmission > 0.0 {
        extensions["KHR_materials_transmission"] = json!({"transmissionFactor": material.transmission});
        if let Some((name, texture)) = reference(TextureSlot::Transmission) {
            extensions["KHR_materials_transmission"][name] = texture;
        }
    }
    let color = material.diffuse_transmission_color;
    if material.diffuse_transmission > 0.0 || color != Vec3::ONE {
        extensions["KHR_materials_diffuse_transmission"] = json!({
            "diffuseTransmissionFactor": material.diffuse_transmission,
            "diffuseTransmissionColorFactor": color.to_array(),
        });
        if let Some((name, texture)) = reference(TextureSlot::DiffuseTransmission) {
            extensions["KHR_materials_diffuse_transmission"][name] = texture;
        }
    }
    // JSON has no infinity, so an infinite distance is omitted: that is glTF's default.
    let mut volume = Map::new();
    if material.thickness > 0.0 {
        volume.insert("thicknessFactor".to_owned(), json!(material.thickness));
        volume.extend(reference(TextureSlot::Thickness).map(|(name, texture)| (name.to_owned(), texture)));
    }
    if material.attenuation_color != Vec3::ONE {
        volume.insert("attenuationColor".to_owned(), json!(material.attenuation_color.to_array()));
    }
    if material.attenuation_distance.is_finite() {
        volume.insert("attenuationDistance".to_owned(), json!(material.attenuation_distance));
    }
    if !volume.is_empty() {
        extensions["KHR_materials_volume"] = volume.into();
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
    if let Some(Lobe { roughness, weight }) = material.second_lobe {
        extras.insert("secondLobe".to_owned(), json!({"roughness": roughness, "weight": weight}));
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
    if material.priority != 0 {
        extras.insert("priority".to_owned(), json!(material.priority));
    }
    if let Some(name) = material.normals.name() {
        extras.insert("normals".to_owned(), json!(name));
    }
    if let Some(solver) = material.solver {
        extras.insert("solver".to_owned(), json!(solver.to_string()));
    }
    let mut written = json!({
        "name": material.name,
        "pbrMetallicRoughness": {
            "baseColorFactor": material.base_color.extend(material.coverage.map_or(1.0, |coverage| coverage.share)).to_array(),
            "metallicFactor": material.metallic,
            "roughnessFactor": material.roughness,
        },
        "extensions": extensions,
    });
    if let Some((name, texture)) = reference(TextureSlot::BaseColor) {
        written["pbrMetallicRoughness"][name] = texture;
    }
    if let Some((name, texture)) = reference(TextureSlot::MetallicRoughness) {
        written["pbrMetallicRoughness"][name] = texture;
    }
    if let Some((name, texture)) = reference(TextureSlot::Normal) {
        written[name] = texture;
        if material.normal_scale != 1.0 {
            written[name]["scale"] = json!(material.normal_scale);
        }
    }
    match material.coverage {
        None => {}
        Some(Coverage { cutoff: None, .. }) => written["alphaMode"] = json!("BLEND"),
        Some(Coverage { cutoff: Some(cutoff), .. }) => {
            written["alphaMode"] = json!("MASK");
            written["alphaCutoff"] = json!(cutoff);
        }
    }
    if material.double_sided {
        written["doubleSided"] = json!(true);
    }
    if !extras.is_empty() {
        written["extras"] = json!({"lapidary": extras});
    }
    written
}
