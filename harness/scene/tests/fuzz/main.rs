//! Fuzzing of the glTF loader: valid files, broken in many ways.
//!
//! Every run takes [`SUITE_CASES`] cases; a long one (`--ignored`) takes [`LONG_CASES`]. Both call
//! [`run`]. A case is a list of [`Edit`]s to one of the [`seeds`]. It fails if the loader panics,
//! or if a scene takes more memory than [`gltf::MAX_SCENE_BYTES`] allows or breaks a promise of
//! [`Mesh`], `Material` or [`Light`].

mod checks;
mod textured;

use proptest::collection::vec;
use proptest::prelude::{Strategy, any, prop_oneof};
use proptest::sample::Index;
use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestError, TestRng, TestRunner};

use glam::Vec3;
use lapidary_scene::{Light, Mesh, MeshDiagnosis, Scene, SceneError, glb, gltf};

/// Cases of the test suite, which take seconds.
pub const SUITE_CASES: u32 = 5_000;

/// Cases of a long run, which take minutes.
pub const LONG_CASES: u32 = 100_000;

/// One change to a file.
#[derive(Debug, Clone)]
pub enum Edit {
    /// Replaces a byte anywhere.
    Byte(Index, u8),
    /// Cuts the file off.
    Truncate(Index),
    /// Inserts a copy of a range, of at most 64 bytes, at another place.
    Duplicate {
        /// Start of the range.
        from: Index,
        /// Length of the range, in bytes.
        length: u8,
        /// Place of the copy.
        to: Index,
    },
    /// Replaces a digit inside the JSON with another, so that the JSON stays valid.
    Digit(Index, u8),
    /// Replaces a number inside the JSON with one of [`HOSTILE_NUMBERS`], and corrects the
    /// lengths of a .glb, so that the number reaches the loader's checks.
    Number(Index, Index),
}

/// Numbers that overflow, wrap, are not whole, or lie just beyond a limit.
pub const HOSTILE_NUMBERS: [&str; 18] = [
    "0",
    "1",
    "2",
    "3",
    "5",
    "6",
    "5121",
    "5126",
    "255",
    "65536",
    "4294967295",
    "4294967296",
    "18446744073709551615",
    "-1",
    "0.5",
    "-0.0",
    "1e-50",
    "1e39",
];

/// A second seed, with features that [`glb::write`] does not write: base64 buffers, strips, fans,
/// short indices, no normals, texture coordinates as floats and as bytes, a hierarchy with a matrix
/// and with translation, rotation and scale, three lights, instances, a material with attenuation
/// and an Abbe number, one with a named Sellmeier equation, and one with a medium.
const DOCUMENT: &str = r#"{"asset":{"version":"2.0"},"extensionsRequired":["KHR_materials_ior",
"KHR_texture_transform","EXT_mesh_gpu_instancing","KHR_materials_volume","KHR_materials_dispersion","KHR_lights_punctual"],
"extensions":{"KHR_lights_punctual":{"lights":[{"type":"directional","color":[1,0.5,0.25],"intensity":3},
{"type":"point","intensity":40},{"type":"spot","intensity":40,"spot":{"innerConeAngle":0.25,"outerConeAngle":0.5}}]}},
"scene":0,"scenes":[{"nodes":[0,3,4]}],
"nodes":[{"children":[1,2],"matrix":[-1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]},
{"mesh":0,"translation":[1,2,3],"rotation":[0,0,0.6,0.8],"scale":[1,2,3]},
{"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":0,"SCALE":0}}}},
{"camera":0,"translation":[0,0,9]},
{"rotation":[0.6,0,0,0.8],"extensions":{"KHR_lights_punctual":{"light":0}},"children":[5]},
{"translation":[4,5,6],"extensions":{"KHR_lights_punctual":{"light":1}},"children":[6]},
{"translation":[1,0,2],"rotation":[0,0.6,0,0.8],"extensions":{"KHR_lights_punctual":{"light":2}}}],
"cameras":[{"type":"perspective","perspective":{"yfov":0.5,"znear":0.1}}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"mode":5,"material":0},
{"attributes":{"POSITION":0,"TEXCOORD_0":2},"mode":6,"material":1},
{"attributes":{"POSITION":0,"NORMAL":0,"TEXCOORD_0":3},"indices":1,"mode":4,"material":2}]}],
"materials":[{"pbrMetallicRoughness":{"baseColorFactor":[1,0.5,0.25,1]},
"extensions":{"KHR_materials_ior":{"ior":1.75},"KHR_materials_dispersion":{"dispersion":0.35},
"KHR_materials_volume":{"thicknessFactor":1,"attenuationColor":[0.5,1,0],"attenuationDistance":2.5}}},
{"doubleSided":true,"extensions":{"KHR_materials_ior":{"ior":1.768}},"extras":{"lapidary":{"sellmeier":"corundum"}}},
{"extras":{"lapidary":{"sigma0":[4.5,3,2],"scattering":[0.75,1,1.25],"absorption":[0.5,0,0.125]}}}],
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},
{"bufferView":1,"componentType":5121,"count":6,"type":"SCALAR"},
{"bufferView":0,"componentType":5126,"count":4,"type":"VEC2"},
{"bufferView":0,"componentType":5121,"count":4,"type":"VEC2","normalized":true}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48,"byteStride":12},
{"buffer":0,"byteOffset":48,"byteLength":6}],
"buffers":[{"byteLength":54,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAECAgED"}]}"#;

/// Returns the valid files to be broken: an octahedron as .glb, a small hand-written .gltf, and an
/// octahedron as .glb with colours and textures.
///
/// # Errors
/// Never fails: the files are made from constants. The type comes from the functions that make
/// them.
pub fn seeds() -> Result<[Vec<u8>; 3], SceneError> {
    let octahedron = Scene::named("octahedron")?;
    let written = glb::write(&octahedron).unwrap_or_default();
    Ok([written, DOCUMENT.as_bytes().to_vec(), textured::seed(octahedron)])
}

/// Returns valid files that other programs packed: by Draco in two ways, by meshoptimizer, and quantised; and an octahedron with images
/// in WebP and in KTX2 of three kinds.
///
/// # Errors
/// Never fails, as [`seeds`].
pub fn packed() -> Result<Vec<Vec<u8>>, SceneError> {
    let octahedron = Scene::named("octahedron")?;
    let files: [&[u8]; 6] = [
        include_bytes!("../../src/gltf/tests/packed/vcol.draco_edge.glb"),
        include_bytes!("../../src/gltf/tests/packed/vcol.draco_best.glb"),
        include_bytes!("../../src/gltf/tests/packed/tex_base.draco_edge.glb"),
        include_bytes!("../../src/gltf/tests/packed/vcol.draco_seq.glb"),
        include_bytes!("../../src/gltf/tests/packed/vcol.meshopt_high.glb"),
        include_bytes!("../../src/gltf/tests/packed/quantised.glb"),
    ];
    let images: [&[u8]; 5] = [
        include_bytes!("../../src/gltf/tests/packed/pattern.webp"),
        include_bytes!("../../src/gltf/tests/packed/pattern.lossy.webp"),
        include_bytes!("../../src/gltf/tests/packed/pattern.uastc.ktx2"),
        include_bytes!("../../src/gltf/tests/packed/pattern.uastc_zstd.ktx2"),
        include_bytes!("../../src/gltf/tests/packed/pattern.etc1s.ktx2"),
    ];
    let with_image = |image: &&[u8]| textured::with_image(&octahedron, image);
    Ok(files.iter().map(|file| file.to_vec()).chain(images.iter().map(with_image)).collect())
}

/// Returns lists of 1 to 64 edits. Most are short, so that many files stay readable for a long way.
pub fn edits() -> impl Strategy<Value = Vec<Edit>> {
    let edit = prop_oneof![
        4 => (any::<Index>(), any::<u8>()).prop_map(|(place, byte)| Edit::Byte(place, byte)),
        1 => any::<Index>().prop_map(Edit::Truncate),
        1 => (any::<Index>(), 1..=64u8, any::<Index>())
            .prop_map(|(from, length, to)| Edit::Duplicate { from, length, to }),
        6 => (any::<Index>(), b'0'..=b'9').prop_map(|(place, digit)| Edit::Digit(place, digit)),
        6 => (any::<Index>(), any::<Index>()).prop_map(|(place, value)| Edit::Number(place, value)),
    ];
    prop_oneof![
        3 => vec(edit.clone(), 1..=2),
        1 => vec(edit, 1..=64),
    ]
}

/// Returns `bytes` after all `edits`, in order.
#[must_use]
pub fn mutate(bytes: &[u8], edits: &[Edit]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for edit in edits {
        if bytes.is_empty() {
            break;
        }
        apply(&mut bytes, edit);
    }
    bytes
}

fn apply(bytes: &mut Vec<u8>, edit: &Edit) {
    match edit {
        Edit::Byte(place, byte) => *place.get_mut(bytes) = *byte,
        Edit::Truncate(place) => bytes.truncate(place.index(bytes.len())),
        Edit::Duplicate { from, length, to } => {
            let start = from.index(bytes.len());
            let end = bytes.len().min(start + usize::from(*length));
            let copy = bytes[start..end].to_vec();
            let target = to.index(bytes.len());
            bytes.splice(target..target, copy);
        }
        Edit::Digit(place, digit) => {
            let (json, _) = parts(bytes);
            let digits: Vec<usize> = json.filter(|&k| bytes[k].is_ascii_digit()).collect();
            if !digits.is_empty() {
                bytes[*place.get(&digits)] = *digit;
            }
        }
        Edit::Number(place, value) => {
            let (json, binary) = parts(bytes);
            let text = &bytes[json.clone()];
            let numbers = numbers(text);
            if numbers.is_empty() {
                return;
            }
            let mut changed = text.to_vec();
            let value = value.get(&HOSTILE_NUMBERS);
            changed.splice(place.get(&numbers).clone(), value.bytes());
            *bytes = match binary {
                // A file too large for its container would become empty; none here is.
                Some(binary) => glb::container(&changed, &bytes[binary]).unwrap_or_default(),
                None => changed,
            };
        }
    }
}

type Range = std::ops::Range<usize>;

/// Returns the range of the JSON, and the range of the binary chunk if the container is sound.
fn parts(bytes: &[u8]) -> (Range, Option<Range>) {
    let word = |offset: usize| {
        let word = bytes.get(offset..)?.first_chunk()?;
        Some(u32::from_le_bytes(*word) as usize)
    };
    let sound = || {
        let json_end = word(12)?.checked_add(20)?;
        let binary_end = word(json_end)?.checked_add(json_end + 8)?;
        let fits = bytes.starts_with(b"glTF") && binary_end <= bytes.len();
        fits.then(|| (20..json_end, Some(json_end + 8..binary_end)))
    };
    sound().unwrap_or((0..bytes.len(), None))
}

/// Returns the runs of digits, signs, points and exponents in places of JSON values.
fn numbers(json: &[u8]) -> Vec<Range> {
    let is_part = |byte: &u8| byte.is_ascii_digit() || b"+-.eE".contains(byte);
    let mut found = Vec::new();
    let mut position = 0;
    while position < json.len() {
        let length = json[position..].iter().take_while(|byte| is_part(byte)).count();
        let after = position.checked_sub(1).is_some_and(|before| b":[, \n".contains(&json[before]));
        if length > 0 && after && json[position..position + length].iter().any(u8::is_ascii_digit) {
            found.push(position..position + length);
        }
        position += length.max(1);
    }
    found
}

/// Outcomes of the cases of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Tally {
    /// Files that gave a scene.
    pub loaded: u32,
    /// Files that gave an error.
    pub refused: u32,
}

/// Loads one broken file. Returns true if it gives a scene.
///
/// # Errors
/// Returns the fault of the scene or of the error's message.
pub fn check(bytes: &[u8]) -> Result<bool, String> {
    match gltf::parse(bytes, None) {
        Ok(scene) => check_scene(&scene, bytes.len() as u64).map(|()| true),
        Err(error) => {
            let message = error.to_string();
            let one_line = !message.contains('\n') && message.len() < 2_000;
            let fault = || format!("not one short line: {message:?}");
            one_line.then_some(false).ok_or_else(fault)
        }
    }
}

fn check_scene(scene: &Scene, file_bytes: u64) -> Result<(), String> {
    let taken: u64 = scene.objects.iter().map(|o| o.mesh.byte_size()).sum();
    if taken > gltf::MAX_SCENE_BYTES || scene.objects.len() as u64 > gltf::MAX_OBJECTS {
        return Err(format!(
            "{file_bytes} bytes of file became {} bodies and {taken} bytes of mesh",
            scene.objects.len()
        ));
    }
    let camera = &scene.camera;
    let sees = camera.eye.is_finite() && camera.up.is_normalized() && camera.eye != camera.target;
    if !sees || !camera.target.is_finite() || !camera.vertical_fov.is_finite() {
        return Err(format!("the camera sees nothing: {camera:?}"));
    }
    let wrong = scene.objects.iter().find(|object| !is_sound(&object.mesh));
    if let Some(object) = wrong {
        return Err(format!("a broken mesh: {object:?}"));
    }
    // No mesh is taken for solid while it has open edges.
    let looked_through = scene.objects.iter().map(|object| MeshDiagnosis::of(&object.mesh));
    if let Some(found) = looked_through.into_iter().find(|found| found.is_solid() && found.open_edges > 0) {
        return Err(format!("a diagnosis that contradicts itself: {found:?}"));
    }
    if let Some(problem) = scene.objects.iter().find_map(|object| object.material.problem()) {
        return Err(format!("a broken material: {problem}"));
    }
    if scene.objects.iter().any(|object| object.mesh.uvs.is_empty() && object.material.textures().count() > 0) {
        return Err("textures without coordinates".to_owned());
    }
    let problem = scene.lights.iter().find_map(Light::problem);
    problem.map_or(Ok(()), |problem| Err(format!("a broken light: {problem}")))
}

fn is_sound(mesh: &Mesh) -> bool {
    mesh.normals.len() == mesh.positions.len()
        && (mesh.uvs.is_empty() || mesh.uvs.len() == mesh.positions.len())
        && mesh.uvs.iter().all(|uv| uv.is_finite())
        && (mesh.colors.is_empty() || mesh.colors.len() == mesh.positions.len())
        && mesh.colors.iter().all(|color| color.cmpge(Vec3::ZERO).all() && color.cmple(Vec3::ONE).all())
        && mesh.indices.len().is_multiple_of(3)
        && mesh.triangles().count() == mesh.triangle_count()
        && mesh.positions.iter().all(|position| position.is_finite())
        && mesh.normals.iter().all(|normal| normal.is_normalized())
}

/// Runs `cases` cases, the same each time, a third of them on each seed.
///
/// # Errors
/// Returns, in words, the shrunk list of edits that makes the loader panic or break a promise.
pub fn run(cases: u32) -> Result<Tally, String> {
    let failed = |error: SceneError| error.to_string();
    let seeds = [seeds().map_err(failed)?.to_vec(), packed().map_err(failed)?].concat();
    let tally = std::cell::Cell::new(Tally::default());
    let config = Config { cases, failure_persistence: None, ..Config::default() };
    let mut runner = TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha));
    let outcome = runner.run(&(any::<Index>(), edits()), |(seed, edits)| {
        let bytes = mutate(&seeds[seed.index(seeds.len())], &edits);
        let loaded = check(&bytes).map_err(TestCaseError::fail)?;
        let mut counts = tally.get();
        if loaded {
            counts.loaded += 1;
        } else {
            counts.refused += 1;
        }
        tally.set(counts);
        Ok(())
    });
    match outcome {
        Ok(()) => Ok(tally.get()),
        Err(TestError::Fail(reason, edits)) => Err(format!("{reason}: {edits:?}")),
        Err(TestError::Abort(reason)) => Err(reason.to_string()),
    }
}
