//! The gallery: a static site with a page for every technique, module, recipe and guide, with every picture, and with
//! complete WGSL to copy. It can be read from disk, without a network.

pub mod choices;
pub mod command;
mod data;
mod error;
mod guides;
mod highlight;
pub mod ladder;
pub mod live;
mod markdown;
mod mathematics;
mod mirror;
mod pages;
mod parts;
pub mod pictures;
mod places;
pub mod rows;
mod search;
mod take;
mod techniques;
pub mod templates;
mod text;

pub use error::GalleryError;

use lapidary_cookbook as cookbook;
use lapidary_files::folder::{self, FolderError, Owner};
use lapidary_gpu::Gpu;
use pages::Page;
use parts::{LivePage, Parts, diagrams, docs, mirrors};
use pictures::Source;
use places::Places;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use take::Take;

/// What the gallery is made of besides the cookbook itself.
#[derive(Clone, Debug)]
pub struct Site<'a> {
    /// The repository.
    pub root: &'a Path,
    /// The device that rendered the pictures, and its driver.
    pub adapter: String,
    /// The pictures, each with its file.
    pub pictures: Vec<Source>,
    /// The folder that rustdoc wrote, to be taken along.
    pub rustdoc: Option<PathBuf>,
    /// What is made only by a device.
    pub device: Option<&'a Gpu>,
}

/// Whose folder a gallery is.
const OWNER: Owner = Owner { command: "cook gallery", marker: ".lapidary-gallery" };

/// Files of the site that are the same for every page.
const ASSETS: &[(&str, &[u8])] = &[
    ("check.css", include_bytes!("assets/check.css")),
    ("check.js", include_bytes!("assets/check.js")),
    ("compare.css", include_bytes!("assets/compare.css")),
    ("compare.js", include_bytes!("assets/compare.js")),
    ("diagram.css", include_bytes!("assets/diagram.css")),
    ("editor.js", include_bytes!("assets/editor.js")),
    ("environment.js", include_bytes!("assets/environment.js")),
    ("fonts/OFL.txt", include_bytes!("assets/fonts/OFL.txt")),
    ("fonts/stix-two-math.woff2", include_bytes!("assets/fonts/stix-two-math.woff2")),
    ("ladder.css", include_bytes!("assets/ladder.css")),
    ("live.css", include_bytes!("assets/live.css")),
    ("math.css", include_bytes!("assets/math.css")),
    ("piz.js", include_bytes!("assets/piz.js")),
    ("site.js", include_bytes!("assets/site.js")),
    ("style.css", include_bytes!("assets/style.css")),
    ("syntax.css", include_bytes!("assets/syntax.css")),
    ("takes.css", include_bytes!("assets/takes.css")),
    ("theme.js", include_bytes!("assets/theme.js")),
];

/// Writes the gallery into the folder `out` and returns the path of its `index.html`. The folder is either complete or
/// unchanged, and the same site gives the same bytes, but for pictures by Godunov's scheme, which rounds by the order in
/// which a device takes up its tiles.
///
/// # Errors
/// Returns an error if a picture or a doc page is missing, a ladder, a live scene or a shader cannot be drawn, the file
/// system fails, or `out` contains anything that an earlier call did not write.
pub fn write(out: &Path, site: &Site<'_>) -> Result<PathBuf, GalleryError> {
    let folder = folder::replace(out, OWNER, |folder| write_into(folder, site))?;
    Ok(folder.join("index.html"))
}

fn write_into(folder: &Path, site: &Site<'_>) -> Result<(), GalleryError> {
    let adapter = short(&site.adapter);
    let shown = pictures::place(&site.pictures, adapter, folder)?;
    let (mut ladders, mut live) = (BTreeMap::new(), Vec::new());
    if let Some(gpu) = site.device {
        for pictured in ladder::pictures(gpu, adapter, folder)? {
            ladders.insert(pictured.kind.name.to_owned(), ladder::section(pictured.kind, &pictured.pictures, "../")?);
        }
        live::write(folder, gpu)?;
        for scene in &live::SCENES {
            live.push(LivePage {
                scene: scene.scene,
                title: scene.title,
                body: live::section(scene)?,
                ladder: scene.ladder,
            });
        }
    }
    rows::write(folder)?;
    let parts = Parts {
        adapter,
        places: Places::new(&shown),
        pictures: shown,
        docs: docs(site.root)?,
        mirrors: mirrors(site.root)?,
        takes: choices::all().iter().map(take::take).collect::<Result<_, _>>()?,
        diagrams: diagrams(site.root)?,
        ladders,
        editors: cookbook::modules().iter().filter_map(|module| Some((module.name, rows::editor(module)?))).collect(),
        live,
        rustdoc: site.rustdoc.is_some(),
    };
    let pages = pages::all(&parts);
    for index in 0..pages.len() {
        put(folder, &pages[index].path, pages::html(&parts, &pages, index).as_bytes())?;
    }
    for (name, bytes) in ASSETS {
        put(folder, &["assets/", name].concat(), bytes)?;
    }
    put(folder, "assets/mark.svg", templates::render("mark.svg", ICON).0.as_bytes())?;
    write_data(folder, &pages, &parts.takes)?;
    if let Some(rustdoc) = &site.rustdoc {
        copy_folder(rustdoc, &folder.join("rustdoc"))?;
    }
    Ok(())
}

/// Returns an adapter's description without the name that its driver repeats: `NAME (…) (NAME …)`.
fn short(adapter: &str) -> &str {
    let Some((name, _)) = adapter.split_once(" (") else { return adapter };
    let repeated = adapter.rfind(&["(", name, " "].concat());
    repeated.map_or(adapter, |start| adapter[start + 1..].strip_suffix(')').unwrap_or(adapter))
}

/// Writes what pages load on demand: the sources and the index of the search.
fn write_data(folder: &Path, pages: &[Page], takes: &[Take]) -> Result<(), GalleryError> {
    for take in takes {
        data::deliver(folder, &take.source, &take.text)?;
    }
    let entries: Vec<_> = pages.iter().flat_map(|page| &page.entries).collect();
    data::deliver(folder, "search", &entries)?;
    for module in cookbook::modules() {
        data::deliver(folder, &["source/", module.name].concat(), &module.source)?;
    }
    for recipe in lapidary_wgsl::RECIPES {
        data::deliver(folder, &["source/recipe_", recipe.name].concat(), &pages::source_of_recipe(recipe))?;
    }
    Ok(())
}

/// The site's icon, for its template.
#[derive(Serialize)]
struct Mark {
    mark: &'static str,
}

const ICON: Mark = Mark { mark: pages::MARK };

/// Writes a file of the site.
fn put(folder: &Path, path: &str, bytes: &[u8]) -> Result<(), GalleryError> {
    let file = folder.join(path);
    let parent = file.parent().unwrap_or(folder);
    let fault = |source| FolderError::Write { path: file.clone(), source };
    fs::create_dir_all(parent).map_err(fault)?;
    Ok(fs::write(&file, bytes).map_err(fault)?)
}

fn copy_folder(from: &Path, to: &Path) -> Result<(), GalleryError> {
    let read = |source| GalleryError::Read { path: from.to_owned(), source };
    let write = |source| FolderError::Write { path: to.to_owned(), source };
    fs::create_dir_all(to).map_err(write)?;
    for entry in fs::read_dir(from).map_err(read)? {
        let path = entry.map_err(read)?.path();
        // Cargo keeps a lock there.
        let Some(name) = path.file_name().filter(|name| !name.as_encoded_bytes().starts_with(b".")) else { continue };
        if path.is_dir() {
            copy_folder(&path, &to.join(name))?;
        } else {
            fs::copy(&path, to.join(name)).map_err(write)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;
