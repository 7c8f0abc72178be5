//! Text in a language of C's family as items: what naga's writers write.

/// What an item declares.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A structure.
    Struct,
    /// A function.
    Function,
    /// A type's other name.
    Alias,
    /// A constant, a variable or a binding.
    Variable,
    /// A directive or a statement without a name.
    Other,
}

/// Lines at the level of the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Item {
    /// What it declares.
    pub kind: Kind,
    /// The declared name; empty if there is none.
    pub name: String,
    /// Its lines.
    pub text: String,
}

/// Splits a text into items. Comments at the level of the text are dropped; empty lines separate.
pub fn items(text: &str) -> Vec<Item> {
    let (mut items, mut open, mut depth) = (Vec::new(), String::new(), 0i32);
    for line in text.lines() {
        let is_outside = depth == 0 && open.is_empty();
        if is_outside && (line.trim().is_empty() || line.starts_with("//")) {
            continue;
        }
        if is_outside && line.starts_with('#') {
            items.push(Item { kind: Kind::Other, name: String::new(), text: line.to_owned() });
            continue;
        }
        open.push_str(line);
        open.push('\n');
        for character in line.chars() {
            depth += match character {
                '{' | '(' => 1,
                '}' | ')' => -1,
                _ => 0,
            };
        }
        if depth == 0 && line.trim_end().ends_with([';', '}']) {
            items.push(item(std::mem::take(&mut open)));
        }
    }
    if !open.trim().is_empty() {
        items.push(item(open));
    }
    items
}

/// Returns the item that a text declares.
fn item(text: String) -> Item {
    let text = text.trim_end().to_owned();
    // The attributes of a kernel stand on a line of their own.
    let code: Vec<&str> = text.lines().filter(|line| !(line.starts_with('[') && line.ends_with(']'))).collect();
    let code = code.join(" ");
    let before = |ends: &[char]| {
        let end = code.find(ends).unwrap_or(code.len());
        code[..end].rsplit(|c: char| !is_word(c)).find(|word| !word.is_empty()).unwrap_or_default().to_owned()
    };
    // A register stands behind a colon.
    let value = [" = ", " : "].iter().filter_map(|sign| code.find(sign)).min().unwrap_or(code.len());
    let is_called = code.find('(').is_some_and(|place| place < value);
    let (kind, name) = if let Some(rest) = code.strip_prefix("struct ") {
        (Kind::Struct, rest.split(|c: char| !is_word(c)).next().unwrap_or_default().to_owned())
    } else if code.starts_with("typedef ") {
        (Kind::Alias, before(&['[', ';']))
    } else if code.starts_with("using ") || code.starts_with("precision ") || code.starts_with("layout(local_size") {
        (Kind::Other, String::new())
    } else if let Some(rest) = code.strip_prefix("cbuffer ") {
        (Kind::Variable, rest.split(|c: char| !is_word(c)).next().unwrap_or_default().to_owned())
    } else if ["layout", "uniform ", "buffer "].iter().any(|start| code.starts_with(start)) {
        // A block's only member, or the texture.
        let mut words =
            code.split(|c: char| !is_word(c)).filter(|word| word.starts_with(|c: char| !c.is_ascii_digit()));
        (Kind::Variable, words.next_back().unwrap_or_default().to_owned())
    } else if is_called {
        (Kind::Function, before(&['(']))
    } else {
        let name = &code[..value];
        let name = name.split(['[', ';']).next().unwrap_or_default();
        (
            Kind::Variable,
            name.rsplit(|c: char| !is_word(c)).find(|word| !word.is_empty()).unwrap_or_default().to_owned(),
        )
    };
    Item { kind, name, text }
}

/// A part of code: an identifier, with whether it is a member or in a namespace, or anything else.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Token<'a> {
    /// An identifier that names something in the text.
    Name(&'a str),
    /// An identifier after a point or `::`, a number, a comment or anything else.
    Other(&'a str),
}

impl<'a> Token<'a> {
    /// Returns the text.
    pub fn text(self) -> &'a str {
        match self {
            Self::Name(text) | Self::Other(text) => text,
        }
    }
}

/// Splits code into tokens, which give the text again when joined.
pub fn tokens(text: &str) -> Vec<Token<'_>> {
    let mut tokens: Vec<Token<'_>> = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if is_word(first) {
            // A number's point and exponent belong to it.
            let is_number = first.is_ascii_digit();
            let ends = |c: char| !(is_word(c) || (is_number && c == '.'));
            rest.find(ends).unwrap_or(rest.len())
        } else {
            first.len_utf8()
        };
        let (token, left) = rest.split_at(length);
        let is_name = is_word(first) && !first.is_ascii_digit();
        let before: Vec<&str> = tokens.iter().rev().map(|token| token.text()).take(2).collect();
        let is_part = matches!(before.as_slice(), [".", ..] | [":", ":"]);
        tokens.push(if is_name && !is_part { Token::Name(token) } else { Token::Other(token) });
        rest = left;
    }
    tokens
}

fn is_word(character: char) -> bool {
    character.is_ascii_alphanumeric() || character == '_'
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_falls_into_items() {
        let text = "\
#include <metal_stdlib>
using metal::uint;

struct Hit {
    float at;
};
typedef float4 ret_Constructarray2_float4_[2];
static const float HALF = 0.5;
const vec2 PAIR[2] = vec2[2](vec2(1.0), vec2(2.0));
Texture2D<float4> map : register(t1);
[numthreads(64, 1, 1)]
void main(uint3 at : SV_DispatchThreadID)
{

}
metal::float3 turn(
    metal::float3 vector,
    uint axis
) {
    return vector;
}
layout(std140, binding = 0) uniform View_block { View view; };
";
        let found: Vec<(Kind, String)> = items(text).into_iter().map(|item| (item.kind, item.name)).collect();
        let expected = [
            (Kind::Other, ""),
            (Kind::Other, ""),
            (Kind::Struct, "Hit"),
            (Kind::Alias, "ret_Constructarray2_float4_"),
            (Kind::Variable, "HALF"),
            (Kind::Variable, "PAIR"),
            (Kind::Variable, "map"),
            (Kind::Function, "main"),
            (Kind::Function, "turn"),
            (Kind::Variable, "view"),
        ];
        assert_eq!(found, expected.map(|(kind, name)| (kind, name.to_owned())));
    }

    #[test]
    fn members_numbers_and_comments_are_no_names() {
        let names = |text| -> Vec<&str> {
            let found = tokens(text);
            assert_eq!(found.iter().map(|token| token.text()).collect::<String>(), text);
            found
                .into_iter()
                .filter_map(|token| if let Token::Name(name) = token { Some(name) } else { None })
                .collect()
        };
        assert_eq!(names("float x_1 = hit.at + 1.0e5 * y; // z"), ["float", "x_1", "hit", "y"]);
        assert_eq!(names("metal::float3 a = 0x3fu;"), ["metal", "a"]);
    }
}
