//! Output of `cook check` for people.

use console::Color;
use lapidary_assay::failure::Failure;
use lapidary_assay::slack::Reassociation;
use lapidary_cook::check::{On, Row, differing};
use std::collections::BTreeSet;
use std::fmt::Write as _;

/// Results of a check, with notes.
#[derive(Default)]
pub(super) struct Checked {
    /// The two sides of the comparison.
    pub(super) about: String,
    pub(super) rows: Vec<Row>,
    pub(super) notes: Vec<String>,
}

/// Whether to use colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Style {
    Plain,
    Coloured,
}

impl Style {
    /// Coloured on a terminal that supports it, unless `NO_COLOR` or a similar variable forbids it.
    pub(super) fn of_stdout() -> Style {
        if console::colors_enabled() { Style::Coloured } else { Style::Plain }
    }

    fn paint(self, colour: Color, text: &str) -> String {
        match self {
            Style::Plain => text.to_owned(),
            Style::Coloured => console::Style::new().bold().fg(colour).force_styling(true).apply_to(text).to_string(),
        }
    }

    fn verdict(self, row: &Row) -> String {
        if row.passed() { self.paint(Color::Green, "PASS") } else { self.paint(Color::Red, "FAIL") }
    }
}

/// Describes the two sides of the comparison, and the device.
pub(super) fn about(on: On<'_>) -> String {
    match on {
        On::Adapter(gpu) if gpu.is_lavapipe() => format!(
            "Each result of the shader on {} is compared with that of its mirror in\n\
             Rust (f32) and with the exact one of its oracle (f64); all three may differ by the `Accuracy:` line's bound.",
            gpu.describe()
        ),
        On::Adapter(gpu) => format!(
            "Each result of the shader on {} is compared with the exact one of\n\
             its oracle (f64), from which it may differ by the `Accuracy:` line's portable bound.",
            gpu.describe()
        ),
        On::Browser(browser, gpu) => format!(
            "Each result of the shader in a browser on {} is compared\n\
             with the exact one of its oracle (f64), from which it may differ by the `Accuracy:` line's portable bound; its bits with those on\n{}.",
            browser.adapter(),
            gpu.describe()
        ),
        On::Slack(reassociation) => format!(
            "Each result of the shader on a simulated device, with the largest errors that WGSL allows{}, is\n\
             compared with the exact one of its oracle (f64), from which it may differ by the `Accuracy:` line's portable bound.",
            match reassociation {
                Reassociation::Written => "",
                Reassociation::Reordered => " and sums and products in other orders",
            }
        ),
    }
}

/// Formats the whole report: notes, the table, each failure, the total.
pub(super) fn report(checked: &Checked, style: Style) -> String {
    let mut text = String::new();
    for line in notes(&checked.notes) {
        let _ = writeln!(text, "{line}");
    }
    let _ = write!(text, "{} ", checked.about);
    let _ = writeln!(
        text,
        "`max ulp` to\n\
         `median` are the shader's error against the oracle; `of bound` is the worst error over the allowed one.\n"
    );
    let _ = writeln!(
        text,
        "     {:<44} {:>9} {:>7} {:>9} {:>10} {:>9} {:>9} {:>8} {:>10} {:>7}",
        "function", "cases", "failed", "nonfinite", "max ulp", "p99", "median", "of bound", "hard cases", "seconds"
    );
    for row in &checked.rows {
        let _ = writeln!(
            text,
            "{} {:<44} {:>9} {:>7} {:>9} {:>10} {:>9} {:>9} {:>8} {:>10} {:>7.2}",
            style.verdict(row),
            row.function,
            row.cases,
            row.failed,
            row.nonfinite,
            short(row.max_ulp),
            short(row.p99_ulp),
            short(row.median_ulp),
            short(row.worst_ratio),
            if row.hard_cases == 0 { "-".to_owned() } else { format!("{}/{}", row.held_hard_cases, row.hard_cases) },
            row.seconds
        );
    }
    for row in &checked.rows {
        details(row, style, &mut text);
    }
    if checked.rows.iter().any(|row| row.difference.is_some()) {
        differences(&checked.rows, &mut text);
    }
    if checked.rows.iter().any(|row| row.allowance.is_some()) {
        allowances(&checked.rows, &mut text);
    }
    let assumptions: BTreeSet<&String> = checked.rows.iter().flat_map(|row| &row.assumptions).collect();
    for assumption in assumptions {
        let _ = writeln!(text, "\nWGSL does not state, and it is taken to hold: {assumption}.");
    }
    let failed = checked.rows.iter().filter(|row| !row.passed()).count();
    let held = checked.rows.len() - failed;
    let _ = writeln!(
        text,
        "\n{held} of {} functions hold{}. `backward` in an Accuracy line allows more ulp where the input's own last place makes\n\
         them. Naive forms are left out unless named; they are tested where they do well.",
        checked.rows.len(),
        if failed == 0 { String::new() } else { style.paint(Color::Red, &format!(", {failed} fail")) }
    );
    text
}

/// Lists functions whose results in the browser differ in bits from the adapter's, the most
/// different first.
fn differences(rows: &[Row], text: &mut String) {
    let differing = differing::differing(rows);
    let _ = writeln!(
        text,
        "\nWhere the bits differ. {} of {} functions give the same bits everywhere.\n\
         `discrete` counts results with another bool or integer; distances are in ulp of a result's largest component.\n",
        rows.len() - differing.len(),
        rows.len()
    );
    if differing.is_empty() {
        return;
    }
    let _ = writeln!(
        text,
        "{:<44} {:>9} {:>9} {:>9} {:>10} {:>10}  at",
        "function", "inputs", "differ", "discrete", "median ulp", "max ulp"
    );
    for (row, found) in differing {
        let _ = writeln!(
            text,
            "{:<44} {:>9} {:>9} {:>9} {:>10} {:>10}  {}",
            row.function,
            found.inputs,
            found.differing,
            found.discrete,
            short(found.median_ulp),
            short(found.max_ulp),
            row.difference_input.as_deref().unwrap_or_default()
        );
    }
}

/// Lists bounds that a first-order estimate finds too low or too high.
fn allowances(rows: &[Row], text: &mut String) {
    let _ = writeln!(
        text,
        "\nThe errors that WGSL allows each operation, propagated to the result to first order, are at most the stated bound and at least an eighth of it, except for:"
    );
    let mut none = true;
    for row in rows {
        for field in row.allowances.iter().filter(|field| !field.is_fitting()) {
            none = false;
            let name = format!("{} {}", row.function, field.name);
            let _ = writeln!(
                text,
                "  {:<56} {:>8} of the bound; with the error of the method {:>8}",
                name.trim_end(),
                short(field.largest),
                short(field.with_method)
            );
        }
    }
    if none {
        let _ = writeln!(text, "  none");
    }
}

/// Formats each note in one line.
pub(super) fn notes(notes: &[String]) -> Vec<String> {
    notes.iter().map(|note| format!("note: {note}")).collect()
}

/// Describes what is wrong with a function or missing in its test; writes nothing if all is well.
fn details(row: &Row, style: Style, text: &mut String) {
    if row.passed() && row.missed_edges.is_empty() && row.branches_untested.is_none() {
        return;
    }
    let _ = writeln!(text, "\n{} {}", style.verdict(row), row.function);
    if let Some(reason) = &row.reason {
        let _ = writeln!(text, "  {} of {} inputs fail; the worst: {reason}", row.failed, row.cases);
    }
    if let Some(failure) = &row.failure {
        compared(failure, text);
    }
    for case in &row.broken_hard_cases {
        let _ = writeln!(text, "  hard case {case}");
    }
    for broken in row.broken_promises.iter().chain(&row.broken_branches).chain(&row.worst_choices) {
        let _ = writeln!(text, "  {broken}");
    }
    if let Some(why) = &row.branches_untested {
        let _ = writeln!(text, "  inputs beside its branches were not tested: {why}");
    }
    for edge in &row.missed_edges {
        let advice = if row.passed() { "" } else { ", which fails the check" };
        let _ = writeln!(text, "  edge missed: the inputs never reached {edge}{advice}; run more --cases");
    }
    if !row.passed() {
        let _ = writeln!(text, "  again with: {}", row.reproduce);
    }
    if let Some(file) = &row.kept_in {
        let _ = writeln!(text, "  the input is kept in {file}");
    }
}

fn compared(failure: &Failure, text: &mut String) {
    let _ = writeln!(text, "  the simplest that fails, in WGSL and in Rust:");
    for (call, got, expected, mirror) in [
        (&failure.wgsl, &failure.got, &failure.expected, &failure.mirror),
        (&failure.rust, &failure.got_rust, &failure.expected_rust, &failure.mirror_rust),
    ] {
        let _ = writeln!(text, "    {call}\n      = {got}\n      expected {expected}");
        if mirror != expected {
            let _ = writeln!(text, "      mirror   {mirror}");
        }
    }
    let allowed: Vec<String> = failure
        .fields
        .iter()
        .map(|field| {
            let name = if field.field.is_empty() { String::new() } else { format!("{} ", field.field) };
            let plain = if field.allowed == 0.0 { "none".to_owned() } else { format!("{:e}", rounded(field.allowed)) };
            let backward = match field.backward_ulp {
                0.0 => String::new(),
                ulp => format!(", or what {ulp} ulp of the input make"),
            };
            format!("{name}{plain}{backward}")
        })
        .collect();
    let _ = writeln!(text, "    allowed error: {}", allowed.join("; "));
}

/// Rounds to three digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}

/// Formats three digits in the shorter notation.
fn short(value: f64) -> String {
    if value >= f64::MAX {
        return "inf".to_owned();
    }
    if value == 0.0 || (0.01..10_000.0).contains(&value) { format!("{value:.2}") } else { format!("{value:.1e}") }
}
