//! Textures and vertex colours survive writing and loading.

use std::sync::Arc;

use super::*;
use crate::{Texels, Texture, TextureSlot, TextureTransform, Wrap};

/// Returns an octahedron with texture coordinates.
fn octahedron() -> Scene {
    let mut scene = Scene::named("octahedron").unwrap();
    let mesh = &mut scene.objects[0].mesh;
    mesh.uvs = mesh.positions.iter().map(|position| position.truncate()).collect();
    scene
}

/// Returns an image of three columns and two rows.
fn texels(alpha: u8) -> Arc<Texels> {
    let bytes = (0..6u8).flat_map(|k| [k, 40 * k, 255 - k, alpha]).collect();
    Arc::new(Texels::new(3, 2, bytes).unwrap())
}

/// Returns a material with a texture in every slot, each looked up in another way.
fn material(texels: &Arc<Texels>) -> Material {
    let mut material = Material {
        normal_scale: -0.25,
        transmission: 0.5,
        diffuse_transmission: 1.0 / 3.0,
        thickness: 2.0,
        ..Material::standard()
    };
    let wraps = [Wrap::Repeat, Wrap::MirroredRepeat, Wrap::ClampToEdge];
    for (k, slot) in TextureSlot::ALL.into_iter().enumerate() {
        let mut texture = Texture::new(Arc::clone(texels), slot.encoding());
        texture.wrap = [wraps[k % 3], wraps[k / 2]];
        let part = k as f32 / 7.0;
        texture.transform =
            TextureTransform { offset: Vec2::new(part, 0.0), rotation: 2.0 * part, scale: Vec2::splat(1.0 + part) };
        *material.texture_mut(slot) = Some(texture);
    }
    material
}

fn again(scene: &Scene) -> Vec<Object> {
    gltf::parse(&write(scene).unwrap(), None).unwrap().objects
}

#[test]
fn textures_of_every_slot_come_back() {
    for alpha in [255, 7] {
        let mut scene = octahedron();
        scene.objects[0].material = material(&texels(alpha));
        assert_eq!(again(&scene), scene.objects);
        assert_eq!(write(&scene).unwrap(), write(&scene).unwrap());
    }
    let json = json_of(&Scene {
        objects: vec![Object { material: material(&texels(255)), ..octahedron().objects[0].clone() }],
        ..octahedron()
    });
    assert!(json["extensionsUsed"].as_array().unwrap().contains(&json!("KHR_texture_transform")));
    // Without a transform or a wrap of its own, nothing is said of them.
    let plain = json_of(&plain());
    assert_eq!(plain["extensionsUsed"], json!(["KHR_materials_ior"]));
    assert_eq!((&plain["textures"], &plain["samplers"]), (&json!([{"source": 0}]), &Value::Null));
    assert_eq!(plain["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"], json!({"index": 0}));
}

/// Returns a body with a base colour texture.
fn plain() -> Scene {
    let mut scene = octahedron();
    let texture = Texture::new(texels(255), TextureSlot::BaseColor.encoding());
    scene.objects[0].material = Material { base_color_texture: Some(texture), ..Material::standard() };
    scene
}

#[test]
fn an_image_is_written_once_as_png() {
    let mut scene = octahedron();
    let image = texels(255);
    scene.objects[0].material = material(&image);
    scene.objects.push(scene.objects[0].clone());
    // The same texels in an image of their own are another image.
    scene.objects.push(Object { material: material(&texels(255)), ..scene.objects[0].clone() });
    let json = json_of(&scene);
    assert_eq!((json["images"].as_array().unwrap().len(), json["textures"].as_array().unwrap().len()), (2, 12));
    assert_eq!(json["images"][0]["mimeType"], "image/png");
    let bytes = write(&scene).unwrap();
    let (_, text) = chunk(&bytes, 12);
    let (_, binary) = chunk(&bytes, 20 + text.len());
    let view = &json["bufferViews"][json["images"][0]["bufferView"].as_u64().unwrap() as usize];
    assert_eq!(view["target"], Value::Null);
    assert!(binary[view["byteOffset"].as_u64().unwrap() as usize..].starts_with(b"\x89PNG\r\n\x1a\n"));
    let again = again(&scene);
    let shared = |body: usize| &again[body].material.base_color_texture.as_ref().unwrap().texels;
    assert!(Arc::ptr_eq(shared(0), shared(1)) && !Arc::ptr_eq(shared(0), shared(2)));
}

#[test]
fn textures_without_effect_are_left_out() {
    let mut scene = octahedron();
    let all = material(&texels(255));
    let without = Material {
        base_color: Vec3::ZERO,
        normal_scale: 0.0,
        transmission: 0.0,
        diffuse_transmission: 0.0,
        thickness: 0.0,
        roughness: 0.0,
        ..all
    };
    scene.objects[0].material = without;
    let json = json_of(&scene);
    assert_eq!((&json["images"], &json["textures"]), (&Value::Null, &Value::Null));
    assert_eq!(again(&scene)[0].material.textures().count(), 0);
}

#[test]
fn vertex_colours_come_back() {
    let mut scene = Scene::named("octahedron").unwrap();
    let count = scene.objects[0].mesh.positions.len();
    scene.objects[0].mesh.colors = (0..count).map(|k| Vec3::new(k as f32 / count as f32, 1.0, 1.0 / 3.0)).collect();
    assert_eq!(again(&scene), scene.objects);
    assert_eq!(
        json_of(&Scene::named("octahedron").unwrap())["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"],
        Value::Null
    );
}

#[test]
fn what_gltf_forbids_of_them_is_refused() {
    let refused = |change: fn(&mut Scene)| {
        let mut scene = plain();
        change(&mut scene);
        write(&scene).unwrap_err().to_string()
    };
    assert!(refused(|s| s.objects[0].mesh.uvs.clear()).contains("no texture coordinates"));
    assert!(refused(|s| s.objects[0].mesh.colors = vec![Vec3::ONE]).contains("one colour for each position"));
    let colored = |s: &mut Scene| s.objects[0].mesh.colors = vec![Vec3::NAN; s.objects[0].mesh.positions.len()];
    assert!(refused(colored).contains("vertex colour"));
    assert!(refused(|s| s.objects[0].material.normal_scale = f32::NAN).contains("normal scale"));
    let moved = |s: &mut Scene| {
        s.objects[0].material.base_color_texture.as_mut().unwrap().transform.rotation = f32::INFINITY;
    };
    assert!(refused(moved).contains("transform"));
}
