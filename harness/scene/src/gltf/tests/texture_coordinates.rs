//! `TEXCOORD_0`, in every format that glTF allows.

use glam::Vec2;

use super::refusals::message;
use super::*;

/// Returns a file whose triangle has `data` as its texture coordinates.
fn textured(data: &[u8], accessor: Value) -> (Value, Vec<u8>) {
    let mut document = document();
    document["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(2);
    document["accessors"].as_array_mut().unwrap().push(accessor);
    let view = json!({"buffer": 0, "byteOffset": 44, "byteLength": data.len()});
    document["bufferViews"].as_array_mut().unwrap().push(view);
    document["buffers"][0]["byteLength"] = json!(44 + data.len());
    (document, [binary(), data.to_vec()].concat())
}

fn floats(uvs: &[f32]) -> (Value, Vec<u8>) {
    let data: Vec<u8> = uvs.iter().flat_map(|x| x.to_le_bytes()).collect();
    textured(&data, json!({"bufferView": 2, "componentType": 5126, "count": uvs.len() / 2, "type": "VEC2"}))
}

fn uvs((document, data): (Value, Vec<u8>)) -> Vec<Vec2> {
    only_mesh(&parse(&file(&document, &data), None).unwrap()).uvs.clone()
}

fn refusal((document, data): (Value, Vec<u8>)) -> String {
    let message = parse(&file(&document, &data), None).unwrap_err().to_string();
    assert!(!message.contains('\n'), "{message}");
    message
}

#[test]
fn texture_coordinates_are_read_as_floats_or_fractions() {
    let expected = [Vec2::ZERO, Vec2::new(1.0, 0.2), Vec2::new(0.4, 1.0)];
    assert_eq!(uvs(floats(&[0.0, 0.0, 1.0, 0.2, 0.4, 1.0])), expected);
    let accessor = |component| json!({"bufferView": 2, "componentType": component, "count": 3, "type": "VEC2", "normalized": true});
    assert_eq!(uvs(textured(&[0, 0, 255, 51, 102, 255], accessor(5121))), expected);
    let shorts: [u16; 6] = [0, 0, 65535, 13107, 26214, 65535];
    let shorts: Vec<u8> = shorts.into_iter().flat_map(u16::to_le_bytes).collect();
    assert_eq!(uvs(textured(&shorts, accessor(5123))), expected);
    // Coordinates outside the unit square are valid: the texture repeats.
    assert_eq!(uvs(floats(&[-3.0, 0.0, 1e30, 0.2, 0.4, 1.0]))[0], Vec2::new(-3.0, 0.0));
}

#[test]
fn without_texture_coordinates_there_are_none() {
    assert_eq!(only_mesh(&load_changed(|_| ()).unwrap()).uvs, []);
}

#[test]
fn a_mirror_leaves_texture_coordinates_with_their_vertices() {
    let (mut document, data) = floats(&[0.0, 0.0, 1.0, 0.2, 0.4, 1.0]);
    document["nodes"][0]["scale"] = json!([-1, 1, 1]);
    let scene = parse(&file(&document, &data), None).unwrap();
    let mesh = only_mesh(&scene);
    assert_eq!((mesh.positions[1], mesh.uvs[1]), (Vec3::NEG_X, Vec2::new(1.0, 0.2)));
    assert_eq!(mesh.indices, [0, 2, 1]);
}

#[test]
fn texture_coordinates_that_do_not_fit() {
    let says = refusal(floats(&[0.0, 0.0, 1.0, 0.2]));
    assert!(says.contains("primitive 0: it has not as many texture coordinates as positions"), "{says}");
    for odd in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let says = refusal(floats(&[0.0, 0.0, 1.0, 0.2, 0.4, odd]));
        let start =
            format!("mesh 0, primitive 0: vertex 2 has texture coordinates (0.4, {odd}), but they must be finite");
        assert!(says.starts_with(&start), "{says}");
    }
    let accessor = |changes: Value| {
        let mut accessor = json!({"bufferView": 2, "componentType": 5126, "count": 3, "type": "VEC2"});
        accessor.as_object_mut().unwrap().extend(changes.as_object().unwrap().clone());
        textured(&[0; 36], accessor)
    };
    for changes in [
        json!({"type": "VEC3"}),
        json!({"componentType": 5121}),
        json!({"componentType": 5123, "normalized": false}),
        json!({"componentType": 5122, "normalized": true}),
        json!({"componentType": 5125, "normalized": true}),
    ] {
        let says = refusal(accessor(changes));
        assert!(says.contains("accessor 2: mesh 0, primitive 0 needs VEC2 of float, or of normalised"), "{says}");
    }
    let says = message(|d| d["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(7));
    assert!(says.contains("refers to accessor 7"), "{says}");
}
