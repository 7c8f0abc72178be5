//! The gallery: a static site with a page for every technique, module, recipe and guide, with every picture, and with
//! complete WGSL to copy. It can be read from disk, without a network.

pub mod choices;
pub mod command;
mod data;
mod guides;
mod highlight;
pub mod ladder;
pub mod live;
mod markdown;
mod mathematics;
mod mirror;
mod pages;
pub mod pictures;
mod places;
pub mod rows;
mod search;
mod take;
mod techniques;
pub mod templates;
mod text;

use lapidary_cookbook::folder::{self, FolderError, Owner};
use lapidary_cookbook::{self as cookbook, marks};
use lapidary_gpu::Gpu;
use lapidary_wgsl::Recipe;
use pages::Page;
use pictures::{Shown, Source};
use places::Places;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use take::Take;
use techniques::Technique;
use templates::Markup;

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

/// Why the gallery was not written. Anything that existed at its path is unchanged.
#[derive(Debug, thiserror::Error)]
pub enum GalleryError {
    /// A picture's file is missing or damaged.
    #[error("picture `{title}`: {} cannot be shown: {source}; render it again with `{command}`", file.display())]
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
    /// A file of the repository cannot be read.
    #[error("{}: cannot be read: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The underlying file system error.
        source: io::Error,
    },
    /// The ladders were not drawn.
    #[error(transparent)]
    Ladder(#[from] ladder::LadderError),
    /// A shader to take was not made.
    #[error(transparent)]
    Take(#[from] take::TakeError),
    /// The live scenes were not written.
    #[error(transparent)]
    Live(#[from] live::LiveError),
    /// The property rows were not written.
    #[error(transparent)]
    Rows(#[from] rows::RowsError),
    /// What pages load on demand was not written.
    #[error(transparent)]
    Data(#[from] data::DataError),
    /// The folder was not written.
    #[error(transparent)]
    Folder(#[from] FolderError),
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

/// A diagram, drawn.
#[derive(Clone, Debug, Serialize)]
struct DrawnDiagram {
    name: &'static str,
    module: &'static str,
    title: String,
    caption: Vec<text::Span>,
    svg: Markup,
}

/// A live page's contents.
#[derive(Clone, Debug, Serialize)]
struct LivePage {
    scene: &'static str,
    title: &'static str,
    body: Markup,
    ladder: &'static str,
}

/// What pages are made of.
#[derive(Debug)]
struct Parts<'a> {
    adapter: &'a str,
    pictures: Vec<Shown>,
    places: Places,
    docs: BTreeMap<String, String>,
    mirrors: BTreeMap<&'static str, Vec<String>>,
    takes: Vec<Take>,
    diagrams: Vec<DrawnDiagram>,
    ladders: BTreeMap<String, Markup>,
    editors: BTreeMap<&'static str, Markup>,
    live: Vec<LivePage>,
    rustdoc: bool,
}

impl Parts<'_> {
    /// Returns the text of a doc page.
    ///
    /// # Panics
    /// If the page was not read, which [`docs`] does for all that are shown.
    fn doc(&self, file: &str) -> &str {
        self.docs.get(file).unwrap_or_else(|| panic!("{file} was not read"))
    }

    /// Returns the picture of that name; `None` if it is not shown.
    fn picture(&self, name: &str) -> Option<&Shown> {
        self.pictures.iter().find(|picture| picture.name == name)
    }

    /// Returns the scene of a technique's live page; `None` if there is none.
    fn live_scene(&self, of: &Technique) -> Option<&'static str> {
        self.live.iter().find(|live| live.scene == of.live).map(|live| live.scene)
    }
}

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
        for of in ladder::pictures(gpu, adapter, folder)? {
            ladders.insert(of.kind.name.to_owned(), ladder::section(of.kind, &of.pictures, "../")?);
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
    for at in 0..pages.len() {
        put(folder, &pages[at].path, pages::html(&parts, &pages, at).as_bytes())?;
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
    repeated.map_or(adapter, |at| adapter[at + 1..].strip_suffix(')').unwrap_or(adapter))
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
        data::deliver(folder, &["source/recipe_", recipe.name].concat(), &source_of_recipe(recipe))?;
    }
    Ok(())
}

/// Returns the text of a recipe to paste, as `cook copy` writes it.
///
/// # Panics
/// If the recipe's marks are not well formed, which a test of all recipes finds.
fn source_of_recipe(recipe: &Recipe) -> String {
    marks::without(recipe, &[]).unwrap_or_else(|fault| panic!("{}:{}: {}", recipe.name, fault.line, fault.message))
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

fn read(path: PathBuf) -> Result<String, GalleryError> {
    fs::read_to_string(&path).map_err(|source| GalleryError::Read { path, source })
}

/// Reads the doc pages that no module holds.
fn docs(root: &Path) -> Result<BTreeMap<String, String>, GalleryError> {
    let guides = guides::GUIDES.iter().chain(&guides::ENGINES).map(|guide| guide.file.to_owned());
    let techniques = techniques::TECHNIQUES.iter().map(|of| ["docs/", of.doc, ".md"].concat());
    let recipes = lapidary_wgsl::RECIPES.iter().map(|of| ["docs/recipes/", of.name, ".md"].concat());
    // A recipe may have no page: those for hosts alone have.
    let recipes = recipes.filter(|file| root.join(file).is_file());
    guides.chain(techniques).chain(recipes).map(|file| Ok((file.clone(), read(root.join(&file))?))).collect()
}

fn mirrors(root: &Path) -> Result<BTreeMap<&'static str, Vec<String>>, GalleryError> {
    let sources = |name: &'static str| {
        let fault = |source| GalleryError::Read { path: root.join("crates").join(name), source };
        Ok((name, mirror::sources(root, name).map_err(fault)?))
    };
    cookbook::modules().iter().map(|module| sources(module.name)).collect()
}

/// Returns the diagrams of every module's page, which shows each by a line `![caption](diagrams/NAME.svg)`.
fn diagrams(root: &Path) -> Result<Vec<DrawnDiagram>, GalleryError> {
    let mut drawn = Vec::new();
    for module in cookbook::modules() {
        for line in module.page.lines() {
            let image = line.strip_prefix("![").and_then(|rest| rest.split_once("](diagrams/"));
            let Some((caption, name)) = image.and_then(|(caption, file)| Some((caption, file.strip_suffix(".svg)")?)))
            else {
                continue;
            };
            let file = read(root.join("docs/diagrams").join([name, ".svg"].concat()))?;
            drawn.push(DrawnDiagram {
                name,
                module: module.name,
                title: between(&file, "<title", "</title>").split_once('>').map_or("", |(_, title)| title).to_owned(),
                caption: text::prose(caption),
                svg: Markup(without_style(&file)),
            });
        }
    }
    Ok(drawn)
}

/// Returns a diagram's markup without the style that a file of its own carries: the page's style sheet colours it.
fn without_style(file: &str) -> String {
    let style = ["<style>", between(file, "<style>", "</style>"), "</style>\n"].concat();
    file.replacen(&style, "", 1)
}

/// Returns what stands between two texts; nothing if either is missing.
fn between<'a>(text: &'a str, start: &str, end: &str) -> &'a str {
    text.split_once(start).and_then(|(_, rest)| rest.split_once(end)).map_or("", |(inside, _)| inside)
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
