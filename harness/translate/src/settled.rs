//! Branches that constants settle, taken out of a text.

use crate::declarations::{reached_text, without_comment, words};
use crate::indentation::indented;
use std::collections::HashMap;

/// Returns the text without the branches that its constants rule out, and without the declarations that
/// neither entry points nor these functions reach any more. The text must be formatted.
#[must_use]
pub fn settled(source: &str, wanted: &[&str]) -> String {
    let constants: HashMap<&str, Value> = source.lines().filter_map(constant).collect();
    let lines: Vec<&str> = source.lines().collect();
    let folded = folded(&lines, &constants);
    let lines: Vec<&str> = folded.iter().map(String::as_str).collect();
    indented(&reached_text(&lines, wanted))
}

/// What a constant or a part of a condition is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Value {
    Bool(bool),
    Whole(i64),
    Unknown,
}

fn constant(line: &str) -> Option<(&str, Value)> {
    let (declared, value) = without_comment(line).strip_prefix("const ")?.split_once(" = ")?;
    let value = literal(value.trim().strip_suffix(';')?)?;
    Some((declared.split(':').next()?.trim(), value))
}

fn literal(text: &str) -> Option<Value> {
    match text {
        "true" => Some(Value::Bool(true)),
        "false" => Some(Value::Bool(false)),
        _ => text.trim_end_matches(['u', 'i']).parse().ok().map(Value::Whole),
    }
}

/// A branch of an `if`: its condition, `None` for the last `else`, and its lines.
struct Branch<'a> {
    condition: Option<&'a str>,
    body: &'a [&'a str],
}

fn indent(line: &str) -> usize {
    line.len() - line.trim_start().len()
}

/// Returns the lines without the branches that are ruled out.
fn folded(lines: &[&str], constants: &HashMap<&str, Value>) -> Vec<String> {
    let mut kept: Vec<String> = Vec::new();
    let mut index = 0;
    while index < lines.len() {
        let Some((branches, end)) = branches(lines, index) else {
            kept.push(lines[index].to_owned());
            index += 1;
            continue;
        };
        let margin = indent(lines[index]);
        index = end;
        // Those up to the first that is always taken.
        let mut left: Vec<(Option<&str>, Vec<String>)> = Vec::new();
        for Branch { condition, body } in branches {
            let value = condition.map_or(Value::Bool(true), |condition| evaluated(condition, constants));
            match value {
                Value::Bool(false) => continue,
                Value::Bool(true) => {
                    left.push((None, folded(body, constants)));
                    break;
                }
                _ => left.push((condition, folded(body, constants))),
            }
        }
        let space = " ".repeat(margin);
        match left.as_mut_slice() {
            [] => drop_comment(&mut kept, margin),
            [(None, body)] => {
                // Its variables would meet those around it.
                let declares = |line: &String| {
                    indent(line) == margin + 4
                        && ["let ", "var ", "const "].iter().any(|start| line.trim().starts_with(start))
                };
                let braced = body.iter().any(declares);
                // A statement may take several lines, the last of which closes its brackets.
                let begins = |line: &&String| indent(line) == margin + 4 && !line.trim().starts_with([')', ']', '}']);
                let leaves = body.iter().rev().find(begins).is_some_and(|line| {
                    ["return", "break;", "continue;", "discard;"].iter().any(|start| line.trim().starts_with(start))
                });
                if braced {
                    kept.push(format!("{space}{{"));
                    kept.append(body);
                    kept.push(format!("{space}}}"));
                } else {
                    kept.extend(body.iter().map(|line| line.get(4..).unwrap_or_default().to_owned()));
                }
                if leaves {
                    // What follows in this block is never reached.
                    while index < lines.len() && (lines[index].trim().is_empty() || indent(lines[index]) >= margin) {
                        index += 1;
                    }
                }
            }
            _ => {
                for (number, (condition, body)) in left.iter_mut().enumerate() {
                    let start = if number == 0 { "" } else { "} else " };
                    kept.push(match condition {
                        Some(condition) => format!("{space}{start}if {condition} {{"),
                        None => format!("{space}}} else {{"),
                    });
                    kept.append(body);
                }
                kept.push(format!("{space}}}"));
            }
        }
    }
    kept
}

/// Takes the comment off that stood above what is gone.
fn drop_comment(kept: &mut Vec<String>, margin: usize) {
    while kept.last().is_some_and(|line| indent(line) == margin && line.trim_start().starts_with("//")) {
        kept.pop();
    }
}

/// Returns the branches of an `if` that begins on a line, and the number of the line after them.
fn branches<'a>(lines: &'a [&'a str], first: usize) -> Option<(Vec<Branch<'a>>, usize)> {
    let margin = indent(lines[first]);
    let mut condition = Some(condition_of(lines[first].trim_start().strip_prefix("if ")?)?);
    let mut branches = Vec::new();
    let mut start = first + 1;
    loop {
        let ends = |line: &&str| indent(line) == margin && line.trim_start().starts_with('}');
        let end = start + lines[start..].iter().position(ends)?;
        branches.push(Branch { condition, body: &lines[start..end] });
        let rest = without_comment(lines[end].trim_start()).trim_end();
        start = end + 1;
        if rest == "}" {
            return Some((branches, start));
        }
        let rest = rest.strip_prefix("} else ")?;
        condition = match rest.strip_prefix("if ") {
            Some(rest) => Some(condition_of(rest)?),
            None if rest == "{" => None,
            None => return None,
        };
    }
}

/// Returns the condition before a block's brace.
fn condition_of(text: &str) -> Option<&str> {
    without_comment(text).trim_end().strip_suffix('{').map(str::trim)
}

/// Evaluates a condition of names, literals, comparisons, `!`, `&&`, `||` and parentheses; whatever else it
/// holds is unknown.
fn evaluated(condition: &str, constants: &HashMap<&str, Value>) -> Value {
    let mut parser = Parser { rest: condition.trim(), constants };
    let value = parser.either();
    if parser.rest.is_empty() { value } else { Value::Unknown }
}

struct Parser<'a> {
    rest: &'a str,
    constants: &'a HashMap<&'a str, Value>,
}

impl Parser<'_> {
    fn takes(&mut self, token: &str) -> bool {
        match self.rest.strip_prefix(token) {
            Some(rest) => {
                self.rest = rest.trim_start();
                true
            }
            None => false,
        }
    }

    fn either(&mut self) -> Value {
        let mut value = self.both();
        while self.takes("||") {
            value = match (value, self.both()) {
                (Value::Bool(true), _) | (_, Value::Bool(true)) => Value::Bool(true),
                (Value::Bool(false), Value::Bool(false)) => Value::Bool(false),
                _ => Value::Unknown,
            };
        }
        value
    }

    fn both(&mut self) -> Value {
        let mut value = self.compared();
        while self.takes("&&") {
            value = match (value, self.compared()) {
                (Value::Bool(false), _) | (_, Value::Bool(false)) => Value::Bool(false),
                (Value::Bool(true), Value::Bool(true)) => Value::Bool(true),
                _ => Value::Unknown,
            };
        }
        value
    }

    fn compared(&mut self) -> Value {
        let left = self.operand();
        for (token, holds) in COMPARISONS {
            if self.takes(token) {
                return match (left, self.operand()) {
                    (Value::Whole(left), Value::Whole(right)) => Value::Bool(holds(left, right)),
                    _ => Value::Unknown,
                };
            }
        }
        left
    }

    fn operand(&mut self) -> Value {
        if self.rest.starts_with("!=") {
            return Value::Unknown;
        }
        if self.takes("!") {
            return match self.operand() {
                Value::Bool(value) => Value::Bool(!value),
                _ => Value::Unknown,
            };
        }
        if self.takes("(") {
            let value = self.either();
            return if self.takes(")") { value } else { Value::Unknown };
        }
        let length =
            self.rest.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_' || c == '.')).unwrap_or(self.rest.len());
        let (name, rest) = self.rest.split_at(length);
        self.rest = rest.trim_start();
        let is_name = words(name).next() == Some(name);
        match self.constants.get(name) {
            Some(value) if is_name => *value,
            _ => literal(name).unwrap_or(Value::Unknown),
        }
    }
}

/// An operator, and whether it holds of two numbers.
type Comparison = (&'static str, fn(i64, i64) -> bool);

/// Longer ones before those that they begin with.
const COMPARISONS: [Comparison; 6] = [
    ("==", |left, right| left == right),
    ("!=", |left, right| left != right),
    ("<=", |left, right| left <= right),
    (">=", |left, right| left >= right),
    ("<", |left, right| left < right),
    (">", |left, right| left > right),
];

#[cfg(test)]
mod tests {
    use super::*;

    fn constants() -> HashMap<&'static str, Value> {
        HashMap::from([("ON", Value::Bool(true)), ("OFF", Value::Bool(false)), ("TWO", Value::Whole(2))])
    }

    #[test]
    fn conditions_are_settled_as_far_as_they_are_known() {
        for (condition, expected) in [
            ("(ON)", Value::Bool(true)),
            ("!ON", Value::Bool(false)),
            ("(x && OFF)", Value::Bool(false)),
            ("(x || ON)", Value::Bool(true)),
            ("(x && ON)", Value::Unknown),
            ("(ON && TWO == 2u)", Value::Bool(true)),
            ("TWO >= 3u || OFF", Value::Bool(false)),
            ("((OFF || TWO < 3) && !ray.followed)", Value::Unknown),
            ("(OFF && !ray.followed)", Value::Bool(false)),
            ("f(ON) && OFF", Value::Unknown),
            ("a + 1 > TWO", Value::Unknown),
            ("x != ON", Value::Unknown),
            ("ray.ON", Value::Unknown),
        ] {
            assert_eq!(evaluated(condition, &constants()), expected, "{condition}");
        }
    }

    #[test]
    fn what_is_ruled_out_goes_with_its_comment_and_what_it_alone_used() {
        let text = "\
const FORM: u32 = 1u;
const LIMIT: bool = true;

fn first() -> f32 {
    return 1.0f;
}

fn second() -> f32 {
    return 2.0f;
}

@fragment
fn main() -> @location(0) vec4f {
    var sum = 0.0f;
    // The first form.
    if (FORM == 0u) {
        sum += first();
    }
    if (sum > 1.0f) {
        sum = 1.0f;
    } else if (FORM == 1u) {
        sum = 3.0f;
    } else {
        sum = first();
    }
    if (LIMIT) {
        let two = second();
        return vec4f(two);
    }
    return vec4f(sum);
}
";
        let expected = "\
fn second() -> f32 {
    return 2.0f;
}

@fragment
fn main() -> @location(0) vec4f {
    var sum = 0.0f;
    if (sum > 1.0f) {
        sum = 1.0f;
    } else {
        sum = 3.0f;
    }
    {
        let two = second();
        return vec4f(two);
    }
}
";
        assert_eq!(settled(text, &[]), expected);
        // A function that nothing calls stays if it is wanted.
        assert!(settled(text, &["first"]).contains("fn first("));
        lapidary_specialise::parse(expected, "text").expect("valid");
    }
}
