//! Mesh instances from `EXT_mesh_gpu_instancing`.

use super::*;
use crate::Mesh;

/// Returns the triangle's file with instances from these attributes, each with its element type,
/// component type and bytes.
fn instanced(attributes: &[(&str, &str, u32, Vec<u8>)], counts: &[u64]) -> (Value, Vec<u8>) {
    let (mut document, mut data) = (document(), binary());
    let mut names = json!({});
    for ((name, kind, component, bytes), count) in attributes.iter().zip(counts) {
        let place = document["accessors"].as_array().unwrap().len();
        names[name] = json!(place);
        let (accessors, start) = (document["accessors"].as_array_mut().unwrap(), data.len());
        accessors.push(json!({"bufferView": place, "componentType": component, "normalized": *component != 5126,
            "count": count, "type": kind}));
        let view = json!({"buffer": 0, "byteOffset": start, "byteLength": bytes.len()});
        document["bufferViews"].as_array_mut().unwrap().push(view);
        data.extend(bytes);
    }
    document["buffers"][0]["byteLength"] = json!(data.len());
    document["nodes"][0]["extensions"] = json!({"EXT_mesh_gpu_instancing": {"attributes": names}});
    document["extensionsRequired"] = json!(["EXT_mesh_gpu_instancing"]);
    (document, data)
}

fn floats(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

const PLACES: [f32; 6] = [0.0, 0.0, 0.0, 5.0, 6.0, 7.0];

fn placed() -> (&'static str, &'static str, u32, Vec<u8>) {
    ("TRANSLATION", "VEC3", 5126, floats(&PLACES))
}

#[test]
fn instances_are_one_object_each_placed_before_its_node() {
    let scales = ("SCALE", "VEC3", 5126, floats(&[1.0, 1.0, 1.0, -2.0, 1.0, 1.0]));
    let (mut document, data) = instanced(&[placed(), scales], &[2, 2]);
    document["nodes"][0]["translation"] = json!([0, 0, 1]);
    document["nodes"][0]["scale"] = json!([2, 2, 2]);
    let scene = parse(&file(&document, &data), None).unwrap();
    let mesh = only_mesh(&scene);
    let [a, b, c] = [Vec3::new(10.0, 12.0, 15.0), Vec3::new(6.0, 12.0, 15.0), Vec3::new(10.0, 14.0, 15.0)];
    assert_eq!(mesh.positions, [Vec3::Z, Vec3::new(2.0, 0.0, 1.0), Vec3::new(0.0, 2.0, 1.0), a, b, c]);
    // The second is mirrored, and still faces +z.
    assert_eq!((&mesh.indices[..], &mesh.normals[..]), (&[0, 1, 2, 3, 5, 4][..], &[Vec3::Z; 6][..]));
    assert_eq!(scene.lacking.clauses(), [""; 0]);
}

#[test]
fn rotations_may_be_floats_bytes_or_shorts() {
    // A quarter turn about z, as (0, 0, √½, √½), and a half turn about it.
    let half = 0.5f32.sqrt();
    let shorts: Vec<u8> = [0i16, 0, 23_170, 23_170, 0, 0, -32_768, 0].into_iter().flat_map(i16::to_le_bytes).collect();
    let bytes: Vec<u8> = [0i8, 0, 90, 90, 0, 0, -128, 0].into_iter().flat_map(i8::to_le_bytes).collect();
    let numbers = floats(&[0.0, 0.0, half, half, 0.0, 0.0, -1.0, 0.0]);
    for (component, data) in [(5126, numbers), (5122, shorts), (5120, bytes)] {
        let (document, data) = instanced(&[("ROTATION", "VEC4", component, data)], &[2]);
        let scene = parse(&file(&document, &data), None).unwrap();
        let expected = [Vec3::ZERO, Vec3::Y, Vec3::NEG_X, Vec3::ZERO, Vec3::NEG_X, Vec3::NEG_Y];
        let mesh: &Mesh = only_mesh(&scene);
        assert!(mesh.positions.iter().zip(expected).all(|(p, e)| p.distance(e) < 1e-6), "{component}: {mesh:?}");
    }
}

#[test]
fn a_thickness_grows_with_its_node() {
    let (mut document, data) = instanced(&[placed()], &[2]);
    document["nodes"][0]["scale"] = json!([3, 3, 3]);
    document["meshes"][0]["primitives"][0]["material"] = json!(0);
    document["materials"][0]["extensions"] = json!({"KHR_materials_volume": {"thicknessFactor": 0.5}});
    let scene = parse(&file(&document, &data), None).unwrap();
    assert!((scene.objects[0].material.thickness - 1.5).abs() < 1e-6);
}

#[test]
fn instances_that_do_not_fit_are_refused() {
    let refused = |attributes: &[(&str, &str, u32, Vec<u8>)], counts: &[u64], says: &str| {
        let (document, data) = instanced(attributes, counts);
        let message = parse(&file(&document, &data), None).unwrap_err().to_string();
        assert!(message.contains(says) && !message.contains('\n'), "{message}");
    };
    let scales = ("SCALE", "VEC3", 5126, floats(&[1.0; 3]));
    refused(
        &[placed(), scales.clone()],
        &[2, 1],
        "node 0 \"stone\": its EXT_mesh_gpu_instancing attributes have 2 and 1",
    );
    refused(&[placed()], &[0], "accessor 2: it has 0 elements");
    refused(&[placed()], &[1 << 31], "accessor 2: it has 2147483648 elements");
    refused(&[], &[], "node 0 \"stone\": its EXT_mesh_gpu_instancing has none of TRANSLATION, ROTATION, SCALE");
    refused(&[("_ID", "VEC3", 5126, floats(&PLACES))], &[2], "has none of TRANSLATION");
    refused(&[("ROTATION", "VEC3", 5126, floats(&PLACES))], &[2], "needs VEC4 of float, or of normalised byte");
    let broken = ("TRANSLATION", "VEC3", 5126, floats(&[0.0, 0.0, 0.0, 0.0, f32::NAN, 0.0]));
    refused(&[broken], &[2], "instance 1 of its EXT_mesh_gpu_instancing is not finite");
    let far = ("TRANSLATION", "VEC3", 5126, floats(&[0.0, 0.0, 0.0, 0.0, 2e9, 0.0]));
    refused(&[far], &[2], "mesh 0, primitive 0, instance 1: vertex 0 lies at");
    for attributes in [json!({"attributes": {"SCALE": "0"}}), json!({"attributes": 3}), json!({}), json!([])] {
        let message = load_changed(|d| d["nodes"][0]["extensions"] = json!({"EXT_mesh_gpu_instancing": attributes}));
        let message = message.unwrap_err().to_string();
        assert!(message.starts_with("node 0 \"stone\": its EXT_mesh_gpu_instancing"), "{message}");
    }
}

#[test]
fn instances_count_in_the_budgets() {
    // Each instance adds three floats, and draws a strip of 100 triangles.
    let count: usize = 200_000;
    let (mut document, mut data) = instanced(&[("TRANSLATION", "VEC3", 5126, vec![0; 12 * count])], &[count as u64]);
    let start = data.len();
    data.extend((0..102u32).flat_map(|k| ((k % 3) as u16).to_le_bytes()));
    document["bufferViews"][1] = json!({"buffer": 0, "byteOffset": start, "byteLength": 204});
    document["accessors"][1]["count"] = json!(102);
    document["meshes"][0]["primitives"][0]["mode"] = json!(5);
    document["buffers"][0]["byteLength"] = json!(data.len());
    let message = parse(&file(&document, &data), None).unwrap_err().to_string();
    assert!(message.contains("more than 16777216 triangles"), "{message}");
    // A twentieth of the instances is within both bounds.
    document["accessors"][2]["count"] = json!(10_000);
    document["bufferViews"][2]["byteLength"] = json!(120_000);
    document["bufferViews"][2]["byteStride"] = json!(12);
    let data = [&data[..44 + 120_000], &data[start..]].concat();
    document["bufferViews"][1]["byteOffset"] = json!(44 + 120_000);
    document["buffers"][0]["byteLength"] = json!(data.len());
    assert_eq!(parse(&file(&document, &data), None).unwrap().triangle_count(), 1_000_000);
}

/// 1,899 teapots of 6,320 triangles, as in a public file: two or three hundred times the size of
/// the file. Here each is a strip with the same number of triangles.
#[test]
fn thousands_of_instances_of_a_large_mesh_load_in_bodies_that_a_device_holds() {
    let count: usize = 1_899;
    let places: Vec<f32> = (0..count).flat_map(|k| [k as f32, 0.0, 0.0]).collect();
    let (mut document, mut data) = instanced(&[("TRANSLATION", "VEC3", 5126, floats(&places))], &[count as u64]);
    let start = data.len();
    data.extend((0..6_322u32).flat_map(|k| ((k % 3) as u16).to_le_bytes()));
    document["bufferViews"][1] = json!({"buffer": 0, "byteOffset": start, "byteLength": 2 * 6_322});
    document["accessors"][1]["count"] = json!(6_322);
    document["meshes"][0]["primitives"][0]["mode"] = json!(5);
    document["buffers"][0]["byteLength"] = json!(data.len());
    let scene = parse(&file(&document, &data), None).unwrap();
    assert_eq!(scene.triangle_count(), count * 6_320);
    // WebGPU's guaranteed minimum for the size of a storage buffer.
    let held = |mesh: &Mesh| 12 * mesh.positions.len() <= 128 << 20 && 64 * mesh.triangle_count() <= 128 << 20;
    assert!(
        scene.objects.len() < 16 && scene.objects.iter().all(|object| held(&object.mesh)),
        "{}",
        scene.objects.len()
    );
}
