//! A technique's page.

use super::super::search::Entry;
use super::super::{
    ladder::Kind,
    markdown,
    mirror::{self, Coloured},
    parts::{DrawnDiagram, Parts},
    pictures::Shown,
    take,
    techniques::{TECHNIQUES, Technique},
    templates::{self, Markup},
};
use super::page::{Page, address};
use lapidary_cookbook as cookbook;
use serde::Serialize;

/// A module or a recipe in a list.
#[derive(Serialize)]
struct Named<'a> {
    name: &'a str,
    purpose: Vec<super::super::text::Span>,
}

#[derive(Serialize)]
struct Values<'a> {
    technique: &'a str,
    title: &'a str,
    summary: &'a str,
    hero: Option<&'a Shown>,
    scene: &'a str,
    live: Option<&'a str>,
    lead: Markup,
    equation: Markup,
    introduction: Markup,
    /// Its function in both languages, and the module that has it.
    pair: Option<Coloured<'a>>,
    of_module: &'a str,
    /// Modules whose page tells of hard cases.
    hard: Vec<&'a str>,
    solves: bool,
    /// The page that says everything about it.
    whole: String,
    takes: Vec<take::Group<'a>>,
    /// The technique to take in other light.
    beside: Option<Beside<'a>>,
    diagrams: Vec<&'a DrawnDiagram>,
    ladders: Vec<&'a Markup>,
    pictures: Vec<&'a Shown>,
    guides: Vec<Guide>,
    modules: Vec<Named<'a>>,
    recipes: Vec<Named<'a>>,
}

/// Another technique, and when to take it instead.
#[derive(Serialize)]
struct Beside<'a> {
    name: &'a str,
    title: &'a str,
    when: &'a str,
}

#[derive(Serialize)]
struct Guide {
    path: String,
    title: &'static str,
}

/// Diagrams on a technique's page; each module's page has its own.
const MOST_DIAGRAMS: usize = 4;

/// Returns the page of a technique.
pub fn page(parts: &Parts<'_>, technique: &'static Technique) -> Page {
    let path = address("techniques", technique.name);
    let file = ["docs/", technique.doc, ".md"].concat();
    // The doc page is a module's own, or a guide.
    let kind = if cookbook::module(technique.doc).is_some() { "modules" } else { "guides" };
    let whole = ["../", &address(kind, technique.doc)].concat();
    let doc = markdown::page(parts.doc(&file), &parts.places.of_part(&file, &whole));
    let named = |name: &'static str| Named { name, purpose: super::super::text::prose(&purpose(name)) };
    let guide = |name: &str| {
        let guide = super::super::guides::GUIDES.iter().find(|guide| guide.name == name)?;
        Some(Guide { path: ["../", &address("guides", guide.name)].concat(), title: guide.title })
    };
    let shown = |picture: &&Shown| picture.folder == technique.pictures && picture.name != technique.hero;
    let pair = technique.modules.iter().find_map(|name| {
        let module = cookbook::module(name)?;
        let of_crate = parts.mirrors.get(name).map_or(&[][..], Vec::as_slice);
        Some((module, mirror::pair(module, technique.function, of_crate)?))
    });
    let values = Values {
        technique: technique.name,
        title: technique.title,
        summary: technique.summary,
        hero: parts.picture(technique.hero),
        scene: technique.live,
        live: parts.live_scene(technique),
        lead: doc.lead,
        equation: doc.equation,
        introduction: doc.introduction,
        pair: pair.as_ref().map(|(_, pair)| pair.coloured()),
        of_module: pair.as_ref().map_or("", |(module, _)| module.name),
        hard: technique.modules.iter().copied().filter(|name| has_hard_cases(name)).collect(),
        solves: technique.solves,
        whole,
        takes: take::groups(parts.takes.iter().filter(|take| technique.ladders.contains(&take.choice.ladder))),
        beside: technique.beside.as_ref().and_then(|(name, when)| {
            let other = TECHNIQUES.iter().find(|other| other.name == *name)?;
            Some(Beside { name, title: other.title, when })
        }),
        diagrams: diagrams(parts, technique),
        // The first; the guides have the others.
        ladders: technique.ladders.iter().take(1).filter_map(|name| parts.ladders.get(*name)).collect(),
        pictures: parts.pictures.iter().filter(shown).collect(),
        guides: std::iter::once("choosing").chain(technique.guides.iter().copied()).filter_map(guide).collect(),
        modules: technique.modules.iter().copied().map(named).collect(),
        recipes: technique.recipes.iter().copied().map(named).collect(),
    };
    let mut page =
        Page::new("technique", path, technique.title, technique.summary, templates::render("technique.html", values))
            .with(&["diagram.css", "ladder.css", "takes.css"], &[]);
    page.entries = vec![Entry::page(technique.title, &page.path, technique.summary)];
    for (index, kind) in technique.ladders.iter().filter_map(|name| Kind::named(name)).enumerate() {
        // The first is on this page, the others on the guide that shows all.
        let guide = super::super::guides::GUIDES.iter().find(|guide| index > 0 && guide.ladders.contains(&kind.name));
        let on = guide.map_or_else(|| page.path.clone(), |guide| address("guides", guide.name));
        let path = [&on, "#ladder-", kind.name].concat();
        page.entries.extend(kind.steps().iter().map(|step| {
            let figures = format!("{} {:.2}, {:.1} ms on two CPU cores", kind.error, step.error, step.ms);
            Entry::rung(&step.rung, kind.title, &path, figures)
        }));
    }
    page
}

/// Returns what a module or a recipe is for.
fn purpose(name: &str) -> String {
    let recipe = || {
        let recipe = lapidary_wgsl::recipe(name)?;
        Some(cookbook::header::parse_header(recipe.source).ok()?.purpose)
    };
    cookbook::module(name).map(|module| module.header.purpose.clone()).or_else(recipe).unwrap_or_default()
}

/// Whether a module's doc page has a heading of that name.
fn has_hard_cases(name: &str) -> bool {
    cookbook::module(name).is_some_and(|module| module.page.contains("\n## Hard cases\n"))
}

/// Returns the diagrams of the modules that are most its own.
fn diagrams<'a>(parts: &'a Parts<'_>, technique: &Technique) -> Vec<&'a DrawnDiagram> {
    let of_module = |name: &&str| parts.diagrams.iter().find(|diagram| diagram.module == *name);
    technique.modules.iter().filter_map(of_module).take(MOST_DIAGRAMS).collect()
}
