//! Images in WebP and KTX2, made and decoded by their own programs. `packed/ABOUT.md` says which.

use image::GenericImageView;

use super::refusals::one_line;
use super::textures::{load_textured, material};
use super::*;

const LOSSLESS: &[u8] = include_bytes!("packed/pattern.webp");
const UASTC: &[u8] = include_bytes!("packed/pattern.uastc.ktx2");
const UASTC_ZSTD: &[u8] = include_bytes!("packed/pattern.uastc_zstd.ktx2");
const ETC1S: &[u8] = include_bytes!("packed/pattern.etc1s.ktx2");

const WEBP: &str = "EXT_texture_webp";
const BASIS: &str = "KHR_texture_basisu";

/// The picture: ramps of red and green, squares of blue, and alpha in two halves.
fn pattern() -> Vec<u8> {
    let texel = |x: u32, y: u32| {
        let square = (x / 8 + y / 8) % 2;
        [5 * x, 7 * y, 128 + 100 * square, if x > 24 { 155 } else { 255 }].map(|part| part as u8)
    };
    (0..36).flat_map(|y| (0..48).flat_map(move |x| texel(x, y))).collect()
}

/// Texels of the base colour texture whose image this is, by an extension that the file requires.
fn texels(image: &[u8], extension: &str) -> (u32, u32, Vec<u8>) {
    let scene = load_textured(image, |d| {
        d["extensionsUsed"] = json!([extension]);
        d["extensionsRequired"] = json!([extension]);
        d["textures"] = json!([{"extensions": {extension: {"source": 0}}}]);
    });
    let scene = scene.unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(scene.lacking.clauses(), [""; 0]);
    let texels = &scene.objects[0].material.base_color_texture.as_ref().unwrap().texels;
    (texels.width(), texels.height(), texels.bytes().to_vec())
}

fn decoded(png: &[u8]) -> (u32, u32, Vec<u8>) {
    let image = image::load_from_memory(png).unwrap();
    let (width, height) = image.dimensions();
    (width, height, image.into_rgba8().into_raw())
}

#[test]
fn webp_without_loss_is_the_picture() {
    assert_eq!(texels(LOSSLESS, WEBP), (48, 36, pattern()));
}

/// Both decoders turn the same luma and colour differences into red, green and blue, and may round them otherwise.
#[test]
fn webp_with_loss_is_what_its_own_program_makes_of_it() {
    let (found, expected) = (
        texels(include_bytes!("packed/pattern.lossy.webp"), WEBP),
        decoded(include_bytes!("packed/pattern.lossy.png")),
    );
    assert_eq!((found.0, found.1), (expected.0, expected.1));
    assert!(found.2.iter().zip(&expected.2).all(|(x, y)| x.abs_diff(*y) <= 1));
}

#[test]
fn basis_universal_is_what_its_own_program_makes_of_it() {
    let (uastc, etc1s) = (include_bytes!("packed/pattern.uastc.png"), include_bytes!("packed/pattern.etc1s.png"));
    assert!(texels(UASTC, BASIS) == decoded(uastc), "UASTC");
    assert!(texels(UASTC_ZSTD, BASIS) == decoded(uastc), "UASTC with Zstandard");
    assert!(texels(ETC1S, BASIS) == decoded(etc1s), "ETC1S");
    // They are pictures of the pattern.
    let error = |texels: Vec<u8>| {
        texels.iter().zip(pattern()).map(|(x, y)| f64::from(x.abs_diff(y)).powi(2)).sum::<f64>() / (4.0 * 48.0 * 36.0)
    };
    // In the mean a channel strays by less than a sixteenth of its range.
    assert!([uastc.as_slice(), etc1s].into_iter().all(|png| error(decoded(png).2).sqrt() < 16.0));
}

/// Of an image in two formats, the one that every reader knows is taken.
#[test]
fn the_common_format_comes_first() {
    let picture = material(LOSSLESS, |d| {
        d["textures"] = json!([{"source": 0, "extensions": {BASIS: {"source": 9}}}]);
    });
    assert!(picture.base_color_texture.is_some());
    let better = json!([{"extensions": {BASIS: {"source": 9}, WEBP: {"source": 0}}}]);
    assert!(material(LOSSLESS, |d| d["textures"] = better).base_color_texture.is_some());
}

#[test]
fn faults_of_compressed_images() {
    let refused = |image: &[u8], says: &str| {
        let message = one_line(load_textured(image, |_| ()));
        assert!(message.starts_with("image 0 \"bark\": ") && message.contains(says), "{message}");
    };
    let word = |image: &[u8], offset: usize, word: u32| {
        let mut image = image.to_vec();
        image[offset..offset + 4].copy_from_slice(&word.to_le_bytes());
        image
    };
    for image in [UASTC, UASTC_ZSTD, ETC1S, LOSSLESS] {
        for length in [24, 79, 90, 130, image.len() * 9 / 10].into_iter().filter(|length| *length < image.len()) {
            let message = one_line(load_textured(&image[..length], |_| ()));
            assert!(message.starts_with("image 0 \"bark\": it"), "{length}: {message}");
        }
    }
    for (offset, number) in [(28, 2), (32, 5), (36, 6)] {
        refused(&word(UASTC, offset, number), "more than one flat picture");
    }
    for (offset, number) in [(20, 0), (24, 0), (40, 0), (40, 15)] {
        refused(&word(UASTC, offset, number), "no texels, or an impossible number of levels");
    }
    // Sizes are refused before anything is decoded.
    refused(&word(UASTC, 20, 1 << 30), "at most 8192 on a side");
    refused(&word(UASTC, 20, 8192), "its KTX2 data end too early");
    refused(&word(UASTC_ZSTD, 20, 8192), "its KTX2 data end too early");
    refused(&word(UASTC_ZSTD, 20, 44), "its KTX2 data end too early");
    // The place of the first level.
    refused(&word(ETC1S, 80, u32::MAX), "its KTX2 data end too early");
    // Another kind of picture in the same container.
    let other = load_textured(&word(UASTC, 12, 37), |_| ()).unwrap();
    let clause =
        "textures: `baseColorTexture` in KTX2 without Basis Universal of material `gem` (a factor is drawn alone)";
    assert_eq!(other.lacking.clauses(), [clause]);
}
