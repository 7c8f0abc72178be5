//! The page of all pictures.

use super::super::search::Entry;
use super::super::{parts::Parts, pictures::Shown, techniques::TECHNIQUES, templates};
use super::page::Page;
use serde::Serialize;

#[derive(Serialize)]
struct Group<'a> {
    name: &'a str,
    title: &'a str,
    pictures: Vec<&'a Shown>,
}

/// Returns the page.
pub fn page(parts: &Parts<'_>) -> Page {
    let group = |technique: &'static crate::techniques::Technique| Group {
        name: technique.name,
        title: technique.title,
        pictures: parts.pictures.iter().filter(|picture| picture.folder == technique.pictures).collect(),
    };
    let groups: Vec<Group<'_>> = TECHNIQUES.iter().map(group).collect();
    #[derive(Serialize)]
    struct Values<'a> {
        groups: Vec<Group<'a>>,
    }
    let body = templates::render("pictures.html", Values { groups });
    let description = "Every picture, with the rung that drew it and the command that draws it again.";
    let mut page = Page::new("pictures", "pictures.html".to_owned(), "All pictures", description, body);
    page.entries = vec![Entry::page("All pictures", &page.path, description)];
    let entry = |picture: &Shown| Entry::picture(picture, &page.path);
    let pictures: Vec<Entry> = parts.pictures.iter().map(entry).collect();
    page.entries.extend(pictures);
    page
}
