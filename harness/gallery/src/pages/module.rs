//! A module's page.

use super::super::search::Entry;
use super::super::{
    highlight::{self, Language, Piece},
    markdown::{self, Heading},
    mirror::{self, Coloured},
    parts::{DrawnDiagram, Parts},
    rows,
    templates::{self, Markup},
    text::{self, Span, prose},
};
use super::page::{Page, address, techniques_with};
use lapidary_assay::accuracy_line::{Accuracy, FieldBound};
use lapidary_cookbook::{Module, header::FunctionDoc};
use serde::Serialize;

#[derive(Serialize)]
struct Function<'a> {
    name: &'a str,
    naive: bool,
    signature: Vec<Vec<Piece<'a>>>,
    summary: Vec<Span>,
    tags: Vec<(&'static str, Vec<Span>)>,
    bounds: Vec<(&'static str, Vec<Vec<Word>>)>,
    pair: Option<Coloured<'a>>,
    /// Whether the page's editor checks it.
    checked: bool,
}

/// A word of a bound; a small number is a power of ten.
#[derive(Serialize)]
struct Word {
    text: String,
    exponent: Option<String>,
}

#[derive(Serialize)]
struct Values<'a> {
    name: &'a str,
    purpose: Vec<Span>,
    citation: Vec<Span>,
    lead: Markup,
    equation: Markup,
    introduction: Markup,
    rest: Markup,
    headings: Vec<&'a Heading>,
    lines: usize,
    naive_lines: usize,
    wgsl: Vec<Piece<'a>>,
    naive: Vec<Piece<'a>>,
    functions: Vec<Function<'a>>,
    diagrams: Vec<&'a DrawnDiagram>,
    editor: Option<&'a Markup>,
    rustdoc: Option<String>,
    techniques: Vec<(String, &'static str)>,
}

/// Returns the page of a module.
pub fn page(parts: &Parts<'_>, module: &'static Module) -> Page {
    let path = address("modules", module.name);
    let file = ["docs/", module.name, ".md"].concat();
    let doc = markdown::page(module.page, &parts.places.of(&file));
    let pairs = mirror::pairs(module, parts.mirrors.get(module.name).map_or(&[], Vec::as_slice));
    let signatures: Vec<Vec<String>> =
        module.functions.iter().map(|function| signature(module.whole, function)).collect();
    let functions = module.functions.iter().zip(&signatures).map(|(function, signature)| Function {
        name: &function.name,
        naive: matches!(function.accuracy, Accuracy::Naive),
        signature: signature.iter().map(|part| highlight::pieces(part, Language::Wgsl)).collect(),
        summary: prose(&function.summary),
        tags: vec![
            ("Returns", prose(&function.returns)),
            ("Units", prose(&function.units)),
            ("Domain", prose(&function.domain)),
            ("Outside", prose(&function.outside)),
        ],
        bounds: bounds(&function.accuracy),
        pair: pairs.iter().find(|pair| pair.name == function.name).map(mirror::Pair::coloured),
        checked: rows::checked(module).any(|(doc, _)| doc.name == function.name),
    });
    let values = Values {
        name: module.name,
        purpose: prose(&module.header.purpose),
        citation: prose(&text::credit(&module.header.source)),
        lead: doc.lead,
        equation: doc.equation,
        introduction: doc.introduction,
        rest: doc.rest,
        headings: doc.headings.iter().filter(|heading| heading.level == 2).collect(),
        lines: module.source.lines().count(),
        naive_lines: module.naive.lines().count(),
        wgsl: highlight::pieces(module.source, Language::Wgsl),
        naive: highlight::pieces(module.naive, Language::Wgsl),
        functions: functions.collect(),
        diagrams: parts.diagrams.iter().filter(|diagram| diagram.module == module.name).collect(),
        editor: parts.editors.get(module.name),
        rustdoc: parts.rustdoc.then(|| ["../rustdoc/lapidary_", module.name, "/index.html"].concat()),
        techniques: techniques_with(|technique| technique.modules.contains(&module.name)),
    };
    let mut page =
        Page::new("module", path, module.name, &text::plain(&doc.summary), templates::render("module.html", values))
            .with(&["diagram.css", "check.css"], &["check.js", "editor.js"]);
    page.entries = vec![Entry::page(module.name, &page.path, &module.header.purpose)];
    page.entries.extend(module.functions.iter().map(|function| Entry::function(function, module.name, &page.path)));
    page.entries.extend(doc.headings.iter().map(|heading| Entry::heading(heading, module.name, &page.path)));
    page
}

/// Returns the function's signature, from its `fn` line up to the brace: its head, each argument, and the result.
fn signature(source: &str, function: &FunctionDoc) -> Vec<String> {
    let lines: Vec<&str> = source.lines().skip(function.line.saturating_sub(1)).collect();
    let text = lines.join(" ");
    let text = text.split('{').next().unwrap_or_default().split_whitespace().collect::<Vec<_>>().join(" ");
    let parts = text.split_once('(').and_then(|(head, rest)| Some((head, rest.rsplit_once(')')?)));
    let Some((head, (arguments, result))) = parts else { return vec![text] };
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
    let mut all = vec![[head, "("].concat()];
    let last = pieces.len() - 1;
    all.extend(pieces.iter().enumerate().map(|(index, piece)| {
        let piece = piece.trim();
        if index == last { [piece, ")"].concat() } else { piece.to_owned() }
    }));
    if !result.trim().is_empty() {
        all.push(result.trim().to_owned());
    }
    all
}

fn bounds(accuracy: &Accuracy) -> Vec<(&'static str, Vec<Vec<Word>>)> {
    let Accuracy::Bounded { lavapipe, portable, order_kept } = accuracy else { return Vec::new() };
    let device = |bounds: &[FieldBound]| bounds.iter().map(bound).collect::<Vec<_>>();
    let mut all = vec![("lavapipe", device(lavapipe)), ("portable", device(portable))];
    if *order_kept {
        all.push(("order", vec![vec![Word { text: "kept".to_owned(), exponent: None }]]));
    }
    all
}

/// Returns a bound in the accuracy line's grammar, with small numbers as powers of ten.
fn bound(bound: &FieldBound) -> Vec<Word> {
    let word = |word: &str| match word.parse::<f64>() {
        Ok(number) if number != 0.0 && number < 1e-3 => {
            let text = format!("{number:e}");
            let (digits, exponent) = text.split_once("e-").unwrap_or((&text, "0"));
            Word { text: digits.to_owned(), exponent: Some(exponent.to_owned()) }
        }
        _ => Word { text: word.to_owned(), exponent: None },
    };
    bound.to_string().split(' ').map(word).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

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
        let parts = signature(source, &function("demo_f"));
        assert_eq!(parts, ["fn demo_f(", "a: array<vec3f, 3>,", "b: f32)", "-> DemoHit"]);
        assert_eq!(signature("fn demo_g() {\n}", &function("demo_g")), ["fn demo_g(", ")"]);
    }
}
