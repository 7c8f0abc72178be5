//! Limits of a user's file, checked before a compiler sees it: both naga and driver compilers
//! recurse as deeply as the text nests.

use lapidary_assay::tokens::tokens;
use lapidary_files::text_file;
use std::path::Path;

/// Largest size of a file in bytes; all modules of the cookbook together have a fifth of it.
const MOST_BYTES: u64 = 1 << 20;
/// Deepest nesting of brackets: what WGSL guarantees for the braces of a function (section 2.4,
/// limits).
const DEEPEST_BRACKETS: usize = 127;
/// Most operators, calls and `else` that may be chained or nested: far more than a person writes,
/// and safe for the stack.
const MOST_OPERATORS: usize = 2_000;

/// Returns the text of a user's file. An error is a single line with the file's name.
pub fn read(path: &Path) -> Result<String, String> {
    text_file::read(path, MOST_BYTES)
}

/// Checks that a text nests no deeper than compilers can handle. An error is a single line with
/// place and remedy.
pub fn check(path: &str, text: &str) -> Result<(), String> {
    // WGSL forbids it (section 3.2), and naga takes it for a blank.
    if let Some(before) = text.find('\0') {
        let line = 1 + text[..before].matches('\n').count();
        return Err(format!("{path}:{line}: holds a NUL character, which WGSL forbids; remove it"));
    }
    let tokens = tokens(text);
    // The number of operators so far at each level of brackets, and their sum.
    let mut levels = vec![0usize];
    let mut total = 0;
    for (index, token) in tokens.iter().enumerate() {
        // Whether the token ends the chain of its level, and how many links it adds.
        let (ends, links) = match token.text {
            "(" | "[" | "{" => {
                levels.push(0);
                (false, 0)
            }
            ")" | "]" | "}" => {
                if levels.len() > 1 {
                    total -= levels.pop().unwrap_or(0);
                }
                // A call, an index or a branch is a link; other braces end a statement.
                let ends = token.text == "}" && tokens.get(index + 1).is_none_or(|next| next.text != "else");
                (ends, usize::from(!ends))
            }
            "," | ";" => (true, 0),
            text => {
                (false, usize::from(text.len() == 1 && text.bytes().all(|c| c.is_ascii_punctuation() && c != b'_')))
            }
        };
        if let Some(level) = levels.last_mut() {
            if ends {
                total -= std::mem::take(level);
            }
            *level += links;
            total += links;
        }
        if levels.len() - 1 > DEEPEST_BRACKETS {
            return Err(format!(
                "{path}:{}: brackets lie over {DEEPEST_BRACKETS} deep inside one another; name the inner parts with `let`",
                token.line
            ));
        }
        if total > MOST_OPERATORS {
            return Err(format!(
                "{path}:{}: over {MOST_OPERATORS} operators in a row or inside one another; split them with `let`",
                token.line
            ));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_people_write_passes_and_what_overflows_does_not() {
        let sum = |terms: usize| format!("fn f(x: f32) -> f32 {{ return {}; }}", vec!["x"; terms].join(" + "));
        check("f", &sum(1500)).expect("a long sum");
        let error = check("f.wgsl", &sum(20_000)).expect_err("a chain");
        assert!(error.starts_with("f.wgsl:1: over 2000 operators in a row"), "{error}");
        let statements = format!("fn f(x: f32) -> f32 {{\n{}return x;\n}}", "    let y = x + x * x;\n".repeat(20_000));
        check("f", &statements).expect("many statements are no chain");
        let table = format!("const A = array<vec2f, 5000>({});", vec!["vec2f(1.0, -2.0)"; 5000].join(", "));
        check("f", &table).expect("a long list is no chain");
        let nested = |open: &str, close: &str, depth: usize| format!("{}x{}", open.repeat(depth), close.repeat(depth));
        for (open, close) in [("(", ")"), ("[", "]"), ("{", "}"), ("f(", ")")] {
            check("f", &nested(open, close, 127)).expect("as deep as WGSL promises");
            assert!(check("f", &nested(open, close, 128)).expect_err(open).contains("127 deep"));
        }
        for link in ["-", "!", "*", ".x", "[0]", "(x)", "array<", "else if (x) { }"] {
            let chain = format!("fn f() {{ if (x) {{ }} {} }}", link.repeat(20_000));
            assert!(check("f", &chain).is_err(), "{link}");
        }
        assert!(check("f.wgsl", "fn f() {\n\0}").expect_err("a NUL").starts_with("f.wgsl:2: holds a NUL"));
        // Unbalanced text is left for naga to reject.
        check("f", "}}}}))))]]]] ,;").expect("no nesting");
    }
}
