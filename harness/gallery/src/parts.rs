//! What pages are made of, and what of it is read from the repository.

use super::error::GalleryError;
use super::guides::{ENGINES, GUIDES};
use super::mirror;
use super::pictures::Shown;
use super::places::Places;
use super::take::Take;
use super::techniques::{TECHNIQUES, Technique};
use super::templates::Markup;
use super::text::{Span, prose};
use lapidary_cookbook as cookbook;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// A diagram, drawn.
#[derive(Clone, Debug, Serialize)]
pub struct DrawnDiagram {
    pub name: &'static str,
    pub module: &'static str,
    pub title: String,
    pub caption: Vec<Span>,
    pub svg: Markup,
}

/// A live page's contents.
#[derive(Clone, Debug, Serialize)]
pub struct LivePage {
    pub scene: &'static str,
    pub title: &'static str,
    pub body: Markup,
    pub ladder: &'static str,
}

/// What pages are made of.
#[derive(Debug)]
pub struct Parts<'a> {
    pub adapter: &'a str,
    pub pictures: Vec<Shown>,
    pub places: Places,
    pub docs: BTreeMap<String, String>,
    pub mirrors: BTreeMap<&'static str, Vec<String>>,
    pub takes: Vec<Take>,
    pub diagrams: Vec<DrawnDiagram>,
    pub ladders: BTreeMap<String, Markup>,
    pub editors: BTreeMap<&'static str, Markup>,
    pub live: Vec<LivePage>,
    pub rustdoc: bool,
}

impl Parts<'_> {
    /// Returns the text of a doc page.
    ///
    /// # Panics
    /// If the page was not read, which [`docs`] does for all that are shown.
    pub fn doc(&self, file: &str) -> &str {
        self.docs.get(file).unwrap_or_else(|| panic!("{file} was not read"))
    }

    /// Returns the picture of that name; `None` if it is not shown.
    pub fn picture(&self, name: &str) -> Option<&Shown> {
        self.pictures.iter().find(|picture| picture.name == name)
    }

    /// Returns the scene of a technique's live page; `None` if there is none.
    pub fn live_scene(&self, technique: &Technique) -> Option<&'static str> {
        self.live.iter().find(|live| live.scene == technique.live).map(|live| live.scene)
    }
}

fn read(path: PathBuf) -> Result<String, GalleryError> {
    fs::read_to_string(&path).map_err(|source| GalleryError::Read { path, source })
}

/// Reads the doc pages that no module holds.
pub fn docs(root: &Path) -> Result<BTreeMap<String, String>, GalleryError> {
    let guides = GUIDES.iter().chain(&ENGINES).map(|guide| guide.file.to_owned());
    let techniques = TECHNIQUES.iter().map(|technique| ["docs/", technique.doc, ".md"].concat());
    let recipes = lapidary_wgsl::RECIPES.iter().map(|recipe| ["docs/recipes/", recipe.name, ".md"].concat());
    // A recipe may have no page: those for hosts alone have.
    let recipes = recipes.filter(|file| root.join(file).is_file());
    guides.chain(techniques).chain(recipes).map(|file| Ok((file.clone(), read(root.join(&file))?))).collect()
}

/// Reads the sources of every module's mirror.
pub fn mirrors(root: &Path) -> Result<BTreeMap<&'static str, Vec<String>>, GalleryError> {
    let sources = |name: &'static str| {
        let fault = |source| GalleryError::Read { path: root.join("crates").join(name), source };
        Ok((name, mirror::sources(root, name).map_err(fault)?))
    };
    cookbook::modules().iter().map(|module| sources(module.name)).collect()
}

/// Returns the diagrams of every module's page, which shows each by a line `![caption](diagrams/NAME.svg)`.
pub fn diagrams(root: &Path) -> Result<Vec<DrawnDiagram>, GalleryError> {
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
                caption: prose(caption),
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
