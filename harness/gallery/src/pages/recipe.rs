//! A recipe's page.

use super::super::search::Entry;
use super::super::{
    highlight::{self, Language, Piece},
    markdown,
    parts::Parts,
    templates::{self, Markup},
    text::{Span, credit, prose},
};
use super::page::{Page, address, techniques_with};
use lapidary_cookbook::{header::parse_header, marks};
use lapidary_wgsl::Recipe;
use serde::Serialize;

#[derive(Serialize)]
struct Values<'a> {
    name: &'a str,
    purpose: Vec<Span>,
    citation: Vec<Span>,
    requires: Vec<&'a str>,
    lines: usize,
    wgsl: Vec<Piece<'a>>,
    overrides: Vec<(&'a str, Vec<Span>)>,
    /// What a host binds and runs.
    host: Markup,
    techniques: Vec<(String, &'static str)>,
}

/// Returns the text of a recipe to paste, as `cook copy` writes it.
///
/// # Panics
/// If the recipe's marks are not well formed, which a test of all recipes finds.
pub fn source_of_recipe(recipe: &Recipe) -> String {
    marks::without(recipe, &[]).unwrap_or_else(|fault| panic!("{}:{}: {}", recipe.name, fault.line, fault.message))
}

/// Returns the page of a recipe.
pub fn page(parts: &Parts<'_>, recipe: &'static Recipe) -> Page {
    let path = address("recipes", recipe.name);
    let file = ["docs/recipes/", recipe.name, ".md"].concat();
    let host = parts
        .docs
        .get(&file)
        .map_or_else(markdown::Page::default, |text| markdown::page(text, &parts.places.of(&file)));
    let header = parse_header(recipe.source).ok();
    let purpose = header.as_ref().map_or("", |header| header.purpose.as_str());
    let whole = source_of_recipe(recipe);
    let overrides = recipe.own_text().into_iter().flat_map(overrides).map(|(name, text)| (name, prose(&text)));
    let values = Values {
        name: recipe.name,
        purpose: prose(purpose),
        citation: header.as_ref().map_or_else(Vec::new, |header| prose(&credit(&header.source))),
        requires: recipe.requires(),
        lines: whole.lines().count(),
        wgsl: highlight::pieces(recipe.source, Language::Wgsl),
        overrides: overrides.collect(),
        host: Markup([host.lead.0, host.introduction.0, host.rest.0].concat()),
        techniques: techniques_with(|technique| technique.recipes.contains(&recipe.name)),
    };
    let mut page = Page::new("recipe", path, recipe.name, purpose, templates::render("recipe.html", values));
    page.entries = vec![Entry::page(recipe.name, &page.path, purpose)];
    page
}

/// Returns the `override`s of a recipe, each with the comment above it.
fn overrides(source: &str) -> Vec<(&str, String)> {
    let mut comment = Vec::new();
    let mut found = Vec::new();
    for line in source.lines() {
        // A mark for lines that belong to an effect is not an explanation.
        if line.starts_with("//+") {
            continue;
        }
        if let Some(text) = line.strip_prefix("//") {
            comment.push(text.trim());
            continue;
        }
        if let Some(rest) = line.strip_prefix("override ") {
            let name = rest.split([':', '=', ';']).next().unwrap_or_default().trim();
            found.push((name, comment.join(" ")));
        }
        comment.clear();
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_override_has_the_comment_above_it() {
        let source = "// demo: x\n\n//+a {\n// Light through\n// the stone.\noverride EFFECT_A: bool = true;\n//+a }\noverride B = 1u;\n";
        assert_eq!(overrides(source), [("EFFECT_A", "Light through the stone.".to_owned()), ("B", String::new())]);
    }
}
