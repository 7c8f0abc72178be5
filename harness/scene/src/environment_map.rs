//! Loads a latitude-longitude environment map from a .hdr or .exr file.

use std::io::{Cursor, Read};
use std::path::{Path, PathBuf};

use image::codecs::hdr::HdrDecoder;
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};
use thiserror::Error;

/// Largest width that is read, in pixels.
pub const MAX_WIDTH: u32 = 16_384;
/// Largest height that is read, in pixels.
pub const MAX_HEIGHT: u32 = 8_192;
/// Number of pixels that any file may have: 16 MB decoded.
const FREE_PIXELS: u64 = 1 << 20;
/// Number of pixels that a larger map may have per byte of file. Deflate reaches 1000 : 1, which is
/// 125 pixels of four half floats per byte, and only for a map of one colour.
const PIXELS_PER_BYTE: u64 = 128;
/// Largest file that is read, in bytes: more than the largest map needs in 32-bit floats.
const MAX_FILE_BYTES: u64 = 4 << 30;

/// Light from all directions: the top row is straight up, and the left and right edges meet.
#[derive(Debug, Clone, PartialEq)]
pub struct EnvironmentMap {
    /// Number of pixels in a row, at least 2.
    pub width: u32,
    /// Number of rows, at least 2.
    pub height: u32,
    /// Linear radiance in red, green and blue, and an unused alpha; row by row from the top. All
    /// values are finite and non-negative.
    pub pixels: Vec<[f32; 4]>,
}

/// Why an environment map cannot be loaded, in one line that says where, what, and what to do.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{}: {problem}", path.display())]
pub struct EnvironmentMapError {
    /// Path of the file.
    pub path: PathBuf,
    /// What is wrong with it.
    pub problem: MapProblem,
}

/// What is wrong with the file of an environment map.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum MapProblem {
    /// The file cannot be read, for the operating system's reason.
    #[error("cannot be read: {0}; give a .hdr or .exr file")]
    Unreadable(String),
    /// Another kind of file.
    #[error(
        "this is not a Radiance .hdr or OpenEXR .exr image; an environment needs one, since other formats do not hold \
         radiance"
    )]
    Format,
    /// The file is damaged, or an unsupported kind of .hdr or .exr, for the decoder's reason.
    #[error("cannot be decoded: {0}; save it again as uncompressed or ZIP-compressed RGB")]
    Decode(String),
    /// Too small, too large, or larger than its file can hold.
    #[error("it states {width} x {height} pixels, but {rule}")]
    Size {
        /// Stated width in pixels.
        width: u32,
        /// Stated height in pixels.
        height: u32,
        /// What is allowed, and what to do.
        rule: String,
    },
    /// A pixel that is not radiance.
    #[error(
        "the pixel in column {column}, row {row} (from 0, top left) is {value:?}, but radiance must be finite; repair \
         the pixel"
    )]
    Pixel {
        /// Column of the pixel, from the left.
        column: u32,
        /// Row of the pixel, from the top.
        row: u32,
        /// Red, green and blue.
        value: [f32; 3],
    },
}

impl From<image::ImageError> for MapProblem {
    fn from(error: image::ImageError) -> Self {
        Self::Decode(error.to_string().replace(char::is_control, " "))
    }
}

/// Statistics of pixels with a negative component, as lossy compression leaves next to bright ones.
/// Each such component counts as 0.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Clamped {
    /// Number of pixels with a negative component.
    pub pixels: usize,
    /// The lowest component; 0 if none is negative.
    pub least: f32,
}

impl EnvironmentMap {
    /// Loads a .hdr or .exr file, told apart by its content, of any aspect ratio from 2 x 2 to
    /// [`MAX_WIDTH`] x [`MAX_HEIGHT`] pixels. Colours are taken as linear, with Rec. 709 primaries.
    /// The pixels of a .hdr file are divided by its exposures and colour corrections, as the format
    /// requires; negative components count as 0.
    ///
    /// # Errors
    /// Returns an [`EnvironmentMapError`] if the file cannot be used.
    pub fn load(path: &Path) -> Result<Self, EnvironmentMapError> {
        Self::load_counting(path).map(|(map, _)| map)
    }

    /// As [`EnvironmentMap::load`], and also returns statistics of the negative components.
    ///
    /// # Errors
    /// As [`EnvironmentMap::load`].
    pub fn load_counting(path: &Path) -> Result<(Self, Clamped), EnvironmentMapError> {
        let in_file = |problem| EnvironmentMapError { path: path.to_owned(), problem };
        read(path).and_then(|bytes| Self::decode(&bytes)).map_err(in_file)
    }

    fn decode(bytes: &[u8]) -> Result<(Self, Clamped), MapProblem> {
        let image = if bytes.starts_with(RADIANCE) {
            radiance(bytes)?
        } else {
            let is_exr = image::guess_format(bytes).is_ok_and(|format| format == ImageFormat::OpenExr);
            if !is_exr {
                return Err(MapProblem::Format);
            }
            let reader = ImageReader::with_format(Cursor::new(bytes), ImageFormat::OpenExr);
            decoded(reader.into_decoder()?, bytes.len())?
        };
        let (width, height) = (image.width(), image.height());
        let mut pixels: Vec<[f32; 4]> = image.into_rgba32f().pixels().map(|p| p.0).collect();
        let mut clamped = Clamped::default();
        for (place, pixel) in pixels.iter_mut().enumerate() {
            let [red, green, blue, _] = *pixel;
            let value = [red, green, blue];
            if !value.iter().all(|part| part.is_finite()) {
                let place = place as u32;
                return Err(MapProblem::Pixel { column: place % width, row: place / width, value });
            }
            let least = red.min(green).min(blue);
            if least < 0.0 {
                clamped = Clamped { pixels: clamped.pixels + 1, least: clamped.least.min(least) };
                pixel[..3].iter_mut().for_each(|part| *part = part.max(0.0));
            }
        }
        Ok((Self { width, height, pixels }, clamped))
    }
}

/// Start of a Radiance picture, before the name of the program that wrote it: `#?RADIANCE`,
/// `#?RGBE` and others.
const RADIANCE: &[u8] = b"#?";

/// Decodes a Radiance picture to radiance.
fn radiance(bytes: &[u8]) -> Result<DynamicImage, MapProblem> {
    let first = bytes.iter().position(|byte| *byte == b'\n').unwrap_or(bytes.len());
    // The decoder knows only one program's name.
    let renamed = (&b"#?RADIANCE"[..]).chain(&bytes[first..]);
    let decoder = HdrDecoder::new(renamed)?;
    let header = decoder.metadata();
    let (red, green, blue) = header.color_correction.unwrap_or((1.0, 1.0, 1.0));
    let exposure = header.exposure.unwrap_or(1.0);
    let divisors = [red, green, blue].map(|correction| exposure * correction);
    if !divisors.iter().all(|divisor| divisor.is_normal() && *divisor > 0.0) {
        return Err(MapProblem::Decode(format!(
            "its exposures and colour corrections multiply to {divisors:?}, but must be finite and above 0"
        )));
    }
    let mut image = decoded(decoder, bytes.len())?.into_rgb32f();
    if divisors != [1.0; 3] {
        for pixel in image.pixels_mut() {
            pixel.0.iter_mut().zip(divisors).for_each(|(part, divisor)| *part /= divisor);
        }
    }
    Ok(image.into())
}

/// Decodes the whole picture, within the limits for a file of `file_bytes` bytes.
fn decoded(mut decoder: impl ImageDecoder, file_bytes: usize) -> Result<DynamicImage, MapProblem> {
    let (width, height) = decoder.dimensions();
    check_size(width, height, file_bytes as u64)?;
    let mut limits = Limits::no_limits();
    limits.max_image_width = Some(MAX_WIDTH);
    limits.max_image_height = Some(MAX_HEIGHT);
    decoder.set_limits(limits)?;
    Ok(DynamicImage::from_decoder(decoder)?)
}

fn read(path: &Path) -> Result<Vec<u8>, MapProblem> {
    let unreadable = MapProblem::Unreadable;
    let metadata = std::fs::metadata(path).map_err(|error| unreadable(error.to_string()))?;
    if !metadata.is_file() {
        return Err(unreadable(lapidary_files::not_a_file(&metadata).to_owned()));
    }
    if metadata.len() > MAX_FILE_BYTES {
        let size = metadata.len();
        return Err(unreadable(format!("it has {size} bytes, more than the {MAX_FILE_BYTES} that are read")));
    }
    std::fs::read(path).map_err(|error| unreadable(error.to_string()))
}

fn check_size(width: u32, height: u32, file_bytes: u64) -> Result<(), MapProblem> {
    let pixels = u64::from(width) * u64::from(height);
    let rule = if width < 2 || height < 2 {
        "it must have at least 2 x 2; give a latitude-longitude map".to_owned()
    } else if width > MAX_WIDTH || height > MAX_HEIGHT {
        format!("at most {MAX_WIDTH} x {MAX_HEIGHT} are read; scale it down")
    } else if pixels > FREE_PIXELS.max(file_bytes.saturating_mul(PIXELS_PER_BYTE)) {
        format!("its {file_bytes} bytes cannot hold so many; save it again or scale it down")
    } else {
        return Ok(());
    };
    Err(MapProblem::Size { width, height, rule })
}

#[cfg(test)]
mod tests;
