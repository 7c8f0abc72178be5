//! `COLOR_0`, in every format that glTF allows.

use super::refusals::one_line;
use super::*;

/// Returns a file whose triangle has `data` as its colours.
fn colored(data: &[u8], accessor: Value) -> (Value, Vec<u8>) {
    let mut document = document();
    document["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(2);
    document["accessors"].as_array_mut().unwrap().push(accessor);
    let view = json!({"buffer": 0, "byteOffset": 44, "byteLength": data.len()});
    document["bufferViews"].as_array_mut().unwrap().push(view);
    document["buffers"][0]["byteLength"] = json!(44 + data.len());
    (document, [binary(), data.to_vec()].concat())
}

fn accessor(component: u32, type_: &str) -> Value {
    json!({"bufferView": 2, "componentType": component, "count": 3, "type": type_, "normalized": component != 5126})
}

fn floats(colors: &[f32], type_: &str) -> (Value, Vec<u8>) {
    let data: Vec<u8> = colors.iter().flat_map(|x| x.to_le_bytes()).collect();
    colored(&data, accessor(5126, type_))
}

fn colors((document, data): (Value, Vec<u8>)) -> Vec<Vec3> {
    only_mesh(&parse(&file(&document, &data), None).unwrap()).colors.clone()
}

#[test]
fn colours_are_read_as_floats_or_fractions_with_or_without_alpha() {
    let expected = [Vec3::new(0.0, 0.2, 1.0), Vec3::new(0.4, 1.0, 0.0), Vec3::ONE];
    for (type_, alpha) in [("VEC3", None), ("VEC4", Some(51u8))] {
        let texels = [[0, 51, 255], [102, 255, 0], [255, 255, 255u8]];
        let bytes: Vec<u8> = texels.into_iter().flat_map(|color| color.into_iter().chain(alpha)).collect();
        let shorts: Vec<u8> = bytes.iter().flat_map(|byte| (u16::from(*byte) * 257).to_le_bytes()).collect();
        let singles: Vec<f32> = bytes.iter().map(|byte| f32::from(*byte) / 255.0).collect();
        assert_eq!(colors(colored(&bytes, accessor(5121, type_))), expected, "{type_}");
        assert_eq!(colors(colored(&shorts, accessor(5123, type_))), expected, "{type_}");
        assert_eq!(colors(floats(&singles, type_)), expected, "{type_}");
    }
    // Bytes in threes are padded to four.
    let mut padded = accessor(5121, "VEC3");
    padded["count"] = json!(3);
    let (mut document, data) = colored(&[0, 51, 255, 9, 102, 255, 0, 9, 255, 255, 255, 9], padded);
    document["bufferViews"][2]["byteStride"] = json!(4);
    assert_eq!(colors((document, data)), expected);
}

#[test]
fn colours_are_clamped_and_white_is_none() {
    let found = colors(floats(&[-1.0, 0.5, 7.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0], "VEC3"));
    assert_eq!(found, [Vec3::new(0.0, 0.5, 1.0), Vec3::ONE, Vec3::ZERO]);
    assert_eq!(colors(floats(&[1.0; 12], "VEC4")), []);
    assert_eq!(only_mesh(&load_changed(|_| ()).unwrap()).colors, []);
}

#[test]
fn colours_that_do_not_fit() {
    let refusal = |(document, data): (Value, Vec<u8>)| one_line(parse(&file(&document, &data), None));
    for odd in [f32::NAN, f32::INFINITY] {
        let says = refusal(floats(&[0.0, 0.0, 0.0, 0.0, odd, 0.0, 0.0, 0.0, 0.0], "VEC3"));
        let start = format!("mesh 0, primitive 0: vertex 1 has the colour (0, {odd}, 0), but it must be finite");
        assert!(says.starts_with(&start), "{says}");
    }
    let mut short = accessor(5126, "VEC3");
    short["count"] = json!(2);
    let says = refusal(colored(&[0; 36], short));
    assert!(says.contains("primitive 0: it has not as many colours as positions"), "{says}");
    let mut plain = accessor(5121, "VEC4");
    plain["normalized"] = json!(false);
    for wrong in [accessor(5126, "VEC2"), accessor(5120, "VEC4"), accessor(5125, "VEC4"), accessor(1, "VEC4"), plain] {
        let says = refusal(colored(&[0; 48], wrong));
        let kind = "needs VEC3 or VEC4 of float, or of normalised unsigned byte or short, there";
        assert!(says.starts_with("accessor 2: ") && (says.contains(kind) || says.contains("componentType")), "{says}");
    }
    let says = refusal(colored(&[0; 12], accessor(5126, "VEC3")));
    assert!(says.contains("accessor 2: it has 3 elements of 12 bytes"), "{says}");
}

#[test]
fn instances_have_the_colours_of_their_shape() {
    let (mut document, data) = floats(&[0.0, 0.5, 1.0, 0.25, 0.0, 0.0, 1.0, 1.0, 1.0], "VEC3");
    document["nodes"][0]["extensions"] = json!({"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 0}}});
    let scene = parse(&file(&document, &data), None).unwrap();
    let object = &scene.objects[0];
    assert_eq!(object.mesh.colors, object.shape().colors.repeat(3));
    assert_eq!(object.shape().colors[1], Vec3::new(0.25, 0.0, 0.0));
}
