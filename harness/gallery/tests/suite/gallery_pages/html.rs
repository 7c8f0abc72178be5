//! Just as much of HTML as the site's own pages need: tags with their attributes, and text.

use std::collections::BTreeMap;

/// A piece of a page.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Piece {
    /// A start tag: name and attributes.
    Start(String, BTreeMap<String, String>),
    /// An end tag.
    End(String),
    /// Text, its references replaced. That of scripts and styles is as it stands.
    Text(String),
}

impl Piece {
    /// Whether it starts an element of this class.
    pub(crate) fn has_class(&self, wanted: &str) -> bool {
        let Self::Start(_, attributes) = self else { return false };
        attributes.get("class").is_some_and(|names| names.split_whitespace().any(|name| name == wanted))
    }
}

/// Elements whose text is no HTML.
const RAW: [&str; 2] = ["script", "style"];

/// Returns the pieces of a page, in order.
///
/// # Panics
/// Panics at a tag without an end: nothing that a template writes.
pub(crate) fn pieces(html: &str) -> Vec<Piece> {
    let mut pieces = Vec::new();
    let mut rest = html;
    while let Some((text, after)) = rest.split_once('<') {
        if !text.is_empty() {
            pieces.push(Piece::Text(unescaped(text)));
        }
        if let Some(comment) = after.strip_prefix("!--") {
            rest = comment.split_once("-->").expect("a comment's end").1;
            continue;
        }
        let (tag, after) = cut(after);
        rest = after;
        if let Some(name) = tag.strip_prefix('/') {
            pieces.push(Piece::End(name.trim().to_ascii_lowercase()));
        } else if !tag.starts_with('!') {
            let (name, attributes) = start(tag);
            if RAW.contains(&name.as_str()) {
                let (text, after) = rest.split_once(&format!("</{name}")).expect("an end");
                rest = after.split_once('>').expect("an end").1;
                pieces.extend([Piece::Start(name.clone(), attributes), Piece::Text(text.to_owned()), Piece::End(name)]);
            } else {
                pieces.push(Piece::Start(name, attributes));
            }
        }
    }
    pieces.push(Piece::Text(unescaped(rest)));
    pieces
}

/// Cuts at the tag's end, which is not in quotes.
fn cut(text: &str) -> (&str, &str) {
    let mut quote = None;
    for (index, letter) in text.char_indices() {
        match (quote, letter) {
            (None, '>') => return (&text[..index], &text[index + 1..]),
            (None, '"' | '\'') => quote = Some(letter),
            (Some(open), _) if open == letter => quote = None,
            _ => {}
        }
    }
    panic!("a tag without an end: {}", &text[..text.len().min(80)]);
}

fn start(tag: &str) -> (String, BTreeMap<String, String>) {
    let tag = tag.trim_end_matches('/');
    let (name, mut rest) = tag.split_once(char::is_whitespace).unwrap_or((tag, ""));
    let mut attributes = BTreeMap::new();
    loop {
        rest = rest.trim_start();
        if rest.is_empty() {
            return (name.to_ascii_lowercase(), attributes);
        }
        let end = rest.find(|letter: char| letter == '=' || letter.is_whitespace()).unwrap_or(rest.len());
        let key = rest[..end].to_ascii_lowercase();
        rest = &rest[end..];
        let mut value = "";
        if let Some(after) = rest.strip_prefix('=') {
            (value, rest) = match after.chars().next() {
                Some(quote @ ('"' | '\'')) => after[1..].split_once(quote).expect("a quote's end"),
                _ => after.split_at(after.find(char::is_whitespace).unwrap_or(after.len())),
            };
        }
        attributes.insert(key, unescaped(value));
    }
}

/// Replaces references to characters.
pub(crate) fn unescaped(text: &str) -> String {
    let mut plain = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('&') {
        plain.push_str(before);
        let end = after.find(';').filter(|end| *end <= 8);
        let known = end.and_then(|end| character(&after[..end]));
        match (known, end) {
            (Some(letter), Some(end)) => {
                plain.push(letter);
                rest = &after[end + 1..];
            }
            _ => {
                plain.push('&');
                rest = after;
            }
        }
    }
    plain + rest
}

fn character(name: &str) -> Option<char> {
    let number = |digits: &str, radix| u32::from_str_radix(digits, radix).ok().and_then(char::from_u32);
    match name {
        "lt" => Some('<'),
        "gt" => Some('>'),
        "amp" => Some('&'),
        "quot" => Some('"'),
        "apos" => Some('\''),
        "nbsp" => Some('\u{a0}'),
        _ => name.strip_prefix("#x").map_or_else(|| number(name.strip_prefix('#')?, 10), |digits| number(digits, 16)),
    }
}

#[test]
fn a_page_is_taken_apart() {
    let html = "<!DOCTYPE html>\n<a href='x.html?a=1&amp;b' hidden data-n=3>1 &lt; 2 &#x2F; R&D</a><!-- <b> --><br/>\
        <script>if (a < b) '<p>'</script >";
    let attribute = |key: &str, value: &str| (key.to_owned(), value.to_owned());
    let expected = [
        Piece::Text("\n".to_owned()),
        Piece::Start(
            "a".to_owned(),
            BTreeMap::from([attribute("href", "x.html?a=1&b"), attribute("hidden", ""), attribute("data-n", "3")]),
        ),
        Piece::Text("1 < 2 / R&D".to_owned()),
        Piece::End("a".to_owned()),
        Piece::Start("br".to_owned(), BTreeMap::new()),
        Piece::Start("script".to_owned(), BTreeMap::new()),
        Piece::Text("if (a < b) '<p>'".to_owned()),
        Piece::End("script".to_owned()),
        Piece::Text(String::new()),
    ];
    assert_eq!(pieces(html), expected);
}
