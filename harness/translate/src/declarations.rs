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

    /// Whether it is one of these functions.
    #[must_use]
    pub fn is_function_of(&self, names: &[&str]) -> bool {
        let mut named = self.lines.iter().filter_map(|line| words(line.strip_prefix("fn ")?).next());
        named.any(|name| names.contains(&name))
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
    let mut left: Vec<usize> = (0..declarations.len()).filter(|index| taken[*index]).collect();
    while let Some(index) = left.pop() {
        let local_names = locals(&declarations[index]);
        let used = declarations[index].lines.iter().flat_map(|line| used(without_comment(line)));
        names.extend(used.filter(|word| !local_names.contains(word)));
        for (other, declaration) in declarations.iter().enumerate() {
            if !taken[other] && declaration.name.is_some_and(|name| names.contains(name)) {
                taken[other] = true;
                left.push(other);
            }
        }
    }
    taken
}

/// Returns the words of a line but those after a `.`, which name members.
fn used(code: &str) -> impl Iterator<Item = &str> {
    let is_word = |character: char| character.is_ascii_alphanumeric() || character == '_';
    let paths = code.split(move |character: char| !is_word(character) && character != '.');
    paths.filter_map(|path| path.split('.').next()).filter(|word| !word.is_empty())
}

/// Returns the names of a function's parameters and variables, which hide what the module calls so, and
/// those of a struct's members.
fn locals<'a>(declaration: &Declaration<'a>) -> HashSet<&'a str> {
    let code: Vec<&str> = declaration.lines.iter().map(|line| without_comment(line)).collect();
    let is_head = |line: &&str| ["fn ", "struct "].iter().any(|start| line.starts_with(start));
    let Some(first) = code.iter().position(is_head) else { return HashSet::new() };
    let mut locals = HashSet::new();
    let is_struct = code[first].starts_with("struct ");
    let mut is_head = true;
    for line in &code[first..] {
        if is_head {
            // `name: type`, but for attributes such as `@location(0)`.
            locals.extend(line.split(':').rev().skip(1).filter_map(|before| words(before).last()));
        }
        is_head &= is_struct || !line.trim_end().ends_with('{');
        let mut words = words(line);
        while let Some(word) = words.next() {
            if ["let", "var", "const"].contains(&word) {
                locals.extend(words.next());
            }
        }
    }
    locals
}

/// Returns the text of those declarations that are needed. A comment with a licence heads what follows up to
/// the next, and goes if nothing of that is left; the last one stays. Several empty lines become one.
#[must_use]
pub fn text_of(declarations: &[Declaration<'_>], needed: &[bool]) -> String {
    let headers: Vec<usize> = (0..declarations.len()).filter(|index| declarations[*index].is_header()).collect();
    let is_left = |header: usize| {
        let end = headers.iter().copied().find(|next| *next > header).unwrap_or(declarations.len());
        end == declarations.len() || (header..end).any(|index| needed[index] && declarations[index].name.is_some())
    };
    let mut text = String::new();
    for (index, declaration) in declarations.iter().enumerate() {
        let is_kept = match declaration.name {
            Some(_) => needed[index],
            None => !headers.contains(&index) || is_left(index),
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

/// Returns the text without the declarations that neither entry points nor these functions reach; all of it if
/// there is no entry point.
#[must_use]
pub fn reached_text(lines: &[&str], wanted: &[&str]) -> String {
    let declarations = declarations(lines);
    let has_entry = declarations.iter().any(|declaration| declaration.is_entry);
    let is_root =
        |declaration: &Declaration<'_>| declaration.is_entry || !has_entry || declaration.is_function_of(wanted);
    text_of(&declarations, &reached(&declarations, is_root))
}

/// Returns the names of a text's functions, entry points among them.
#[must_use]
pub fn functions(source: &str) -> Vec<&str> {
    source.lines().filter_map(|line| words(line.strip_prefix("fn ")?).next()).collect()
}

/// Returns the text with these functions and entry points and what they need; `None` if it lacks one of
/// them. The line of the version goes: it is that of the whole text.
#[must_use]
pub fn of_functions(source: &str, wanted: &[&str]) -> Option<String> {
    let known = functions(source);
    if !wanted.iter().all(|function| known.contains(function)) {
        return None;
    }
    let lines: Vec<&str> = source.lines().filter(|line| !line.starts_with("// Version:")).collect();
    let declarations = declarations(&lines);
    let needed = reached(&declarations, |declaration| declaration.is_function_of(wanted));
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
    let code = if code.starts_with('@') { &code[code.find(" var").map_or(code.len(), |gap| gap + 1)..] } else { code };
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
        assert_eq!(of_functions(TEXT, &["halved"]).as_deref(), Some(expected));
        let hit = of_functions(TEXT, &["hit"]).expect("a function");
        assert!(hit.contains("struct Hit") && !hit.contains("HALF"), "{hit}");
        let both = of_functions(TEXT, &["hit", "halved"]).expect("two functions");
        assert!(both.contains("struct Hit") && both.contains("HALF") && !both.contains("main"), "{both}");
        assert_eq!(of_functions(TEXT, &["halved", "Hit"]), None);
        // A local hides what the module calls so.
        let hiding = format!("{TEXT}\nfn hiding(hit: f32) -> f32 {{\n    let HALF = hit;\n    return HALF;\n}}\n");
        let text = of_functions(&hiding, &["hiding"]).expect("a function");
        assert!(!text.contains("const HALF") && !text.contains("fn hit("), "{text}");
    }
}
