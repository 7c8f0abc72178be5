//! Contents of a module's comments: its header and the tags of each function. The format is
//! described in `docs/contract.md`.

use lapidary_assay::accuracy_line::Accuracy;

/// Licence line of every module.
pub const LICENCE: &str = "MIT-0 OR Apache-2.0";
/// Tags of a function, in order.
pub const TAGS: [&str; 5] = ["Returns", "Units", "Domain", "Outside", "Accuracy"];

/// Header of a module.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Header {
    /// Name of the module.
    pub name: String,
    /// Purpose of the module in one line.
    pub purpose: String,
    /// Release from the `// Version:` line; always present in a module.
    pub version: Option<String>,
    /// Source of the mathematics.
    pub source: String,
}

/// Comment of a function.
#[derive(Clone, Debug, PartialEq)]
pub struct FunctionDoc {
    /// WGSL name of the function.
    pub name: String,
    /// Line of the `fn`, from 1.
    pub line: usize,
    /// What the function does, and why it does so.
    pub summary: String,
    /// Meaning of the result.
    pub returns: String,
    /// Units of the result and parameters.
    pub units: String,
    /// Domain in which the stated accuracy holds.
    pub domain: String,
    /// Behaviour outside the domain.
    pub outside: String,
    /// Tolerance of the tests.
    pub accuracy: Accuracy,
}

/// A comment that breaks the contract.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct HeaderFault {
    /// Line, from 1.
    pub line: usize,
    /// Problem, and what is expected instead.
    pub message: String,
}

/// Parses the header of a module.
pub fn parse_header(source: &str) -> Result<Header, HeaderFault> {
    let fault = |line: usize, message: &str| HeaderFault { line, message: message.to_owned() };
    let mut lines = source.lines();
    let first = lines.next().and_then(|line| line.strip_prefix("// ")).and_then(|line| line.split_once(": "));
    let Some((name, purpose)) = first.filter(|(name, purpose)| !name.is_empty() && !purpose.trim().is_empty()) else {
        return Err(fault(1, "expected `// <module>: <purpose in one line>`"));
    };
    let licence = lines.next().and_then(|line| line.strip_prefix("// SPDX-License-Identifier: "));
    if licence != Some(LICENCE) {
        return Err(fault(2, &format!("expected `// SPDX-License-Identifier: {LICENCE}`")));
    }
    let mut third = lines.next();
    let mut number = 3;
    let mut version = None;
    if let Some(release) = third.and_then(|line| line.strip_prefix("// Version: ")) {
        version = Some(release.to_owned());
        third = lines.next();
        number = 4;
    }
    let source_line = third.and_then(|line| line.strip_prefix("// Source: "));
    let Some(source_line) = source_line.filter(|source| !source.trim().is_empty()) else {
        return Err(fault(number, "expected `// Source: <paper, book or specification, with equation numbers>`"));
    };
    // A source may continue up to an empty comment line or the end of the comment.
    let needs = ["requires:", "parts:", "compares:"];
    let more = lines
        .map_while(|line| line.strip_prefix("// ").map(str::trim))
        .filter(|line| !needs.iter().any(|need| line.starts_with(need)));
    let source = std::iter::once(source_line.trim()).chain(more).collect::<Vec<_>>().join(" ");
    Ok(Header { name: name.to_owned(), purpose: purpose.to_owned(), version, source })
}

/// Parses the comment of every function of a module.
pub fn parse_functions(source: &str) -> Result<Vec<FunctionDoc>, HeaderFault> {
    let lines: Vec<&str> = source.lines().collect();
    let mut functions = Vec::new();
    for (index, line) in lines.iter().enumerate() {
        if let Some(rest) = line.strip_prefix("fn ") {
            let name = rest.split('(').next().unwrap_or_default().trim();
            let start = lines[..index].iter().rposition(|line| !line.starts_with("//")).map_or(0, |line| line + 1);
            functions.push(parse_function(name, index + 1, &lines[start..index])?);
        }
    }
    Ok(functions)
}

fn parse_function(name: &str, line: usize, comment: &[&str]) -> Result<FunctionDoc, HeaderFault> {
    let fault = |message: String| HeaderFault { line, message: format!("`{name}`: {message}") };
    let mut parts: Vec<(Option<usize>, String)> = vec![(None, String::new())];
    for text in comment.iter().map(|line| line.trim_start_matches('/').trim()) {
        let tag = TAGS.iter().position(|tag| text.strip_prefix(tag).is_some_and(|rest| rest.starts_with(':')));
        match (tag, parts.last_mut()) {
            (Some(tag), _) => parts.push((Some(tag), text[TAGS[tag].len() + 1..].trim().to_owned())),
            (None, Some((_, last))) => {
                if !last.is_empty() {
                    last.push(' ');
                }
                last.push_str(text);
            }
            (None, None) => unreachable!("starts with the summary"),
        }
    }
    let found: Vec<Option<usize>> = parts.iter().skip(1).map(|(tag, _)| *tag).collect();
    if found != (0..TAGS.len()).map(Some).collect::<Vec<_>>() {
        return Err(fault(format!(
            "expected the tags {} once each, in this order",
            TAGS.map(|tag| format!("{tag}:")).join(" ")
        )));
    }
    if let Some((tag, _)) = parts.iter().find(|(_, text)| text.is_empty()) {
        return Err(fault(format!("{} is empty", tag.map_or("the summary", |tag| TAGS[tag]))));
    }
    let mut texts = parts.into_iter().map(|(_, text)| text);
    let mut next = || texts.next().unwrap_or_default();
    let (summary, returns, units, domain, outside) = (next(), next(), next(), next(), next());
    let accuracy = Accuracy::parse(&next()).map_err(|reason| fault(format!("Accuracy: {reason}")))?;
    Ok(FunctionDoc { name: name.to_owned(), line, summary, returns, units, domain, outside, accuracy })
}
