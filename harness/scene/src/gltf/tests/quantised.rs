//! Numbers of vertices as `KHR_mesh_quantization` stores them.

use glam::Vec2;

use super::refusals::one_line;
use super::*;

const NAME: &str = "KHR_mesh_quantization";

/// Integers in the bytes of a component type, with its number in glTF.
fn stored(component: u32, numbers: &[i32]) -> Vec<u8> {
    let size = if component < 5122 { 1 } else { 2 };
    numbers.iter().flat_map(|number| number.to_le_bytes().into_iter().take(size)).collect()
}

/// A file whose triangle has these integers as an attribute of `width` components.
fn with(attribute: &str, width: usize, component: u32, normalized: bool, numbers: &[i32]) -> (Value, Vec<u8>) {
    let mut document = document();
    document["extensionsUsed"] = json!([NAME]);
    document["extensionsRequired"] = json!([NAME]);
    document["meshes"][0]["primitives"][0]["attributes"][attribute] = json!(2);
    let type_ = format!("VEC{width}");
    let accessor =
        json!({"bufferView": 2, "componentType": component, "normalized": normalized, "count": 3, "type": type_});
    document["accessors"].as_array_mut().unwrap().push(accessor);
    // Elements begin at multiples of four bytes.
    let size = if component < 5122 { 1 } else { 2 };
    let stride = (width * size).next_multiple_of(4);
    let mut data = binary();
    for element in numbers.chunks(width) {
        let mut bytes = stored(component, element);
        bytes.resize(stride, 0xaa);
        data.extend(bytes);
    }
    let length = data.len() - 44;
    let view = json!({"buffer": 0, "byteOffset": 44, "byteLength": length, "byteStride": stride});
    document["bufferViews"].as_array_mut().unwrap().push(view);
    document["buffers"][0]["byteLength"] = json!(data.len());
    (document, data)
}

fn loaded((document, data): (Value, Vec<u8>)) -> crate::Mesh {
    only_mesh(&parse(&file(&document, &data), None).unwrap()).clone()
}

/// Each component type with the least and the greatest number, and what the least stands for if it is normalised.
const TYPES: [(u32, i32, i32, f32); 4] =
    [(5120, -128, 127, -1.0), (5121, 0, 255, 0.0), (5122, -32768, 32767, -1.0), (5123, 0, 65535, 0.0)];

#[test]
fn positions_are_integers_or_fractions_of_the_largest() {
    for (component, least, greatest, lowest) in TYPES {
        let numbers = [least, 0, 0, greatest, 1, 0, 0, greatest, 3];
        let plain = loaded(with("POSITION", 3, component, false, &numbers));
        let vectors: Vec<Vec3> =
            numbers.chunks(3).map(|of| Vec3::new(of[0] as f32, of[1] as f32, of[2] as f32)).collect();
        assert_eq!(plain.positions, vectors, "{component}");
        let normalised = loaded(with("POSITION", 3, component, true, &numbers));
        let step = 1.0 / greatest as f32;
        let expected =
            [Vec3::new(lowest, 0.0, 0.0), Vec3::new(1.0, step, 0.0), Vec3::new(0.0, 1.0, 3.0 / greatest as f32)];
        assert_eq!(normalised.positions, expected, "{component}");
    }
}

/// The node undoes the quantisation, as packers write it.
#[test]
fn a_node_places_quantised_positions() {
    let (mut document, data) = with("POSITION", 3, 5123, false, &[0, 0, 0, 16384, 0, 0, 0, 8192, 0]);
    document["nodes"][0]["scale"] = json!([1.0 / 16384.0, 1.0 / 16384.0, 1.0 / 16384.0]);
    document["nodes"][0]["translation"] = json!([1, 2, 3]);
    let expected = [[1.0, 2.0, 3.0], [2.0, 2.0, 3.0], [1.0, 2.5, 3.0]].map(Vec3::from_array);
    assert_eq!(loaded((document, data)).positions, expected);
}

#[test]
fn normals_are_normalised_integers_with_a_sign() {
    for (component, largest) in [(5120, 127), (5122, 32767)] {
        let numbers = [0, 0, largest, 0, -largest, 0, -largest - 1, 0, 0];
        let mesh = loaded(with("NORMAL", 3, component, true, &numbers));
        assert_eq!(mesh.normals, [Vec3::Z, Vec3::NEG_Y, Vec3::NEG_X]);
    }
}

#[test]
fn texture_coordinates_of_every_kind() {
    for (component, least, greatest, lowest) in TYPES {
        let numbers = [0, 0, greatest, 0, least, greatest];
        let largest = greatest as f32;
        let plain = [Vec2::ZERO, Vec2::new(largest, 0.0), Vec2::new(least as f32, largest)];
        assert_eq!(loaded(with("TEXCOORD_0", 2, component, false, &numbers)).uvs, plain);
        let normalised = [Vec2::ZERO, Vec2::X, Vec2::new(lowest, 1.0)];
        assert_eq!(loaded(with("TEXCOORD_0", 2, component, true, &numbers)).uvs, normalised);
    }
}

#[test]
fn what_the_extension_does_not_allow() {
    let refused = |(document, data): (Value, Vec<u8>), says: &str| {
        let message = one_line(parse(&file(&document, &data), None));
        assert!(message.contains(says), "{message}");
    };
    let nine = [0, 0, 1, 0, 1, 0, 1, 0, 0];
    // Directions have signs, and fill the range of their type.
    for (component, normalized) in [(5120, false), (5122, false), (5121, true), (5123, true)] {
        refused(with("NORMAL", 3, component, normalized, &nine), "accessor 2: mesh 0, primitive 0 needs VEC3 of float");
    }
    let (mut document, data) = with("POSITION", 3, 5122, false, &nine);
    document.as_object_mut().unwrap().remove("extensionsUsed");
    document["extensionsRequired"] = json!([]);
    refused((document, data), "or KHR_mesh_quantization in extensionsUsed");
    // Instances are placed in floats, with the extension or without.
    let (mut document, data) = with("POSITION", 3, 5122, false, &nine);
    document["nodes"][0]["extensions"] = json!({"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 2}}});
    refused((document, data), "EXT_mesh_gpu_instancing needs VEC3 of float");
}
