//! What can be searched for: pages, functions, headings and pictures.

use super::{markdown::Heading, pictures::Shown, text};
use crate::cookbook::header::FunctionDoc;
use serde::Serialize;

/// Something to find.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Entry {
    /// What it is: `page`, `function`, `heading` or `picture`.
    pub kind: &'static str,
    /// Its name.
    pub name: String,
    /// Where it stands.
    pub on: String,
    /// Its address, from the site's root.
    pub path: String,
    /// What it is, in a sentence.
    pub text: String,
}

impl Entry {
    /// A page.
    pub fn page(title: &str, path: &str, description: &str) -> Self {
        let text = text::first_sentence(&text::plain(description)).to_owned();
        Self { kind: "page", name: title.to_owned(), on: String::new(), path: path.to_owned(), text }
    }

    /// A function of a module.
    pub fn function(function: &FunctionDoc, module: &str, path: &str) -> Self {
        let text = text::first_sentence(&text::plain(&function.summary)).to_owned();
        let path = [path, "#", &function.name].concat();
        Self { kind: "function", name: function.name.clone(), on: module.to_owned(), path, text }
    }

    /// A heading of a page.
    pub fn heading(heading: &Heading, title: &str, path: &str) -> Self {
        let path = [path, "#", &heading.id].concat();
        Self { kind: "heading", name: heading.text.clone(), on: title.to_owned(), path, text: String::new() }
    }

    /// A picture.
    pub fn picture(picture: &Shown, path: &str) -> Self {
        let path = [path, "#picture=", &picture.name].concat();
        Self { kind: "picture", name: picture.title.clone(), on: "All pictures".to_owned(), path, text: String::new() }
    }
}
