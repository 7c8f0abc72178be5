//! The doc pages as HTML: Markdown by pulldown-cmark, and LaTeX as MathML by pulldown-latex, which
//! browsers typeset themselves.

use super::{
    highlight,
    text::{escape, slug},
};
use pulldown_cmark::{CodeBlockKind, CowStr, Event, HeadingLevel, Options, Parser, Tag, TagEnd, html};
use pulldown_latex::config::{DisplayMode, RenderConfig};
use std::convert::Infallible;

/// The parts of a module's doc page as HTML; parts that the page does not have are empty.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Page {
    /// The first paragraph, a `<p>`.
    pub lead: String,
    /// The first display equation.
    pub equation: String,
    /// Everything else except the title, with headings one level lower.
    pub rest: String,
}

/// An error for LaTeX that could not be converted.
#[derive(Debug, thiserror::Error)]
#[error("`{latex}` is not LaTeX that can be converted to MathML: {reason}")]
pub struct MathError {
    latex: String,
    reason: String,
}

/// Renders the doc page of `module`.
///
/// Links between pages lead to the modules' sections; other relative links and images, which would
/// be broken in the gallery, become text, and raw HTML is shown as text. LaTeX that cannot be
/// converted is shown as source.
pub fn page(source: &str, module: &str) -> Page {
    let mut page = Page::default();
    let mut under_heading = false;
    for block in blocks(source) {
        match block.first() {
            Some(Event::Start(Tag::Heading { level: HeadingLevel::H1, .. })) => continue,
            Some(Event::Start(Tag::Heading { .. })) => under_heading = true,
            Some(Event::Start(Tag::Paragraph)) if !under_heading => {
                let equation = is_equation(&block);
                let place = if equation { &mut page.equation } else { &mut page.lead };
                if place.is_empty() {
                    *place = render(block, module);
                    continue;
                }
            }
            _ => {}
        }
        if page.equation.is_empty() {
            let first = block.iter().find_map(|event| match event {
                Event::DisplayMath(latex) => Some(display(latex)),
                _ => None,
            });
            page.equation = first.map(|html| format!("<p>{html}</p>\n")).unwrap_or_default();
        }
        page.rest.push_str(&render(block, module));
    }
    page
}

/// Converts LaTeX to a `<math>` element, with its source as an annotation.
pub fn math(latex: &str, display_mode: DisplayMode) -> Result<String, MathError> {
    let error = |reason: String| MathError { latex: latex.trim().to_owned(), reason };
    let storage = pulldown_latex::Storage::new();
    let events = pulldown_latex::Parser::new(latex, &storage)
        .collect::<Result<Vec<_>, _>>()
        .map_err(|reason| error(reason.to_string()))?;
    let mut html = String::new();
    // The writer does not escape an annotation.
    let annotation = escape(latex.trim());
    let config = RenderConfig { display_mode, annotation: Some(&annotation), ..RenderConfig::default() };
    pulldown_latex::push_mathml(&mut html, events.into_iter().map(Ok::<_, Infallible>), config)
        .map_err(|reason| error(reason.to_string()))?;
    Ok(html)
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

fn display(latex: &str) -> String {
    let inner = math(latex, DisplayMode::Block).unwrap_or_else(|_| format!("<code>{}</code>", escape(latex.trim())));
    format!("<span class=\"equation scroll\">{inner}</span>")
}

fn render(block: Vec<Event<'_>>, module: &str) -> String {
    if let [Event::Start(Tag::HtmlBlock), Event::Html(text), ..] = block.as_slice()
        && text.trim_start().starts_with("<!--")
    {
        return String::new();
    }
    let heading = heading_text(&block);
    let mut events: Vec<Event<'_>> = Vec::with_capacity(block.len());
    let mut code: Option<(String, String)> = None;
    // Whether each open link is kept.
    let mut links = Vec::new();
    for event in block {
        if let (Some((_, text)), Event::Text(more)) = (&mut code, &event) {
            text.push_str(more);
            continue;
        }
        let written = match event {
            Event::Start(Tag::Heading { level, .. }) => {
                let level = (level as usize + 1).min(6);
                raw(format!("<h{level} id=\"{}\">", escape(&format!("{module}-{}", slug(&heading)))))
            }
            Event::End(TagEnd::Heading(level)) => {
                let anchor = escape(&format!("{module}-{}", slug(&heading)));
                let level = (level as usize + 1).min(6);
                let name = escape(&format!("Link to {heading}"));
                raw(format!(" <a class=\"anchor\" href=\"#{anchor}\" aria-label=\"{name}\">#</a></h{level}>\n"))
            }
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
                let text = if language == "wgsl" { highlight::wgsl(&text) } else { escape(&text) };
                raw(format!("<pre class=\"listing scroll\"><code>{text}</code></pre>\n"))
            }
            Event::Start(Tag::Table(_)) => {
                events.push(raw("<div class=\"table scroll\">".to_owned()));
                event
            }
            Event::End(TagEnd::Table) => {
                events.push(event);
                raw("</div>\n".to_owned())
            }
            Event::Start(Tag::Link { dest_url, .. }) => {
                let target = link(&dest_url);
                links.push(target.is_some());
                raw(target.map(|target| format!("<a href=\"{}\">", escape(&target))).unwrap_or_default())
            }
            Event::End(TagEnd::Link) => raw(if links.pop() == Some(true) { "</a>" } else { "" }.to_owned()),
            Event::Start(Tag::Image { .. }) => raw("<em>".to_owned()),
            Event::End(TagEnd::Image) => raw("</em>".to_owned()),
            Event::DisplayMath(latex) => raw(display(&latex)),
            Event::InlineMath(latex) => {
                raw(math(&latex, DisplayMode::Inline).unwrap_or_else(|_| format!("<code>{}</code>", escape(&latex))))
            }
            Event::InlineHtml(text) if text.starts_with("<!--") => continue,
            Event::Html(text) | Event::InlineHtml(text) => Event::Text(text),
            other => other,
        };
        events.push(written);
    }
    let mut written = String::new();
    html::push_html(&mut written, events.into_iter());
    written
}

fn raw(html: String) -> Event<'static> {
    Event::InlineHtml(CowStr::from(html))
}

/// Returns the text of a heading block.
fn heading_text(block: &[Event<'_>]) -> String {
    match block.first() {
        Some(Event::Start(Tag::Heading { .. })) => block
            .iter()
            .filter_map(|event| match event {
                Event::Text(text) | Event::Code(text) | Event::InlineMath(text) => Some(text.as_ref()),
                _ => None,
            })
            .collect(),
        _ => String::new(),
    }
}

/// Returns the gallery's target for a link of a doc page; `None` if there is none.
fn link(target: &str) -> Option<String> {
    if target.starts_with("https://") || target.starts_with("http://") {
        return Some(target.to_owned());
    }
    let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
    let name = file.trim_start_matches("./").strip_suffix(".md")?;
    crate::cookbook::module(name)?;
    Some(if anchor.is_empty() { format!("#{name}") } else { format!("#{name}-{anchor}") })
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAGE: &str = r"# fresnel

Lead with `<f32>`, $n < 2$.

$$ R = \tfrac12 $$

More.

## Hard cases

<!-- generated
by x -->

| a | b |
|---|---|
| 1 | 2 |

See [it](srgb.md), [web](https://x.org/?a&b), [lost](../x.rs), vec3<f32>, <script>x</script>.

```wgsl
fn f() {}
```
";

    #[test]
    fn a_page_falls_into_lead_equation_and_rest() {
        let page = page(PAGE, "fresnel");
        assert!(page.lead.starts_with("<p>Lead with <code>&lt;f32&gt;</code>, <math"), "{}", page.lead);
        assert!(page.equation.contains("<mfrac"), "{}", page.equation);
        assert!(!page.rest.contains("<mfrac") && !page.rest.contains("<h1") && !page.rest.contains("generated"));
        for part in [
            "<p>More.</p>",
            "<h3 id=\"fresnel-hard-cases\">Hard cases <a class=\"anchor\" href=\"#fresnel-hard-cases\"",
            "<div class=\"table scroll\"><table>",
            "<a href=\"#srgb\">it</a>",
            "<a href=\"https://x.org/?a&amp;b\">web</a>",
            ", lost, vec3&lt;f32&gt;, &lt;script&gt;x",
            "<span class=\"k\">fn</span>",
        ] {
            assert!(page.rest.contains(part), "{part} is not in {}", page.rest);
        }
    }

    #[test]
    fn what_a_page_lacks_is_empty() {
        assert_eq!(page("# srgb\n", "srgb"), Page::default());
    }

    #[test]
    fn mathematics_becomes_mathml() {
        let html = math(r"a < \sqrt{\vec n_i}", DisplayMode::Inline).expect("valid LaTeX");
        assert!(html.starts_with("<math") && html.contains("<msqrt") && html.contains("&lt;"), "{html}");
        assert!(!html.contains("< "), "{html}");
    }

    #[test]
    fn mathematics_that_cannot_be_converted_is_shown_as_it_is_written() {
        assert!(math(r"\frac{1}{", DisplayMode::Block).is_err());
        let page = page("# srgb\n\n$$ \\nosuch{<b>} $$\n", "srgb");
        assert!(page.equation.contains("<code>\\nosuch{&lt;b&gt;}</code>"), "{}", page.equation);
    }

    #[test]
    fn every_equation_of_the_cookbook_can_be_converted() {
        for module in crate::cookbook::modules() {
            for event in blocks(module.page).concat() {
                if let Event::DisplayMath(latex) | Event::InlineMath(latex) = event {
                    math(&latex, DisplayMode::Inline)
                        .unwrap_or_else(|error| panic!("docs/{}.md: {error}", module.name));
                }
            }
        }
    }
}
