//! The example of docs/scene_files.md.

use super::*;
use crate::scene::convex::is_closed;
use crate::scene::{Light, Medium};

#[test]
fn the_documented_example_loads_as_it_says() {
    let page = include_str!("../../../../../docs/scene_files.md");
    let (_, rest) = page.split_once("```json\n").unwrap();
    let (example, _) = rest.split_once("```").unwrap();
    let scene = parse(example.as_bytes(), None).unwrap();
    let material = &scene.objects[0].material;
    assert_eq!((material.name.as_str(), material.ior, material.roughness), ("skin", 1.4, 0.45));
    assert_eq!(material.base_color, Vec3::new(0.625, 0.385, 0.241));
    assert_eq!(material.sigma0, Some(Vec3::new(5.8, 3.8, 2.3)));
    let medium = Medium::isotropic(Vec3::new(0.74, 0.88, 1.01), Vec3::new(0.032, 0.17, 0.48));
    assert_eq!(material.medium, Some(medium));

    let mesh = only_mesh(&scene);
    assert!(is_closed(mesh) && mesh.volume_and_area().0 > 0.0 && mesh.triangle_count() == 4);
    let width = mesh.positions[0].distance(mesh.positions[1]);
    assert!((17.0..17.5).contains(&width), "{width}");
    for triangle in mesh.indices.chunks_exact(3) {
        let [a, b, c] = [0, 1, 2].map(|k| mesh.uvs[triangle[k] as usize]);
        // A net of equal triangles, clockwise with v down.
        assert!(((b - a).perp_dot(c - a) + 0.25).abs() < 1e-4);
    }

    let [Light::Directional { toward, irradiance }, lamp] = scene.lights[..] else { panic!("{:?}", scene.lights) };
    let from_above = Vec3::new(0.0, 3f32.sqrt() / 2.0, 0.5);
    assert!(toward.distance(from_above) < 1e-6 && irradiance == Vec3::splat(std::f32::consts::PI), "{toward}");
    let intensity = Vec3::new(300.0, 225.0, 150.0);
    assert_eq!(lamp, Light::Point { position: Vec3::new(30.0, 20.0, 10.0), intensity });
}

#[test]
fn the_page_names_every_extension_that_is_read() {
    let page = include_str!("../../../../../docs/scene_files.md");
    // The two others say how light passes the surface, which is followed anyway.
    for name in KNOWN_EXTENSIONS.iter().filter(|name| !name.ends_with("transmission")) {
        assert!(page.contains(name), "{name}");
    }
    for mineral in Mineral::ALL {
        assert!(page.contains(mineral.name()), "{mineral:?}");
    }
}
