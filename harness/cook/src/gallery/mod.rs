//! The gallery: a static site with every picture, and with every technique's equation, functions
//! with their promises, and complete WGSL to copy. It is a single page with its pictures in a
//! folder, readable from disk without a network.

mod highlight;
pub mod ladder;
pub mod live;
mod markdown;
mod page;
pub mod rows;
mod section;
pub mod templates;
mod text;

use crate::folder::{self, FolderError, Owner};
use std::{
    collections::HashSet,
    fs, io,
    path::{Path, PathBuf},
};

/// One rendered picture of the gallery.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Title of the picture; the picture of the brilliant, recognised by its title, opens the page.
    pub title: String,
    /// The PNG or SVG to copy into the gallery.
    pub file: PathBuf,
    /// Description in a paragraph of plain text with `` `code` ``.
    pub paragraph: String,
    /// The command that renders the picture again.
    pub command: String,
    /// Width and height in pixels.
    pub size: (u32, u32),
}

/// The contents of the gallery besides the cookbook itself.
#[derive(Clone, Debug)]
pub struct Site<'a> {
    /// The device that rendered the pictures, and its driver.
    pub adapter: String,
    /// The pictures of the scenes.
    pub pictures: &'a [Picture],
    /// Figures of single modules and recipes, each with the module's or recipe's name; may be
    /// empty.
    pub figures: &'a [(String, Picture)],
}

/// Why the gallery was not written. Anything that existed at its path is unchanged.
#[derive(Debug, thiserror::Error)]
pub enum GalleryError {
    /// A picture's file is missing.
    #[error("picture `{title}`: {} cannot be copied: {source}; render it again with `{command}`", file.display())]
    Picture {
        /// The picture's title.
        title: String,
        /// Expected path of its file.
        file: PathBuf,
        /// The command that renders it.
        command: String,
        /// The underlying file system error.
        source: io::Error,
    },
    /// A figure's module or recipe does not exist.
    #[error("figure `{title}` belongs to module `{module}`, which the cookbook does not have")]
    UnknownModule {
        /// Title of the figure.
        title: String,
        /// Name of the unknown module.
        module: String,
    },
    /// The folder was not written.
    #[error(transparent)]
    Folder(#[from] FolderError),
}

/// Whose folder a gallery is.
const OWNER: Owner = Owner { command: "cook gallery", marker: ".lapidary-gallery" };

/// A picture and its file in the gallery, `images/NAME.png`.
#[derive(Clone, Debug)]
struct Placed<'a> {
    picture: &'a Picture,
    module: Option<&'a str>,
    place: String,
}

/// Writes the gallery into the folder `out` and returns the path of its `index.html`. The folder is
/// either complete or unchanged, and the same site gives the same bytes.
///
/// # Errors
/// Returns an error if a picture is missing, a figure's module is unknown, the file system fails,
/// or `out` contains anything that an earlier call did not write.
pub fn write(out: &Path, site: &Site<'_>) -> Result<PathBuf, GalleryError> {
    if let Some((module, figure)) = site.figures.iter().find(|(name, _)| !is_known(name)) {
        return Err(GalleryError::UnknownModule { title: figure.title.clone(), module: module.clone() });
    }
    let pictures = site.pictures.iter().map(|picture| (None, picture));
    let figures = site.figures.iter().map(|(module, figure)| (Some(module.as_str()), figure));
    let placed = place(pictures.chain(figures));
    let folder = folder::replace(out, OWNER, |folder| -> Result<(), GalleryError> {
        let images = folder.join("images");
        fs::create_dir(&images).map_err(|source| FolderError::Write { path: images, source })?;
        for Placed { picture, place, .. } in &placed {
            fs::copy(&picture.file, folder.join(place)).map_err(|source| GalleryError::Picture {
                title: picture.title.clone(),
                file: picture.file.clone(),
                command: picture.command.clone(),
                source,
            })?;
        }
        let index = folder.join("index.html");
        let text = page::page(&site.adapter, &placed);
        Ok(fs::write(&index, text).map_err(|source| FolderError::Write { path: index, source })?)
    })?;
    Ok(folder.join("index.html"))
}

/// Whether the cookbook has a module or a recipe with that name.
fn is_known(name: &str) -> bool {
    crate::cookbook::module(name).is_some() || lapidary_wgsl::recipe(name).is_some()
}

/// Gives each picture a unique file name, derived from its title.
fn place<'a>(pictures: impl Iterator<Item = (Option<&'a str>, &'a Picture)>) -> Vec<Placed<'a>> {
    let mut taken = HashSet::new();
    pictures
        .map(|(module, picture)| {
            let title: String = picture.title.chars().filter(|c| c.is_ascii()).collect();
            let stem = text::slug(&format!("{} {title}", module.unwrap_or_default()));
            let stem = if stem.is_empty() { "picture".to_owned() } else { stem };
            let mut name = stem.clone();
            let mut count = 1;
            while !taken.insert(name.clone()) {
                count += 1;
                name = format!("{stem}-{count}");
            }
            let extension =
                if picture.file.extension().is_some_and(|extension| extension == "svg") { "svg" } else { "png" };
            Placed { picture, module, place: format!("images/{name}.{extension}") }
        })
        .collect()
}

#[cfg(test)]
mod tests;
