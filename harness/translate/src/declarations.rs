//! WGSL text as declarations with their comments.

use std::collections::HashSet;

/// Lines of a text at the level of the module: a declaration with its comments and attributes, or
/// anything else.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Declaration<'a> {
    /// The lines, comments first.
    pub lines: Vec<&'a str>,
    /// The declared name; `None` for comments that stand alone and for empty lines.
    pub name: Option<&'a str>,
    /// Whether it is an entry point.
    pub is_entry: bool,
}

impl<'a> Declaration<'a> {
    /// Returns the comment above the declaration, or the whole comment if nothing is declared.
    #[must_use]
    pub fn comment(&self) -> &[&'a str] {
        let length = self.lines.iter().take_while(|line| line.starts_with("//")).count();
        &self.lines[..length]
    }

    /// Whether it is a comment with a licence, which heads what follows.
    #[must_use]
    pub fn is_header(&self) -> bool {
        self.name.is_none() && self.lines.iter().any(|line| line.starts_with("// SPDX-License-Identifier:"))
    }
}

/// Splits a text into declarations. The text must be formatted: a declaration begins at the start of
/// a line, and ends with a line that begins with `}`, or, without a body, with `;`.
#[must_use]
pub fn declarations<'a>(lines: &[&'a str]) -> Vec<Declaration<'a>> {
    let mut declarations: Vec<Declaration<'a>> = Vec::new();
    let mut next = Declaration::default();
    let mut is_open = false;
    for &line in lines {
        let code = without_comment(line).trim_end();
        if line.trim().is_empty() && !is_open {
            declarations.push(std::mem::take(&mut next));
            declarations.push(Declaration { lines: vec![line], ..Declaration::default() });
            continue;
        }
        next.lines.push(line);
        next.is_entry |= !is_open && ["@vertex", "@fragment", "@compute"].iter().any(|stage| code.starts_with(stage));
        if !is_open && let Some(name) = declared(code) {
            (next.name, is_open) = (Some(name), true);
        }
        let has_body = next.lines.iter().any(|line| ["fn ", "struct "].iter().any(|start| line.starts_with(start)));
        if is_open && (if has_body { code.starts_with('}') } else { code.ends_with(';') }) {
            is_open = false;
            declarations.push(std::mem::take(&mut next));
        }
    }
    declarations.push(next);
    declarations
}

/// Returns which declarations are needed by those for which `is_root` holds, these included.
pub fn reached(declarations: &[Declaration<'_>], is_root: impl Fn(&Declaration<'_>) -> bool) -> Vec<bool> {
    let mut names: HashSet<&str> = HashSet::new();
    let mut taken: Vec<bool> = declarations.iter().map(is_root).collect();
    let mut left: Vec<usize> = (0..declarations.len()).filter(|at| taken[*at]).collect();
    while let Some(at) = left.pop() {
        names.extend(declarations[at].lines.iter().flat_map(|line| words(without_comment(line))));
        for (other, declaration) in declarations.iter().enumerate() {
            if !taken[other] && declaration.name.is_some_and(|name| names.contains(name)) {
                taken[other] = true;
                left.push(other);
            }
        }
    }
    taken
}

/// Returns the text of those declarations that are needed. A comment with a licence heads what follows up to
/// the next, and goes if nothing of that is left; the last one stays. Several empty lines become one.
#[must_use]
pub fn text_of(declarations: &[Declaration<'_>], needed: &[bool]) -> String {
    let headers: Vec<usize> = (0..declarations.len()).filter(|at| declarations[*at].is_header()).collect();
    let is_left = |header: usize| {
        let end = headers.iter().copied().find(|next| *next > header).unwrap_or(declarations.len());
        end == declarations.len() || (header..end).any(|at| needed[at] && declarations[at].name.is_some())
    };
    let mut text = String::new();
    for (at, declaration) in declarations.iter().enumerate() {
        let is_kept = match declaration.name {
            Some(_) => needed[at],
            None => !headers.contains(&at) || is_left(at),
        };
        for line in declaration.lines.iter().filter(|_| is_kept) {
            if !line.trim().is_empty() || !(text.is_empty() || text.ends_with("\n\n")) {
                text.push_str(line);
                text.push('\n');
            }
        }
    }
    text
}

/// Returns the text with one function or entry point and what it needs; `None` if it has no such
/// function. The line of the version goes: it is that of the whole text.
#[must_use]
pub fn of_function(source: &str, function: &str) -> Option<String> {
    let lines: Vec<&str> = source.lines().filter(|line| !line.starts_with("// Version:")).collect();
    let declarations = declarations(&lines);
    let is_function = |line: &&str| line.strip_prefix("fn ").is_some_and(|rest| words(rest).next() == Some(function));
    let is_root = |declaration: &Declaration<'_>| declaration.lines.iter().any(is_function);
    declarations.iter().find(|declaration| is_root(declaration))?;
    let needed = reached(&declarations, is_root);
    Some(text_of(&declarations, &needed).trim_end().to_owned() + "\n")
}

/// Returns the identifiers and numbers of a line of code.
pub fn words(code: &str) -> impl Iterator<Item = &str> {
    code.split(|character: char| !character.is_ascii_alphanumeric() && character != '_').filter(|word| !word.is_empty())
}

/// Returns a line without its comment.
#[must_use]
pub fn without_comment(line: &str) -> &str {
    line.split("//").next().unwrap_or_default()
}

/// Returns the name that a line at the level of the module declares.
fn declared(code: &str) -> Option<&str> {
    // Attributes such as `@group(1) @binding(0)` stand before a variable.
    let code = if code.starts_with('@') { &code[code.find(" var").map_or(code.len(), |at| at + 1)..] } else { code };
    let keyword = code.split([' ', '<']).next()?;
    let rest = match keyword {
        "fn" | "struct" | "const" | "override" | "alias" => &code[keyword.len()..],
        "var" if code.starts_with("var<") => code.split_once('>')?.1,
        "var" => &code[keyword.len()..],
        _ => return None,
    };
    words(rest).next()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "\
// A module.
// Licence.

// Half.
const HALF: f32 = 0.5f;

struct Hit {
    // How far.
    at: f32,
}

// Halves.
fn halved(
    x: f32,
) -> f32 {
    return HALF * x;
}

fn hit(x: f32) -> Hit {
    return Hit(x);
}

@compute @workgroup_size(1)
fn main() {
    _ = halved(1.0f);
}
";

    #[test]
    fn a_text_falls_into_its_declarations() {
        let lines: Vec<&str> = TEXT.lines().collect();
        let found = declarations(&lines);
        let named: Vec<(&str, usize, bool)> =
            found.iter().filter_map(|found| Some((found.name?, found.comment().len(), found.is_entry))).collect();
        let expected =
            [("HALF", 1, false), ("Hit", 0, false), ("halved", 1, false), ("hit", 0, false), ("main", 0, true)];
        assert_eq!(named, expected);
        assert_eq!(found[0].comment(), ["// A module.", "// Licence."]);
        let together: Vec<&str> = found.iter().flat_map(|declaration| declaration.lines.clone()).collect();
        assert_eq!(together, lines);
    }

    #[test]
    fn a_function_comes_with_what_it_needs() {
        let expected = "// A module.\n// Licence.\n\n// Half.\nconst HALF: f32 = 0.5f;\n\n// Halves.\nfn halved(\n    x: f32,\n) -> f32 {\n    return HALF * x;\n}\n";
        assert_eq!(of_function(TEXT, "halved").as_deref(), Some(expected));
        assert!(of_function(TEXT, "hit").is_some_and(|text| text.contains("struct Hit") && !text.contains("HALF")));
        assert_eq!(of_function(TEXT, "Hit"), None);
    }
}
