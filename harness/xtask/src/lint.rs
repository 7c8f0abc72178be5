//! The module contract as checks of the text and of naga's IR. A finding fails the tests.

use lapidary_assay::accuracy_line::Accuracy;
use lapidary_assay::dispatch;
use lapidary_assay::dispatch::signature::of_type;
use lapidary_cookbook::header::{self, Header};
use lapidary_cookbook::marks;
use naga::{Expression, Function, Handle};
use std::fmt;

/// Rules of the contract.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Rule {
    /// naga parses and validates the module by itself.
    Valid,
    /// Header lines: name and purpose, licence, source.
    Header,
    /// Every function has its tags, and its accuracy line fits its result.
    FunctionComment,
    /// `wgsl/naive/` contains all naive forms, and nothing else.
    Place,
    /// Only functions, structs and consts.
    PureFunctions,
    /// Every global name starts with the module's name.
    Prefix,
    /// No names that naga or naga_oil would rename or refuse.
    Identifier,
    /// Every literal states its type.
    Literal,
    /// No comparison of a value with itself.
    SelfComparison,
    /// Lines that exist only for an effect are marked.
    Mark,
    /// No two modules define the same name; all of them compile as one.
    Composition,
}

/// A violation of the contract.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// Violated rule.
    pub rule: Rule,
    /// Name of the module.
    pub module: String,
    /// Line from 1; 0 if the rule concerns the whole text.
    pub line: usize,
    /// Problem, why it matters, and what to do.
    pub message: String,
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "wgsl/{}.wgsl:{}: {:?}: {}", self.module, self.line, self.rule, self.message)
    }
}

/// Checks one module and its naive forms against every rule that concerns a single module.
pub fn lint(name: &str, source: &str, naive: &str) -> Vec<Finding> {
    // Lines of the module itself; the naive forms begin after an empty line.
    let own_lines = source.lines().count();
    let whole = format!("{source}\n{naive}");
    let mut findings = Vec::new();
    let mut report = |rule, line, message: String| {
        let (module, line) = match line > own_lines {
            true => (format!("naive/{name}"), line - own_lines - 1),
            false => (name.to_owned(), line),
        };
        findings.push(Finding { rule, module, line, message });
    };
    check_header(name, source, &mut report);
    check_literals(&whole, &mut report);
    match dispatch::parse(&whole, &format!("wgsl/{name}.wgsl")) {
        Err(error) => report(Rule::Valid, 0, error.to_string()),
        Ok((module, _)) => {
            check_functions(&whole, own_lines, &module, &mut report);
            check_purity(&whole, &module, &mut report);
            check_names(name, &whole, &module, &mut report);
            check_self_comparison(&whole, &module, &mut report);
        }
    }
    findings
}

/// Checks text that is not a module: a recipe and its parts, each separately. `effects` are those
/// that marks may name.
pub fn lint_recipe(name: &str, source: &str, effects: &[String]) -> Vec<Finding> {
    let mut findings = Vec::new();
    let mut report = |rule, line, message| {
        findings.push(Finding { rule, module: format!("recipes/{name}"), line, message });
    };
    for fault in marks::faults(source, effects) {
        report(Rule::Mark, fault.line, fault.message);
    }
    findings
}

/// Checks that all modules compile as one text, in this order and in reverse.
pub fn lint_composition(modules: &[(&str, &str)]) -> Vec<Finding> {
    let forwards: Vec<&str> = modules.iter().map(|(_, source)| *source).collect();
    let backwards: Vec<&str> = forwards.iter().rev().copied().collect();
    [forwards, backwards]
        .iter()
        .filter_map(|sources| dispatch::parse(&sources.join("\n"), "all modules").err())
        .map(|error| Finding {
            rule: Rule::Composition,
            module: "*".to_owned(),
            line: 0,
            message: format!("modules pasted after one another do not compile: {error}"),
        })
        .collect()
}

type Report<'a> = dyn FnMut(Rule, usize, String) + 'a;

fn check_header(name: &str, source: &str, report: &mut Report<'_>) {
    match header::parse_header(source) {
        Err(fault) => report(Rule::Header, fault.line, fault.message),
        Ok(Header { name: written, .. }) if written != name => {
            report(Rule::Header, 1, format!("the header names `{written}`, the file is `{name}`"));
        }
        Ok(_) => {}
    }
}

fn check_functions(source: &str, own_lines: usize, module: &naga::Module, report: &mut Report<'_>) {
    let documented = match header::parse_functions(source) {
        Err(fault) => return report(Rule::FunctionComment, fault.line, fault.message),
        Ok(functions) => functions,
    };
    for (_, function) in module.functions.iter() {
        let name = function.name.as_deref().unwrap_or_default();
        let Some(comment) = documented.iter().find(|comment| comment.name == name) else {
            report(Rule::FunctionComment, 0, format!("`{name}`: `fn` must start its line, after its comment"));
            continue;
        };
        // Code that fails is not pasted.
        let is_naive = comment.accuracy == Accuracy::Naive;
        if is_naive != (comment.line > own_lines) {
            let folder = if is_naive { "wgsl/naive" } else { "wgsl" };
            report(Rule::Place, comment.line, format!("`{name}` belongs in {folder}"));
        }
        let Some(result) = &function.result else {
            report(Rule::FunctionComment, comment.line, format!("`{name}` returns nothing, so nothing can test it"));
            continue;
        };
        match of_type(module, result.ty) {
            Err(reason) => report(Rule::FunctionComment, comment.line, format!("`{name}`: result: {reason}")),
            Ok(shape) => {
                if let Err(reason) = comment.accuracy.check_fields(&shape) {
                    report(Rule::FunctionComment, comment.line, format!("`{name}`: Accuracy: {reason}"));
                }
            }
        }
    }
}

fn check_purity(source: &str, module: &naga::Module, report: &mut Report<'_>) {
    let held = [
        (module.global_variables.len(), "a global variable"),
        (module.overrides.len(), "an `override`"),
        (module.entry_points.len(), "an entry point"),
    ];
    for (_, what) in held.iter().filter(|(count, _)| *count > 0) {
        report(
            Rule::PureFunctions,
            0,
            format!("{what} belongs in a recipe; a module holds functions, structs and consts"),
        );
    }
    for (line, code) in code_lines(source) {
        let word = identifiers(code).next().unwrap_or_default();
        if ["enable", "requires", "diagnostic", "alias", "const_assert"].contains(&word) {
            report(
                Rule::PureFunctions,
                line,
                format!("`{word}` does not survive pasting after other text; leave it out"),
            );
        }
    }
}

fn check_names(name: &str, source: &str, module: &naga::Module, report: &mut Report<'_>) {
    let prefixes = lapidary_wgsl::prefixes(name);
    let mut globals: Vec<(&str, &str)> = Vec::new();
    let functions = module.functions.iter().filter_map(|(_, function)| function.name.as_deref());
    globals.extend(functions.map(|found| (found, prefixes[0].as_str())));
    let types = module.types.iter().filter(|(_, ty)| matches!(ty.inner, naga::TypeInner::Struct { .. }));
    globals.extend(types.filter_map(|(_, ty)| ty.name.as_deref()).map(|found| (found, prefixes[1].as_str())));
    let constants = module.constants.iter().filter_map(|(_, constant)| constant.name.as_deref());
    globals.extend(constants.map(|found| (found, prefixes[2].as_str())));
    for (found, prefix) in globals {
        if !found.starts_with(prefix) {
            let message = format!("`{found}` must start with `{prefix}`, or modules clash when pasted together");
            report(Rule::Prefix, line_of(source, found), message);
        }
    }
    // Checked in the text, because naga drops the names of local consts, and keeps only one of two
    // names for the same value.
    for (line, code) in code_lines(source) {
        for found in identifiers(code).filter(|found| found.ends_with('_') || found.contains("__")) {
            let message = format!("`{found}`: naga renames what ends in `_` or holds `__`, and naga_oil refuses it");
            report(Rule::Identifier, line, message);
        }
    }
    for (_, ty) in module.types.iter() {
        let naga::TypeInner::Struct { members, .. } = &ty.inner else { continue };
        for member in members.iter().filter_map(|member| member.name.as_deref()) {
            if member.ends_with(|c: char| c.is_ascii_digit()) {
                let message = format!("member `{member}` ends in a digit: naga renames it, and naga_oil refuses that");
                report(Rule::Identifier, line_of(source, member), message);
            }
        }
    }
}

/// Iterates over the identifiers and keywords of a line, in order.
fn identifiers(code: &str) -> impl Iterator<Item = &str> {
    let word = |c: char| c.is_alphanumeric() || c == '_';
    code.split(move |c| !word(c)).filter(|token| token.starts_with(|c: char| c.is_alphabetic() || c == '_'))
}

fn check_self_comparison(source: &str, module: &naga::Module, report: &mut Report<'_>) {
    for (_, function) in module.functions.iter() {
        for (handle, expression) in function.expressions.iter() {
            let Expression::Binary { op, left, right } = expression else { continue };
            let equality = matches!(op, naga::BinaryOperator::Equal | naga::BinaryOperator::NotEqual);
            if equality && same(function, *left, *right) {
                let line = function.expressions.get_span(handle).location(source).line_number as usize;
                let name = function.name.as_deref().unwrap_or_default();
                let message = format!(
                    "`{name}` compares a value with itself: naga emits an ordered comparison, so this never finds a NaN; test bits, or keep NaN out"
                );
                report(Rule::SelfComparison, line, message);
            }
        }
    }
}

/// Whether two expressions read the same value.
fn same(function: &Function, left: Handle<Expression>, right: Handle<Expression>) -> bool {
    if left == right {
        return true;
    }
    match (&function.expressions[left], &function.expressions[right]) {
        (Expression::Load { pointer: left }, Expression::Load { pointer: right }) => same(function, *left, *right),
        (
            Expression::AccessIndex { base: left, index: first },
            Expression::AccessIndex { base: right, index: second },
        ) => first == second && same(function, *left, *right),
        // Two calls may return different values.
        (Expression::CallResult(_), _) => false,
        (left, right) => left == right,
    }
}

fn check_literals(source: &str, report: &mut Report<'_>) {
    for (line, code) in code_lines(source) {
        for literal in numeric_literals(code) {
            // The f of 0xff is a digit.
            let typed = if literal.starts_with("0x") && !literal.contains(['p', 'P']) {
                literal.ends_with(['u', 'i'])
            } else {
                literal.ends_with(['f', 'u', 'i'])
            };
            if !typed {
                let message =
                    format!("literal `{literal}` carries no type: write `{literal}f`, `{literal}u` or `{literal}i`");
                report(Rule::Literal, line, message);
            }
        }
    }
}

/// Iterates over the lines, numbered from 1, without comments.
fn code_lines(source: &str) -> impl Iterator<Item = (usize, &str)> {
    source.lines().enumerate().map(|(index, line)| (index + 1, line.split("//").next().unwrap_or_default()))
}

/// Tokens that start with a digit, including exponents and suffixes.
fn numeric_literals(code: &str) -> Vec<&str> {
    let bytes = code.as_bytes();
    let mut literals = Vec::new();
    let mut end = 0;
    while end < bytes.len() {
        let start = end;
        if bytes[end].is_ascii_alphabetic() || bytes[end] == b'_' {
            while end < bytes.len() && (bytes[end].is_ascii_alphanumeric() || bytes[end] == b'_') {
                end += 1;
            }
        } else if bytes[end].is_ascii_digit()
            || (bytes[end] == b'.' && bytes.get(end + 1).is_some_and(u8::is_ascii_digit))
        {
            let exponent: &[u8] = if code[end..].starts_with("0x") { b"pP" } else { b"eE" };
            while end < bytes.len()
                && (bytes[end].is_ascii_alphanumeric()
                    || bytes[end] == b'.'
                    || (matches!(bytes[end], b'+' | b'-') && exponent.contains(&bytes[end - 1])))
            {
                end += 1;
            }
            literals.push(&code[start..end]);
        } else {
            end += 1;
        }
    }
    literals
}

/// First line that contains `word`, from 1; 0 if there is none.
fn line_of(source: &str, word: &str) -> usize {
    source
        .lines()
        .position(|line| line.split("//").next().unwrap_or_default().contains(word))
        .map_or(0, |line| line + 1)
}
