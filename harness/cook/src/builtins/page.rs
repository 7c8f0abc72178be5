//! The measured built-ins as a table.

use super::Report;
use std::fmt::Write as _;

/// A table of what was measured.
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
        let spelt = |at: &[f32]| at.iter().map(|float| format!("{float:e}")).collect::<Vec<_>>().join(", ");
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
