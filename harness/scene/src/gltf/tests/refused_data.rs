//! Bad buffers, views, accessors and vertices are refused with one line that describes the problem.

use super::refusals::{message, refused};
use super::*;

#[test]
fn ranges_past_the_end_and_absurd_counts() {
    let huge = json!(u64::MAX);
    // The fourth claims two gigabytes.
    for count in [json!(0), json!(4), json!(u64::MAX / 12 + 1), json!((1u64 << 31) / 12), huge.clone()] {
        refused("/accessors/0/count", count, "accessor 0: it has");
    }
    refused("/accessors/0/byteOffset", json!(1), "accessor 0: it has");
    refused("/accessors/0/byteOffset", huge.clone(), "accessor 0: it has");
    refused("/bufferViews/0/byteLength", json!(45), "bufferView 0: it takes 45 bytes");
    refused("/bufferViews/0/byteLength", huge.clone(), "bufferView 0: it takes");
    refused("/bufferViews/1/byteOffset", huge.clone(), "bufferView 1: it takes");
    refused("/buffers/0/byteLength", json!(48), "buffer 0: it must have 48 bytes but has 44");
    refused("/buffers/0/byteLength", huge, "at most 1073741824 are read");
    for stride in [0, 4, 11, 253] {
        refused("/bufferViews/0/byteStride", json!(stride), "must lie 12 to 252 apart");
    }
}

#[test]
fn accessors_of_the_wrong_kind() {
    refused("/accessors/0/componentType", json!(5123), "needs VEC3 of float");
    refused("/accessors/0/componentType", json!(1), "componentType is not one of glTF's");
    refused("/accessors/0/type", json!("VEC4"), "needs VEC3 of float");
    refused("/accessors/0/type", json!("VEC9"), "type is not one of glTF's");
    refused("/accessors/1/componentType", json!(5126), "unsigned byte, short or int");
    refused("/accessors/0/bufferView", Value::Null, "it has no bufferView");
    refused("/meshes/0/primitives/0/attributes", json!({}), "it has no POSITION");
    refused("/accessors/1/count", json!(2), "shows no triangles");
}

#[test]
fn positions_that_are_nowhere() {
    for (vertex, value) in [(0, f32::NAN), (1, f32::INFINITY), (2, -2e9)] {
        let mut data = binary();
        data[12 * vertex..12 * vertex + 4].copy_from_slice(&value.to_le_bytes());
        let message = parse(&file(&document(), &data), None).unwrap_err().to_string();
        assert!(message.starts_with("mesh 0, primitive 0: vertex "), "{message}");
        assert!(message.contains(&format!("vertex {vertex} lies at")), "{message}");
    }
    refused("/nodes/0/scale", json!([1e30, 1.0, 1.0]), "vertex 1 lies at");
    refused("/nodes/0/translation", json!([1e39, 0.0, 0.0]), "vertex 0 lies at");
}

#[test]
fn indices_past_the_last_vertex() {
    let mut data = binary();
    data[38] = 3;
    let message = parse(&file(&document(), &data), None).unwrap_err().to_string();
    assert!(message.contains("primitive 0: index 1 is 3, but it has 3 vertices"), "{message}");
}

#[test]
fn buffers_that_cannot_be_had() {
    for (uri, says) in [
        ("data:text/plain,hello", "not base64"),
        ("data:;base64", "no comma"),
        ("data:;base64,!!!", "base64 is damaged"),
        ("data:;base64,AAAA", "must have 44 bytes but has 3"),
        ("http://example.com/a.bin", "not a relative path"),
        ("/etc/passwd", "not a relative path"),
        ("../stone.bin", "leads out of the file's folder"),
        ("a/../../stone.bin", "leads out of the file's folder"),
        ("%2e%2e/stone.bin", "leads out of the file's folder"),
        ("%2E%2E%5Cstone.bin", "leads out of the file's folder"),
        ("%2Fetc%2Fpasswd", "not a relative path"),
        ("C:%5Cstone.bin", "not a relative path"),
        ("%zz", "is not valid"),
        ("%00", "is not valid"),
        ("stone.bin", "did not come from a file"),
    ] {
        refused("/buffers/0/uri", json!(uri), says);
    }
    let mut document = document();
    document["buffers"][0]["uri"] = json!("none.bin");
    let folder = tempfile::tempdir().unwrap();
    let json = document.to_string();
    let message = parse(json.as_bytes(), Some(folder.path())).unwrap_err().to_string();
    assert!(message.starts_with("buffer 0's file") && message.contains("none.bin"), "{message}");
    document["buffers"][0] = json!({"byteLength": 44});
    let message = parse(document.to_string().as_bytes(), None).unwrap_err().to_string();
    assert!(message.contains("no uri and no binary chunk"), "{message}");
}

#[test]
#[cfg(unix)]
fn links_may_not_lead_out_of_the_folder() {
    let [inside, outside] = [(); 2].map(|()| tempfile::tempdir().unwrap());
    let secret = outside.path().join("secret.bin");
    std::fs::write(&secret, binary()).unwrap();
    std::fs::write(inside.path().join("own.bin"), binary()).unwrap();
    let link = |target: &std::path::Path, name: &str| {
        std::os::unix::fs::symlink(target, inside.path().join(name)).unwrap();
    };
    link(&secret, "far.bin");
    link(outside.path(), "folder");
    link(&inside.path().join("own.bin"), "near.bin");
    let load = |uri: &str| {
        let mut document = document();
        document["buffers"][0]["uri"] = json!(uri);
        parse(document.to_string().as_bytes(), Some(inside.path()))
    };
    for uri in ["far.bin", "folder/secret.bin"] {
        let message = load(uri).unwrap_err().to_string();
        assert!(
            message.starts_with("buffer 0: its uri leads by a link to ") && message.contains("out of"),
            "{message}"
        );
    }
    assert_eq!(load("near.bin").unwrap().triangle_count(), 1);
}

#[test]
fn many_nodes_of_many_lines_are_refused() {
    let message = message(|d| {
        let line = json!({"attributes": {"POSITION": 0}, "mode": 1});
        d["meshes"][0]["primitives"] = vec![line; 20_000].into();
        d["nodes"] = vec![json!({"mesh": 0}); 20_000].into();
        d["scenes"][0]["nodes"] = (0..20_000).collect();
    });
    assert!(message.contains("show fewer instances"), "{message}");
}

#[test]
fn small_files_that_unfold_to_large_scenes() {
    // A thousand primitives of a mesh, shown by a thousand nodes: a million bodies from about 100
    // KB.
    let message = message(|d| {
        let primitive = d["meshes"][0]["primitives"][0].clone();
        d["meshes"][0]["primitives"] = vec![primitive; 1_000].into();
        d["nodes"] = vec![json!({"mesh": 0}); 1_000].into();
        d["scenes"][0]["nodes"] = (0..1_000).collect();
    });
    assert!(message.contains("show fewer instances"), "{message}");
}

/// The limit is on the memory needed, not on its ratio to the size of the file: a mesh of a
/// thousand triangles at two thousand places loads from a small file, and no file exceeds the
/// budget.
#[test]
fn memory_is_bounded_whatever_the_files_size() {
    let with = |nodes: usize, corners: usize| {
        load_changed(|d| {
            // One triangle repeated, with indices that share four bytes.
            d["meshes"][0]["primitives"] = json!([{"attributes": {"POSITION": 0}, "mode": 5, "indices": 1}]);
            let data: Vec<u8> = (0..corners).flat_map(|k| ((k % 3) as u16).to_le_bytes()).collect();
            use base64::Engine;
            let uri = format!("data:;base64,{}", base64::engine::general_purpose::STANDARD.encode(&data));
            d["buffers"].as_array_mut().unwrap().push(json!({"byteLength": data.len(), "uri": uri}));
            d["bufferViews"][1] = json!({"buffer": 1, "byteLength": data.len()});
            d["accessors"][1]["count"] = json!(corners);
            d["nodes"] = vec![json!({"mesh": 0}); nodes].into();
            d["scenes"][0]["nodes"] = (0..nodes).collect();
        })
    };
    // 24 MB of mesh from 100 KB, beyond the former limit of 256 times the size of the file.
    let scene = with(2_000, 1_002).unwrap();
    assert_eq!(scene.triangle_count(), 2_000_000);
    let message = with(20_000, 1_002).unwrap_err().to_string();
    assert!(message.contains("more than 16777216 triangles"), "{message}");
    let message = with(70_000, 3).unwrap_err().to_string();
    assert!(message.contains("more than 65536 bodies"), "{message}");
}

/// The limits complement each other: vertices with texture coordinates that no triangle uses.
#[test]
fn the_budget_counts_bytes() {
    use crate::gltf::budget::Budget;
    let mut budget = Budget::new();
    let most = 3 * MAX_TRIANGLES;
    assert_eq!(budget.take(1, most, 32, MAX_TRIANGLES), Ok(()));
    assert_eq!(budget.take(MAX_OBJECTS, 0, 0, 0), Err(GltfError::TooManyObjects));
    assert_eq!(budget.take(0, 1, 32, 0), Err(GltfError::TooManyTriangles));
    assert_eq!(Budget::new().take(1, most, 64, 0), Err(GltfError::TooMuchMemory));
}
