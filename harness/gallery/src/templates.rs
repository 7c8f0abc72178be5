//! The site's templates: every tag of it is in `templates/`, and what Rust fills in is escaped there.

use minijinja::value::{Serde, Value};
use minijinja::{AutoEscape, Environment, syntax::SyntaxConfig};
use serde::Serialize;
use std::sync::LazyLock;

/// Every template: a line each.
const TEXTS: &[(&str, &str)] = &[
    ("base.html", include_str!("templates/base.html")),
    ("choices.md", include_str!("templates/choices.md")),
    ("compare.html", include_str!("templates/compare.html")),
    ("editor.html", include_str!("templates/editor.html")),
    ("figure.html", include_str!("templates/figure.html")),
    ("figure_alone.html", include_str!("templates/figure_alone.html")),
    ("ladder.html", include_str!("templates/ladder.html")),
    ("markdown.html", include_str!("templates/markdown.html")),
    ("parts.html", include_str!("templates/parts.html")),
    ("guide.html", include_str!("templates/guide.html")),
    ("live.html", include_str!("templates/live.html")),
    ("live_page.html", include_str!("templates/live_page.html")),
    ("mark.svg", include_str!("templates/mark.svg")),
    ("module.html", include_str!("templates/module.html")),
    ("prose.html", include_str!("templates/prose.html")),
    ("pictures.html", include_str!("templates/pictures.html")),
    ("recipe.html", include_str!("templates/recipe.html")),
    ("start.html", include_str!("templates/start.html")),
    ("takes.html", include_str!("templates/takes.html")),
    ("technique.html", include_str!("templates/technique.html")),
];

static TEMPLATES: LazyLock<Environment<'static>> = LazyLock::new(|| {
    let mut environment = Environment::new();
    environment.set_undefined_behavior(minijinja::UndefinedBehavior::Strict);
    let syntax = SyntaxConfig::builder().trim_blocks(true).lstrip_blocks(true).build();
    environment.set_formatter(|output, state, value| {
        if value.is_undefined() || matches!(state.auto_escape(), AutoEscape::None) || value.is_safe() {
            return minijinja::escape_formatter(output, state, value);
        }
        Ok(output.write_str(&escaped(&value.to_string()))?)
    });
    environment.set_syntax(syntax.unwrap_or_else(|error| panic!("the default delimiters: {error:#}")));
    for &(name, text) in TEXTS {
        environment.add_template(name, text).unwrap_or_else(|error| panic!("templates/{name}: {error:#}"));
    }
    environment
});

/// Returns the template's HTML for these values; text among them is escaped.
///
/// # Panics
/// Panics if the template asks for a value that is not there, which a test of its page finds.
pub fn render(name: &str, values: impl Serialize) -> Markup {
    let html = TEMPLATES
        .get_template(name)
        .and_then(|template| template.render(Serde(values)))
        .unwrap_or_else(|error| panic!("templates/{name}: {error:#}"));
    Markup(html)
}

/// HTML that a template takes as it is; everything else is escaped.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Markup(pub String);

impl Serialize for Markup {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Value::from_safe_string(self.0.clone()).serialize(serializer)
    }
}

/// Returns text as a template writes it, in elements and in attributes alike. A path's slashes stay.
pub fn escaped(text: &str) -> String {
    let mut html = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => html.push_str("&amp;"),
            '<' => html.push_str("&lt;"),
            '>' => html.push_str("&gt;"),
            '"' => html.push_str("&quot;"),
            '\'' => html.push_str("&#39;"),
            other => html.push(other),
        }
    }
    html
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_text_becomes_markup() {
        assert_eq!(escaped("<a href=\"x\">'&amp;'</a>"), "&lt;a href=&quot;x&quot;&gt;&#39;&amp;amp;&#39;&lt;/a&gt;");
    }

    #[test]
    fn a_template_escapes_all_but_markup() {
        #[derive(Serialize)]
        struct Values<'a> {
            prose: Vec<super::super::text::Span>,
            other: &'a Markup,
        }
        let values = Values { prose: super::super::text::prose("<b> & `a/b`"), other: &Markup("<i>".to_owned()) };
        assert_eq!(render("prose.html", values).0, "<p>&lt;b&gt; &amp; <code>a/b</code></p>");
    }
}
