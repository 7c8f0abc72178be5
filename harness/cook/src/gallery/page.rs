//! The page's HTML: document frame, table of contents, pictures and listings.

use super::{
    Placed, highlight, section,
    text::{escape, framed, prose},
};
use crate::cookbook::header::LICENCE;
use crate::cookbook::{self, Module};
use lapidary_wgsl::Recipe;

/// A brilliant cut in side view, as line art; the page's logo and icon.
const MARK: &str = "M5 11 10 5H22L27 11 16 27ZM5 11H27M10 5 12 11 16 27 20 11 22 5M12 11 16 5 20 11";

/// Returns the whole page.
pub fn page(adapter: &str, placed: &[Placed<'_>]) -> String {
    let pictures: Vec<&Placed<'_>> = placed.iter().filter(|placed| placed.module.is_none()).collect();
    let hero = pictures.iter().position(|placed| placed.picture.title.to_lowercase().contains("brilliant"));
    let hero = hero.or(if pictures.is_empty() { None } else { Some(0) });
    let (modules, recipes) = (cookbook::modules(), lapidary_wgsl::RECIPES);
    let functions: usize = modules.iter().map(|module| module.functions.len()).sum();
    let grid: String =
        pictures.iter().enumerate().filter(|(at, _)| Some(*at) != hero).map(|(_, placed)| figure(placed, 3)).collect();
    let grid =
        framed("<section id=\"pictures\">\n<h2>Pictures</h2>\n<div class=\"grid\">\n", &grid, "</div>\n</section>\n");
    let contents = contents(modules, recipes, !grid.is_empty());
    let icon = format!(
        "data:image/svg+xml,%3Csvg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 32 32'%3E%3Cpath d='{MARK}' \
        fill='none' stroke='%239fd8e8' stroke-width='1.5' stroke-linejoin='round'/%3E%3C/svg%3E"
    );
    let (style, script) = (include_str!("page.css"), include_str!("page.js"));
    let hero = hero.map(|at| opening_picture(pictures[at])).unwrap_or_default();
    let modules_html: String = modules.iter().map(|module| section::module(module, placed)).collect();
    let recipes_html: String = recipes.iter().map(|recipe| section::recipe(recipe, placed)).collect();
    let (modules, recipes, adapter) = (modules.len(), recipes.len(), escape(adapter));
    format!(
        r##"<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="dark">
<meta name="description" content="A shader cookbook for gems: WGSL to paste, with its equations, its accuracy and its pictures.">
<title>Lapidary, a shader cookbook for gems</title>
<link rel="icon" href="{icon}">
<style>
{style}</style>
</head>
<body id="top">
<a class="skip" href="#content">Skip to the content</a>
{contents}<main id="content">
<header class="hero">
<div class="opening">
<h1>Lapidary</h1>
<p class="tagline">A shader cookbook for gems</p>
<p>Each technique is one WGSL module to paste into your engine. Its functions run on a Vulkan device and are held to a
stated accuracy, against a mirror in Rust and an oracle in double precision.</p>
<p class="facts"><span><b>{modules}</b> modules</span> <span><b>{functions}</b> functions</span> <span><b>{recipes}</b> recipes</span></p>
</div>
{hero}</header>
{grid}<section id="accuracy" class="legend">
<h2>What the tables promise</h2>
<p>An accuracy is the tolerance that the property tests apply. <dfn>ulp</dfn> counts units in the last place of the exact
value; <dfn>rel</dfn> and <dfn>abs</dfn> are relative and absolute; <dfn>backward</dfn> says that the result is exact for
an input so many ulp away, the fair measure where the problem itself is ill-conditioned. <dfn>lavapipe</dfn> is the device
that the tests run on, <dfn>portable</dfn> what WGSL’s own guarantees allow on any. A <span class="badge">naive</span> form
is what one finds elsewhere: kept to be compared with, and shown to fail where the stable one holds.</p>
</section>
{modules_html}<section id="recipes">
<h2>Recipes</h2>
<p class="lead">Complete shaders, with entry points and bindings, written with the modules’ functions. Each text below
holds the modules that it requires, so it can be pasted as it is.</p>
{recipes_html}</section>
</main>
<footer>
<p>Pictures rendered on {adapter}. The whole page is written by <code>./cook gallery</code>, from the same files that the
tests run.</p>
<p>Licence: {LICENCE}, at your choice.</p>
</footer>
<div id="status" role="status" class="quiet"></div>
<script>
{script}</script>
</body>
</html>
"##
    )
}

fn contents(modules: &[Module], recipes: &[Recipe], pictures: bool) -> String {
    let item = |anchor: &str, name: &str| format!("<li><a href=\"#{anchor}\">{name}</a></li>\n");
    let modules: String = modules.iter().map(|module| item(module.name, module.name)).collect();
    let recipes: String = recipes.iter().map(|recipe| item(&format!("recipe-{}", recipe.name), recipe.name)).collect();
    let pictures = if pictures { item("pictures", "Pictures") } else { String::new() };
    let accuracy = item("accuracy", "Accuracy");
    format!(
        r##"<nav aria-label="Contents">
<a class="brand" href="#top"><svg viewBox="0 0 32 32" width="26" height="26" aria-hidden="true"><path d="{MARK}"/></svg>Lapidary</a>
<ul>
{pictures}{accuracy}</ul>
<p>Modules</p>
<ul class="names">
{modules}</ul>
<p>Recipes</p>
<ul class="names">
{recipes}</ul>
</nav>
"##
    )
}

fn image(placed: &Placed<'_>, loading: &str) -> String {
    let (place, (width, height), title) = (escape(&placed.place), placed.picture.size, escape(&placed.picture.title));
    format!(
        "<a class=\"picture\" href=\"{place}\">\
        <img src=\"{place}\" width=\"{width}\" height=\"{height}\" loading=\"{loading}\" \
        alt=\"Rendering: {title}\"></a>"
    )
}

fn caption(placed: &Placed<'_>) -> String {
    format!("<p>{}</p>\n{}", prose(&placed.picture.paragraph), command(&placed.picture.command))
}

fn opening_picture(placed: &Placed<'_>) -> String {
    let title = escape(&placed.picture.title);
    format!(
        "<figure>\n{}\n<figcaption>\n<h2>{title}</h2>\n{}</figcaption>\n</figure>\n",
        image(placed, "eager"),
        caption(placed)
    )
}

/// Returns a picture with a heading of that level.
pub fn figure(placed: &Placed<'_>, level: u32) -> String {
    let title = escape(&placed.picture.title);
    format!(
        "<figure>\n{}\n<figcaption>\n<h{level}>{title}</h{level}>\n{}</figcaption>\n</figure>\n",
        image(placed, "lazy"),
        caption(placed)
    )
}

/// Returns a command line with a copy button.
pub fn command(line: &str) -> String {
    let line = escape(line);
    format!(
        "<div class=\"command copyable\"><code class=\"scroll\">{line}</code>\
        <button type=\"button\" class=\"copy\" aria-label=\"Copy the command {line}\" hidden>Copy</button></div>\n"
    )
}

/// Returns a collapsed shader listing with a copy button.
pub fn listing(file: &str, source: &str) -> String {
    let (file, lines, code) = (escape(file), source.lines().count(), highlight::wgsl(source));
    format!(
        r#"<div class="source copyable">
<details>
<summary><span class="file">{file}</span> <span class="dim">{lines} lines</span></summary>
<pre class="scroll"><code>{code}</code></pre>
</details>
<button type="button" class="copy" aria-label="Copy {file}" hidden>Copy</button>
</div>
"#
    )
}
