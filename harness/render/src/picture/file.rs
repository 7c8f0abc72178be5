//! Picture files: PNG for viewing, EXR if the range matters.

use super::Picture;
use exr::prelude::{Image, WritableImage as _, f16};
use lapidary_files::WriteError;
use std::io::Cursor;
use std::path::{Path, PathBuf};

/// Reason why a picture could not be written.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// A file name whose extension is not that of a format that can be written.
    #[error("{path}: the name must end in {endings}")]
    Extension {
        /// The file.
        path: PathBuf,
        /// The endings that can be written.
        endings: &'static str,
    },
    /// An error of the file system.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// An error of the encoder.
    #[error("{path}: cannot be encoded: {reason}")]
    Encode {
        /// The file.
        path: PathBuf,
        /// The encoder's message.
        reason: String,
    },
}

/// File format, chosen by the extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// 8-bit sRGB.
    Png,
    /// Half-float linear RGBA.
    Exr,
}

impl Format {
    /// Returns the ending of a file's name.
    #[must_use]
    pub fn ending(self) -> &'static str {
        match self {
            Format::Png => "png",
            Format::Exr => "exr",
        }
    }

    /// Returns the format that the extension of `path` names.
    pub fn of_path(path: &Path) -> Result<Format, FileError> {
        match path.extension().and_then(|extension| extension.to_str()).map(str::to_lowercase).as_deref() {
            Some("png") => Ok(Format::Png),
            Some("exr") => Ok(Format::Exr),
            _ => Err(FileError::Extension { path: path.to_owned(), endings: ".png or .exr" }),
        }
    }
}

/// Checks that the name of `path` ends in `ending`, such as `.glb`, in any case.
pub fn check_ending(path: &Path, ending: &'static str) -> Result<(), FileError> {
    let name = path.to_string_lossy().to_lowercase();
    if name.ends_with(ending) { Ok(()) } else { Err(FileError::Extension { path: path.to_owned(), endings: ending }) }
}

/// Writes `picture` in the format that the extension of `path` names.
pub fn write(picture: &Picture, path: &Path) -> Result<(), FileError> {
    let encode = |reason: String| FileError::Encode { path: path.to_owned(), reason };
    let bytes = match Format::of_path(path)? {
        Format::Png => png(picture.width, picture.height, &picture.encoded).map_err(encode)?,
        Format::Exr => exr(picture).map_err(encode)?,
    };
    Ok(lapidary_files::replace(path, &bytes)?)
}

/// Encodes pixels as a PNG, without alpha if all are opaque.
pub fn png(width: u32, height: u32, pixels: &[[u8; 4]]) -> Result<Vec<u8>, String> {
    let is_opaque = pixels.iter().all(|[.., alpha]| *alpha == 255);
    let (data, color) = if is_opaque {
        (pixels.iter().flat_map(|[r, g, b, _]| [*r, *g, *b]).collect(), image::ExtendedColorType::Rgb8)
    } else {
        (pixels.concat(), image::ExtendedColorType::Rgba8)
    };
    let mut bytes = Vec::new();
    let encoder = image::codecs::png::PngEncoder::new_with_quality(
        Cursor::new(&mut bytes),
        image::codecs::png::CompressionType::Best,
        image::codecs::png::FilterType::Adaptive,
    );
    image::ImageEncoder::write_image(encoder, &data, width, height, color).map_err(|error| error.to_string())?;
    Ok(bytes)
}

fn exr(picture: &Picture) -> Result<Vec<u8>, String> {
    let width = picture.width as usize;
    let channels = exr::prelude::SpecificChannels::rgba(|place: exr::prelude::Vec2<usize>| {
        let [r, g, b, a] = picture.linear[place.1 * width + place.0];
        (f16::from_f32(r), f16::from_f32(g), f16::from_f32(b), f16::from_f32(a))
    });
    let mut image = Image::from_channels((width, picture.height as usize), channels);
    image.layer_data.encoding.compression = exr::prelude::Compression::ZIP16;
    let mut bytes = Vec::new();
    image.write().to_buffered(Cursor::new(&mut bytes)).map_err(|error| error.to_string())?;
    Ok(bytes)
}
