//! A module's functions in WGSL beside their mirrors in Rust, line by line.

use super::highlight::{self, Language, Piece};
use lapidary_cookbook::Module;
use serde::Serialize;
use std::fs;
use std::path::Path;

/// A function in both languages; the lines of both are as many, and those that correspond stand side by side.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pair {
    /// The function's WGSL name.
    pub name: String,
    /// The lines in WGSL; a line without a counterpart stands beside an empty one.
    pub wgsl: String,
    /// The lines in Rust.
    pub rust: String,
}

/// A pair with its colours, for a template.
#[derive(Serialize)]
pub struct Coloured<'a> {
    name: &'a str,
    wgsl: Vec<Piece<'a>>,
    rust: Vec<Piece<'a>>,
}

impl Pair {
    /// Returns the pair with colours.
    pub fn coloured(&self) -> Coloured<'_> {
        Coloured {
            name: &self.name,
            wgsl: highlight::pieces(&self.wgsl, Language::Wgsl),
            rust: highlight::pieces(&self.rust, Language::Rust),
        }
    }
}

/// Pairs each function of a module with its mirror among the crate's sources, a text for each file. Functions
/// without a mirror of their name are left out.
pub fn pairs(module: &Module, sources: &[String]) -> Vec<Pair> {
    module.functions.iter().filter_map(|function| pair(module, &function.name, sources)).collect()
}

/// Pairs one function with its mirror; `None` if one of both is not there.
pub fn pair(module: &Module, name: &str, sources: &[String]) -> Option<Pair> {
    let short = name.strip_prefix(module.name)?.strip_prefix('_')?;
    let wgsl = declaration(module.whole, "fn ", name)?;
    // A name that is a keyword of Rust's is written as r#NAME.
    let rust = |keyword| sources.iter().find_map(|source| declaration(source, keyword, short));
    let rust = rust("fn ").or_else(|| rust("fn r#"))?;
    let (wgsl, rust) = aligned(&wgsl, &rust);
    Some(Pair { name: name.to_owned(), wgsl, rust })
}

/// Reads the sources of a module's mirror: those of its crate, but for the oracle, the formulas and the tests.
///
/// # Errors
/// Returns an error if a file cannot be read.
pub fn sources(root: &Path, module: &str) -> std::io::Result<Vec<String>> {
    let mut files: Vec<_> = fs::read_dir(root.join("crates").join(module).join("src"))?
        .filter_map(|entry| entry.ok().map(|entry| entry.path()))
        .filter(|path| path.extension().is_some_and(|extension| extension == "rs"))
        .filter(|path| {
            !path.file_stem().is_some_and(|stem| ["oracle", "formulas", "tests"].iter().any(|name| stem == *name))
        })
        .collect();
    // lib.rs first: the mirror of a function is there if it is anywhere.
    files.sort_by_key(|path| (!path.ends_with("lib.rs"), path.clone()));
    files.into_iter().map(fs::read_to_string).collect()
}

/// Returns the text of a function that is declared at the start of a line, possibly after other words, up to the
/// brace that closes it.
fn declaration(source: &str, keyword: &str, name: &str) -> Option<String> {
    let mut lines = source.lines();
    let head = [keyword, name].concat();
    let starts = |line: &str| {
        let after = line.find(&head).and_then(|offset| {
            let before = &line[..offset];
            (!before.starts_with([' ', '/'])).then(|| &line[offset + head.len()..])
        });
        after.is_some_and(|after| after.starts_with(['(', '<']))
    };
    let first = lines.find(|line| starts(line))?;
    let mut text = vec![first];
    if !first.ends_with('}') || !first.contains('{') {
        for line in lines {
            text.push(line);
            if line == "}" {
                break;
            }
        }
    }
    Some(text.join("\n"))
}

/// Puts empty lines where one text has a line that the other lacks, so that lines that correspond have one number:
/// the alignment of greatest similarity (Needleman and Wunsch).
fn aligned(left: &str, right: &str) -> (String, String) {
    let (left, right): (Vec<&str>, Vec<&str>) = (left.lines().collect(), right.lines().collect());
    let words: (Vec<_>, Vec<_>) =
        (left.iter().map(|l| words(l)).collect(), right.iter().map(|r| self::words(r)).collect());
    let width = right.len() + 1;
    let mut best = vec![0.0_f32; (left.len() + 1) * width];
    for (row, one) in words.0.iter().enumerate() {
        for (column, other) in words.1.iter().enumerate() {
            let matched = best[row * width + column] + similarity(one, other);
            let skipped = best[row * width + column + 1].max(best[(row + 1) * width + column]);
            best[(row + 1) * width + column + 1] = matched.max(skipped);
        }
    }
    let (mut row, mut column) = (left.len(), right.len());
    let mut lines = Vec::new();
    while row > 0 || column > 0 {
        let here = best[row * width + column];
        if row > 0 && column > 0 && here > best[(row - 1) * width + column] && here > best[row * width + column - 1] {
            (row, column) = (row - 1, column - 1);
            lines.push((left[row], right[column]));
        } else if row > 0 && (column == 0 || here == best[(row - 1) * width + column]) {
            row -= 1;
            lines.push((left[row], ""));
        } else {
            column -= 1;
            lines.push(("", right[column]));
        }
    }
    lines.reverse();
    // A line that the one lacks and the next that the other lacks stand beside each other.
    let mut folded: Vec<(&str, &str)> = Vec::new();
    let (mut lone_left, mut lone_right) = (Vec::new(), Vec::new());
    for (one, other) in lines.into_iter().chain([("\0", "\0")]) {
        let lone = (one.is_empty() != other.is_empty()).then_some(one.is_empty());
        match lone {
            Some(true) => lone_right.push(other),
            Some(false) => lone_left.push(one),
            None => {
                for index in 0..lone_left.len().max(lone_right.len()) {
                    folded.push((lone_left.get(index).unwrap_or(&""), lone_right.get(index).unwrap_or(&"")));
                }
                lone_left.clear();
                lone_right.clear();
                if one != "\0" {
                    folded.push((one, other));
                }
            }
        }
    }
    let text = |side: fn(&(&str, &str)) -> String| folded.iter().map(side).collect::<Vec<_>>().join("\n");
    (text(|(one, _)| (*one).to_owned()), text(|(_, other)| (*other).to_owned()))
}

/// Returns the names and numbers of a line, as both languages write them.
fn words(line: &str) -> Vec<&str> {
    line.split(|c: char| !c.is_alphanumeric() && c != '.' && c != '_')
        .map(|word| word.trim_matches('.').trim_end_matches('f'))
        .flat_map(|word| word.split(['.', '_']))
        .filter(|word| !word.is_empty())
        .collect()
}

/// Returns the share of words that two lines have in common; a brace alone is like another.
fn similarity(one: &[&str], other: &[&str]) -> f32 {
    if one.is_empty() && other.is_empty() {
        return 0.5;
    }
    let common = one.iter().filter(|word| other.contains(word)).count() as f32;
    2.0 * common / (one.len() + other.len()) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use lapidary_cookbook::{self as cookbook, repository};

    #[test]
    fn lines_that_correspond_stand_side_by_side() {
        let wgsl = "fn a_f(x: f32) -> f32 {\n    // Why.\n    let y = x * 2.0f;\n    return y;\n}";
        let rust = "pub fn f(x: f32) -> f32 {\n    let y = x * 2.0;\n    y\n}";
        let (left, right) = aligned(wgsl, rust);
        let rows: Vec<(&str, &str)> = left.lines().zip(right.split('\n')).collect();
        assert_eq!(rows[1], ("    // Why.", ""));
        assert_eq!(rows[2], ("    let y = x * 2.0f;", "    let y = x * 2.0;"));
        assert_eq!(rows[3], ("    return y;", "    y"));
        assert_eq!(rows[4], ("}", "}"));
    }

    #[test]
    fn every_function_with_a_bound_has_its_mirror_beside_it() {
        let root = repository::place();
        for module in cookbook::modules() {
            let sources = sources(&root, module.name).expect("readable");
            let pairs = pairs(module, &sources);
            for function in &module.functions {
                let pair = pairs.iter().find(|pair| pair.name == function.name);
                let pair = pair.unwrap_or_else(|| panic!("{} has no mirror", function.name));
                assert_eq!(pair.wgsl.split('\n').count(), pair.rust.split('\n').count(), "{}", function.name);
                let lines: Vec<&str> = pair.wgsl.lines().filter(|line| !line.is_empty()).collect();
                let text = declaration(module.whole, "fn ", &function.name).expect("there");
                assert_eq!(lines, text.lines().filter(|line| !line.is_empty()).collect::<Vec<_>>());
            }
        }
    }
}
