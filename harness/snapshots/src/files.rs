//! Where committed pictures stand, how large they are, and how they are read.

use super::error::SnapshotError;
use lapidary_cookbook::repository;
use lapidary_gpu::Gpu;
use lapidary_render as render;
use lapidary_render::{Picture, Settings};
use std::path::{Path, PathBuf};

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
