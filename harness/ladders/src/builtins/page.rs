//! The measured built-ins as tables.

use super::measured::Report;
use std::fmt::Write as _;

/// Returns a table of the measurements.
pub fn text(report: &Report) -> String {
    let every = if report.stride == 1 { "all floats".to_owned() } else { format!("every {}th float", report.stride) };
    let mut text = format!(
        "Built-in functions on {}.\nThose of one float over {every}, the others over 2^24 samples. Errors are from the exact value (f64): in ulp of it, where it is a normal float;\n\
         absolute; and over what WGSL allows a device. Subnormal arguments are left out.\n\n\
         {:<20} {:<8} {:>11} {:>11} {:>10} {:>11} {:>8} {:>8} {:>10}  {:<24} {}\n",
        report.adapter,
        "function",
        "range",
        "inputs",
        "not nearest",
        "max ulp",
        "max abs",
        "of WGSL",
        "flushed",
        "nonfinite",
        "max ulp at",
        "of WGSL at"
    );
    for row in &report.rows {
        let spelt = |floats: &[f32]| floats.iter().map(|float| format!("{float:e}")).collect::<Vec<_>>().join(", ");
        let share = row.of_wgsl.map_or("-".to_owned(), |share| format!("{share:.4}"));
        let ulp = if row.max_ulp < 1e5 { format!("{:.3}", row.max_ulp) } else { format!("{:.2e}", row.max_ulp) };
        let _ = writeln!(
            text,
            "{:<20} {:<8} {:>11} {:>11} {:>10} {:>11.3e} {:>8} {:>8} {:>10}  {:<24} {}",
            row.name,
            row.range,
            row.inputs,
            row.not_nearest,
            ulp,
            row.max_absolute,
            share,
            row.flushed,
            row.nonfinite,
            spelt(&row.at),
            spelt(&row.of_wgsl_at)
        );
    }
    text
}

/// Returns a table that compares devices, for the built-ins and ranges with an accuracy in WGSL:
/// the largest ratio of the error to the allowed one, and the largest error in ulp.
pub fn side_by_side(reports: &[(&str, Report)]) -> String {
    let names: Vec<&str> = reports.iter().map(|(name, _)| *name).collect();
    let mut table = format!("| function | {} |\n|---|{}\n", names.join(" | "), "---|".repeat(names.len()));
    let Some((_, first)) = reports.first() else { return table };
    for row in first.rows.iter().filter(|row| row.of_wgsl.is_some()) {
        let cells: Vec<String> = reports
            .iter()
            .map(|(_, report)| {
                let found = report.rows.iter().find(|other| (&other.name, &other.range) == (&row.name, &row.range));
                found.map_or("-".to_owned(), |found| {
                    let share = found.of_wgsl.unwrap_or_default();
                    let share = if share > 1.0 { format!("**{share:.2}**") } else { format!("{share:.2}") };
                    // Near a zero of the function the error in ulp is unbounded.
                    let ulp = format!(" ({:.1} ulp)", found.max_ulp.max(0.5));
                    if found.max_ulp < 1e4 { share + &ulp } else { share }
                })
            })
            .collect();
        let _ = writeln!(table, "| `{}` | {} |", row.name, cells.join(" | "));
    }
    table
}
