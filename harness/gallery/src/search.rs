//! What can be searched for: pages, functions, headings and pictures.

use super::{markdown::Heading, pictures::Shown, text};
use lapidary_cookbook::header::FunctionDoc;
use serde::Serialize;

/// Something to find.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Entry {
    /// What it is: `page`, `function`, `rung`, `heading` or `picture`.
    pub kind: &'static str,
    /// Its name.
    pub name: String,
    /// Where it stands.
    pub on: String,
    /// Its address, from the site's root.
    pub path: String,
    /// What it is, in a sentence.
    pub text: String,
    /// Further words to find it by.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub words: String,
}

impl Entry {
    /// A page.
    pub fn page(title: &str, path: &str, description: &str) -> Self {
        let text = text::first_sentence(&text::plain(description)).to_owned();
        Self {
            kind: "page",
            name: title.to_owned(),
            on: String::new(),
            path: path.to_owned(),
            text,
            words: String::new(),
        }
    }

    /// A function of a module.
    pub fn function(function: &FunctionDoc, module: &str, path: &str) -> Self {
        let text = text::first_sentence(&text::plain(&function.summary)).to_owned();
        let path = [path, "#", &function.name].concat();
        Self { kind: "function", name: function.name.clone(), on: module.to_owned(), path, text, words: String::new() }
    }

    /// A heading of a page.
    pub fn heading(heading: &Heading, title: &str, path: &str) -> Self {
        let path = [path, "#", &heading.id].concat();
        let (name, on) = (heading.text.clone(), title.to_owned());
        Self { kind: "heading", name, on, path, text: String::new(), words: vocabulary(&heading.words) }
    }

    /// A rung of a ladder.
    pub fn rung(rung: &str, ladder: &str, path: &str, figures: String) -> Self {
        let (name, on) = (rung.to_owned(), ladder.to_owned());
        Self { kind: "rung", name, on, path: path.to_owned(), text: figures, words: "rung ladder".to_owned() }
    }

    /// A picture.
    pub fn picture(picture: &Shown, path: &str) -> Self {
        let path = [path, "#picture=", &picture.name].concat();
        Self {
            kind: "picture",
            name: picture.title.clone(),
            on: "All pictures".to_owned(),
            path,
            text: String::new(),
            words: String::new(),
        }
    }
}

/// Returns each word of a text once, in lower case.
fn vocabulary(text: &str) -> String {
    let words: std::collections::BTreeSet<String> = text
        .split(|c: char| !c.is_alphanumeric() && !matches!(c, '-' | '_' | '+'))
        .filter(|word| word.len() > 2)
        .map(str::to_lowercase)
        .collect();
    words.into_iter().collect::<Vec<_>>().join(" ")
}
