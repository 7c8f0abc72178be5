//! The example of docs/scene_files.md.

use lapidary_veins::VeinsPattern;

use super::*;
use crate::convex::is_closed;
use crate::{Density, Light, Medium, Object};

const PAGE: &str = include_str!("../../../../../docs/scene_files.md");

fn example() -> Scene {
    let (_, rest) = PAGE.split_once("```json\n").unwrap();
    let (example, _) = rest.split_once("```").unwrap();
    parse(example.as_bytes(), None).unwrap()
}

#[test]
fn the_documented_example_asks_for_nothing_in_vain_and_survives_writing() {
    let scene = example();
    assert_eq!(scene.lacking.clauses(), [""; 0]);
    let names: Vec<&str> = scene.objects.iter().map(|object| object.name.as_str()).collect();
    assert_eq!(names, ["skin", "jade", "rubies", "wax"]);
    let again = parse(&glb::write(&scene).unwrap(), None).unwrap();
    assert_eq!((&again.objects, &again.lights), (&scene.objects, &scene.lights));
    assert_eq!((scene.camera.eye, scene.camera.vertical_fov), (Vec3::new(0.0, 8.0, 90.0), 0.5));
}

#[test]
fn the_documented_skin_and_jade_load_as_they_say() {
    let [Object { mesh, material: skin, .. }, Object { mesh: small, material: jade, .. }, ..] = &example().objects[..]
    else {
        panic!("four objects");
    };
    assert_eq!((skin.name.as_str(), skin.ior, skin.roughness), ("skin", 1.4, 0.45));
    assert_eq!(skin.base_color, Vec3::new(0.625, 0.385, 0.241));
    assert_eq!(skin.sigma0, Some(Vec3::new(5.8, 3.8, 2.3)));
    assert_eq!(skin.solver, Some("accurate".parse().unwrap()));
    let medium = Medium::isotropic(Vec3::new(0.74, 0.88, 1.01), Vec3::new(0.032, 0.17, 0.48));
    assert_eq!(skin.medium, Some(medium));
    let pattern = VeinsPattern { frequency: 0.1, width: 0.08, least: 0.5, greatest: 4.0, octaves: 3, seed: 7 };
    let medium = Medium::isotropic(Vec3::new(1.6, 2.4, 1.8), Vec3::new(0.12, 0.02, 0.08));
    assert_eq!(jade.medium, Some(Medium { anisotropy: 0.5, density: Density::Veins(pattern), ..medium }));
    assert_eq!(jade.solver, Some("godunov-64".parse().unwrap()));

    assert!(is_closed(mesh) && mesh.volume_and_area().0 > 0.0 && mesh.triangle_count() == 4);
    let width = mesh.positions[0].distance(mesh.positions[1]);
    assert!((17.0..17.5).contains(&width), "{width}");
    for triangle in mesh.indices.chunks_exact(3) {
        let [a, b, c] = [0, 1, 2].map(|k| mesh.uvs[triangle[k] as usize]);
        // A grid of equal triangles, clockwise if v points down.
        assert!(((b - a).perp_dot(c - a) + 0.25).abs() < 1e-4);
    }
    let halved = |p: &Vec3| 0.5 * *p + Vec3::new(22.0, 0.0, 0.0);
    assert!(small.positions.iter().zip(&mesh.positions).all(|(small, p)| small.distance(halved(p)) < 1e-5));
}

#[test]
fn the_documented_rubies_and_wax_load_as_they_say() {
    let objects = example().objects;
    let [_, _, Object { mesh: rubies, material: ruby, .. }, Object { mesh, material: wax, .. }] = &objects[..] else {
        panic!("four objects");
    };
    assert_eq!(ruby.dispersion, Dispersion::Sellmeier(Mineral::Corundum));
    assert_eq!((ruby.transmission, ruby.attenuation_distance, ruby.ior), (1.0, 8.0, Mineral::Corundum.index()));
    // The largest of the three is 1.5 times as high as the mesh.
    assert!((ruby.thickness - 4.0 * 1.5f32.cbrt()).abs() < 1e-5, "{}", ruby.thickness);
    assert!(is_closed(rubies) && rubies.triangle_count() == 24);
    let volume = 4.0 / 3.0 * 64.0;
    assert!((rubies.volume_and_area().0 - volume * (1.0 + 0.125 + 1.5)).abs() < 1e-3);
    let [_, turned, high] = [0, 6, 12].map(|first| &rubies.positions[first..first + 6]);
    // Scaled by a half, rotated by an eighth of a turn about y.
    let expected = Vec3::new(0.0, 4.0, 24.0) + Vec3::new(2.0, 0.0, -2.0) * 0.5f32.sqrt();
    assert!(turned[0].distance(expected) < 1e-3, "{}", turned[0]);
    assert!(high[2].distance(Vec3::new(12.0, 12.0, 20.0)) < 1e-5 && high[0].x < 12.0);

    assert!((wax.thickness - 8.0 * 2f32.cbrt()).abs() < 1e-5);
    assert_eq!((wax.transmission, wax.diffuse_transmission), (0.0, 1.0));
    assert_eq!(wax.diffuse_transmission_color, Vec3::new(1.0, 1.0, 0.95));
    let medium = wax.medium.as_ref().unwrap();
    let extinction = medium.scattering + medium.absorption;
    assert!(extinction.distance(Vec3::splat(-0.3f32.ln())) < 1e-6);
    // Wax absorbs more blue than red.
    assert!(medium.absorption.x < medium.absorption.y && medium.absorption.y < medium.absorption.z);
    assert!(mesh.volume_and_area().0 > 0.0 && mesh.normals.contains(&Vec3::Y));
}

#[test]
fn the_documented_lights_load_as_they_say() {
    let [Light::Directional { toward, irradiance }, lamp, spot] = example().lights[..] else { panic!("three lights") };
    let from_above = Vec3::new(0.0, 3f32.sqrt() / 2.0, 0.5);
    assert!(toward.distance(from_above) < 1e-6 && irradiance == Vec3::splat(std::f32::consts::PI), "{toward}");
    let intensity = Vec3::new(300.0, 225.0, 150.0);
    assert_eq!(lamp, Light::Point { position: Vec3::new(30.0, 20.0, 10.0), intensity });
    let (position, intensity) = (Vec3::new(0.0, 10.0, 60.0), Vec3::splat(900.0));
    assert_eq!(spot, Light::Spot { position, direction: Vec3::NEG_Z, intensity, inner_angle: 0.1, outer_angle: 0.3 });
}

#[test]
fn the_page_names_every_extension_that_is_read() {
    for name in KNOWN_EXTENSIONS {
        assert!(PAGE.contains(&format!("| `{name}` |")), "{name}");
        // The example has no images, no vendor's mark and no compressed numbers, and its materials are not of the archived form.
        let is_shown = (name.starts_with("KHR_materials") && name != specular_glossiness::NAME)
            || [INSTANCING, "KHR_lights_punctual"].contains(&name);
        assert_eq!(PAGE.contains(&format!("\"{name}\"")), is_shown, "{name}");
    }
    for mineral in Mineral::ALL {
        assert!(PAGE.contains(mineral.name()), "{mineral:?}");
    }
}
