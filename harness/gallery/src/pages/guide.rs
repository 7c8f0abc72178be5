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

/// The guide to the rungs, and its section of tables: the page has the same tables with the shaders to copy instead.
const CHOOSING: &str = "choosing";
const FIGURES: &str = "The figures";

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
pub fn page(parts: &Parts<'_>, guide: &'static Guide) -> Page {
    let has_takes = guide.name == CHOOSING;
    let source = parts.doc(guide.file);
    let cut = if has_takes { without_section(source, FIGURES) } else { source.to_owned() };
    let doc = markdown::page(&cut, &parts.places.of(guide.file));
    let figures = Heading { level: 2, id: text::slug(FIGURES), text: FIGURES.to_owned(), words: String::new() };
    let values = Values {
        title: &doc.title,
        lead: doc.lead,
        equation: doc.equation,
        introduction: doc.introduction,
        rest: doc.rest,
        headings: Some(&figures)
            .filter(|_| has_takes)
            .into_iter()
            .chain(doc.headings.iter().filter(|heading| heading.level == 2))
            .collect(),
        ladders: guide.ladders.iter().filter_map(|name| parts.ladders.get(*name)).collect(),
        takes: if has_takes { take::groups(&parts.takes) } else { Vec::new() },
        live: parts.live.iter().collect(),
        sixty: parts.takes.iter().find(|take| take.choice.serves(choices::IN_A_SIXTIETH)).map(|take| take.id.as_str()),
    };
    let body = templates::render("guide.html", values);
    let path = address("guides", guide.name);
    let description = text::first_sentence(&doc.summary);
    let mut page =
        Page::new("guide", path, guide.title, description, body).with(&["diagram.css", "ladder.css", "takes.css"], &[]);
    page.entries = vec![Entry::page(guide.title, &page.path, description)];
    page.entries.extend(doc.headings.iter().map(|heading| Entry::heading(heading, guide.title, &page.path)));
    page
}

/// Returns a text without its section under a heading of the second level; all of it if it has none.
fn without_section(source: &str, heading: &str) -> String {
    let Some((before, section)) = source.split_once(&format!("\n## {heading}\n")) else { return source.to_owned() };
    let after = section.find("\n## ").map_or("", |end| &section[end..]);
    [before, after].concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_section_goes_and_the_others_stay() {
        let text = "# T\n\na\n\n## B\n\nb\n\n### D\n\nd\n\n## C\n\nc\n";
        assert_eq!(without_section(text, "B"), "# T\n\na\n\n## C\n\nc\n");
        assert_eq!(without_section(text, "C"), "# T\n\na\n\n## B\n\nb\n\n### D\n\nd\n");
        assert_eq!(without_section(text, "D"), text);
    }

    /// The tables that the page has with shaders stand nowhere else in the guide.
    #[test]
    fn the_guides_tables_of_rungs_are_in_its_section_of_figures() {
        let path = lapidary_cookbook::repository::place().join("docs/choosing.md");
        let text = std::fs::read_to_string(path).expect("the page");
        let cut = without_section(&text, FIGURES);
        assert!(text.contains("\n| `--quality` |") && !cut.contains("\n|"), "{cut}");
    }
}
