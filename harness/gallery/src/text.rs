//! Plain text for the templates.

use serde::Serialize;

/// A piece of a sentence: plain, or code.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Span {
    /// Whether it is code.
    pub code: bool,
    /// The text.
    pub text: String,
}

/// Cuts plain text in which only `` `code` `` is markup, as in WGSL comments: their `*`, `_` and `$` are
/// mathematics.
pub fn prose(text: &str) -> Vec<Span> {
    let parts: Vec<&str> = text.split('`').collect();
    let mut spans: Vec<Span> = Vec::new();
    for (index, part) in parts.iter().enumerate() {
        let closed = index + 1 < parts.len();
        let span = match (index % 2 == 1, closed) {
            (true, true) => Span { code: true, text: (*part).to_owned() },
            (true, false) => Span { code: false, text: ["`", part].concat() },
            (false, _) => Span { code: false, text: (*part).to_owned() },
        };
        if !span.text.is_empty() {
            spans.push(span);
        }
    }
    spans
}

/// Returns the text without its marks of code, for an attribute.
pub fn plain(text: &str) -> String {
    text.replace('`', "")
}

/// Converts text to a part of an anchor's name: lower-case letters, digits and single hyphens. Raised and lowered digits
/// are left out, as code hosts do it.
pub fn slug(text: &str) -> String {
    let text = text.replace(|c: char| c.is_numeric() && !c.is_ascii_digit(), "");
    let words: Vec<String> =
        text.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).map(str::to_lowercase).collect();
    words.join("-")
}

/// Returns whom a header's source credits, as a sentence: `own` is what is new here.
pub fn credit(source: &str) -> String {
    match source.strip_prefix("own") {
        Some(rest) => ["New here", rest].concat(),
        None => ["After ", source].concat(),
    }
}

/// Returns the first sentence of a text.
pub fn first_sentence(text: &str) -> &str {
    text.find(". ").map_or(text, |end| &text[..=end])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_closed_code_is_markup_in_prose() {
        let span = |code: bool, text: &str| Span { code, text: text.to_owned() };
        assert_eq!(
            prose("a * b_c * d, `x<y>` and `open"),
            [span(false, "a * b_c * d, "), span(true, "x<y>"), span(false, " and "), span(false, "`open")]
        );
    }

    #[test]
    fn anchors_hold_letters_digits_and_hyphens() {
        assert_eq!(slug("  Hard cases: n → 1 "), "hard-cases-n-1");
        assert_eq!(slug("Is σ = σ₀κ true?"), "is-σ-σκ-true");
    }
}
