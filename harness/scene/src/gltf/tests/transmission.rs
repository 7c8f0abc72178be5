//! The medium that represents diffuse transmission.

use super::*;
use lapidary_assay::extremum::largest;

/// Returns a material with diffuse transmission of this colour.
fn diffuse(color: Vec3, volume: Value) -> Result<Material, SceneError> {
    material_of(json!({
        "pbrMetallicRoughness": {"baseColorFactor": color.extend(1.0).to_array()},
        "extensions": {
            "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 1},
            "KHR_materials_volume": volume,
        },
    }))
}

#[test]
fn the_colour_gives_the_albedo_and_the_attenuation_the_extinction() {
    let volume = json!({"thicknessFactor": 1, "attenuationColor": [0.5, 0.25, 0], "attenuationDistance": 2});
    // The coefficients of each built-in body were measured or chosen, and its colour is the one
    // that a half space of the medium was found to show.
    for name in ["skin", "wax", "jade", "bunny"] {
        let built_in = Scene::named(name).unwrap().objects.remove(0).material;
        let known = built_in.medium.unwrap();
        let material = diffuse(built_in.base_color, volume.clone()).unwrap();
        let medium = material.medium.unwrap();
        let extinction = medium.scattering + medium.absorption;
        let expected = Vec3::new(0.5 * 2f32.ln(), 2f32.ln(), 0.5 * 126.0 * 2f32.ln());
        assert!(largest(((extinction - expected) / expected).abs().to_array()) < 1e-6, "{extinction}");
        let albedo = medium.scattering / extinction;
        let difference = albedo - known.scattering / (known.scattering + known.absorption);
        assert!(difference.abs().max_element() < 0.003, "{name}: {difference}");
    }
}

#[test]
fn black_scatters_next_to_nothing_and_white_takes_up_next_to_nothing() {
    let volume = json!({"thicknessFactor": 1, "attenuationColor": [0.5, 0.5, 0.5], "attenuationDistance": 1});
    let medium = |color| diffuse(color, volume.clone()).unwrap().medium.unwrap();
    assert!(medium(Vec3::ZERO).scattering.max_element() < 1e-5 && medium(Vec3::ZERO).scattering.min_element() >= 0.0);
    assert!(medium(Vec3::ONE).absorption.max_element() < 1e-9 && medium(Vec3::ONE).absorption.min_element() >= 0.0);
}

#[test]
fn no_medium_is_derived_where_the_file_gives_no_reason() {
    let none = |volume: Value| assert_eq!(diffuse(Vec3::ONE, volume).unwrap().medium, None);
    none(json!({}));
    none(json!({"thicknessFactor": 1}));
    none(json!({"thicknessFactor": 1, "attenuationColor": [0.5, 0.5, 0.5]}));
    none(json!({"thicknessFactor": 1, "attenuationDistance": 1}));
    // What JavaScript writes for an infinite distance.
    none(json!({"thicknessFactor": 1, "attenuationColor": [0.5, 0.5, 0.5], "attenuationDistance": null}));
    none(json!({"attenuationColor": [0.5, 0.5, 0.5], "attenuationDistance": 1}));
    let volume = json!({"thicknessFactor": 1, "attenuationColor": [0.5, 0.5, 0.5], "attenuationDistance": 1});
    let clear = material_of(json!({"extensions": {
        "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 1},
        "KHR_materials_transmission": {"transmissionFactor": 1},
        "KHR_materials_volume": volume,
    }}));
    assert_eq!(clear.unwrap().medium, None);
}

#[test]
fn an_extinction_that_no_number_holds_is_refused() {
    let volume = json!({"thicknessFactor": 1, "attenuationColor": [0, 0, 0], "attenuationDistance": 1e-37});
    let message = diffuse(Vec3::ONE, volume).unwrap_err().to_string();
    assert!(message.contains("an extinction that is not finite in single precision"), "{message}");
}
