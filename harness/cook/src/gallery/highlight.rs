//! WGSL as HTML: escaped, with classes for comments, keywords, types, numbers, attributes and
//! declared names. No text is added: without its tags the HTML is the original source, as the copy
//! button requires.

use super::text::escape;

const KEYWORDS: [&str; 26] = [
    "alias",
    "break",
    "case",
    "const",
    "const_assert",
    "continue",
    "continuing",
    "default",
    "diagnostic",
    "discard",
    "else",
    "enable",
    "false",
    "fn",
    "for",
    "if",
    "let",
    "loop",
    "override",
    "requires",
    "return",
    "struct",
    "switch",
    "true",
    "var",
    "while",
];

/// Built-in types; matrices and vectors are recognised by their first letters, structs by their
/// capital.
const TYPES: [&str; 10] =
    ["array", "atomic", "bool", "f16", "f32", "i32", "ptr", "sampler", "sampler_comparison", "u32"];

/// Returns the source as HTML, for a `<code>` element. Classes: `c` comment, `k` keyword, `t` type,
/// `n` number, `a` attribute, `d` name of a declared function, struct or constant.
pub fn wgsl(source: &str) -> String {
    let mut html = String::with_capacity(source.len() * 2);
    let mut rest = source;
    let mut declares = false;
    while !rest.is_empty() {
        let (length, class) = token(rest);
        let (text, after) = rest.split_at(length);
        let class = match class {
            Some('i') if declares => Some('d'),
            Some('i') => word_class(text),
            other => other,
        };
        if !text.trim().is_empty() && class != Some('c') {
            declares = matches!(text, "fn" | "struct" | "const" | "override" | "alias");
        }
        match class {
            Some(class) => html.push_str(&format!("<span class=\"{class}\">{}</span>", escape(text))),
            None => html.push_str(&escape(text)),
        }
        rest = after;
    }
    html
}

/// Returns the length in bytes of the first token of a non-empty text, at least 1, and its class;
/// `i` marks a word that is still to be classified.
fn token(text: &str) -> (usize, Option<char>) {
    let run = |accept: fn(char) -> bool| text.find(|c: char| !accept(c)).unwrap_or(text.len());
    let word = |c: char| c.is_alphanumeric() || c == '_';
    let mut characters = text.chars();
    let first = characters.next().unwrap_or_default();
    let second = characters.next().unwrap_or_default();
    match first {
        '/' if second == '/' => (text.find('\n').unwrap_or(text.len()), Some('c')),
        '/' if second == '*' => (block_comment(text), Some('c')),
        '0'..='9' => (number(text), Some('n')),
        '.' if second.is_ascii_digit() => (number(text), Some('n')),
        '@' => (1 + text[1..].find(|c: char| !word(c)).unwrap_or(text.len() - 1), Some('a')),
        _ if first.is_alphabetic() || first == '_' => (text.find(|c: char| !word(c)).unwrap_or(text.len()), Some('i')),
        _ if first.is_whitespace() => (run(char::is_whitespace), None),
        _ => (first.len_utf8(), None),
    }
}

/// Returns the length of a block comment; WGSL nests them. An unclosed one extends to the end.
fn block_comment(text: &str) -> usize {
    let mut depth = 0_usize;
    let mut at = 0;
    while let Some(step) = text[at..].find(['/', '*']) {
        at += step;
        if text[at..].starts_with("/*") {
            depth += 1;
            at += 2;
        } else if text[at..].starts_with("*/") {
            depth -= 1;
            at += 2;
            if depth == 0 {
                return at;
            }
        } else {
            at += 1;
        }
    }
    text.len()
}

/// Returns the length of a numeric literal with exponent and suffix: `0x1.8p-3f`, `1e-6f`, `12u`.
fn number(text: &str) -> usize {
    let exponent: &[u8] = if text.starts_with("0x") || text.starts_with("0X") { b"pP" } else { b"eE" };
    let bytes = text.as_bytes();
    let mut at = 1;
    while at < bytes.len()
        && (bytes[at].is_ascii_alphanumeric()
            || bytes[at] == b'.'
            || (matches!(bytes[at], b'+' | b'-') && exponent.contains(&bytes[at - 1])))
    {
        at += 1;
    }
    at
}

fn word_class(word: &str) -> Option<char> {
    let shaped =
        |prefix: &str| word.strip_prefix(prefix).is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()));
    let built_in = TYPES.contains(&word) || shaped("vec") || shaped("mat") || word.starts_with("texture_");
    // A name that starts with a capital is a struct's, unless it is all capitals: then it is a
    // constant's.
    let structure = word.starts_with(char::is_uppercase) && word.contains(char::is_lowercase);
    if KEYWORDS.contains(&word) {
        Some('k')
    } else if built_in || structure {
        Some('t')
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the text of an HTML fragment, like a browser's `textContent`.
    fn text_of(html: &str) -> String {
        let mut text = String::new();
        let mut rest = html;
        while let Some((before, tag)) = rest.split_once('<') {
            text.push_str(before);
            rest = tag.split_once('>').expect("a tag closes").1;
        }
        text.push_str(rest);
        text.replace("&lt;", "<")
            .replace("&gt;", ">")
            .replace("&quot;", "\"")
            .replace("&#39;", "'")
            .replace("&amp;", "&")
    }

    #[test]
    fn without_its_tags_it_is_the_source_again() {
        let odd =
            "/* a /* nested */ b */ fn f(a: ptr<function, vec3f>) -> f32 { return *a.x & 0x1.8p-3f; } // λ² <b>&amp;";
        let mut sources = vec![odd, "", "\n\n", "/* open", "/", "@", "1e", "a\r\n", "é_ü1 + .5f", "\"quote\" 'q'"];
        sources.extend(crate::cookbook::modules().iter().map(|module| module.source));
        for source in sources {
            assert_eq!(text_of(&wgsl(source)), source);
        }
    }

    #[test]
    fn classes_are_told_apart() {
        let html = wgsl("@compute fn main(x: vec3<f32>, y: MyHit) { let z = 1e-6f - LIMIT; } // fn");
        for part in [
            "<span class=\"a\">@compute</span>",
            "<span class=\"k\">fn</span> <span class=\"d\">main</span>(",
            "<span class=\"t\">vec3</span>&lt;<span class=\"t\">f32</span>&gt;",
            "<span class=\"t\">MyHit</span>",
            "<span class=\"n\">1e-6f</span> - LIMIT",
            "<span class=\"c\">// fn</span>",
        ] {
            assert!(html.contains(part), "{part} is not in {html}");
        }
    }

    #[test]
    fn a_nested_block_comment_ends_where_its_outermost_does() {
        let html = wgsl("/* a /* b */ c */ let");
        assert_eq!(html, "<span class=\"c\">/* a /* b */ c */</span> <span class=\"k\">let</span>");
    }

    #[test]
    fn nothing_of_the_source_becomes_markup() {
        assert!(!wgsl("// <script>alert(1)</script>").contains("<script"));
    }
}
