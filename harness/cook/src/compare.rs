//! Comparison of two picture files: how different they look, and how different their light is.

use glam::Vec3;
use image::{DynamicImage, ImageDecoder as _, ImageReader, Limits};
use std::path::{Path, PathBuf};

/// Most pixels along a side, those of `cook render`.
const LARGEST: u32 = 8192;

/// Reason why two pictures could not be compared.
#[derive(Debug, thiserror::Error)]
pub enum CompareError {
    /// A file that is no picture, or is not there.
    #[error("{path}: cannot be read: {reason}; give a .png or .exr file")]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Message of the system or of the decoder.
        reason: String,
    },
    /// Pictures of different sizes.
    #[error("{path}: is {found:?} pixels, {reference} is {expected:?}; render both in one size")]
    Size {
        /// The picture.
        path: PathBuf,
        /// Its width and height in pixels.
        found: (u32, u32),
        /// The reference.
        reference: PathBuf,
        /// Its width and height in pixels.
        expected: (u32, u32),
    },
    /// A pixel is NaN or infinite.
    #[error("{path}: pixel ({column}, {row}) is {value:?}; only finite radiance can be compared")]
    NotFinite {
        /// The file.
        path: PathBuf,
        /// Column of the pixel, from the left.
        column: u32,
        /// Row of the pixel, from the top.
        row: u32,
        /// Value of the pixel.
        value: [f32; 4],
    },
}

/// Difference of a picture from its reference, over the pixels that the reference covers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Mean FLIP of what one sees, 0 to 1. An EXR is seen through the tone curve of `cook render`,
    /// over black.
    pub flip: f64,
    /// RMSE of linear RGB, divided by the reference's root mean square; infinite for a black
    /// reference.
    pub rmse: f64,
    /// Number of pixels: those with coverage in the reference, or all if it has none anywhere.
    pub pixels: usize,
}

/// A picture file: linear RGB and coverage, and what one sees.
struct Picture {
    size: (u32, u32),
    linear: Vec<[f32; 4]>,
    seen: Vec<u8>,
}

/// Compares the picture in a file with the reference in another, each PNG or EXR.
///
/// # Errors
/// Returns an error if a file is no picture, if the sizes differ, or if a pixel is not finite.
pub fn compare(reference: &Path, picture: &Path) -> Result<Difference, CompareError> {
    let (truth, found) = (read(reference)?, read(picture)?);
    if found.size != truth.size {
        let (path, reference) = (picture.to_owned(), reference.to_owned());
        return Err(CompareError::Size { path, found: found.size, reference, expected: truth.size });
    }
    let flip = lapidary_flip::flip(truth.size, &truth.seen, &found.seen);
    let is_empty = truth.linear.iter().all(|pixel| pixel[3] == 0.0);
    let covered = (0..truth.linear.len()).filter(|place| is_empty || truth.linear[*place][3] > 0.0);
    let (mut sum, mut error, mut power, mut pixels) = (0.0, 0.0, 0.0, 0);
    for place in covered {
        pixels += 1;
        sum += f64::from(flip[place]);
        for (found, truth) in found.linear[place][..3].iter().zip(&truth.linear[place][..3]) {
            error += (f64::from(*found) - f64::from(*truth)).powi(2);
            power += f64::from(*truth).powi(2);
        }
    }
    let rmse = if error == 0.0 { 0.0 } else { (error / power).sqrt() };
    Ok(Difference { flip: sum / pixels as f64, rmse, pixels })
}

fn read(path: &Path) -> Result<Picture, CompareError> {
    let unreadable = |reason: String| CompareError::Unreadable {
        path: path.to_owned(),
        reason: reason.replace(char::is_control, " "),
    };
    let metadata = std::fs::metadata(path).map_err(|error| unreadable(error.to_string()))?;
    if !metadata.is_file() {
        return Err(unreadable(lapidary_files::not_a_file(&metadata).to_owned()));
    }
    let reader = ImageReader::open(path).map_err(|error| unreadable(error.to_string()))?;
    let reader = reader.with_guessed_format().map_err(|error| unreadable(error.to_string()))?;
    let mut decoder = reader.into_decoder().map_err(|error| unreadable(error.to_string()))?;
    let (width, height) = decoder.dimensions();
    if width.max(height) > LARGEST {
        return Err(unreadable(format!("it is {width} x {height} pixels, more than {LARGEST} along a side")));
    }
    decoder.set_limits(Limits::no_limits()).map_err(|error| unreadable(error.to_string()))?;
    let image = DynamicImage::from_decoder(decoder).map_err(|error| unreadable(error.to_string()))?;
    let size = (image.width(), image.height());
    let is_linear = matches!(image, DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_));
    let values: Vec<[f32; 4]> = image.into_rgba32f().pixels().map(|pixel| pixel.0).collect();
    if let Some((place, value)) = (0..).zip(&values).find(|(_, pixel)| !pixel.iter().all(|value| value.is_finite())) {
        let (column, row) = (place % size.0, place / size.0);
        return Err(CompareError::NotFinite { path: path.to_owned(), column, row, value: *value });
    }
    let mapped = |conversion: fn(Vec3) -> Vec3| {
        values.iter().map(|&[r, g, b, coverage]| conversion(Vec3::new(r, g, b)).extend(coverage).to_array()).collect()
    };
    let (linear, encoded): (Vec<[f32; 4]>, Vec<[f32; 4]>) = if is_linear {
        let encoded = mapped(|light| lapidary_srgb::encode_color(lapidary_srgb::tone_curve(light.max(Vec3::ZERO))));
        (values, encoded)
    } else {
        (mapped(lapidary_srgb::decode_color), values)
    };
    let seen = encoded.iter().flat_map(|pixel| [0, 1, 2].map(|channel| (255.0 * pixel[channel]).round() as u8));
    Ok(Picture { size, linear, seen: seen.collect() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{Rgba, Rgba32FImage, RgbaImage};

    fn exr(folder: &Path, name: &str, pixel_of: impl Fn(u32, u32) -> [f32; 4]) -> PathBuf {
        let path = folder.join(name);
        Rgba32FImage::from_fn(16, 8, |x, y| Rgba(pixel_of(x, y))).save(&path).expect("an EXR");
        path
    }

    #[test]
    fn only_covered_pixels_count() {
        let folder = tempfile::tempdir().expect("a folder");
        let stone = |x: u32, light: f32| if x < 4 { [light, light, light, 1.0] } else { [0.0; 4] };
        let truth = exr(folder.path(), "truth.exr", |x, _| stone(x, 0.5));
        assert_eq!(compare(&truth, &truth).expect("one picture"), Difference { flip: 0.0, rmse: 0.0, pixels: 32 });
        let darker = exr(folder.path(), "darker.exr", |x, _| stone(x, 0.25));
        let difference = compare(&truth, &darker).expect("two pictures");
        assert!((difference.rmse - 0.5).abs() < 1e-6 && difference.flip > 0.1, "{difference:?}");
        // Beside the stone anything may be.
        let beside = exr(folder.path(), "beside.exr", |x, _| if x < 4 { stone(x, 0.5) } else { [9.0, 0.0, 0.0, 1.0] });
        assert_eq!(compare(&truth, &beside).expect("two pictures").rmse, 0.0);
    }

    #[test]
    fn a_png_is_what_one_sees_of_an_exr() {
        let folder = tempfile::tempdir().expect("a folder");
        let gradient = exr(folder.path(), "gradient.exr", |x, y| [x as f32 / 4.0, y as f32 / 4.0, 0.3, 1.0]);
        let seen = read(&gradient).expect("an EXR").seen;
        let png = folder.path().join("gradient.png");
        let pixel = |x: u32, y: u32| {
            let place = 3 * (16 * y + x) as usize;
            Rgba([seen[place], seen[place + 1], seen[place + 2], 255])
        };
        RgbaImage::from_fn(16, 8, pixel).save(&png).expect("a PNG");
        assert_eq!(compare(&gradient, &png).expect("two pictures").flip, 0.0);
    }

    #[test]
    fn what_cannot_be_compared_is_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        let truth = exr(folder.path(), "truth.exr", |_, _| [1.0; 4]);
        let hole = exr(folder.path(), "hole.exr", |x, y| [if (x, y) == (3, 2) { f32::NAN } else { 1.0 }; 4]);
        let message = compare(&truth, &hole).expect_err("NaN").to_string();
        assert!(message.contains("pixel (3, 2)"), "{message}");
        let small = folder.path().join("small.png");
        RgbaImage::new(4, 4).save(&small).expect("a PNG");
        let message = compare(&truth, &small).expect_err("another size").to_string();
        assert!(
            message.contains("small.png") && message.contains("(4, 4)") && message.contains("(16, 8)"),
            "{message}"
        );
        let message = compare(&truth, folder.path()).expect_err("a folder").to_string();
        assert!(message.contains("cannot be read"), "{message}");
        let black = exr(folder.path(), "black.exr", |_, _| [0.0; 4]);
        assert_eq!(compare(&black, &truth).expect("two pictures").rmse, f64::INFINITY);
    }
}
