//! WGSL as tokens: with comments and white space, or without, and so independent of the layout of the text.
//! For questions that arise before naga may see a text, or for which naga keeps no names.

/// A token and its position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Token<'a> {
    /// An identifier, keyword or number, or one character of punctuation.
    pub text: &'a str,
    /// Line, from 1.
    pub line: u32,
}

/// What a stretch of text is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// White space.
    Space,
    /// A comment, to the end of the line or of the outermost block.
    Comment,
    /// A number with exponent and suffix: `0x1.8p-3f`, `1e-6f`, `12u`.
    Number,
    /// An identifier or keyword.
    Word,
    /// A character of punctuation.
    Punctuation,
}

/// Returns the length in bytes, at least 1, and the kind of what a text, which is not empty, begins with. The text need
/// not be valid; Rust's is read by the same rules.
pub fn first(text: &str) -> (usize, Kind) {
    let mut characters = text.chars();
    let first = characters.next().unwrap_or_default();
    let is_followed_by = |accept: fn(&char) -> bool| characters.clone().next().as_ref().is_some_and(accept);
    let run = |accept: fn(char) -> bool| text.find(|c: char| !accept(c)).unwrap_or(text.len());
    match first {
        '/' if is_followed_by(|next| *next == '/') => (text.find('\n').unwrap_or(text.len()), Kind::Comment),
        '/' if is_followed_by(|next| *next == '*') => (block_comment(text), Kind::Comment),
        '0'..='9' => (number(text), Kind::Number),
        '.' if is_followed_by(char::is_ascii_digit) => (number(text), Kind::Number),
        _ if first.is_whitespace() => (run(char::is_whitespace), Kind::Space),
        _ if is_word(first) => (run(is_word), Kind::Word),
        _ => (first.len_utf8(), Kind::Punctuation),
    }
}

fn is_word(letter: char) -> bool {
    letter.is_alphanumeric() || letter == '_'
}

/// Splits a source into tokens; it need not be valid.
pub fn tokens(source: &str) -> Vec<Token<'_>> {
    let mut tokens = Vec::new();
    let mut line = 1;
    let mut rest = source;
    while !rest.is_empty() {
        let (length, kind) = first(rest);
        let (text, left) = rest.split_at(length);
        if !matches!(kind, Kind::Space | Kind::Comment) {
            tokens.push(Token { text, line });
        }
        line += text.bytes().filter(|byte| *byte == b'\n').count() as u32;
        rest = left;
    }
    tokens
}

/// Returns the length of the comment at the start, including nested comments.
fn block_comment(text: &str) -> usize {
    let bytes = text.as_bytes();
    let (mut offset, mut depth) = (0, 0);
    while offset < bytes.len() {
        match bytes.get(offset..offset + 2) {
            Some(b"/*") => {
                depth += 1;
                offset += 2;
            }
            Some(b"*/") => {
                depth -= 1;
                offset += 2;
                if depth == 0 {
                    return offset;
                }
            }
            _ => offset += 1,
        }
    }
    bytes.len()
}

/// Returns the length of the number at the start; the sign of an exponent belongs to it.
fn number(text: &str) -> usize {
    let exponent: &[u8] = if text.starts_with("0x") || text.starts_with("0X") { b"pP" } else { b"eE" };
    let bytes = text.as_bytes();
    let belongs = |offset: usize| {
        bytes[offset].is_ascii_alphanumeric()
            || bytes[offset] == b'.'
            || (matches!(bytes[offset], b'+' | b'-') && exponent.contains(&bytes[offset - 1]))
    };
    1 + (1..bytes.len()).take_while(|offset| belongs(*offset)).count()
}

/// A declaration at module scope.
#[derive(Clone, Debug)]
pub struct Item<'a> {
    /// Keyword: `fn`, `struct`, `const` and so on.
    pub kind: &'a str,
    /// Declared name.
    pub name: &'a str,
    /// Line of the keyword, from 1.
    pub line: u32,
    /// All tokens, including attributes.
    pub tokens: Vec<Token<'a>>,
}

/// Returns the named declarations of a source, in order.
pub fn items<'a>(tokens: &[Token<'a>]) -> Vec<Item<'a>> {
    let mut items = Vec::new();
    let (mut start, mut depth) = (0, 0usize);
    for (index, token) in tokens.iter().enumerate() {
        let ends = match token.text {
            "(" | "[" | "{" => {
                depth += 1;
                false
            }
            ")" | "]" => {
                depth = depth.saturating_sub(1);
                false
            }
            "}" => {
                depth = depth.saturating_sub(1);
                depth == 0
            }
            ";" => depth == 0,
            _ => false,
        };
        if ends {
            items.extend(item(&tokens[start..=index]));
            start = index + 1;
        }
    }
    items
}

fn item<'a>(tokens: &[Token<'a>]) -> Option<Item<'a>> {
    const KEYWORDS: [&str; 6] = ["fn", "struct", "const", "override", "var", "alias"];
    // An attribute may hold anything but a keyword.
    let start = tokens.iter().position(|token| KEYWORDS.contains(&token.text))?;
    let keyword = tokens[start];
    let mut after = start + 1;
    if keyword.text == "var" && tokens.get(after).is_some_and(|token| token.text == "<") {
        after += tokens[after..].iter().position(|token| token.text == ">")? + 1;
    }
    let name = tokens.get(after)?.text;
    Some(Item { kind: keyword.text, name, line: keyword.line, tokens: tokens.to_vec() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(source: &str) -> Vec<&str> {
        tokens(source).iter().map(|token| token.text).collect()
    }

    #[test]
    fn layout_and_comments_leave_no_token() {
        let plain = texts("fn f(x:f32)->f32{return x-1e-5f*.5f+0x1p-3f-0xeu;}");
        let laid_out =
            "// a\r\nfn f /* b /* c */ d */ (x : f32)\n\n -> f32 {\n\treturn x - 1e-5f * .5f + 0x1p-3f - 0xeu; }//";
        assert_eq!(texts(laid_out), plain);
        assert!(plain.contains(&"1e-5f") && plain.contains(&".5f") && plain.contains(&"0x1p-3f"), "{plain:?}");
        assert_eq!(texts("0xe-1u"), ["0xe", "-", "1u"]);
        // Tokenizing ends, whatever the file holds.
        assert_eq!(texts("/* open"), [""; 0]);
        assert_eq!(texts("é€ \u{0}"), ["é", "€", "\u{0}"]);
    }

    #[test]
    fn items_are_named_with_their_lines() {
        let source = "enable f16;\nconst A: f32 = 1.0f;\n@must_use\nfn\nb\n(x: f32) -> f32 { if (x > A) { return x; } return A; }\n\
            struct C { d: f32, };\n@group(0) @binding(1) var<storage, read> e: array<f32>;\nalias F = f32;";
        let tokens = tokens(source);
        let found: Vec<(&str, &str, u32)> =
            items(&tokens).iter().map(|item| (item.kind, item.name, item.line)).collect();
        let wanted = [("const", "A", 2), ("fn", "b", 4), ("struct", "C", 7), ("var", "e", 8), ("alias", "F", 9)];
        assert_eq!(found, wanted);
    }
}
