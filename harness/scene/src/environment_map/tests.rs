use image::{ImageBuffer, Rgb, Rgba};

use super::*;

/// Returns a map with a different colour in each pixel.
fn coloured(width: u32, height: u32) -> DynamicImage {
    DynamicImage::ImageRgb32F(ImageBuffer::from_fn(width, height, |x, y| Rgb([x as f32, y as f32, 0.5])))
}

fn encoded(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

fn decode(bytes: &[u8]) -> Result<EnvironmentMap, MapProblem> {
    EnvironmentMap::decode(bytes).map(|(map, _)| map)
}

#[test]
fn both_formats_give_linear_pixels_from_the_top_left() {
    for format in [ImageFormat::OpenExr, ImageFormat::Hdr] {
        let map = decode(&encoded(&coloured(5, 3), format)).unwrap();
        assert_eq!((map.width, map.height, map.pixels.len()), (5, 3, 15));
        let [red, green, blue, _] = map.pixels[2 * 5 + 4];
        assert_eq!([red, green, blue], [4.0, 2.0, 0.5], "{format:?}");
    }
}

#[test]
fn a_file_is_loaded_and_errors_name_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sky.exr");
    std::fs::write(&path, encoded(&coloured(4, 2), ImageFormat::OpenExr)).unwrap();
    assert_eq!(EnvironmentMap::load(&path).unwrap().width, 4);

    for missing in [folder.path().join("none.hdr"), folder.path().to_owned()] {
        let message = EnvironmentMap::load(&missing).unwrap_err().to_string();
        assert!(message.starts_with(&missing.display().to_string()), "{message}");
        assert!(message.contains("cannot be read"), "{message}");
    }
}

#[test]
fn other_files_are_refused() {
    let png = encoded(&DynamicImage::new_rgb8(4, 4), ImageFormat::Png);
    for bytes in [&b""[..], b"hello", &png] {
        let error = decode(bytes).unwrap_err();
        assert!(matches!(error, MapProblem::Format), "{error}");
    }
}

#[test]
fn impossible_radiance_is_found_at_its_place() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let image = DynamicImage::ImageRgba32F(ImageBuffer::from_fn(4, 3, |x, y| {
            Rgba([1.0, if (x, y) == (3, 1) { bad } else { 0.0 }, 1.0, f32::NAN])
        }));
        let error = decode(&encoded(&image, ImageFormat::OpenExr)).unwrap_err();
        assert!(error.to_string().contains("column 3, row 1"), "{error}");
    }
}

#[test]
fn negative_parts_count_as_nothing_and_are_counted() {
    let image = DynamicImage::ImageRgb32F(ImageBuffer::from_fn(4, 3, |x, y| match (x, y) {
        (0, 0) => Rgb([-0.25, 0.5, -0.0]),
        (3, 2) => Rgb([1.0, -1e-6, 2.0]),
        _ => Rgb([1.0, 2.0, 3.0]),
    }));
    let bytes = encoded(&image, ImageFormat::OpenExr);
    let (map, clamped) = EnvironmentMap::decode(&bytes).unwrap();
    assert_eq!(clamped, Clamped { pixels: 2, least: -0.25 });
    assert_eq!([map.pixels[0], map.pixels[11]], [[0.0, 0.5, 0.0, 1.0], [1.0, 0.0, 2.0, 1.0]]);
    let bytes = encoded(&coloured(4, 3), ImageFormat::OpenExr);
    assert_eq!(EnvironmentMap::decode(&bytes).unwrap().1, Clamped::default());
}

/// Returns a Radiance picture of 8 x 2 pixels of (1, .5, .25), with the given header lines.
fn radiance_picture(first: &str, lines: &str) -> Vec<u8> {
    let mut bytes = format!("{first}\n{lines}FORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 8\n").into_bytes();
    // Without run lengths: mantissas over 256, times 2^(129 - 128).
    bytes.extend([128u8, 64, 32, 129].repeat(16));
    bytes
}

#[test]
fn radiance_pictures_of_any_program_are_divided_by_their_exposures() {
    let first = |name: &str, lines: &str| {
        let [red, green, blue, _] = decode(&radiance_picture(name, lines)).unwrap().pixels[5];
        [red, green, blue]
    };
    for name in ["#?RADIANCE", "#?RGBE", "#?AUTOPANO"] {
        assert_eq!(first(name, ""), [1.0, 0.5, 0.25], "{name}");
    }
    // Ward: all exposures of a header multiply, and the pixels are to be divided by the product.
    assert_eq!(first("#?RGBE", "EXPOSURE=4\n"), [0.25, 0.125, 0.0625]);
    assert_eq!(first("#?RADIANCE", "EXPOSURE=0.5\n# a comment\nEXPOSURE= 4.0\n"), [0.5, 0.25, 0.125]);
    assert_eq!(first("#?RADIANCE", "EXPOSURE=2\nCOLORCORR=1 0.5 0.25\n"), [0.5, 0.5, 0.5]);
    for line in ["EXPOSURE=0\n", "EXPOSURE=-1\n", "EXPOSURE=nan\n", "EXPOSURE=x\n", "COLORCORR=1 0 1\n"] {
        let message = decode(&radiance_picture("#?RADIANCE", line)).unwrap_err().to_string();
        assert!(message.contains("cannot be decoded") && !message.contains('\n'), "{line}: {message}");
    }
}

#[test]
fn small_files_with_large_claims_take_no_memory() {
    for (size, says) in [
        ("-Y 8192 +X 16384", "cannot hold so many"),
        ("-Y 8193 +X 16", "at most 16384 x 8192"),
        ("-Y 65535 +X 65535", "at most 16384 x 8192"),
        ("-Y 4294967295 +X 4294967295", "are too large"),
        ("-Y 1 +X 16", "at least 2 x 2"),
        ("-Y 0 +X 0", "at least 2 x 2"),
    ] {
        let text = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n{size}\n");
        let message = decode(text.as_bytes()).unwrap_err().to_string();
        assert!(message.contains(says), "{size}: {message}");
    }
}

#[test]
fn truncated_and_changed_files_are_errors_or_images() {
    for format in [ImageFormat::OpenExr, ImageFormat::Hdr] {
        let good = encoded(&coloured(16, 8), format);
        for end in 0..good.len() {
            assert!(decode(&good[..end]).is_err(), "{format:?} cut at {end}");
        }
        for place in 0..good.len() {
            for value in [0, 0xff, good[place].wrapping_add(1)] {
                let mut bytes = good.clone();
                bytes[place] = value;
                // The only requirement is that the call returns.
                let _ = decode(&bytes);
            }
        }
    }
}
