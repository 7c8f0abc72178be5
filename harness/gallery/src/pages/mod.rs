//! The pages of the site.

mod guide;
mod module;
mod page;
mod pictures;
mod recipe;
mod start;
mod technique;

pub use page::{Page, address};
pub use recipe::source_of_recipe;

use super::guides::{ENGINES, GUIDES};
use super::parts::{LivePage, Parts};
use super::search::Entry;
use super::techniques::TECHNIQUES;
use super::templates::{self, Markup};
use lapidary_cookbook::{self as cookbook, header::LICENCE};
use serde::Serialize;

/// A brilliant cut in side view, as line art: the site's mark.
pub const MARK: &str = "M5 11 10 5H22L27 11 16 27ZM5 11H27M10 5 12 11 16 27 20 11 22 5M12 11 16 5 20 11";

/// Returns all pages, in the order in which one reads on.
pub fn all(parts: &Parts<'_>) -> Vec<Page> {
    let mut pages = vec![start::page(parts)];
    pages.extend(TECHNIQUES.iter().map(|subject| technique::page(parts, subject)));
    pages.extend(parts.live.iter().map(|live| live_page(parts, live)));
    pages.extend(GUIDES.iter().chain(&ENGINES).map(|subject| guide::page(parts, subject)));
    pages.push(pictures::page(parts));
    pages.extend(cookbook::modules().iter().map(|subject| module::page(parts, subject)));
    pages.extend(lapidary_wgsl::RECIPES.iter().map(|subject| recipe::page(parts, subject)));
    pages
}

#[derive(Serialize)]
struct Live<'a> {
    live: &'a LivePage,
    ladder: Option<&'a Markup>,
}

fn live_page(parts: &Parts<'_>, live: &LivePage) -> Page {
    let path = address("live", live.scene);
    let body = templates::render("live_page.html", Live { live, ladder: parts.ladders.get(live.ladder) });
    let description = "The frames that the renderer makes, run by your browser on your GPU.";
    let mut page = Page::new("live", path, live.title, description, body)
        .with(&["ladder.css", "live.css"], &["piz.js", "environment.js"]);
    page.entries = vec![Entry::page(live.title, &page.path, description)];
    page
}

/// A link in the contents.
#[derive(Serialize)]
struct Link<'a> {
    path: String,
    title: &'a str,
    code: bool,
}

/// A part of the contents.
#[derive(Serialize)]
struct Group<'a> {
    title: &'a str,
    entries: Vec<Link<'a>>,
    folded: bool,
    current: bool,
}

fn groups<'a>(parts: &'a Parts<'_>, current: &str) -> Vec<Group<'a>> {
    let link = |folder: &str, name: &str, title: &'a str, code: bool| Link { path: address(folder, name), title, code };
    let techniques = TECHNIQUES.iter().map(|technique| link("techniques", technique.name, technique.title, false));
    let pictures = Link { path: "pictures.html".to_owned(), title: "All pictures", code: false };
    let list: [(&str, Vec<Link<'_>>, bool); 6] = [
        ("Techniques", techniques.chain([pictures]).collect(), false),
        ("Live", parts.live.iter().map(|live| link("live", live.scene, live.title, false)).collect(), false),
        ("Guides", GUIDES.iter().map(|guide| link("guides", guide.name, guide.title, false)).collect(), false),
        (
            "Engines and languages",
            ENGINES.iter().map(|guide| link("guides", guide.name, guide.title, false)).collect(),
            true,
        ),
        (
            "Modules",
            cookbook::modules().iter().map(|module| link("modules", module.name, module.name, true)).collect(),
            true,
        ),
        (
            "Recipes",
            lapidary_wgsl::RECIPES.iter().map(|recipe| link("recipes", recipe.name, recipe.name, true)).collect(),
            true,
        ),
    ];
    let group = |(title, entries, folded): (&'a str, Vec<Link<'a>>, bool)| Group {
        title,
        current: entries.iter().any(|entry| entry.path == current),
        entries,
        folded,
    };
    list.into_iter().filter(|(_, entries, _)| !entries.is_empty()).map(group).collect()
}

/// A page before or after another.
#[derive(Serialize)]
struct Neighbour<'a> {
    path: &'a str,
    title: &'a str,
}

/// What every page's frame shows.
#[derive(Serialize)]
struct Values<'a> {
    root: &'a str,
    mark: &'a str,
    page: &'a Page,
    groups: Vec<Group<'a>>,
    previous: Option<Neighbour<'a>>,
    next: Option<Neighbour<'a>>,
    adapter: &'a str,
    licence: &'a str,
}

/// Returns the whole HTML of the page at that place.
pub fn html(parts: &Parts<'_>, pages: &[Page], place: usize) -> String {
    let page = &pages[place];
    let neighbour = |index: usize| pages.get(index).map(|page| Neighbour { path: &page.path, title: &page.title });
    let values = Values {
        root: root(&page.path),
        mark: MARK,
        page,
        groups: groups(parts, &page.path),
        previous: place.checked_sub(1).and_then(neighbour),
        next: neighbour(place + 1),
        adapter: parts.adapter,
        licence: LICENCE,
    };
    templates::render("base.html", values).0
}

/// Returns the way from a page to the site's root.
pub fn root(path: &str) -> &'static str {
    if path.contains('/') { "../" } else { "" }
}
