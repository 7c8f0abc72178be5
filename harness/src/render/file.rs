//! Pictures as files: PNG to look at, EXR where the range matters. A file is complete or absent.

use super::Picture;
use exr::prelude::{Image, WritableImage as _, f16};
use std::io::{Cursor, Write as _};
use std::path::{Path, PathBuf};

/// Why a picture could not be written or read.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// A name that says no format.
    #[error("{path}: the name must end in .png or .exr")]
    Extension {
        /// The file.
        path: PathBuf,
    },
    /// The system's word.
    #[error("{path}: cannot be written: {error}")]
    Write {
        /// The file.
        path: PathBuf,
        /// What went wrong.
        error: std::io::Error,
    },
    /// The encoder's word.
    #[error("{path}: cannot be encoded: {reason}")]
    Encode {
        /// The file.
        path: PathBuf,
        /// What went wrong.
        reason: String,
    },
}

/// What a file name asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// 8-bit sRGB.
    Png,
    /// Half-float linear RGBA.
    Exr,
}

impl Format {
    /// The format that `path` ends in.
    pub fn of_path(path: &Path) -> Result<Format, FileError> {
        match path.extension().and_then(|extension| extension.to_str()).map(str::to_lowercase).as_deref() {
            Some("png") => Ok(Format::Png),
            Some("exr") => Ok(Format::Exr),
            _ => Err(FileError::Extension { path: path.to_owned() }),
        }
    }
}

/// Writes `picture` in the format that `path` ends in.
pub fn write(picture: &Picture, path: &Path) -> Result<(), FileError> {
    let encode = |reason: String| FileError::Encode { path: path.to_owned(), reason };
    let bytes = match Format::of_path(path)? {
        Format::Png => png(picture.width, picture.height, &picture.encoded).map_err(encode)?,
        Format::Exr => exr(picture).map_err(encode)?,
    };
    replace(path, &bytes)
}

/// Whether a file can be written at `path`: asked before hours of rendering, not after.
pub fn check_writable(path: &Path) -> Result<(), FileError> {
    let writable = || {
        if path.is_dir() {
            return Err(std::io::Error::from(std::io::ErrorKind::IsADirectory));
        }
        tempfile::NamedTempFile::new_in(folder_of(path)).map(drop)
    };
    writable().map_err(|error| FileError::Write { path: path.to_owned(), error })
}

/// Writes bytes to a file beside `path`, then renames it, so that no reader ever meets half of them.
pub fn replace(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    let write = || {
        let mut file = tempfile::NamedTempFile::new_in(folder_of(path))?;
        file.write_all(bytes)?;
        // Temporary files are private; a picture is not.
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt as _;
            file.as_file().set_permissions(std::fs::Permissions::from_mode(0o644))?;
        }
        file.persist(path).map_err(|error| error.error)?;
        Ok(())
    };
    write().map_err(|error| FileError::Write { path: path.to_owned(), error })
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Encodes opaque pixels as a PNG without alpha.
pub fn png(width: u32, height: u32, pixels: &[[u8; 4]]) -> Result<Vec<u8>, String> {
    let rgb: Vec<u8> = pixels.iter().flat_map(|[r, g, b, _]| [*r, *g, *b]).collect();
    let mut bytes = Vec::new();
    let encoder = image::codecs::png::PngEncoder::new_with_quality(
        Cursor::new(&mut bytes),
        image::codecs::png::CompressionType::Best,
        image::codecs::png::FilterType::Adaptive,
    );
    image::ImageEncoder::write_image(encoder, &rgb, width, height, image::ExtendedColorType::Rgb8)
        .map_err(|error| error.to_string())?;
    Ok(bytes)
}

fn exr(picture: &Picture) -> Result<Vec<u8>, String> {
    let width = picture.width as usize;
    let channels = exr::prelude::SpecificChannels::rgba(|at: exr::prelude::Vec2<usize>| {
        let [r, g, b, a] = picture.linear[at.1 * width + at.0];
        (f16::from_f32(r), f16::from_f32(g), f16::from_f32(b), f16::from_f32(a))
    });
    let mut image = Image::from_channels((width, picture.height as usize), channels);
    image.layer_data.encoding.compression = exr::prelude::Compression::ZIP16;
    let mut bytes = Vec::new();
    image.write().to_buffered(Cursor::new(&mut bytes)).map_err(|error| error.to_string())?;
    Ok(bytes)
}
