//! The page that one sees first.

use super::super::choices::{self, Choice, Heading};
use super::super::ladder::Kind;
use super::super::search::Entry;
use super::super::techniques::{TECHNIQUES, Technique};
use super::super::{parts::Parts, pictures::Shown, take::Take, templates, text};
use super::page::Page;
use lapidary_cookbook as cookbook;
use serde::Serialize;

/// A technique, in short.
#[derive(Serialize)]
struct Card<'a> {
    name: &'a str,
    title: &'a str,
    summary: &'a str,
    choice: Option<&'a Choice>,
    heading: Option<Heading>,
    live: Option<&'a str>,
    picture: Option<&'a Shown>,
}

/// Returns the page.
pub fn page(parts: &Parts<'_>) -> Page {
    let card = |technique: &'static Technique| Card {
        name: technique.name,
        title: technique.title,
        summary: technique.summary,
        choice: default(parts, technique),
        heading: technique.ladders.first().and_then(|name| Kind::named(name)).map(choices::heading),
        live: parts.live_scene(technique),
        picture: parts.picture(technique.hero),
    };
    #[derive(Serialize)]
    struct Values<'a> {
        hero: Option<&'a Shown>,
        cards: Vec<Card<'a>>,
        modules: usize,
        functions: usize,
        recipes: usize,
    }
    let values = Values {
        hero: parts.picture("ring"),
        cards: TECHNIQUES.iter().map(card).collect(),
        modules: cookbook::modules().len(),
        functions: cookbook::modules().iter().map(|module| module.functions.len()).sum(),
        recipes: lapidary_wgsl::RECIPES.len(),
    };
    let body = templates::render("start.html", values);
    let description = "A shader cookbook for gems and translucent materials: WGSL to paste, with its mathematics, its accuracy and its cost.";
    let mut page =
        Page::new("start", "index.html".to_owned(), "Lapidary, a shader cookbook for gems", description, body);
    page.entries = vec![Entry::page("Start", &page.path, &text::plain(description))];
    page
}

/// Returns the rung that a technique has without a choice, on its first ladder.
fn default<'a>(parts: &'a Parts<'_>, technique: &Technique) -> Option<&'a Choice> {
    let of_ladder = |take: &&Take| technique.ladders.first() == Some(&take.choice.ladder) && take.choice.is_default;
    parts.takes.iter().find(of_ladder).map(|take| &take.choice)
}
