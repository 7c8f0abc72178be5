//! Operators that WGSL's grammar does not allow to be mixed, although naga accepts it: other
//! compilers, including Chromium's, refuse `a | b << c` without parentheses.

use std::mem::take;

/// Kind of an operator between two operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Arithmetic,
    Shift,
    Bitwise,
    Relational,
    ShortCircuit,
}

/// Longer operators first.
const OPERATORS: [(&str, Kind); 18] = [
    ("<<", Kind::Shift),
    (">>", Kind::Shift),
    ("&&", Kind::ShortCircuit),
    ("||", Kind::ShortCircuit),
    ("==", Kind::Relational),
    ("!=", Kind::Relational),
    ("<=", Kind::Relational),
    (">=", Kind::Relational),
    ("&", Kind::Bitwise),
    ("|", Kind::Bitwise),
    ("^", Kind::Bitwise),
    ("<", Kind::Relational),
    (">", Kind::Relational),
    ("+", Kind::Arithmetic),
    ("-", Kind::Arithmetic),
    ("*", Kind::Arithmetic),
    ("/", Kind::Arithmetic),
    ("%", Kind::Arithmetic),
];

/// Keywords after which a sign is a unary operator.
const KEYWORDS: [&str; 6] = ["return", "if", "while", "case", "else", "switch"];
/// Names whose following angle brackets are not comparisons.
const TEMPLATES: [&str; 6] = ["array", "atomic", "bitcast", "ptr", "var", "texture_storage_2d"];

/// Returns the lines, from 1, on which operators are mixed that need parentheses, each with the
/// operators.
pub fn mixed_operators(source: &str) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    // Operators within the open brackets, one list per level.
    let mut levels: Vec<Vec<(&str, Kind)>> = vec![Vec::new()];
    for (line, text) in (1..).zip(source.lines()) {
        let mut rest = text.split("//").next().unwrap_or_default();
        let mut after_operand = false;
        let mut end = |operators: Vec<(&str, Kind)>| {
            if !are_compatible(&operators) {
                let names: Vec<&str> = operators.iter().map(|(name, _)| *name).collect();
                found.push((line, names.join(" ")));
            }
        };
        while let Some(first) = rest.chars().next() {
            let word = rest.len() - rest.trim_start_matches(|c: char| c.is_alphanumeric() || "_.@".contains(c)).len();
            let current = levels.last_mut();
            if word > 0 {
                let name = &rest[..word];
                rest = &rest[word..];
                after_operand = !KEYWORDS.contains(&name);
                if TEMPLATES.contains(&name) && rest.starts_with('<') {
                    rest = rest.find('>').map_or("", |close| &rest[close + 1..]);
                }
                continue;
            }
            let assigns = ["<<=", ">>=", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "->"];
            if let Some(sign) = assigns.into_iter().find(|sign| rest.starts_with(sign)) {
                current.map(take).map(&mut end);
                (rest, after_operand) = (&rest[sign.len()..], false);
                continue;
            }
            let operator = OPERATORS.into_iter().find(|(name, _)| rest.starts_with(name));
            if let Some((name, kind)) = operator {
                if let Some(operators) = current.filter(|_| after_operand) {
                    operators.push((name, kind));
                }
                (rest, after_operand) = (&rest[name.len()..], false);
                continue;
            }
            match first {
                '(' | '[' | '{' => {
                    if first == '{' {
                        current.map(take).map(&mut end);
                    }
                    levels.push(Vec::new());
                    after_operand = false;
                }
                ')' | ']' | '}' => {
                    levels.pop().map(&mut end);
                    after_operand = true;
                }
                ',' | ';' | '=' | ':' => {
                    current.map(take).map(&mut end);
                    after_operand = false;
                }
                _ => {}
            }
            rest = &rest[first.len_utf8()..];
        }
    }
    found
}

/// Whether the grammar allows these operators together: bitwise operators only with themselves,
/// shifts not with arithmetic or with another shift, && not with ||.
fn are_compatible(operators: &[(&str, Kind)]) -> bool {
    let has = |kind: Kind| operators.iter().any(|(_, other)| *other == kind);
    let of = |kind: Kind| operators.iter().filter(move |(_, other)| *other == kind).map(|(name, _)| *name);
    let one_of = |kind: Kind| of(kind).all(|name| of(kind).next() == Some(name));
    let bitwise =
        !has(Kind::Bitwise) || (operators.iter().all(|(_, kind)| *kind == Kind::Bitwise) && one_of(Kind::Bitwise));
    let shifts = !has(Kind::Shift) || !has(Kind::Arithmetic) && (of(Kind::Shift).count() == 1 || has(Kind::Relational));
    bitwise && shifts && one_of(Kind::ShortCircuit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_grammar_keeps_apart_is_found() {
        for statement in [
            "let x = a | b << 16u;",
            "let x = (bits >> (max(place, 1u) - 1u) & 7u) != 0u;",
            "let x = a & b | c;",
            "let x = a + b << 2u;",
            "let x = a << 2u << 3u;",
            "let x = a ^ b * c;",
            "if a & 1u == 0u {",
            "let x = a && b || c;",
            "return f(a, b | c + d);",
            "x |= y & bitcast<u32>(z) + 1u;",
        ] {
            assert_eq!(mixed_operators(&format!("\n{statement}\n")).len(), 1, "{statement}");
        }
        let lines = "let x = f(\n    a | b << 16u,\n    c,\n);";
        assert_eq!(mixed_operators(lines), [(2, "| <<".to_owned())]);
    }

    #[test]
    fn what_the_grammar_allows_is_not_found() {
        for statement in [
            "let x = a | (b << 16u);",
            "let x = a | b | c;",
            "let x = ((a >> 3u) & 1u) != 0u;",
            "let x = a < b && c > d && -e < f;",
            "let x = vec2u(a | b, c + d);",
            "let x = a[b + 1u] & 3u;",
            "x &= a + b;",
            "if ((a & b) == 0u) {",
            "var<storage, read> words: array<u32>; // a | b << c",
            "let x = bitcast<u32>(y) & 7u;",
            "f(&x, &y);",
            "let x = a << 1u < b << 2u;",
            "for (var z = 0u; z < 3u; z++) { x += z * 2u; }",
            "return -a;",
        ] {
            assert_eq!(mixed_operators(statement), [], "{statement}");
        }
    }
}
