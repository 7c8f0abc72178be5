//! Sparse accessors.

use super::*;

/// The triangle whose corners of these numbers are moved to (5, 6, 7) and (8, 9, 10) by a sparse accessor.
fn moved(places: [u16; 2], change: impl FnOnce(&mut Value)) -> Result<Scene, SceneError> {
    let mut data = binary();
    data.extend(places.into_iter().flat_map(u16::to_le_bytes));
    data.extend([5.0f32, 6.0, 7.0, 8.0, 9.0, 10.0].into_iter().flat_map(f32::to_le_bytes));
    let mut document = document();
    document["buffers"][0]["byteLength"] = json!(data.len());
    let views = document["bufferViews"].as_array_mut().unwrap();
    views.push(json!({"buffer": 0, "byteOffset": 44, "byteLength": 4}));
    views.push(json!({"buffer": 0, "byteOffset": 48, "byteLength": 24}));
    document["accessors"][0]["sparse"] = json!({
        "count": 2,
        "indices": {"bufferView": 2, "componentType": 5123},
        "values": {"bufferView": 3},
    });
    change(&mut document);
    parse(&file(&document, &data), None)
}

#[test]
fn some_elements_are_replaced() {
    let scene = moved([0, 2], |_| ()).unwrap();
    assert_eq!(only_mesh(&scene).positions, [Vec3::new(5.0, 6.0, 7.0), Vec3::X, Vec3::new(8.0, 9.0, 10.0)]);
}

#[test]
fn without_a_view_the_others_are_zero() {
    let without = |d: &mut Value| {
        d["accessors"][0].as_object_mut().unwrap().remove("bufferView");
    };
    let scene = moved([1, 2], without).unwrap();
    assert_eq!(only_mesh(&scene).positions, [Vec3::ZERO, Vec3::new(5.0, 6.0, 7.0), Vec3::new(8.0, 9.0, 10.0)]);
}

#[test]
fn indices_rise_within_the_accessor_and_counts_are_bounded() {
    let refused = |places, change: fn(&mut Value), part: &str| {
        let message = moved(places, change).unwrap_err().to_string();
        assert!(message.contains(part), "{message}");
    };
    refused([1, 1], |_| (), "accessor 0: its sparse indices must rise");
    refused([2, 0], |_| (), "accessor 0: its sparse indices must rise");
    refused([0, 3], |_| (), "from 0 to 2 at most, but 3 stands");
    let count = |d: &mut Value| d["accessors"][0]["sparse"]["count"] = json!(3);
    refused([0, 1], count, "accessor 0, sparse indices: it has 3 elements");
    let view = |d: &mut Value| d["accessors"][0]["sparse"]["values"]["bufferView"] = json!(9);
    refused([0, 1], view, "accessor 0, sparse values refers to bufferView 9");
    let huge = |d: &mut Value| {
        d["accessors"][0].as_object_mut().unwrap().remove("bufferView");
        d["accessors"][0]["count"] = json!(u64::MAX);
    };
    refused([0, 1], huge, "at most 1073741824 are read");
    let none = |d: &mut Value| {
        d["accessors"][0].as_object_mut().unwrap().remove("bufferView");
        d["accessors"][0]["count"] = json!(0);
    };
    refused([0, 1], none, "it has no elements");
    let kind = |d: &mut Value| d["accessors"][0]["sparse"]["indices"]["componentType"] = json!(5126);
    refused([0, 1], kind, "not one of glTF's");
}
