//! The doc pages as HTML: Markdown by pulldown-cmark, and LaTeX as MathML by pulldown-latex, which
//! browsers typeset themselves.

use super::{
    highlight::{self, Language, Piece},
    mathematics::{MathError, clauses, math},
    templates::{self, Markup},
    text::slug,
};
use pulldown_cmark::{CodeBlockKind, CowStr, Event, HeadingLevel, Options, Parser, Tag, TagEnd, html};
use pulldown_latex::config::DisplayMode;
use serde::Serialize;

/// A doc page as HTML; parts that it does not have are empty.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Page {
    /// The title, of its first heading.
    pub title: String,
    /// The first paragraph, a `<p>`.
    pub lead: Markup,
    /// The first paragraph as plain text.
    pub summary: String,
    /// The first display equation.
    pub equation: Markup,
    /// What follows before the first heading.
    pub introduction: Markup,
    /// Everything from the first heading on.
    pub rest: Markup,
    /// The headings of the rest.
    pub headings: Vec<Heading>,
}

/// A heading of a page.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Heading {
    /// Its level, from 2.
    pub level: usize,
    /// Its anchor.
    pub id: String,
    /// Its text.
    pub text: String,
    /// What stands below it, as plain text to search in.
    #[serde(skip)]
    pub words: String,
}

/// A picture in a text.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Image {
    /// Where the large picture is, from the page.
    pub file: String,
    /// Where the small one is.
    pub thumb: String,
    /// Width in pixels of the large one.
    pub width: u32,
    /// Its height.
    pub height: u32,
}

/// Where a page's links lead.
pub trait Links {
    /// Returns the address of what a link's target is on the site; `None` if the site does not have it.
    fn page(&self, target: &str) -> Option<String>;
    /// Returns the address of the page that the text is of, if it stands on another one.
    fn own(&self) -> &str {
        ""
    }
    /// Returns the picture of that target; `None` if the site does not have it.
    fn image(&self, target: &str) -> Option<Image>;
}

/// Renders a doc page.
///
/// Links and pictures that the site does not have become text, and raw HTML is shown as text. LaTeX that
/// cannot be converted is shown as source.
pub fn page(source: &str, links: &dyn Links) -> Page {
    let mut page = Page::default();
    let mut under_heading = false;
    for block in blocks(source) {
        match block.first() {
            Some(Event::Start(Tag::Heading { level: HeadingLevel::H1, .. })) => {
                page.title = text_of(&block);
                continue;
            }
            Some(Event::Start(Tag::Heading { level, .. })) => {
                under_heading = true;
                let text = text_of(&block);
                page.headings.push(Heading { level: *level as usize, id: slug(&text), text, words: String::new() });
            }
            Some(Event::Start(Tag::Paragraph)) if !under_heading => {
                if is_equation(&block) && page.equation.0.is_empty() {
                    page.equation = render(block, links);
                    continue;
                }
                if page.lead.0.is_empty() && !is_equation(&block) {
                    page.summary = text_of(&block);
                    page.lead = render(block, links);
                    continue;
                }
            }
            _ => {}
        }
        if page.equation.0.is_empty() {
            let first = block.iter().find_map(|event| match event {
                Event::DisplayMath(latex) => Some(display(latex)),
                _ => None,
            });
            if let Some(markup) = first {
                page.equation = part(Part { kind: "paragraph", markup: Some(markup), ..Part::default() });
            }
        }
        if let Some(heading) = page.headings.last_mut() {
            heading.words.push_str(&text_of(&block));
            heading.words.push(' ');
        }
        let place = if under_heading { &mut page.rest } else { &mut page.introduction };
        place.0.push_str(&render(block, links).0);
    }
    page
}

/// A part of a page, by kind, with what its template fills in.
#[derive(Default, Serialize)]
struct Part<'a> {
    kind: &'a str,
    id: &'a str,
    text: &'a str,
    level: usize,
    pieces: Vec<Piece<'a>>,
    target: &'a str,
    picture: Option<Image>,
    markup: Option<Markup>,
}

fn part(part: Part<'_>) -> Markup {
    templates::render("markdown.html", part)
}

/// Returns the page's events, one list per top-level block.
fn blocks(source: &str) -> Vec<Vec<Event<'_>>> {
    let mut blocks = vec![Vec::new()];
    let mut depth = 0_usize;
    for event in Parser::new_ext(source, Options::ENABLE_TABLES | Options::ENABLE_MATH) {
        match &event {
            Event::Start(_) => depth += 1,
            Event::End(_) => depth -= 1,
            _ => {}
        }
        if let Some(block) = blocks.last_mut() {
            block.push(event);
        }
        if depth == 0 {
            blocks.push(Vec::new());
        }
    }
    blocks.retain(|block| !block.is_empty());
    blocks
}

/// Whether a block consists only of display mathematics.
fn is_equation(block: &[Event<'_>]) -> bool {
    block.iter().any(|event| matches!(event, Event::DisplayMath(_)))
        && block.iter().all(|event| match event {
            Event::Start(Tag::Paragraph) | Event::End(TagEnd::Paragraph) | Event::DisplayMath(_) | Event::SoftBreak => {
                true
            }
            Event::Text(text) => text.trim().is_empty(),
            _ => false,
        })
}

fn display(latex: &str) -> Markup {
    let clauses: Result<String, MathError> =
        clauses(latex).into_iter().map(|clause| math(clause, DisplayMode::Block)).collect();
    let markup = clauses.ok().map(Markup);
    part(Part { kind: "equation", text: latex.trim(), markup, ..Part::default() })
}

fn formula(latex: &str) -> Markup {
    let markup = math(latex, DisplayMode::Inline).ok().map(Markup);
    part(Part { kind: "formula", text: latex, markup, ..Part::default() })
}

fn render(block: Vec<Event<'_>>, links: &dyn Links) -> Markup {
    if let [Event::Start(Tag::HtmlBlock), Event::Html(text), ..] = block.as_slice()
        && text.trim_start().starts_with("<!--")
    {
        return Markup::default();
    }
    let heading = text_of(&block);
    let anchor = slug(&heading);
    let mut events: Vec<Event<'_>> = Vec::with_capacity(block.len());
    let mut code: Option<(String, String)> = None;
    // A picture's place, while its description is read.
    let mut image: Option<(Option<Image>, String)> = None;
    // Whether each open link is kept.
    let mut kept = Vec::new();
    // Whether a place to link to is open.
    let mut placed = false;
    for event in block {
        if let (Some((_, text)), Event::Text(more)) = (&mut code, &event) {
            text.push_str(more);
            continue;
        }
        if let (Some((_, text)), Event::Text(more) | Event::Code(more)) = (&mut image, &event) {
            text.push_str(more);
            continue;
        }
        let written = match event {
            Event::Start(Tag::Heading { level, .. }) => {
                part(Part { kind: "heading", level: level as usize, id: &anchor, ..Part::default() })
            }
            Event::End(TagEnd::Heading(level)) => part(Part {
                kind: "heading end",
                level: level as usize,
                id: &anchor,
                text: &heading,
                ..Part::default()
            }),
            Event::Start(Tag::CodeBlock(kind)) => {
                let language = match kind {
                    CodeBlockKind::Fenced(language) => language.to_string(),
                    CodeBlockKind::Indented => String::new(),
                };
                code = Some((language, String::new()));
                continue;
            }
            Event::End(TagEnd::CodeBlock) => {
                let (language, text) = code.take().unwrap_or_default();
                let pieces = match language.as_str() {
                    "wgsl" => highlight::pieces(&text, Language::Wgsl),
                    "rust" => highlight::pieces(&text, Language::Rust),
                    _ => vec![Piece { class: None, text: &text }],
                };
                part(Part { kind: "code", pieces, ..Part::default() })
            }
            Event::Start(Tag::Table(_)) => {
                events.push(raw(part(Part { kind: "table", ..Part::default() })));
                events.push(event);
                continue;
            }
            Event::End(TagEnd::Table) => {
                events.push(event);
                part(Part { kind: "table end", ..Part::default() })
            }
            Event::Start(Tag::Link { dest_url, .. }) => {
                let target = address(&dest_url, links);
                kept.push(target.is_some());
                match &target {
                    Some(target) => part(Part { kind: "link", target, ..Part::default() }),
                    None => continue,
                }
            }
            Event::End(TagEnd::Link) => match kept.pop() {
                Some(true) => part(Part { kind: "link end", ..Part::default() }),
                _ => continue,
            },
            Event::Start(Tag::Image { dest_url, .. }) => {
                image = Some((links.image(&dest_url), String::new()));
                continue;
            }
            Event::End(TagEnd::Image) => match image.take() {
                // A picture within a link is a link already.
                Some((Some(picture), text)) => {
                    part(Part { kind: "image", text: &text, picture: Some(picture), ..Part::default() })
                }
                _ => continue,
            },
            Event::DisplayMath(latex) => display(&latex),
            Event::InlineMath(latex) => formula(&latex),
            Event::InlineHtml(text) if text.starts_with("<!--") || (&*text == "</a>" && placed) => {
                placed = false;
                continue;
            }
            // A place to link to, without a heading.
            Event::InlineHtml(text) if text.starts_with("<a id=\"") => {
                placed = true;
                let id = text.split('"').nth(1).map(slug).unwrap_or_default();
                part(Part { kind: "place", id: &id, ..Part::default() })
            }
            Event::Html(text) | Event::InlineHtml(text) => {
                events.push(Event::Text(text));
                continue;
            }
            other => {
                events.push(other);
                continue;
            }
        };
        events.push(raw(written));
    }
    let mut written = String::new();
    html::push_html(&mut written, events.into_iter());
    // A heading without words heads nothing; the library writes it as a heading all the same.
    Markup(written.replace("<th></th>", "<td></td>"))
}

fn raw(html: Markup) -> Event<'static> {
    Event::InlineHtml(CowStr::from(html.0))
}

/// Returns the text of a block.
fn text_of(block: &[Event<'_>]) -> String {
    let texts = block.iter().filter_map(|event| match event {
        Event::Text(text) | Event::Code(text) | Event::InlineMath(text) => Some(text.as_ref()),
        Event::SoftBreak | Event::HardBreak => Some(" "),
        _ => None,
    });
    texts.collect()
}

/// Returns where a link leads; `None` if the site does not have it.
fn address(target: &str, links: &dyn Links) -> Option<String> {
    if target.starts_with("https://") || target.starts_with("http://") {
        return Some(target.to_owned());
    }
    let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
    let page = if file.is_empty() { links.own().to_owned() } else { links.page(file)? };
    Some(if anchor.is_empty() { page } else { [&page, "#", &slug(anchor)].concat() })
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAGE: &str = r#"# fresnel

Lead with `<f32>`, $n < 2$.

$$ R = \tfrac12 $$

More.

## Hard cases

<!-- generated
by x -->

| a | b |
|---|---|
| 1 | 2 |

<a id="Far off"></a>See [it](srgb.md#hard-cases), [web](https://x.org/?a&b), [lost](../x.rs), vec3<f32>, <script>x</script>.
![a `stone`](stone.png) ![lost](lost.png)

```wgsl
fn f() {}
```
"#;

    struct Few;

    impl Links for Few {
        fn page(&self, target: &str) -> Option<String> {
            (target == "srgb.md").then(|| "../modules/srgb.html".to_owned())
        }

        fn image(&self, target: &str) -> Option<Image> {
            let (file, thumb) = ("stone.png".to_owned(), "small.jpg".to_owned());
            (target == "stone.png").then_some(Image { file, thumb, width: 2, height: 1 })
        }
    }

    #[test]
    fn a_page_falls_into_lead_equation_and_rest() {
        let page = page(PAGE, &Few);
        assert_eq!((page.title.as_str(), page.headings.len()), ("fresnel", 1));
        let (lead, equation, rest) = (page.lead.0, page.equation.0, [page.introduction.0, page.rest.0].concat());
        assert!(lead.starts_with("<p>Lead with <code>&lt;f32&gt;</code>, <math"), "{lead}");
        assert!(equation.contains("<mfrac"), "{equation}");
        assert!(!rest.contains("<mfrac") && !rest.contains("<h1") && !rest.contains("generated"));
        for part in [
            "<p>More.</p>",
            "<h2 id=\"hard-cases\">Hard cases<a class=\"anchor\" href=\"#hard-cases\"",
            "<div class=\"table scroll\"><table>",
            "<a href=\"../modules/srgb.html#hard-cases\">it</a>",
            "<a href=\"https://x.org/?a&amp;b\">web</a>",
            "<span id=\"far-off\"></span>See",
            ", lost, vec3&lt;f32&gt;, &lt;script&gt;x",
            "<img src=\"small.jpg\" width=\"2\" height=\"1\" loading=\"lazy\" alt=\"a stone\">",
            "<span class=\"k\">fn</span>",
        ] {
            assert!(rest.contains(part), "{part} is not in {rest}");
        }
    }

    #[test]
    fn what_a_page_lacks_is_empty() {
        assert_eq!(page("# srgb\n", &Few), Page { title: "srgb".to_owned(), ..Page::default() });
    }

    #[test]
    fn an_equation_is_as_many_formulas_as_it_has_clauses() {
        let page = page("# srgb\n\n$$ a, \\qquad b $$\n", &Few);
        assert_eq!(page.equation.0.matches("<math").count(), 2, "{}", page.equation.0);
    }

    #[test]
    fn mathematics_that_cannot_be_converted_is_shown_as_it_is_written() {
        let page = page("# srgb\n\n$$ \\nosuch{<b>} $$\n", &Few);
        assert!(page.equation.0.contains("<code>\\nosuch{&lt;b&gt;}</code>"), "{}", page.equation.0);
    }

    #[test]
    fn every_equation_of_the_cookbook_can_be_converted() {
        for module in lapidary_cookbook::modules() {
            for event in blocks(module.page).concat() {
                if let Event::DisplayMath(latex) | Event::InlineMath(latex) = event {
                    math(&latex, DisplayMode::Inline)
                        .unwrap_or_else(|error| panic!("docs/{}.md: {error}", module.name));
                }
            }
        }
    }
}
