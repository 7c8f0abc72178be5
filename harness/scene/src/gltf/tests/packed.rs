//! Files packed by other programs hold the mesh of the plain file, but for the quantisation. `packed/ABOUT.md` says what each is.

use glam::Vec2;

use super::refusals::one_line;
use super::*;

macro_rules! files {
    ($($name:literal),*) => { [$(($name, include_bytes!(concat!("packed/", $name, ".glb")).as_slice())),*] };
}

fn scene(name: &str, bytes: &[u8]) -> Scene {
    let scene = parse(bytes, None).unwrap_or_else(|error| panic!("{name}: {error}"));
    assert!(
        !scene.lacking.clauses().iter().any(|line| line.contains("extensions")),
        "{name}: {:?}",
        scene.lacking.clauses()
    );
    scene
}

/// How far a packed vertex may lie from its own.
#[derive(Debug, Clone, Copy)]
struct Tolerance {
    position: f32,
    /// In radians.
    normal: f32,
    coordinates: f32,
    color: f32,
}

/// Half a step of `bits` over a box of the side `size`, along all three axes; as much again is for rounding to single precision.
fn half_step(size: f32, bits: i32) -> f32 {
    3.0_f32.sqrt() / 2.0 * size / (2.0_f32.powi(bits) - 1.0) * (1.0 + 1e-3)
}

/// Greatest angle between a normal and its place on an octahedron, whose two coordinates from -1 to 1 have `bits`: half a step h of
/// both moves the point by √6 h at most, and it lies 1/√3 from the centre or more.
fn octahedral(bits: i32) -> f32 {
    18.0_f32.sqrt() / (2.0_f32.powi(bits) - 2.0)
}

/// A corner of a triangle.
#[derive(Debug, Clone, Copy)]
struct Corner {
    position: Vec3,
    normal: Vec3,
    uv: Vec2,
    color: Vec3,
}

impl Corner {
    fn is_near(&self, other: &Self, tolerance: Tolerance) -> bool {
        self.position.distance(other.position) <= tolerance.position
            && self.normal.angle_between(other.normal) <= tolerance.normal
            && (self.uv - other.uv).abs().max_element() <= tolerance.coordinates
            && (self.color - other.color).abs().max_element() <= tolerance.color
    }
}

fn triangles(mesh: &crate::Mesh) -> Vec<[Corner; 3]> {
    let corner = |vertex: &u32| {
        let vertex = *vertex as usize;
        Corner {
            position: mesh.positions[vertex],
            normal: mesh.normals[vertex],
            uv: mesh.uvs.get(vertex).copied().unwrap_or_default(),
            color: mesh.colors.get(vertex).copied().unwrap_or(Vec3::ONE),
        }
    };
    mesh.indices.chunks(3).map(|of| [corner(&of[0]), corner(&of[1]), corner(&of[2])]).collect()
}

/// Asserts that both have the same triangles, in any order, wound alike.
fn assert_same(name: &str, plain: &crate::Mesh, packed: &crate::Mesh, tolerance: Tolerance) {
    let mut left = triangles(plain);
    assert_eq!(left.len(), packed.triangle_count(), "{name}");
    assert_eq!((plain.uvs.is_empty(), plain.colors.is_empty()), (packed.uvs.is_empty(), packed.colors.is_empty()));
    for triangle in triangles(packed) {
        let is_near = |other: &[Corner; 3]| {
            (0..3).any(|turn| (0..3).all(|corner| triangle[corner].is_near(&other[(corner + turn) % 3], tolerance)))
        };
        let place = left.iter().position(is_near);
        left.swap_remove(place.unwrap_or_else(|| panic!("{name}: {triangle:?} is not in the plain file")));
    }
}

#[test]
fn packed_files_hold_the_plain_ones() {
    let [stone, block] = files!["vcol", "tex_base"].map(|(name, bytes)| scene(name, bytes).objects.remove(0).mesh);
    let (is_stone, is_block) = (|name: &str| name.starts_with("vcol"), |name: &str| name.starts_with("tex_base"));
    for (name, bytes) in files![
        "vcol.draco_edge",
        "vcol.draco_best",
        "vcol.draco_seq",
        "vcol.meshopt_med",
        "vcol.meshopt_high",
        "tex_base.draco_edge",
        "tex_base.meshopt_high",
        "quantised"
    ] {
        let plain = if is_block(name) { &block } else { &stone };
        let bounds = crate::Bounds::of(plain.positions.iter().copied());
        let size = (bounds.max - bounds.min).max_element();
        // Half a step of fractions with a sign in so many bits, along three axes.
        let signed = |bits: i32| 3.0_f32.sqrt() / 2.0 / (2.0_f32.powi(bits - 1) - 1.0);
        let (position, normal) = match name.split_once('.').map(|(_, kind)| kind) {
            Some("draco_seq") => (half_step(size, 16), octahedral(10)),
            Some("meshopt_med") => (half_step(size, 14), signed(10)),
            Some("meshopt_high") => (half_step(size, 14), octahedral(8) + signed(8)),
            Some(_) => (half_step(size, 14), octahedral(10)),
            None => (signed(16), signed(8)),
        };
        let tolerance = Tolerance { position, normal, coordinates: half_step(1.0, 12), color: 0.5 / 255.0 };
        let mut packed = scene(name, bytes).objects.remove(0).mesh;
        let mut plain = plain.clone();
        if !is_stone(name) && !is_block(name) {
            plain.colors.clear();
            packed.colors.clear();
        }
        assert_same(name, &plain, &packed, tolerance);
    }
}

/// Beyond 1000 triangles Draco predicts by valences. Two packers agree within the sum of what each may err.
#[test]
fn two_packers_agree() {
    let [draco, meshopt] = files!["cabochon.draco_best", "cabochon.meshopt_high"]
        .map(|(name, bytes)| scene(name, bytes).objects.remove(0).mesh);
    assert_eq!(draco.triangle_count(), 2048);
    let bounds = crate::Bounds::of(draco.positions.iter().copied());
    let size = (bounds.max - bounds.min).max_element();
    let normal = octahedral(10) + octahedral(8) + 3.0_f32.sqrt() / 2.0 / 127.0;
    assert_same(
        "cabochon",
        &draco,
        &meshopt,
        Tolerance { position: 2.0 * half_step(size, 14), normal, coordinates: 0.0, color: 0.0 },
    );
}

/// Rewrites a file's JSON.
fn changed(bytes: &[u8], change: impl FnOnce(&mut Value)) -> Vec<u8> {
    let container = container::split(bytes).unwrap();
    let mut document: Value = serde_json::from_slice(container.json).unwrap();
    change(&mut document);
    file(&document, container.binary.unwrap())
}

fn refused(bytes: &[u8], change: impl FnOnce(&mut Value), says: &str) {
    let message = one_line(parse(&changed(bytes, change), None));
    assert!(message.contains(says), "{message}");
}

#[test]
fn both_names_of_meshopt_are_known() {
    let [(_, bytes)] = files!["vcol.meshopt_high"];
    let text = String::from_utf8_lossy(container::split(bytes).unwrap().json).replace("EXT_meshopt", "KHR_meshopt");
    let renamed = changed(bytes, |document| *document = serde_json::from_str(&text).unwrap());
    assert_eq!(scene("KHR", &renamed).objects, scene("EXT", bytes).objects);
}

#[test]
fn what_meshopt_says_must_fit() {
    const NAME: &str = "EXT_meshopt_compression";
    let [(_, bytes)] = files!["vcol.meshopt_high"];
    let with = |key: &str, value: Value, says: &str| {
        refused(bytes, |d| d["bufferViews"][0]["extensions"][NAME][key] = value, says);
    };
    with("buffer", json!(9), "bufferView 0 refers to buffer 9");
    with("byteOffset", json!(1u64 << 40), "bufferView 0: it takes");
    with("byteLength", Value::Null, "bufferView 0: its byteLength is null");
    with("byteLength", json!(20), "bufferView 0: its compressed data are damaged");
    with("count", json!(1), "its mode, filter and count do not fit");
    with("count", json!(3), "its 3 elements of 2 bytes do not take 276 bytes");
    with("byteStride", json!(6), "bufferView 0: its elements cannot have 6 bytes, by its EXT_meshopt_compression");
    with("mode", json!("POINTS"), "its mode, filter and count do not fit");
    let filter = |d: &mut Value| d["bufferViews"][1]["extensions"][NAME]["filter"] = json!("SHARPEN");
    refused(bytes, filter, "bufferView 1: its filter is unknown or does not fit");
    // A count that only the memory of unpacked data forbids.
    refused(
        bytes,
        |d| {
            let view = &mut d["bufferViews"][0];
            let stride = view["extensions"][NAME]["byteStride"].as_u64().unwrap();
            view["byteLength"] = json!(3 * (1u64 << 30) * stride);
            view["extensions"][NAME]["count"] = json!(3 * (1u64 << 30));
        },
        "bufferView 0, with what was unpacked before it, has",
    );
}

#[test]
fn what_draco_says_must_fit() {
    const NAME: &str = "KHR_draco_mesh_compression";
    let [(_, bytes)] = files!["vcol.draco_edge"];
    let with = |key: &str, value: Value, says: &str| {
        refused(bytes, |d| d["meshes"][0]["primitives"][0]["extensions"][NAME][key] = value, says);
    };
    with("bufferView", json!(9), "primitive 0 refers to bufferView 9");
    with("bufferView", Value::Null, "its bufferView is null");
    with("attributes", json!(7), "has no bufferView or no attributes");
    with("attributes", json!({"POSITION": 77}), "says that POSITION is attribute 77, which is not there");
    with("attributes", json!({"POSITION": "a"}), "its POSITION is a string");
    with("attributes", json!({}), "it has no bufferView, so no data");
    let type_ =
        |d: &mut Value| d["accessors"].as_array_mut().unwrap().iter_mut().for_each(|a| a["type"] = json!("VEC2"));
    refused(bytes, type_, "needs VEC3 of float");
    let length = |d: &mut Value| d["bufferViews"][0]["byteLength"] = json!(100);
    refused(bytes, length, "its KHR_draco_mesh_compression cannot be decoded");
}
