//! A vendor's mark of a stone.

use super::*;

fn marked(members: Value) -> Result<Material, SceneError> {
    material_of(json!({
        "name": "gem",
        "alphaMode": "BLEND",
        "pbrMetallicRoughness": {"baseColorFactor": [0.2, 0.3, 0.4, 0.5], "metallicFactor": 1, "roughnessFactor": 0.7},
        "extensions": {DIAMOND: members, "KHR_materials_ior": {"ior": 0}},
    }))
}

#[test]
fn a_marked_material_is_a_clear_stone_of_its_index_dispersion_and_colour() {
    let stone =
        Material { name: "gem".to_owned(), transmission: 1.0, thickness: 1.0, roughness: 0.0, ..Material::standard() };
    assert_eq!(marked(json!({})).unwrap(), Material { ior: 2.417, ..stone.clone() });
    let white = json!({"refractiveIndex": 2.6, "dispersion": 0.016, "color": 16_777_215, "rayBounces": 5, "absorptionFactor": 2});
    let expected = Material {
        ior: 2.6,
        dispersion: Dispersion::Abbe((20.0 * 0.032 / f64::from(2.6f32 - 1.0)) as f32),
        ..stone.clone()
    };
    assert_eq!(marked(white).unwrap(), expected);
    // The triangle's greatest extent is 1: no part of it is closed.
    let extent = 1.0;
    for color in [json!([1, 0.5, 0]), json!({"r": 1, "g": 0.5, "b": 0})] {
        let found = marked(json!({"color": color, "absorptionFactor": 2})).unwrap();
        assert_eq!((found.attenuation_color, found.attenuation_distance), (Vec3::new(1.0, 0.5, 0.0), 0.25 * extent));
    }
    for color in [json!(0xff8000), json!("#ff8000")] {
        let found = marked(json!({"color": color})).unwrap().attenuation_color;
        assert!(found.abs_diff_eq(Vec3::new(1.0, 0.21586, 0.0), 1e-5), "{found}");
    }
}

#[test]
fn an_index_that_no_stone_has_is_drawn_as_the_nearest_and_said() {
    for (index, drawn) in [(0.0, 1.0), (0.5, 1.0), (9.0, 4.0)] {
        assert_eq!(marked(json!({"refractiveIndex": index})).unwrap().ior, drawn);
        let scene = load_changed(|d| {
            d["meshes"][0]["primitives"][0]["material"] = json!(0);
            d["materials"][0] = json!({"name": "gem", "extensions": {DIAMOND: {"refractiveIndex": index}}});
        });
        let lacking = scene.unwrap().lacking.clauses().join("; ");
        assert!(
            lacking.contains(&format!("`refractiveIndex` {index:?} of material `gem` (drawn as {drawn})")),
            "{lacking}"
        );
    }
}

#[test]
fn what_is_no_stone_is_refused() {
    for (members, says) in [
        (json!({"refractiveIndex": -1}), "refractiveIndex of WEBGI_materials_diamond is -1.0, but must be at least 0"),
        (json!({"refractiveIndex": "high"}), "refractiveIndex is a string, but must be a number"),
        (json!({"dispersion": 1e300}), "dispersion of WEBGI_materials_diamond is 1e300"),
        (json!({"absorptionFactor": -0.5}), "absorptionFactor of WEBGI_materials_diamond is -0.5"),
        (json!({"color": [1, 2, 3]}), "color of WEBGI_materials_diamond is [1,2,3], but must be three numbers"),
        (json!({"color": "red"}), "color of WEBGI_materials_diamond is \"red\""),
        (json!({"color": 16_777_216}), "but must be three numbers"),
        (json!([]), "its WEBGI_materials_diamond is an array of something else, but must be an object"),
    ] {
        let error = marked(members).expect_err("wrong").to_string();
        assert!(error.contains(says), "{error}");
    }
}
