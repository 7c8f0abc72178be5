//! Marks of the lines of a recipe that belong to an effect, or that replace it. The format is
//! described in `docs/contract.md`.

/// A line of a recipe with its marks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Line<'a> {
    /// Line number, from 1.
    pub number: usize,
    /// Text of the line, without the mark.
    pub text: &'a str,
    /// Effects that the line needs: it is removed if one of them is off.
    pub with: Vec<&'a str>,
    /// Effects that the line replaces. If there are any, the line is a comment, and becomes a line
    /// of the shader if one of these effects is off.
    pub without: Vec<&'a str>,
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

/// Parses the lines of a text, without those that hold only a mark.
pub fn lines(source: &str) -> Result<Vec<Line<'_>>, Fault> {
    let mut lines = Vec::new();
    // Open marked ranges, each with its first line.
    let mut open: Vec<(&str, usize)> = Vec::new();
    for (number, text) in (1..).zip(source.lines()) {
        let fault = |message: String| Fault { line: number, message };
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
            lines.push(Line { number, text: code, with: within(&open), without: names.split(',').collect() });
        } else if code.starts_with("//-") {
            return Err(fault(format!("`{code}`: no line follows the effect's name")));
        } else {
            let (text, names) = text.split_once("//+").map_or((text, None), |(text, names)| (text, Some(names)));
            let with = within(&open).into_iter().chain(names.into_iter().flat_map(|names| names.split(','))).collect();
            lines.push(Line { number, text: text.trim_end(), with, without: Vec::new() });
        }
    }
    match open.pop() {
        Some((names, line)) => Err(Fault { line, message: format!("the stretch of lines for `{names}` has no end") }),
        None => Ok(lines),
    }
}

/// Effects of the open marked ranges.
fn within<'a>(open: &[(&'a str, usize)]) -> Vec<&'a str> {
    open.iter().flat_map(|(names, _)| names.split(',')).collect()
}

/// Checks a text's marks: each names one of `known`, and all lines that name the override of an
/// effect are marked with that effect.
pub fn faults(source: &str, known: &[String]) -> Vec<Fault> {
    let lines = match lines(source) {
        Ok(lines) => lines,
        Err(fault) => return vec![fault],
    };
    let mut faults = Vec::new();
    for Line { number, text, with, without } in &lines {
        let mut report = |message| faults.push(Fault { line: *number, message });
        for effect in with.iter().chain(without) {
            if !known.iter().any(|known| known == effect) {
                report(format!("marked as a line of `{effect}`, which no recipe declares"));
            }
        }
        let code = text.split("//").next().unwrap_or_default();
        for word in code.split(|character: char| !character.is_ascii_alphanumeric() && character != '_') {
            let Some(effect) = word.strip_prefix("EFFECT_").map(str::to_lowercase) else { continue };
            if !with.contains(&effect.as_str()) {
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
        let mut own = lines.iter().filter(|line| line.with.contains(&effect.as_str()));
        own.all(|line| effect_of(line.text).is_some() || line.text.trim().is_empty())
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
        let found: Vec<(usize, &str, &[&str], &[&str])> =
            lines.iter().map(|line| (line.number, line.text, &line.with[..], &line.without[..])).collect();
        let expected: [(usize, &str, &[&str], &[&str]); 6] = [
            (1, "a", &[], &[]),
            (2, "override EFFECT_FOG: bool = true;", &["fog"], &[]),
            (4, "    b", &["fog", "rain"], &[]),
            (6, "    c", &["fog", "rain", "snow", "hail"], &[]),
            (9, "d(e);", &[], &["fog"]),
            (10, "// f", &[], &[]),
        ];
        assert_eq!(found, expected);
        assert_eq!(effects(TEXT), ["fog"]);
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
        for line in ["if (EFFECT_FOG) {", "if (EFFECT_FOG) {  //+rain", "//-fog if (EFFECT_FOG) {"] {
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
