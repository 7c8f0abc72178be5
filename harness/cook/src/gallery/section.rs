//! The section of the page for one module or one recipe.

use super::{
    Placed, highlight, markdown,
    page::{command, figure, listing},
    text::{escape, framed, prose},
};
use crate::cookbook::header::{FunctionDoc, parse_header};
use crate::cookbook::{Module, marks};
use lapidary_assay::accuracy_line::{Accuracy, FieldBound};
use lapidary_wgsl::Recipe;

/// Returns the section of a module: its purpose, its WGSL, its functions and the rest of its doc
/// page.
pub fn module(module: &Module, placed: &[Placed<'_>]) -> String {
    let name = module.name;
    let page = markdown::page(module.page, name);
    let lead = framed("<div class=\"lead\">", &page.lead, "</div>\n");
    let equation = framed("<div class=\"key\">", &page.equation, "</div>\n");
    let figures = figures(name, placed);
    let rows: String = module.functions.iter().map(|function| row(module, function)).collect();
    let (purpose, source) = (prose(&module.header.purpose), prose(&module.header.source));
    let mut listings = listing(&format!("{name}.wgsl"), module.source);
    if !module.naive.is_empty() {
        listings += &listing(&format!("naive/{name}.wgsl"), module.naive);
    }
    let check = command(&format!("./cook check {name}"));
    let notes = framed("<div class=\"notes\">\n", &page.rest, "</div>\n");
    format!(
        r##"<section id="{name}" class="module">
<h2>{name} <a class="anchor" href="#{name}" aria-label="Link to {name}">#</a></h2>
<p class="purpose">{purpose}</p>
{lead}{equation}{listings}<p class="dim citation">After {source}</p>
<h3>Functions</h3>
<table class="functions">
<thead><tr><th scope="col">Function</th><th scope="col"><a href="#accuracy">Accuracy</a></th></tr></thead>
<tbody>
{rows}</tbody>
</table>
{check}{figures}{notes}</section>
"##
    )
}

fn row(module: &Module, function: &FunctionDoc) -> String {
    let naive = matches!(function.accuracy, Accuracy::Naive);
    let class = if naive { " class=\"naive\"" } else { "" };
    let tags = [
        ("Returns", &function.returns),
        ("Units", &function.units),
        ("Domain", &function.domain),
        ("Outside", &function.outside),
    ];
    let tags: String = tags.iter().map(|(tag, text)| format!("<dt>{tag}</dt><dd>{}</dd>\n", prose(text))).collect();
    format!(
        r#"<tr id="{}"{class}>
<td>{}
<p>{}</p>
<details><summary>Returns, units, domain</summary><dl>
{tags}</dl></details></td>
<td>{}</td>
</tr>
"#,
        escape(&function.name),
        signature(module.whole, function),
        prose(&function.summary),
        accuracy(&function.accuracy)
    )
}

/// Returns the function's signature, from its `fn` line up to the brace, with each argument on one
/// line.
fn signature(source: &str, function: &FunctionDoc) -> String {
    let lines: Vec<&str> = source.lines().skip(function.line.saturating_sub(1)).collect();
    let text = lines.join(" ");
    let text = text.split('{').next().unwrap_or_default().split_whitespace().collect::<Vec<_>>().join(" ");
    let parts = text.split_once('(').and_then(|(head, rest)| Some((head, rest.rsplit_once(')')?)));
    let Some((head, (arguments, result))) = parts else {
        return format!("<code class=\"signature\">{}</code>", highlight::wgsl(&text));
    };
    let mut pieces = vec![String::new()];
    let mut depth = 0_i32;
    for character in arguments.trim().trim_end_matches(',').chars() {
        depth += i32::from(matches!(character, '<' | '(')) - i32::from(matches!(character, '>' | ')'));
        match pieces.last_mut() {
            Some(piece) if depth == 0 && character == ',' => {
                piece.push(',');
                pieces.push(String::new());
            }
            Some(piece) => piece.push(character),
            None => {}
        }
    }
    let piece = |text: &str| format!("<span class=\"piece\">{}</span>", highlight::wgsl(text));
    let last = pieces.pop().unwrap_or_default();
    let mut arguments: Vec<String> = pieces.iter().map(|text| piece(text.trim())).collect();
    arguments.push(piece(&format!("{})", last.trim())));
    let result = if result.trim().is_empty() { String::new() } else { format!(" {}", piece(result.trim())) };
    format!("<code class=\"signature\">{}(<wbr>{}{result}</code>", highlight::wgsl(head), arguments.join(" "))
}

fn accuracy(accuracy: &Accuracy) -> String {
    let Accuracy::Bounded { lavapipe, portable, order_kept } = accuracy else {
        return "<span class=\"badge\">naive</span>".to_owned();
    };
    let device = |name: &str, bounds: &[FieldBound]| {
        let bounds: String = bounds.iter().map(|bound| format!("<dd>{}</dd>", self::bound(bound))).collect();
        format!("<div><dt>{name}</dt>{bounds}</div>\n")
    };
    let order = if *order_kept { "<div><dt>order</dt><dd>kept</dd></div>\n" } else { "" };
    format!("<dl class=\"bounds\">\n{}{}{order}</dl>", device("lavapipe", lavapipe), device("portable", portable))
}

/// Returns a bound in the accuracy line's grammar, with small numbers as powers of ten.
fn bound(bound: &FieldBound) -> String {
    let words: Vec<String> = bound
        .to_string()
        .split(' ')
        .map(|word| match word.parse::<f64>() {
            Ok(number) if number != 0.0 && number < 1e-3 => {
                let text = format!("{number:e}");
                let (digits, exponent) = text.split_once("e-").unwrap_or((&text, "0"));
                format!("{digits}·10<sup>−{exponent}</sup>")
            }
            _ => escape(word),
        })
        .collect();
    words.join(" ")
}

/// Returns the figures of the module or recipe `name`.
fn figures(name: &str, placed: &[Placed<'_>]) -> String {
    let own = placed.iter().filter(|placed| placed.module == Some(name));
    framed(
        "<h3>Figures</h3>\n<div class=\"grid\">\n",
        &own.map(|placed| figure(placed, 4)).collect::<String>(),
        "</div>\n",
    )
}

/// Returns the article of a recipe, with the required modules included in the source.
pub fn recipe(recipe: &Recipe, placed: &[Placed<'_>]) -> String {
    let name = recipe.name;
    let figures = figures(name, placed);
    let (purpose, source) = match parse_header(recipe.source) {
        Ok(header) => (
            format!("<p class=\"purpose\">{}</p>\n", prose(&header.purpose)),
            format!("<p class=\"dim citation\">After {}</p>\n", prose(&header.source)),
        ),
        Err(_) => (String::new(), String::new()),
    };
    let requires: Vec<String> =
        recipe.requires().iter().map(|module| format!("<a href=\"#{module}\">{module}</a>")).collect();
    let requires = framed("<p>Requires ", &requires.join(", "), ".</p>\n");
    let overrides: String = recipe
        .own_text()
        .into_iter()
        .flat_map(overrides)
        .map(|(name, comment)| format!("<dt><code>{}</code></dt><dd>{}</dd>\n", escape(name), prose(&comment)))
        .collect();
    let overrides = framed("<dl class=\"overrides\">\n", &overrides, "</dl>\n");
    // The text to paste, as `cook copy` writes it.
    let text = marks::without(recipe, &[]).unwrap_or_else(|_| recipe.compose());
    let listing = listing(&format!("{name}.wgsl"), &text);
    format!(
        r##"<article id="recipe-{name}" class="module">
<h3>{name} <a class="anchor" href="#recipe-{name}" aria-label="Link to recipe {name}">#</a></h3>
{purpose}{requires}{listing}{source}{overrides}{figures}</article>
"##
    )
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

    #[test]
    fn a_signature_is_read_over_lines_and_keeps_each_argument_whole() {
        let source = "fn demo_f(\n    a: array<vec3f, 3>,\n    b: f32,\n) -> DemoHit {\n}";
        let function = |name: &str| FunctionDoc {
            name: name.to_owned(),
            line: 1,
            summary: String::new(),
            returns: String::new(),
            units: String::new(),
            domain: String::new(),
            outside: String::new(),
            accuracy: Accuracy::Naive,
        };
        let html = signature(source, &function("demo_f"));
        assert_eq!(html.matches("class=\"piece\"").count(), 3, "{html}");
        assert!(html.contains("&lt;<span class=\"t\">vec3f</span>, <span class=\"n\">3</span>&gt;,</span>"), "{html}");
        assert!(html.contains("<span class=\"t\">f32</span>)</span> <span class=\"piece\">-&gt; "), "{html}");
        assert!(
            signature("fn demo_g() {\n}", &function("demo_g")).ends_with("(<wbr><span class=\"piece\">)</span></code>")
        );
    }
}
