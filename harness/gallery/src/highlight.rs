//! WGSL and Rust in colours: the source cut into pieces with classes for comments, keywords, types,
//! numbers, attributes and declared names. The pieces' texts in a row are the source, as the copy button
//! requires.

use serde::Serialize;

/// The language of a source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    /// WGSL.
    Wgsl,
    /// Rust.
    Rust,
}

/// A piece of a source. Classes: `c` comment, `k` keyword, `t` type, `n` number, `a` attribute, `d` name of a
/// declared function, struct or constant.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Piece<'a> {
    /// The class, if the text has a colour of its own.
    pub class: Option<char>,
    /// The text.
    pub text: &'a str,
}

const WGSL_KEYWORDS: &[&str] = &[
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

const RUST_KEYWORDS: &[&str] = &[
    "as", "break", "const", "continue", "else", "enum", "false", "fn", "for", "if", "impl", "in", "let", "loop",
    "match", "mod", "mut", "pub", "return", "self", "static", "struct", "true", "type", "use", "while",
];

/// Built-in types; matrices and vectors are recognised by their first letters, structs by their
/// capital.
const TYPES: [&str; 10] =
    ["array", "atomic", "bool", "f16", "f32", "i32", "ptr", "sampler", "sampler_comparison", "u32"];

/// Cuts a source into pieces; neighbours without a colour are one.
pub fn pieces(source: &str, language: Language) -> Vec<Piece<'_>> {
    let mut pieces = Vec::new();
    let mut declares = false;
    let (mut at, mut plain) = (0, 0);
    while at < source.len() {
        let (length, class) = token(&source[at..]);
        let text = &source[at..at + length];
        let class = match class {
            Some('i') if declares => Some('d'),
            Some('i') => word_class(text, language),
            other => other,
        };
        if !text.trim().is_empty() && class != Some('c') {
            declares = matches!(text, "fn" | "struct" | "const" | "override" | "alias" | "enum");
        }
        at += length;
        if class.is_some() {
            let start = at - length;
            if plain < start {
                pieces.push(Piece { class: None, text: &source[plain..start] });
            }
            pieces.push(Piece { class, text });
            plain = at;
        }
    }
    if plain < source.len() {
        pieces.push(Piece { class: None, text: &source[plain..] });
    }
    pieces
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

fn word_class(word: &str, language: Language) -> Option<char> {
    let keywords = match language {
        Language::Wgsl => WGSL_KEYWORDS,
        Language::Rust => RUST_KEYWORDS,
    };
    let shaped =
        |prefix: &str| word.strip_prefix(prefix).is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()));
    let built_in = TYPES.contains(&word) || shaped("vec") || shaped("mat") || word.starts_with("texture_");
    // A name that starts with a capital is a struct's, unless it is all capitals: then it is a
    // constant's.
    let structure = word.starts_with(char::is_uppercase) && word.contains(char::is_lowercase);
    if keywords.contains(&word) {
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

    /// Returns the classes and texts of what has a colour.
    fn coloured(source: &str, language: Language) -> Vec<(char, &str)> {
        pieces(source, language).into_iter().filter_map(|piece| Some((piece.class?, piece.text))).collect()
    }

    #[test]
    fn the_pieces_in_a_row_are_the_source() {
        let odd =
            "/* a /* nested */ b */ fn f(a: ptr<function, vec3f>) -> f32 { return *a.x & 0x1.8p-3f; } // λ² <b>&amp;";
        let mut sources = vec![odd, "", "\n\n", "/* open", "/", "@", "1e", "a\r\n", "é_ü1 + .5f", "\"quote\" 'q'"];
        sources.extend(lapidary_cookbook::modules().iter().map(|module| module.source));
        for source in sources {
            for language in [Language::Wgsl, Language::Rust] {
                let text: String = pieces(source, language).iter().map(|piece| piece.text).collect();
                assert_eq!(text, source);
            }
        }
    }

    #[test]
    fn classes_are_told_apart() {
        let source = "@compute fn main(x: vec3<f32>, y: MyHit) { let z = 1e-6f - LIMIT; } // fn";
        let expected = [
            ('a', "@compute"),
            ('k', "fn"),
            ('d', "main"),
            ('t', "vec3"),
            ('t', "f32"),
            ('t', "MyHit"),
            ('k', "let"),
            ('n', "1e-6f"),
            ('c', "// fn"),
        ];
        assert_eq!(coloured(source, Language::Wgsl), expected);
        assert_eq!(coloured("pub fn f(mut a: Vec3)", Language::Rust)[..3], [('k', "pub"), ('k', "fn"), ('d', "f")]);
        assert_eq!(coloured("pub mut", Language::Wgsl), []);
    }

    #[test]
    fn a_nested_block_comment_ends_where_its_outermost_does() {
        assert_eq!(coloured("/* a /* b */ c */ let", Language::Wgsl), [('c', "/* a /* b */ c */"), ('k', "let")]);
    }
}
