//! WGSL as tokens, without comments and white space, and so independent of the layout of the text.
//! For questions that arise before naga may see a text, or for which naga keeps no names.

/// A token and its position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Token<'a> {
    /// An identifier, keyword or number, or one character of punctuation.
    pub text: &'a str,
    /// Line, from 1.
    pub line: u32,
}

/// Splits a source into tokens; it need not be valid.
pub fn tokens(source: &str) -> Vec<Token<'_>> {
    let mut tokens = Vec::new();
    let mut line = 1;
    let mut rest = source;
    while let Some(first) = rest.chars().next() {
        let length = if first.is_whitespace() {
            first.len_utf8()
        } else if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            block_comment(rest)
        } else {
            let length = token_length(rest, first);
            tokens.push(Token { text: &rest[..length], line });
            length
        };
        let (passed, left) = rest.split_at(length);
        line += passed.bytes().filter(|byte| *byte == b'\n').count() as u32;
        rest = left;
    }
    tokens
}

/// Returns the length of the comment at the start, including nested comments.
fn block_comment(text: &str) -> usize {
    let bytes = text.as_bytes();
    let (mut at, mut depth) = (0, 0);
    while at < bytes.len() {
        match bytes.get(at..at + 2) {
            Some(b"/*") => {
                depth += 1;
                at += 2;
            }
            Some(b"*/") => {
                depth -= 1;
                at += 2;
                if depth == 0 {
                    return at;
                }
            }
            _ => at += 1,
        }
    }
    bytes.len()
}

fn token_length(text: &str, first: char) -> usize {
    let word = |c: char| c.is_alphanumeric() || c == '_';
    if first.is_ascii_digit() || (first == '.' && text[1..].starts_with(|c: char| c.is_ascii_digit())) {
        // The sign of an exponent belongs to the number.
        let exponent: &[u8] = if text.starts_with("0x") || text.starts_with("0X") { b"pP" } else { b"eE" };
        let bytes = text.as_bytes();
        let belongs = |at: usize| {
            bytes[at].is_ascii_alphanumeric()
                || bytes[at] == b'.'
                || (matches!(bytes[at], b'+' | b'-') && exponent.contains(&bytes[at - 1]))
        };
        return 1 + (1..bytes.len()).take_while(|at| belongs(*at)).count();
    }
    if word(first) {
        return text.find(|c: char| !word(c)).unwrap_or(text.len());
    }
    first.len_utf8()
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
    let at = tokens.iter().position(|token| KEYWORDS.contains(&token.text))?;
    let keyword = tokens[at];
    let mut after = at + 1;
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
