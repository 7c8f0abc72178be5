//! The gallery reads dropped environments in JavaScript. Its own tests run, and it reads the same texels as `cook
//! render --environment` does, from files that other encoders write.
//!
//! If there is no Node.js, these tests say so and pass. With `LAPIDARY_NODE=required` they fail.

use exr::image::write::channels::WritableChannels;
use exr::prelude::{Compression, Encoding, Image, LineOrder, SpecificChannels, Vec2, WritableImage as _, f16};
use image::codecs::hdr::HdrEncoder;
use lapidary_assay::draws::mix;
use lapidary_scene::environment_map::EnvironmentMap;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Variable with the value `required` if a missing Node.js is a failure.
const VARIABLE: &str = "LAPIDARY_NODE";

/// The oldest version of Node.js that has what the scripts use.
const OLDEST: u32 = 20;

/// Width and height of the files.
const SIZES: [(usize, usize); 3] = [(33, 17), (7, 70), (256, 96)];

const CONTENTS: [Content; 3] = [Content::Steps, Content::Noise, Content::Ramp];

const COMPRESSIONS: [Compression; 5] =
    [Compression::Uncompressed, Compression::RLE, Compression::ZIP1, Compression::ZIP16, Compression::PIZ];

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/environment_js")
}

/// Whether there is a Node.js that can run the scripts; otherwise says so, or panics if it is required.
fn has_node() -> bool {
    let version = Command::new("node").arg("--version").output();
    let version = version.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned()).unwrap_or_default();
    let major = version.trim_start_matches('v').split('.').next().and_then(|major| major.parse::<u32>().ok());
    if major.is_some_and(|major| major >= OLDEST) {
        return true;
    }
    let found = if version.is_empty() { "none" } else { &version };
    let required = std::env::var_os(VARIABLE).is_some_and(|value| value == "required");
    assert!(!required, "{VARIABLE}=required: no Node.js from version {OLDEST} on the PATH, but {found}");
    // Bypasses the test's own capture, which shows nothing of a passing test.
    let _ = writeln!(std::io::stderr(), "environments in JavaScript not checked: Node.js {OLDEST} needed, not {found}");
    false
}

/// Runs `node`, which must succeed.
fn node(arguments: &[&Path]) {
    let output = Command::new("node").args(arguments).output().expect("node starts");
    let said = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).concat();
    assert!(output.status.success(), "node {arguments:?}: {}\n{said}", output.status);
}

/// What a picture shows.
#[derive(Clone, Copy, Debug)]
enum Content {
    /// Few values, which all compressions make smaller.
    Steps,
    /// Noise over the range of half floats, partly negative, which none does.
    Noise,
    /// All half floats one after another. In a chunk of the largest picture PIZ then finds more values than the shorter
    /// of its transforms takes, and yet makes it smaller.
    Ramp,
}

fn sample(content: Content, pixel: Vec2<usize>, part: usize) -> f32 {
    match content {
        Content::Steps => ((pixel.0 * (part + 1) + pixel.1) % 29 / 3) as f32 * 0.375,
        Content::Noise => {
            let bits = mix((pixel.1 << 20 | pixel.0 << 2 | part) as u64);
            let value = (bits as u32 as f32 / u32::MAX as f32 * 20.0 - 8.0).exp2();
            if bits >> 60 == 0 { -value } else { value }
        }
        Content::Ramp => {
            let place = part << 13 | (pixel.1 & 31) << 8 | pixel.0;
            f16::from_bits(place as u16).to_f32()
        }
    }
}

fn write<C>(path: &Path, size: (usize, usize), compression: Compression, channels: C)
where
    C: for<'image> WritableChannels<'image>,
{
    let encoding = Encoding { compression, line_order: LineOrder::Increasing, ..Encoding::UNCOMPRESSED };
    Image::from_encoded_channels(size, encoding, channels).write().to_file(path).expect("a file is written");
}

/// Writes a picture as OpenEXR by each compression, of each type of sample.
fn write_open_exr(folder: &Path, size: (usize, usize), content: Content) {
    for compression in COMPRESSIONS {
        let (width, height) = size;
        let path =
            |kind| folder.join(format!("{compression}_{kind}_{width}x{height}_{content:?}.exr").replace(' ', "_"));
        let part = move |pixel, part| sample(content, pixel, part);
        let floats = SpecificChannels::rgb(move |pixel: Vec2<usize>| (part(pixel, 0), part(pixel, 1), part(pixel, 2)));
        write(&path("float"), size, compression, floats);
        let half = move |pixel, channel| f16::from_f32(part(pixel, channel));
        let halves = SpecificChannels::rgb(move |pixel: Vec2<usize>| (half(pixel, 0), half(pixel, 1), half(pixel, 2)));
        write(&path("half"), size, compression, halves);
        let whole = move |pixel, channel| part(pixel, channel).abs() as u32;
        let mixed = SpecificChannels::rgba(move |pixel: Vec2<usize>| {
            (whole(pixel, 0), half(pixel, 1), part(pixel, 2), half(pixel, 0))
        });
        write(&path("mixed"), size, compression, mixed);
    }
}

/// Writes a picture as Radiance, by runs and as it is, as its encoder chooses by the width, with and without exposure.
fn write_radiance(folder: &Path, (width, height): (usize, usize), content: Content) {
    let places = (0..width * height).map(|place| Vec2(place % width, place / width));
    let pixels: Vec<_> =
        places.map(|pixel| image::Rgb([0, 1, 2].map(|part| sample(content, pixel, part).abs()))).collect();
    let mut bytes = Vec::new();
    HdrEncoder::new(&mut bytes).encode(&pixels, width, height).expect("a file is written");
    let name = format!("{width}x{height}_{content:?}");
    fs::write(folder.join(format!("{name}.hdr")), &bytes).expect("a file is written");
    let line = bytes.iter().position(|byte| *byte == b'\n').expect("a line") + 1;
    let corrected = [&bytes[..line], b"EXPOSURE=0.7\nCOLORCORR=1 1.1 1.3\nEXPOSURE= 3e0\n", &bytes[line..]].concat();
    fs::write(folder.join(format!("{name}_corrected.hdr")), corrected).expect("a file is written");
}

/// Returns what decode.mjs wrote of a file: width, height and texels.
fn decoded(path: &Path) -> (u32, u32, Vec<[f32; 4]>) {
    let beside = |ending: &str| PathBuf::from(format!("{}.{ending}", path.display()));
    let bytes = fs::read(beside("raw")).unwrap_or_else(|_| {
        panic!("JavaScript does not read it: {}", fs::read_to_string(beside("txt")).unwrap_or_default())
    });
    let words: Vec<u32> = bytes.chunks_exact(4).map(bytemuck::pod_read_unaligned).collect();
    let texels = words[2..].chunks_exact(4);
    (words[0], words[1], texels.map(|texel| [0, 1, 2, 3].map(|part| f32::from_bits(texel[part]))).collect())
}

#[test]
fn javascript_reads_environments_as_its_tests_say() {
    if has_node() {
        node(&[Path::new("--test"), &folder().join("environment.test.mjs")]);
    }
}

/// Both formats state their samples exactly, and a quotient by an exposure is rounded once: no tolerance is needed.
#[test]
fn javascript_reads_the_texels_that_rust_reads() {
    if !has_node() {
        return;
    }
    let written = tempfile::tempdir().expect("a folder");
    for size in SIZES {
        for content in CONTENTS {
            write_open_exr(written.path(), size, content);
            write_radiance(written.path(), size, content);
        }
    }
    let files: Vec<PathBuf> = fs::read_dir(written.path())
        .expect("the folder can be listed")
        .map(|entry| entry.expect("an entry").path())
        .collect();
    assert_eq!(files.len(), SIZES.len() * CONTENTS.len() * (COMPRESSIONS.len() * 3 + 2));
    node(&[&folder().join("decode.mjs"), written.path()]);
    for path in files {
        let map = EnvironmentMap::load(&path).unwrap_or_else(|error| panic!("{error}"));
        let (width, height, texels) = decoded(&path);
        assert_eq!((width, height, texels.len()), (map.width, map.height, map.pixels.len()), "{}", path.display());
        for (place, (ours, theirs)) in texels.iter().zip(&map.pixels).enumerate() {
            assert_eq!(ours[..3], theirs[..3], "{}: pixel {place}", path.display());
        }
    }
}
