//! WGSL and Rust in colours: the source cut into pieces with classes for comments, keywords, types,
//! numbers, attributes and declared names. The pieces' texts in a row are the source, as the copy button
//! requires.

use lapidary_assay::tokens::{self, Kind};
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
    let (mut position, mut plain) = (0, 0);
    while position < source.len() {
        let (length, class) = token(&source[position..]);
        let text = &source[position..position + length];
        let class = match class {
            Some('i') if declares => Some('d'),
            Some('i') => word_class(text, language),
            other => other,
        };
        if !text.trim().is_empty() && class != Some('c') {
            declares = matches!(text, "fn" | "struct" | "const" | "override" | "alias" | "enum");
        }
        position += length;
        if class.is_some() {
            let start = position - length;
            if plain < start {
                pieces.push(Piece { class: None, text: &source[plain..start] });
            }
            pieces.push(Piece { class, text });
            plain = position;
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
    if let Some(rest) = text.strip_prefix('@') {
        let name = Some(rest).filter(|rest| !rest.is_empty()).map(tokens::first);
        return (1 + name.filter(|(_, kind)| *kind == Kind::Word).map_or(0, |(length, _)| length), Some('a'));
    }
    let (length, kind) = tokens::first(text);
    let class = match kind {
        Kind::Comment => Some('c'),
        Kind::Number => Some('n'),
        Kind::Word => Some('i'),
        Kind::Space | Kind::Punctuation => None,
    };
    (length, class)
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
