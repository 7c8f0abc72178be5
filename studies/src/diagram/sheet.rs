//! A diagram: what it is of, who draws it, and its text as SVG.

use super::scene::Scene;
use minijinja::value::{Serde, Value};
use minijinja::{Environment, UndefinedBehavior, syntax::SyntaxConfig};
use serde::Serialize;
use std::sync::LazyLock;

/// A diagram of a technique.
#[derive(Clone, Copy, Debug)]
pub struct Diagram {
    /// Name of its file, `docs/diagrams/NAME.svg`.
    pub name: &'static str,
    /// The module or recipe that it explains.
    pub module: &'static str,
    /// What it shows, in a few words.
    pub title: &'static str,
    /// What one sees, in plain text with `` `code` ``.
    pub caption: &'static str,
    /// Draws it.
    pub draw: fn() -> Scene,
}

/// A diagram's style, as the page has it.
const STYLE: &str = include_str!("../../../harness/gallery/src/assets/diagram.css");
/// The colours of a file of its own, light and dark.
const COLOURS: &str = include_str!("colours.css");

/// The template's name; its ending makes text in it escaped.
const TEMPLATE: &str = "diagram.xml";

/// The template.
static TEMPLATES: LazyLock<Environment<'static>> = LazyLock::new(|| {
    let mut environment = Environment::new();
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    let syntax = SyntaxConfig::builder().trim_blocks(true).lstrip_blocks(true).build();
    environment.set_syntax(syntax.unwrap_or_else(|error| panic!("the default delimiters: {error:#}")));
    let text = include_str!("diagram.xml");
    environment.add_template(TEMPLATE, text).unwrap_or_else(|error| panic!("{TEMPLATE}: {error:#}"));
    environment
});

/// What the template takes.
#[derive(Serialize)]
struct Sheet<'a> {
    name: &'a str,
    title: &'a str,
    description: String,
    style: Option<Value>,
    scene: Scene,
}

impl Diagram {
    /// Returns the diagram as a file of its own, which carries its colours for light and dark grounds.
    #[must_use]
    pub fn file_text(&self) -> String {
        self.render(Some(format!("{}\n{}", COLOURS.trim_end(), STYLE.trim_end())))
    }

    /// Returns the diagram as markup for a page, whose style sheet colours it.
    #[must_use]
    pub fn inline(&self) -> String {
        self.render(None)
    }

    fn render(&self, style: Option<String>) -> String {
        let description = self.caption.replace('`', "");
        let (name, title, scene) = (self.name, self.title, (self.draw)());
        let sheet = Sheet { name, title, description, style: style.map(Value::from_safe_string), scene };
        let text = TEMPLATES.get_template(TEMPLATE).and_then(|template| template.render(Serde(sheet)));
        let mut text = text.unwrap_or_else(|error| panic!("{TEMPLATE}: {error:#}"));
        if !text.ends_with('\n') {
            text.push('\n');
        }
        text
    }
}
