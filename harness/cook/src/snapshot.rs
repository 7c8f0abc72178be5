//! The pictures that are committed, and how a new one is compared with them: FLIP on what is seen, RMSE on linear radiance.

pub mod beside_walks;
mod comparison;
pub mod frames;
mod shots;
pub mod strip;
mod walked;

pub(crate) use comparison::flip;
pub use comparison::{Comparison, MOST_FLIP, MOST_HIGH_FLIP, MOST_RMSE, compare, compare_linear};
use lapidary_gpu::Gpu;
use lapidary_render as render;
use lapidary_render::{Picture, RenderError, Settings, file};
use lapidary_scene::{Scene, SceneError};
pub use shots::{SHOTS, Shot};
use std::path::{Path, PathBuf};
pub use walked::{WALKED, WalkedReference};

/// Side of the PNG that is looked at.
pub const PNG_SIDE: u32 = 512;
/// Side of the EXR that holds linear radiance.
pub const EXR_SIDE: u32 = 256;
/// Largest committed file in bytes.
pub const LARGEST_FILE: u64 = 512 * 1024;
/// A committed picture: a file to look at and one of linear radiance.
#[derive(Clone, Copy, Debug)]
pub enum Committed {
    /// Of one scene.
    Shot(&'static Shot),
    /// Of translucent stone in motion.
    Strip,
    /// Of translucent stone beside random walks.
    BesideWalks,
}

impl Committed {
    /// Every one.
    pub const COUNT: usize = SHOTS.len() + 2;

    /// Each once.
    pub fn all() -> impl Iterator<Item = Self> {
        SHOTS.iter().map(Self::Shot).chain([Self::Strip, Self::BesideWalks])
    }

    /// Its files' name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Shot(shot) => shot.name,
            Self::Strip => strip::NAME,
            Self::BesideWalks => beside_walks::NAME,
        }
    }

    /// Where they are.
    #[must_use]
    pub fn folder(self) -> PathBuf {
        match self {
            Self::Shot(shot) => shot.folder(),
            Self::Strip | Self::BesideWalks => folder("optical_path"),
        }
    }

    /// Renders it anew, as its PNG and as its EXR would hold it.
    ///
    /// # Errors
    /// Where its scene does not load, or the device refuses.
    pub fn render(self, gpu: &Gpu) -> Result<[Picture; 2], SnapshotError> {
        match self {
            Self::Shot(shot) => render_shot(gpu, shot),
            Self::Strip => strip::render(gpu),
            Self::BesideWalks => beside_walks::render(gpu),
        }
    }

    /// The second of them alone: a quarter of the work.
    ///
    /// # Errors
    /// As [`Committed::render`].
    pub fn render_linear(self, gpu: &Gpu) -> Result<Picture, SnapshotError> {
        match self {
            Self::Shot(shot) => Ok(render::render(gpu, &shot.open()?, &shot.settings(EXR_SIDE))?),
            Self::Strip | Self::BesideWalks => self.render(gpu).map(|[_, linear]| linear),
        }
    }
}

/// Where the pictures of a technique's recipes are.
pub fn folder(technique: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../snapshots").join(technique)
}

/// A committed reference's linear radiance, and as it is seen with the settings' size and exposure.
pub(crate) fn reference_picture(gpu: &Gpu, path: &Path, settings: &Settings) -> Result<Picture, SnapshotError> {
    let (width, height) = (settings.width, settings.height);
    let linear: Vec<[f32; 4]> = read(path, (width, height))?.into_rgba32f().pixels().map(|pixel| pixel.0).collect();
    let encoded = vec![[0; 4]; linear.len()];
    let mut picture = Picture { width, height, linear, encoded, lost: None, walked: None, notes: Vec::new() };
    render::encode(gpu, settings, &mut picture)?;
    Ok(picture)
}

/// Why a snapshot does not hold.
#[derive(Debug, thiserror::Error)]
pub enum SnapshotError {
    /// No reference: it is never made by itself.
    #[error("{}: missing; look at the new picture, then accept it with `./cook snapshots --accept`", .0.display())]
    Missing(PathBuf),
    /// A reference that cannot be decoded.
    #[error("{path}: unreadable: {reason}; restore it from version control")]
    Unreadable {
        /// Which file.
        path: PathBuf,
        /// The decoder's word.
        reason: String,
    },
    /// A reference of another size.
    #[error("{path}: is {found:?} pixels, expected {expected:?}; accept a new one with `./cook snapshots --accept`")]
    Size {
        /// Which file.
        path: PathBuf,
        /// Its size.
        found: (u32, u32),
        /// The size rendered.
        expected: (u32, u32),
    },
    /// A pixel that is no number, or infinite.
    #[error(
        "{what}: pixel ({column}, {row}) is {value:?}; find out why, such a picture is never a reference nor like one"
    )]
    NotFinite {
        /// Which picture.
        what: String,
        /// Of the pixel, from the left.
        column: u32,
        /// Of the pixel, from the top.
        row: u32,
        /// What it holds.
        value: [f32; 4],
    },
    /// A file too large to commit.
    #[error("{path}: {bytes} bytes, at most {LARGEST_FILE} are committed")]
    TooLarge {
        /// Which file.
        path: PathBuf,
        /// Its size.
        bytes: u64,
    },
    /// No picture to compare.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// No scene to render.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A picture could not be written.
    #[error(transparent)]
    File(#[from] file::FileError),
}

/// Renders `shot` as PNG and as EXR would hold it.
pub fn render_shot(gpu: &Gpu, shot: &Shot) -> Result<[Picture; 2], SnapshotError> {
    let scene = shot.open()?;
    let render = |side| render::render(gpu, &scene, &shot.settings(side));
    Ok([render(PNG_SIDE)?, render(EXR_SIDE)?])
}

/// The same for another scene in the shot's place, with `source`, another text of its recipe.
pub fn render_scene(gpu: &Gpu, shot: &Shot, scene: &Scene, source: &str) -> Result<[Picture; 2], SnapshotError> {
    let render = |side| render::render_with(gpu, scene, &shot.settings(side), source);
    Ok([render(PNG_SIDE)?, render(EXR_SIDE)?])
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

pub(crate) fn read(path: &Path, expected: (u32, u32)) -> Result<image::DynamicImage, SnapshotError> {
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
