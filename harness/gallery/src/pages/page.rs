//! A page of the site, and where it stands.

use super::super::search::Entry;
use super::super::techniques::{TECHNIQUES, Technique};
use super::super::templates::Markup;
use serde::Serialize;

/// Styles and scripts of every page.
const STYLES: [&str; 4] = ["style.css", "math.css", "syntax.css", "compare.css"];
const SCRIPTS: [&str; 2] = ["site.js", "compare.js"];

/// A page of the site.
#[derive(Clone, Debug, Serialize)]
pub struct Page {
    /// Its path from the site's root, such as `modules/srgb.html`.
    pub path: String,
    /// Its title.
    pub title: String,
    /// What it is about, in a sentence.
    pub description: String,
    /// What kind of page it is: `start`, `technique`, `module`, `recipe`, `guide`, `live` or `pictures`.
    pub kind: &'static str,
    /// Its contents.
    pub body: Markup,
    /// Stylesheets in `assets/`.
    pub styles: Vec<&'static str>,
    /// Scripts in `assets/`.
    pub scripts: Vec<&'static str>,
    /// What of it can be searched for.
    #[serde(skip)]
    pub entries: Vec<Entry>,
}

impl Page {
    /// Returns a page with the styles and scripts of all.
    pub fn new(kind: &'static str, path: String, title: &str, description: &str, body: Markup) -> Self {
        let (title, description) = (title.to_owned(), description.to_owned());
        let (styles, scripts) = (STYLES.to_vec(), SCRIPTS.to_vec());
        Self { path, title, description, kind, body, styles, scripts, entries: Vec::new() }
    }

    /// Adds a style and a script.
    pub fn with(mut self, styles: &[&'static str], scripts: &[&'static str]) -> Self {
        self.styles.extend(styles);
        self.scripts.extend(scripts);
        self
    }
}

/// Returns the path of a page from the site's root.
pub fn address(folder: &str, name: &str) -> String {
    [folder, "/", name, ".html"].concat()
}

/// Returns the techniques that something belongs to: their pages, from a page in another folder, and their titles.
pub fn techniques_with(has: impl Fn(&Technique) -> bool) -> Vec<(String, &'static str)> {
    let techniques = TECHNIQUES.iter().filter(|technique| has(technique));
    techniques.map(|technique| (["../", &address("techniques", technique.name)].concat(), technique.title)).collect()
}
