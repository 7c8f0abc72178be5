//! Marks of the lines of a recipe that belong to an effect, or that replace it. The format is
//! described in `docs/contract.md`.

use lapidary_translate::declarations::{self, reached_text, words};
use lapidary_translate::indentation::indented;
use lapidary_wgsl::Recipe;
use std::collections::HashSet;

/// A line of a recipe with its marks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Line<'a> {
    /// Line number, from 1.
    pub number: usize,
    /// Text of the line, without the mark.
    pub text: &'a str,
    /// Effects that the line needs: it is removed if one of them is off.
    pub with: Vec<String>,
    /// Effects that the line replaces. If there are any, the line is a comment, and becomes a line
    /// of the shader if one of these effects is off.
    pub without: Vec<String>,
}

/// Error in the marks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Line number, from 1.
    pub line: usize,
    /// Problem, and what is expected instead.
    pub message: String,
}

/// Name, as used in marks, of the effect that a line of WGSL declares; `None` if it declares none.
pub fn effect_of(line: &str) -> Option<String> {
    let name = line.strip_prefix("override EFFECT_")?.split(':').next()?;
    Some(name.trim().to_lowercase())
}

/// Name of an effect's override.
pub fn override_of(effect: &str) -> String {
    format!("EFFECT_{}", effect.to_uppercase())
}

/// Effects that a text declares, in order.
pub fn effects(source: &str) -> Vec<String> {
    source.lines().filter_map(effect_of).collect()
}

/// Returns the effect that a block needs as a whole, and the number of its last line, if `number` is
/// its first: `if (EFFECT_FOG) {` or `if (EFFECT_FOG && …) {` without an `else`.
fn block_of(source: &[&str], number: usize) -> Option<(String, usize)> {
    let line = source[number - 1];
    let indent = &line[..line.len() - line.trim_start().len()];
    let condition = line.trim().strip_prefix("if ")?.split("//").next()?.trim().strip_suffix('{')?;
    let condition = condition.trim();
    let condition = condition.strip_prefix('(').and_then(|rest| rest.strip_suffix(')')).unwrap_or(condition);
    let operand = condition.split("&&").next()?.trim();
    let effect = operand.strip_prefix("EFFECT_")?.to_lowercase();
    if condition.contains("||") || !effect.chars().all(|c| c.is_alphanumeric() || c == '_') {
        return None;
    }
    let ends = |line: &&str| line.strip_prefix(indent).is_some_and(|rest| rest.starts_with('}'));
    let length = source[number..].iter().position(ends)?;
    let last = source[number + length].split("//").next().unwrap_or_default();
    (last.trim() == "}").then_some((effect, number + length + 1))
}

/// Parses the lines of a text, without those that hold only a mark. A block that begins with
/// `if (EFFECT_FOG) {` and has no `else` needs no mark.
pub fn lines(source: &str) -> Result<Vec<Line<'_>>, Fault> {
    let all: Vec<&str> = source.lines().collect();
    // Open blocks, each with its last line.
    let mut blocks: Vec<(String, usize)> = Vec::new();
    let mut lines = Vec::new();
    // Open marked ranges, each with its first line.
    let mut open: Vec<(&str, usize)> = Vec::new();
    for (number, text) in (1..).zip(source.lines()) {
        let fault = |message: String| Fault { line: number, message };
        blocks.retain(|(_, last)| number <= *last);
        blocks.extend(block_of(&all, number));
        let code = text.trim_start();
        if let Some(mark) = code.strip_prefix("//+") {
            match mark.split_once(' ') {
                Some((names, "{")) => open.push((names, number)),
                Some((names, "}")) if open.last().is_some_and(|(opened, _)| *opened == names) => {
                    open.pop();
                }
                _ => return Err(fault(format!("`{code}`: no stretch of lines begins or ends like this"))),
            }
        } else if let Some((names, code)) = code.strip_prefix("//-").and_then(|mark| mark.split_once(' ')) {
            lines.push(Line { number, text: code, with: within(&open, &blocks), without: owned(names) });
        } else if code.starts_with("//-") {
            return Err(fault(format!("`{code}`: no line follows the effect's name")));
        } else {
            let (text, names) = text.split_once("//+").map_or((text, None), |(text, names)| (text, Some(names)));
            let mut with = within(&open, &blocks);
            with.extend(names.into_iter().flat_map(owned));
            lines.push(Line { number, text: text.trim_end(), with, without: Vec::new() });
        }
    }
    match open.pop() {
        Some((names, line)) => Err(Fault { line, message: format!("the stretch of lines for `{names}` has no end") }),
        None => Ok(lines),
    }
}

/// Effects of the open marked ranges and blocks.
fn within(open: &[(&str, usize)], blocks: &[(String, usize)]) -> Vec<String> {
    let marked = open.iter().flat_map(|(names, _)| owned(names));
    marked.chain(blocks.iter().map(|(effect, _)| effect.clone())).collect()
}

fn owned(names: &str) -> Vec<String> {
    names.split(',').map(str::to_owned).collect()
}

/// Returns the text without marks, without the lines for any effect of `off`, and with the lines that
/// replace them. A comment above removed lines goes with them, unless it also stands above others.
/// Declarations that no entry point reaches any more go too.
pub fn cut(source: &str, off: &[&str]) -> Result<String, Fault> {
    cut_but(source, off, &[])
}

/// Returns the same as [`cut`], and keeps these functions even if no entry point reaches them.
fn cut_but(source: &str, off: &[&str], wanted: &[&str]) -> Result<String, Fault> {
    let is_off = |effects: &[String]| effects.iter().any(|effect| off.contains(&effect.as_str()));
    let is_comment = |text: &str| text.trim_start().starts_with("//");
    let indents: Vec<&str> = source.lines().map(|line| &line[..line.len() - line.trim_start().len()]).collect();
    let mut kept: Vec<String> = Vec::new();
    let mut is_after_removed = false;
    for Line { number, text, with, without } in lines(source)? {
        if is_off(&with) {
            is_after_removed = true;
            continue;
        }
        if !without.is_empty() {
            if is_off(&without) {
                kept.push(format!("{}{text}", indents[number - 1]));
                is_after_removed = false;
            }
            continue;
        }
        let ends = text.trim().is_empty() || text.trim() == "}" || is_comment(text);
        if is_after_removed && ends {
            while kept.last().is_some_and(|text| is_comment(text)) {
                kept.pop();
            }
        }
        is_after_removed = false;
        kept.push(text.to_owned());
    }
    let kept: Vec<&str> = kept.iter().map(String::as_str).collect();
    Ok(reached_text(&kept, wanted))
}

/// Returns a recipe with its modules, cut as by [`cut`], without the modules, naive forms and parts of
/// which the cut recipe uses nothing, and without the lines that say what it is made of.
pub fn without(recipe: &Recipe, off: &[&str]) -> Result<String, Fault> {
    without_but(recipe, off, &[])
}

/// Returns the same as [`without`], and keeps these functions even if no entry point reaches them.
pub fn without_but(recipe: &Recipe, off: &[&str], wanted: &[&str]) -> Result<String, Fault> {
    let code = |line: &str| line.split("//").next().unwrap_or_default().trim().to_owned();
    let remaining = cut_but(&recipe.own_text().join("\n"), off, wanted)?;
    let lines: Vec<String> = remaining.lines().map(code).collect();
    let mut words: HashSet<&str> = lines.iter().flat_map(|line| words(line)).collect();
    words.extend(wanted);
    let is_used = |text: &str| {
        let starts = ["fn ", "struct ", "const "];
        let mut declared = text.lines().filter_map(|line| starts.iter().find_map(|start| line.strip_prefix(start)));
        declared.any(|rest| declarations::words(rest).next().is_some_and(|name| words.contains(name)))
    };
    let source = |name: &str| lapidary_wgsl::module(name).map_or("", |module| module.source);
    let naive = |name: &str| lapidary_wgsl::module(name).map_or("", |module| module.naive);
    let compared: Vec<&str> = recipe.compares().into_iter().filter(|name| is_used(naive(name))).collect();
    // A naive form uses its module.
    let required = recipe.requires().into_iter().filter(|name| is_used(source(name)) || compared.contains(name));
    let last: Vec<&str> = compared.iter().map(|name| naive(name)).chain([remaining.as_str()]).collect();
    let whole = lapidary_wgsl::compose(&required.collect::<Vec<_>>(), &last.join("\n"));
    let made_of = ["// requires:", "// parts:", "// compares:"];
    let kept = whole.lines().filter(|line| !made_of.iter().any(|start| line.starts_with(start)));
    // A block whose condition went leaves its lines too deep.
    Ok(indented(&kept.flat_map(|line| [line, "\n"]).collect::<String>()))
}

/// Returns a recipe to paste with these effects switched on and all others cut out, by [`without_but`]; without a list
/// all effects are kept, with the recipe's own defaults.
///
/// # Errors
/// Returns an error if the recipe's marks are not well formed.
pub fn with_effects(recipe: &Recipe, wanted: Option<&[&str]>, functions: &[&str]) -> Result<String, Fault> {
    let known = effects(&recipe.compose());
    let off = known.iter().filter(|effect| wanted.is_some_and(|wanted| !wanted.contains(&effect.as_str())));
    let text = without_but(recipe, &off.map(String::as_str).collect::<Vec<_>>(), functions)?;
    let switched = text.lines().map(|line| match effect_of(line) {
        Some(effect) if wanted.is_some() => format!("override {}: bool = true;", override_of(&effect)),
        _ => line.to_owned(),
    });
    Ok(switched.collect::<Vec<_>>().join("\n") + "\n")
}

/// Checks a text's marks: each names one of `known`, and all lines that name the override of an
/// effect, besides its declaration, are marked with that effect.
pub fn faults(source: &str, known: &[String]) -> Vec<Fault> {
    let lines = match lines(source) {
        Ok(lines) => lines,
        Err(fault) => return vec![fault],
    };
    let mut faults = Vec::new();
    for Line { number, text, with, without } in &lines {
        let mut report = |message| faults.push(Fault { line: *number, message });
        for effect in with.iter().chain(without) {
            if !known.contains(effect) {
                report(format!("marked as a line of `{effect}`, which no recipe declares"));
            }
        }
        // The declaration itself goes once nothing names it.
        let code = if effect_of(text).is_some() { "" } else { text.split("//").next().unwrap_or_default() };
        for word in words(code) {
            let Some(effect) = word.strip_prefix("EFFECT_").map(str::to_lowercase) else { continue };
            if !with.contains(&effect) {
                report(format!("`{word}` stays behind where the effect is off; end the line with `//+{effect}`"));
            }
        }
    }
    faults
}

/// Returns the effects of a whole recipe that do nothing, because they have no lines besides their
/// override.
pub fn idle_effects(source: &str) -> Result<Vec<String>, Fault> {
    let lines = lines(source)?;
    let is_idle = |effect: &String| {
        let mut marked = lines.iter().filter(|line| line.with.contains(effect));
        marked.all(|line| effect_of(line.text).is_some() || line.text.trim().is_empty())
    };
    Ok(effects(source).into_iter().filter(is_idle).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "\
a
override EFFECT_FOG: bool = true;  //+fog
//+fog,rain {
    b
    //+snow {
    c  //+hail
    //+snow }
//+fog,rain }
    //-fog d(e);
// f
";

    #[test]
    fn a_line_has_the_marks_about_it_and_its_own() {
        let lines = lines(TEXT).expect("well formed");
        let found: Vec<(usize, &str, String, String)> =
            lines.iter().map(|line| (line.number, line.text, line.with.join(","), line.without.join(","))).collect();
        let expected: [(usize, &str, &[&str], &[&str]); 6] = [
            (1, "a", &[], &[]),
            (2, "override EFFECT_FOG: bool = true;", &["fog"], &[]),
            (4, "    b", &["fog", "rain"], &[]),
            (6, "    c", &["fog", "rain", "snow", "hail"], &[]),
            (9, "d(e);", &[], &["fog"]),
            (10, "// f", &[], &[]),
        ];
        let expected = expected.map(|(number, text, with, without)| (number, text, with.join(","), without.join(",")));
        assert_eq!(found, expected);
        assert_eq!(effects(TEXT), ["fog"]);
    }

    #[test]
    fn what_is_off_is_cut_with_its_comments_and_no_mark_is_left() {
        assert_eq!(cut(TEXT, &[]).expect("well formed"), "a\noverride EFFECT_FOG: bool = true;\n    b\n    c\n// f\n");
        assert_eq!(cut(TEXT, &["snow"]).expect("well formed"), "a\noverride EFFECT_FOG: bool = true;\n    b\n// f\n");
        assert_eq!(cut(TEXT, &["fog"]).expect("well formed"), "a\n    d(e);\n// f\n");
        let commented = "// Both.\nfog,  //+fog\nrain,\n\n// Fog alone.\nmore fog;  //+fog\n\n// Kept.\nend\n";
        assert_eq!(cut(commented, &["fog"]).expect("well formed"), "// Both.\nrain,\n\n// Kept.\nend\n");
        assert_eq!(cut("//+fog (\n", &[]).expect_err("not well formed").line, 1);
    }

    #[test]
    fn a_block_of_one_effect_needs_no_mark() {
        let text = |condition: &str, end: &str| {
            format!("a;\n    if {condition} {{\n        if b {{\n        }}\n    {end}\nc;\n")
        };
        for condition in ["(EFFECT_FOG)", "EFFECT_FOG", "(EFFECT_FOG && d)", "EFFECT_FOG && d > 0u"] {
            let text = text(condition, "}");
            assert_eq!(cut(&text, &["fog"]).expect("well formed"), "a;\nc;\n", "{condition}");
            assert_eq!(faults(&text, &["fog".to_owned()]), [], "{condition}");
        }
        for (condition, end) in
            [("(EFFECT_FOG || d)", "}"), ("(d && EFFECT_FOG)", "}"), ("(EFFECT_FOG)", "} else {\n    }")]
        {
            let text = text(condition, end);
            assert_eq!(cut(&text, &["fog"]).expect("well formed"), text, "{condition}");
            assert_eq!(faults(&text, &["fog".to_owned()]).len(), 1, "{condition}");
        }
    }

    #[test]
    fn what_no_entry_point_reaches_goes() {
        let text = "\
// A recipe.

// Fog.
override EFFECT_FOG: bool = true;
override STEPS: u32 = 4u;

// The mesh.
@group(1) @binding(0) var<storage, read> positions: array<f32>;
@group(1) @binding(1) var fog: texture_2d<f32>;

struct Hit {
    at: vec3f,
}

// Thins what is behind.
fn thin(
    hit: Hit,
) -> f32 {
    return textureLoad(fog, vec2u(0u), 0).x;
}

// Draws.
@fragment
fn main() -> @location(0) vec4f {
    let first = positions[0];
    if (EFFECT_FOG) {  //+fog
        return vec4f(thin(Hit(vec3f(first))));  //+fog
    }  //+fog
    return vec4f(first);
}
";
        let whole = cut(text, &[]).expect("well formed");
        assert_eq!(whole, text.replace("  //+fog", "").replace("override STEPS: u32 = 4u;\n", ""));
        let bare = cut(text, &["fog"]).expect("well formed");
        let expected = "\
// A recipe.

// The mesh.
@group(1) @binding(0) var<storage, read> positions: array<f32>;

// Draws.
@fragment
fn main() -> @location(0) vec4f {
    let first = positions[0];
    return vec4f(first);
}
";
        assert_eq!(bare, expected);
        assert_eq!(reached_text(&["fn f() {", "}"], &[]), "fn f() {\n}\n");
    }

    #[test]
    fn stretches_that_do_not_close_are_found() {
        for (text, line) in [
            ("//+fog {\na\n", 1),
            ("a\n//+fog }\n", 2),
            ("//+fog {\n//+rain }\n", 2),
            ("//+fog (\n", 1),
            ("//+fog\na\n", 1),
            ("a\n//-fog\n", 2),
        ] {
            assert_eq!(lines(text).expect_err(text).line, line, "{text}");
        }
    }

    #[test]
    fn unknown_and_missing_marks_are_found() {
        let known = ["fog", "rain", "snow", "hail"].map(str::to_owned);
        assert_eq!(faults(TEXT, &known), []);
        let found = faults(TEXT, &known[..3]);
        assert!(found.len() == 1 && found[0].line == 6 && found[0].message.contains("`hail`"), "{found:?}");
        for line in ["a(EFFECT_FOG);", "if (EFFECT_FOG) {  //+rain", "//-fog if (EFFECT_FOG) {"] {
            let found = faults(line, &known);
            assert!(found.len() == 1 && found[0].message.contains("//+fog"), "{line}: {found:?}");
        }
        assert_eq!(faults("// EFFECT_FOG\nif (EFFECT_FOG && a) {  //+fog", &known), []);
    }

    #[test]
    fn an_effect_without_a_line_is_found() {
        assert_eq!(idle_effects(TEXT), Ok(Vec::new()));
        assert_eq!(idle_effects("override EFFECT_FOG: bool = true;  //+fog\na\n"), Ok(vec!["fog".to_owned()]));
    }
}
