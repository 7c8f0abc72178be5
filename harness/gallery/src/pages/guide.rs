//! A guide's page.

use super::super::search::Entry;
use super::super::{
    choices,
    guides::Guide,
    markdown::{self, Heading},
    parts::{LivePage, Parts},
    take,
    templates::{self, Markup},
    text,
};
use super::page::{Page, address};
use serde::Serialize;

/// The guide to the rungs.
const CHOOSING: &str = "choosing";

#[derive(Serialize)]
struct Values<'a> {
    title: &'a str,
    lead: Markup,
    equation: Markup,
    introduction: Markup,
    rest: Markup,
    headings: Vec<&'a Heading>,
    ladders: Vec<&'a Markup>,
    /// Shaders of the rungs, on the page that says which to choose.
    takes: Vec<take::Group<'a>>,
    live: Vec<&'a LivePage>,
    /// The row of the rung for 60 frames a second.
    sixty: Option<&'a str>,
}

/// Returns the page of a guide.
pub fn page(parts: &Parts<'_>, of: &'static Guide) -> Page {
    let doc = markdown::page(parts.doc(of.file), &parts.places.of(of.file));
    let values = Values {
        title: &doc.title,
        lead: doc.lead,
        equation: doc.equation,
        introduction: doc.introduction,
        rest: doc.rest,
        headings: doc.headings.iter().filter(|heading| heading.level == 2).collect(),
        ladders: of.ladders.iter().filter_map(|name| parts.ladders.get(*name)).collect(),
        takes: if of.name == CHOOSING { take::groups(&parts.takes) } else { Vec::new() },
        live: parts.live.iter().collect(),
        sixty: parts.takes.iter().find(|take| take.choice.serves(choices::IN_A_SIXTIETH)).map(|take| take.id.as_str()),
    };
    let body = templates::render("guide.html", values);
    let path = address("guides", of.name);
    let description = text::first_sentence(&doc.summary);
    let mut page =
        Page::new("guide", path, of.title, description, body).with(&["diagram.css", "ladder.css", "takes.css"], &[]);
    page.entries = vec![Entry::page(of.title, &page.path, description)];
    page.entries.extend(doc.headings.iter().map(|heading| Entry::heading(heading, of.title, &page.path)));
    page
}
