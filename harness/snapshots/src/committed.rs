//! The list of the committed pictures, and how each is rendered and accepted.

use super::beside_walks::{self, BesideWalks};
use super::comparison;
use super::error::SnapshotError;
use super::files::folder;
use super::shots::{self, SHOTS, Shot};
use super::sizes::{EXR_SIDE, LARGEST_FILE};
use super::strip;
use lapidary_files::WriteError;
use lapidary_gpu::Gpu;
use lapidary_render as render;
use lapidary_render::{Picture, file};
use lapidary_scene::{BUILT_IN, SAMPLES, Scene};
use std::path::{Path, PathBuf};

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
            Self::BesideWalks(beside) => beside.name,
        }
    }

    /// Returns its title.
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Self::Shot(shot) => shot.title,
            Self::Strip => strip::TITLE,
            Self::BesideWalks(beside) => beside.title,
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
            Self::BesideWalks(beside) => beside.paragraph,
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
            Self::BesideWalks(beside) => folder(beside.technique),
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
            Self::BesideWalks(beside) => beside.render(gpu),
        }
    }

    /// Renders only the second of them, which is a quarter of the work.
    ///
    /// # Errors
    /// Returns an error as in [`Committed::render`].
    pub fn render_linear(self, gpu: &Gpu) -> Result<Picture, SnapshotError> {
        match self {
            Self::Shot(shot) => {
                let (scene, settings) = shot.drawn(EXR_SIDE)?;
                Ok(render::render(gpu, &scene, &settings)?)
            }
            Self::Strip | Self::BesideWalks(_) => self.render(gpu).map(|[_, linear]| linear),
        }
    }
}

/// Renders `shot` at the sizes of its PNG and its EXR.
pub fn render_shot(gpu: &Gpu, shot: &Shot) -> Result<[Picture; 2], SnapshotError> {
    let render = |side| -> Result<Picture, SnapshotError> {
        let (scene, settings) = shot.drawn(side)?;
        Ok(render::render(gpu, &scene, &settings)?)
    };
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
    std::fs::create_dir_all(folder)
        .map_err(|error| file::FileError::Write(WriteError { path: folder.to_owned(), error }))?;
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
