//! The committed pictures, and how a new one is compared with them: FLIP on the encoded picture,
//! RMSE on linear radiance.

pub mod beside_walks;
pub mod browse;
mod comparison;
pub mod exposure;
pub mod frames;
mod label;
pub mod motion;
mod shots;
pub mod strip;
mod walked;

use beside_walks::BesideWalks;
pub use comparison::flip;
pub use comparison::{Comparison, MOST_FLIP, MOST_HIGH_FLIP, MOST_RMSE, compare, compare_linear};
use lapidary_cookbook::repository;
use lapidary_gpu::Gpu;
use lapidary_render as render;
use lapidary_render::{Picture, RenderError, Settings, file};
use lapidary_scene::{BUILT_IN, SAMPLES, Scene, SceneError};
pub use shots::{SHOTS, Shot};
use std::path::{Path, PathBuf};
pub use walked::{WALKED, WalkedReference};

/// Width and height in pixels of a usual PNG for viewing.
pub const PNG_SIDE: u32 = 512;
/// Width and height in pixels of the EXR with linear radiance.
pub const EXR_SIDE: u32 = 256;
/// Size limit of a committed file in bytes.
pub const LARGEST_FILE: u64 = 1024 * 1024;
/// A committed picture: a PNG for viewing and an EXR with linear radiance.
#[derive(Clone, Copy, Debug)]
pub enum Committed {
    /// A picture of one scene.
    Shot(&'static Shot),
    /// Translucent stone in motion.
    Strip,
    /// Scattering bodies compared with random walks.
    BesideWalks(&'static BesideWalks),
}

impl Committed {
    /// Number of committed pictures.
    pub const COUNT: usize = SHOTS.len() + 1 + beside_walks::ALL.len();

    /// Returns each picture once.
    pub fn all() -> impl Iterator<Item = Self> {
        let compared = beside_walks::ALL.into_iter().map(Self::BesideWalks);
        SHOTS.iter().map(Self::Shot).chain([Self::Strip]).chain(compared)
    }

    /// Returns the common name of its files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Shot(shot) => shot.name,
            Self::Strip => strip::NAME,
            Self::BesideWalks(of) => of.name,
        }
    }

    /// Returns its title.
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Self::Shot(shot) => shot.title,
            Self::Strip => strip::TITLE,
            Self::BesideWalks(of) => of.title,
        }
    }

    /// Returns what stands below it: its description, or that of its scene.
    #[must_use]
    pub fn caption(self) -> &'static str {
        match self {
            Self::Shot(shot) if shot.paragraph.is_empty() => {
                BUILT_IN.iter().find(|scene| scene.name == shot.scene).map_or("", |scene| scene.description)
            }
            Self::Shot(shot) => shot.paragraph,
            Self::Strip => strip::PARAGRAPH,
            Self::BesideWalks(of) => of.paragraph,
        }
    }

    /// Returns the command that renders it.
    #[must_use]
    pub fn command(self) -> String {
        match self {
            Self::Shot(shot) => shot.command(),
            Self::Strip | Self::BesideWalks(_) => format!("./cook snapshots {}", self.name()),
        }
    }

    /// Returns the rung that draws it.
    #[must_use]
    pub fn rung(self) -> String {
        match self {
            Self::Shot(shot) if shot.rung == shots::BY_MATERIAL => {
                format!("by material, quality {}", shot.quality)
            }
            Self::Shot(shot) => shot.rung.to_owned(),
            Self::Strip => "by material".to_owned(),
            Self::BesideWalks(_) => "several, beside random walks".to_owned(),
        }
    }

    /// Returns how finely a pixel is sampled.
    #[must_use]
    pub fn samples(self) -> String {
        let side = match self {
            Self::Shot(shot) => shot.samples,
            Self::Strip | Self::BesideWalks(_) => SAMPLES,
        };
        if side == 1 { "1 sample a pixel".to_owned() } else { format!("{} samples a pixel", side * side) }
    }

    /// Returns the folder of its files.
    #[must_use]
    pub fn folder(self) -> PathBuf {
        match self {
            Self::Shot(shot) => shot.folder(),
            Self::Strip => folder("optical_path"),
            Self::BesideWalks(of) => folder(of.technique),
        }
    }

    /// Renders the picture anew, at the sizes of its PNG and its EXR.
    ///
    /// # Errors
    /// Returns an error if its scene does not load or if the device fails.
    pub fn render(self, gpu: &Gpu) -> Result<[Picture; 2], SnapshotError> {
        match self {
            Self::Shot(shot) => render_shot(gpu, shot),
            Self::Strip => strip::render(gpu),
            Self::BesideWalks(of) => of.render(gpu),
        }
    }

    /// Renders only the second of them, which is a quarter of the work.
    ///
    /// # Errors
    /// Returns an error as in [`Committed::render`].
    pub fn render_linear(self, gpu: &Gpu) -> Result<Picture, SnapshotError> {
        match self {
            Self::Shot(shot) => Ok(render::render(gpu, &shot.open()?, &shot.settings(EXR_SIDE))?),
            Self::Strip | Self::BesideWalks(_) => self.render(gpu).map(|[_, linear]| linear),
        }
    }
}

/// Returns the folder of the pictures of a technique's recipes.
pub fn folder(technique: &str) -> PathBuf {
    repository::place().join("snapshots").join(technique)
}

/// Reads a committed reference's linear radiance, and encodes it with the settings' size and
/// exposure.
pub fn reference_picture(gpu: &Gpu, path: &Path, settings: &Settings) -> Result<Picture, SnapshotError> {
    let (width, height) = (settings.width, settings.height);
    let linear: Vec<[f32; 4]> = read(path, (width, height))?.into_rgba32f().pixels().map(|pixel| pixel.0).collect();
    let encoded = vec![[0; 4]; linear.len()];
    let mut picture = Picture { width, height, linear, encoded, lost: None, walked: None, notes: Vec::new() };
    render::encode(gpu, settings, &mut picture)?;
    Ok(picture)
}

/// Why a snapshot test failed.
#[derive(Debug, thiserror::Error)]
pub enum SnapshotError {
    /// The reference is missing; references are never generated automatically.
    #[error("{}: missing; look at the new picture, then accept it with `./cook snapshots --accept`", .0.display())]
    Missing(PathBuf),
    /// A reference cannot be decoded.
    #[error("{path}: unreadable: {reason}; restore it from version control")]
    Unreadable {
        /// Path of the reference.
        path: PathBuf,
        /// The decoder's message.
        reason: String,
    },
    /// A reference has the wrong size.
    #[error("{path}: is {found:?} pixels, expected {expected:?}; accept a new one with `./cook snapshots --accept`")]
    Size {
        /// Path of the reference.
        path: PathBuf,
        /// Width and height of the reference in pixels.
        found: (u32, u32),
        /// Width and height of the rendered picture in pixels.
        expected: (u32, u32),
    },
    /// A pixel is NaN or infinite.
    #[error(
        "{what}: pixel ({column}, {row}) is {value:?}; find out why, such a picture is never a reference nor like one"
    )]
    NotFinite {
        /// Name of the picture.
        what: String,
        /// Column of the pixel, from the left.
        column: u32,
        /// Row of the pixel, from the top.
        row: u32,
        /// Value of the pixel.
        value: [f32; 4],
    },
    /// A file is too large to commit.
    #[error("{path}: {bytes} bytes, at most {LARGEST_FILE} are committed")]
    TooLarge {
        /// Path of the file.
        path: PathBuf,
        /// Size of the file in bytes.
        bytes: u64,
    },
    /// The picture to compare could not be rendered.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The scene to render could not be made.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A picture could not be written.
    #[error(transparent)]
    File(#[from] file::FileError),
}

/// Renders `shot` at the sizes of its PNG and its EXR.
pub fn render_shot(gpu: &Gpu, shot: &Shot) -> Result<[Picture; 2], SnapshotError> {
    let scene = shot.open()?;
    let render = |side| render::render(gpu, &scene, &shot.settings(side));
    Ok([render(shot.side)?, render(EXR_SIDE)?])
}

/// Renders another scene in place of the shot's; `source` replaces the text of the recipe.
pub fn render_scene(gpu: &Gpu, shot: &Shot, scene: &Scene, source: &str) -> Result<[Picture; 2], SnapshotError> {
    let render = |side| render::render_with(gpu, scene, &shot.settings(side), source);
    Ok([render(shot.side)?, render(EXR_SIDE)?])
}

/// Makes new pictures the references called `name`.
pub fn accept(name: &str, [seen, linear]: &[Picture; 2], folder: &Path) -> Result<(), SnapshotError> {
    for picture in [seen, linear] {
        comparison::require_finite(&format!("the new picture {name}"), picture.width, &picture.linear)?;
    }
    std::fs::create_dir_all(folder).map_err(|error| file::FileError::Write { path: folder.to_owned(), error })?;
    for (picture, extension) in [(seen, "png"), (linear, "exr")] {
        let path = folder.join(format!("{name}.{extension}"));
        file::write(picture, &path)?;
        let bytes = std::fs::metadata(&path).map_or(0, |metadata| metadata.len());
        if bytes > LARGEST_FILE {
            return Err(SnapshotError::TooLarge { path, bytes });
        }
    }
    Ok(())
}

/// Reads a committed picture, which must have the expected width and height.
///
/// # Errors
/// Returns an error if the file is missing, unreadable or of another size.
pub fn read(path: &Path, expected: (u32, u32)) -> Result<image::DynamicImage, SnapshotError> {
    if !path.exists() {
        return Err(SnapshotError::Missing(path.to_owned()));
    }
    let image = image::open(path)
        .map_err(|error| SnapshotError::Unreadable { path: path.to_owned(), reason: error.to_string() })?;
    let found = (image.width(), image.height());
    if found != expected {
        return Err(SnapshotError::Size { path: path.to_owned(), found, expected });
    }
    Ok(image)
}
