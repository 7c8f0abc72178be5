//! Loads a latitude-longitude environment map from a .hdr or .exr file.

use std::io::Cursor;
use std::path::{Path, PathBuf};

use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};
use thiserror::Error;

/// The largest width that is read, in pixels.
pub const MAX_WIDTH: u32 = 16_384;
/// The largest height that is read, in pixels.
pub const MAX_HEIGHT: u32 = 8_192;
/// Every file may have this many pixels: 16 MB decoded.
const FREE_PIXELS: u64 = 1 << 20;
/// A larger map may have this many pixels per byte of file. Deflate reaches 1000 : 1, which is 125
/// pixels of four half floats per byte, and only on a map of one colour.
const PIXELS_PER_BYTE: u64 = 128;
/// No file larger than this is read: more than the largest map needs in 32-bit floats.
const MAX_FILE_BYTES: u64 = 4 << 30;

/// Light from all directions: the top row is straight up, the left and right edges meet.
#[derive(Debug, Clone, PartialEq)]
pub struct EnvironmentMap {
    /// Pixels in a row, at least 2.
    pub width: u32,
    /// Rows, at least 2.
    pub height: u32,
    /// Linear radiance in red, green and blue, and an alpha of no meaning; row by row from the top.
    /// All finite and not negative.
    pub pixels: Vec<[f32; 4]>,
}

/// Why there is no environment map. Each message is one line that says where, what, and what to do.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum EnvironmentMapError {
    /// The file cannot be read.
    #[error("{}: cannot be read: {reason}; check that it exists and may be read", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The operating system's reason.
        reason: String,
    },
    /// Another kind of file.
    #[error(
        "{}: this is not a Radiance .hdr or OpenEXR .exr image; \
         an environment needs one, since other formats do not hold radiance",
        path.display()
    )]
    Format {
        /// The file.
        path: PathBuf,
    },
    /// The file is damaged, or of a kind of .hdr or .exr that is not read.
    #[error(
        "{}: cannot be decoded: {reason}; save it again as uncompressed or ZIP-compressed RGB",
        path.display()
    )]
    Decode {
        /// The file.
        path: PathBuf,
        /// The decoder's reason.
        reason: String,
    },
    /// Too small, too large, or larger than its file can hold.
    #[error("{}: it states {width} x {height} pixels, but {rule}", path.display())]
    Size {
        /// The file.
        path: PathBuf,
        /// Its width in pixels.
        width: u32,
        /// Its height in pixels.
        height: u32,
        /// What is allowed, and what to do.
        rule: String,
    },
    /// A pixel that is not radiance.
    #[error(
        "{}: the pixel in column {column}, row {row} (from 0, top left) is {value:?}, but radiance must be \
         finite and not negative; repair the pixel",
        path.display()
    )]
    Pixel {
        /// The file.
        path: PathBuf,
        /// Its column, from the left.
        column: u32,
        /// Its row, from the top.
        row: u32,
        /// Red, green and blue.
        value: [f32; 3],
    },
}

impl EnvironmentMap {
    /// Loads a .hdr or .exr file, told apart by its content, of any aspect ratio from 2 x 2 to
    /// [`MAX_WIDTH`] x [`MAX_HEIGHT`] pixels. Colours count as linear, with Rec. 709 primaries.
    ///
    /// # Errors
    /// [`EnvironmentMapError`], where the file cannot be used.
    pub fn load(path: &Path) -> Result<Self, EnvironmentMapError> {
        Self::decode(&read(path)?, path)
    }

    fn decode(bytes: &[u8], path: &Path) -> Result<Self, EnvironmentMapError> {
        let undecodable = |error: image::ImageError| EnvironmentMapError::Decode {
            path: path.to_owned(),
            reason: error.to_string().replace(char::is_control, " "),
        };
        let format = image::guess_format(bytes).ok();
        let format = format.filter(|f| matches!(f, ImageFormat::Hdr | ImageFormat::OpenExr));
        let format = format.ok_or_else(|| EnvironmentMapError::Format { path: path.to_owned() })?;
        let reader = ImageReader::with_format(Cursor::new(bytes), format);
        let mut decoder = reader.into_decoder().map_err(undecodable)?;
        let (width, height) = decoder.dimensions();
        check_size(width, height, bytes.len() as u64, path)?;
        let mut limits = Limits::no_limits();
        limits.max_image_width = Some(MAX_WIDTH);
        limits.max_image_height = Some(MAX_HEIGHT);
        decoder.set_limits(limits).map_err(undecodable)?;

        let image = DynamicImage::from_decoder(decoder).map_err(undecodable)?;
        let pixels: Vec<[f32; 4]> = image.into_rgba32f().pixels().map(|p| p.0).collect();
        for (place, &[red, green, blue, _]) in pixels.iter().enumerate() {
            let value = [red, green, blue];
            // Written so that NaN fails it too.
            if !value.iter().all(|part| (0.0..f32::INFINITY).contains(part)) {
                let place = place as u32;
                return Err(EnvironmentMapError::Pixel {
                    path: path.to_owned(),
                    column: place % width,
                    row: place / width,
                    value,
                });
            }
        }
        Ok(Self { width, height, pixels })
    }
}

fn read(path: &Path) -> Result<Vec<u8>, EnvironmentMapError> {
    let unreadable = |reason: String| EnvironmentMapError::Unreadable { path: path.to_owned(), reason };
    let metadata = std::fs::metadata(path).map_err(|error| unreadable(error.to_string()))?;
    if !metadata.is_file() {
        return Err(unreadable("it is not a regular file".to_owned()));
    }
    if metadata.len() > MAX_FILE_BYTES {
        let size = metadata.len();
        return Err(unreadable(format!("it has {size} bytes, more than the {MAX_FILE_BYTES} that are read")));
    }
    std::fs::read(path).map_err(|error| unreadable(error.to_string()))
}

fn check_size(width: u32, height: u32, file_bytes: u64, path: &Path) -> Result<(), EnvironmentMapError> {
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
    Err(EnvironmentMapError::Size { path: path.to_owned(), width, height, rule })
}

#[cfg(test)]
mod tests;
