//! What a module's comments say: its header and the tags of each function. Format in `docs/contract.md`.

use super::release;
use lapidary_assay::accuracy_line::Accuracy;

/// The licence line that every module carries.
pub const LICENCE: &str = "MIT-0 OR Apache-2.0";
/// The tags of a function, in their order.
pub const TAGS: [&str; 5] = ["Returns", "Units", "Domain", "Outside", "Accuracy"];

/// A module's header.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Header {
    /// The module's name.
    pub name: String,
    /// Its purpose in one line.
    pub purpose: String,
    /// The release and the hash of the text that its `// Version:` line states; a module has one.
    pub version: Option<(String, String)>,
    /// Where its mathematics comes from.
    pub source: String,
}

/// The comment of a function.
#[derive(Clone, Debug, PartialEq)]
pub struct FunctionDoc {
    /// Its WGSL name.
    pub name: String,
    /// The line of its `fn`, from 1.
    pub line: usize,
    /// What it does and why so.
    pub summary: String,
    /// What it returns.
    pub returns: String,
    /// In which units.
    pub units: String,
    /// Where its accuracy holds.
    pub domain: String,
    /// What it does elsewhere.
    pub outside: String,
    /// The tolerance of its tests.
    pub accuracy: Accuracy,
}

/// Where a comment breaks the contract.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct HeaderFault {
    /// Line, from 1.
    pub line: usize,
    /// What is wrong and what is expected.
    pub message: String,
}

/// Reads the header of a module.
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
    let mut at = 3;
    let mut version = None;
    if let Some(line) = third.filter(|line| line.starts_with("// Version:")) {
        let Some((release, hash)) = release::stated(line) else {
            return Err(fault(3, "expected `// Version: <release>, hash <16 hexadecimal digits>`"));
        };
        version = Some((release.to_owned(), hash.to_owned()));
        third = lines.next();
        at = 4;
    }
    let source_line = third.and_then(|line| line.strip_prefix("// Source: "));
    let Some(source_line) = source_line.filter(|source| !source.trim().is_empty()) else {
        return Err(fault(at, "expected `// Source: <paper, book or specification, with equation numbers>`"));
    };
    // A source may run on, up to an empty comment line or the end of the comment.
    let needs = ["requires:", "parts:", "compares:"];
    let more = lines
        .map_while(|line| line.strip_prefix("// ").map(str::trim))
        .filter(|line| !needs.iter().any(|need| line.starts_with(need)));
    let source = std::iter::once(source_line.trim()).chain(more).collect::<Vec<_>>().join(" ");
    Ok(Header { name: name.to_owned(), purpose: purpose.to_owned(), version, source })
}

/// Reads the comment of every function of a module.
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
