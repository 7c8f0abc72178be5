//! The pictures on the site: each at its full size, and a small one for the page if it is large.

use super::templates::{self, Markup};
use super::{error::GalleryError, text};
use image::codecs::jpeg::JpegEncoder;
use lapidary_snapshots::{Committed, WALKED};
use serde::Serialize;
use std::fs::{self, File};
use std::io::{BufWriter, Write as _};
use std::path::{Path, PathBuf};

/// Width in pixels of the picture in the page.
const THUMB_WIDTH: u32 = 640;
/// JPEG quality of the site's pictures; the committed files are lossless.
const QUALITY: u8 = 92;

/// A picture to show.
#[derive(Clone, Debug)]
pub struct Source {
    /// Name of its files on the site, unique.
    pub name: String,
    /// The folder of its technique.
    pub folder: String,
    /// Its title.
    pub title: String,
    /// What stands below it, plain text with `` `code` ``.
    pub caption: String,
    /// The command that draws it.
    pub command: String,
    /// The rung that drew it.
    pub rung: String,
    /// Samples in a pixel, or walks.
    pub samples: String,
    /// The file to copy.
    pub file: PathBuf,
    /// Its path in the repository, by which doc pages show it.
    pub source: Option<String>,
}

/// A caption, for its template.
#[derive(Serialize)]
struct Prose {
    prose: Vec<text::Span>,
}

/// A picture on the site.
#[derive(Clone, Debug, Serialize)]
pub struct Shown {
    /// Its name.
    pub name: String,
    /// The folder of its technique.
    pub folder: String,
    /// Its title.
    pub title: String,
    /// What stands below it.
    pub caption: Markup,
    /// The command that draws it.
    pub command: String,
    /// The rung that drew it.
    pub rung: String,
    /// Samples in a pixel, or walks.
    pub samples: String,
    /// The device that drew it.
    pub adapter: String,
    /// The picture, from the site's root.
    pub file: String,
    /// The small picture, from the site's root.
    pub thumb: String,
    /// Width in pixels of the picture.
    pub width: u32,
    /// Its height.
    pub height: u32,
    /// Its path in the repository.
    pub source: Option<String>,
}

/// Returns the committed pictures, as their files stand in the repository.
pub fn committed() -> Vec<Source> {
    let source_of = |picture: Committed| {
        let folder = picture.folder().file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        let file = picture.folder().join([picture.name(), ".png"].concat());
        Source {
            name: picture.name().to_owned(),
            title: picture.title().to_owned(),
            caption: picture.caption().to_owned(),
            command: picture.command(),
            rung: picture.rung(),
            samples: picture.samples(),
            source: Some(["snapshots/", &folder, "/", picture.name(), ".png"].concat()),
            folder,
            file,
        }
    };
    Committed::all().map(source_of).collect()
}

/// Returns the titles and commands of the pictures by random walks, to be drawn from their committed radiance.
pub fn walked(folder: &Path) -> Vec<Source> {
    let source_of = |reference: &'static lapidary_snapshots::WalkedReference| {
        Source {
        name: [&reference.name(), "_walked"].concat(),
        folder: reference.technique.to_owned(),
        title: reference.title.to_owned(),
        caption: "What random walks find: light that enters anywhere, is scattered inside and leaves towards the eye. They know thickness \
            and shadows, which no reflectance function does, and all ways, of which the cheapest is one."
            .to_owned(),
        command: reference.command(),
        rung: "reference".to_owned(),
        samples: [&reference.walks.to_string(), " walks a pixel"].concat(),
        file: folder.join([&reference.name(), "_walked.png"].concat()),
        source: None,
    }
    };
    WALKED.iter().map(source_of).collect()
}

/// Writes the pictures into the site's folder.
///
/// # Errors
/// Returns an error that names the picture if one cannot be read or written.
pub fn place(sources: &[Source], adapter: &str, site: &Path) -> Result<Vec<Shown>, GalleryError> {
    use rayon::prelude::*;
    sources.par_iter().map(|source| place_one(source, adapter, site)).collect()
}

fn place_one(source: &Source, adapter: &str, site: &Path) -> Result<Shown, GalleryError> {
    let fault = |error: std::io::Error| GalleryError::Picture {
        title: source.title.clone(),
        file: source.file.clone(),
        command: source.command.clone(),
        source: error,
    };
    let folder = ["images/", &source.folder].concat();
    fs::create_dir_all(site.join(&folder)).map_err(fault)?;
    let picture = image::open(&source.file).map_err(|error| fault(std::io::Error::other(error)))?.into_rgb8();
    let (width, height) = picture.dimensions();
    let file = [&folder, "/", &source.name, ".jpg"].concat();
    encode(&picture, &site.join(&file)).map_err(fault)?;
    let thumb = if width > THUMB_WIDTH {
        let scaled = u64::from(height) * u64::from(THUMB_WIDTH) / u64::from(width);
        let scaled = u32::try_from(scaled.max(1)).unwrap_or(height);
        let small = image::imageops::resize(&picture, THUMB_WIDTH, scaled, image::imageops::FilterType::CatmullRom);
        let thumb = [&folder, "/", &source.name, "-small.jpg"].concat();
        encode(&small, &site.join(&thumb)).map_err(fault)?;
        thumb
    } else {
        file.clone()
    };
    Ok(Shown {
        name: source.name.clone(),
        folder: source.folder.clone(),
        title: source.title.clone(),
        caption: templates::render("prose.html", Prose { prose: text::prose(&source.caption) }),
        command: source.command.clone(),
        rung: source.rung.clone(),
        samples: source.samples.clone(),
        adapter: adapter.to_owned(),
        file,
        thumb,
        width,
        height,
        source: source.source.clone(),
    })
}

fn encode(picture: &image::RgbImage, path: &Path) -> std::io::Result<()> {
    let mut writer = BufWriter::new(File::create(path)?);
    JpegEncoder::new_with_quality(&mut writer, QUALITY).encode_image(picture).map_err(std::io::Error::other)?;
    writer.flush()
}
