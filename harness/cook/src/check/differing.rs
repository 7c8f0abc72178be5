//! The functions whose results differ between a browser and an adapter, as a table.

use super::Row;
use super::difference::Difference;
use std::cmp::Ordering;
use std::fmt::Write as _;

/// Returns the functions whose bits differ, the largest difference first.
pub fn differing(rows: &[Row]) -> Vec<(&Row, &Difference)> {
    let mut differing: Vec<(&Row, &Difference)> = rows
        .iter()
        .filter_map(|row| Some((row, row.difference.as_ref().filter(|found| found.differing > 0)?)))
        .collect();
    differing.sort_by(|(_, one), (_, other)| {
        (other.discrete, other.max_ulp).partial_cmp(&(one.discrete, one.max_ulp)).unwrap_or(Ordering::Equal)
    });
    differing
}

/// Returns a table of these functions, and the number of functions that do not differ.
pub fn table(rows: &[Row]) -> String {
    let differing = differing(rows);
    let same = rows.len() - differing.len();
    let mut table = format!(
        "{same} of {} functions give the same bits for every input.\n\n| function | inputs that differ | another flag or integer | median ulp | largest ulp |\n|---|---|---|---|---|\n",
        rows.len()
    );
    for (row, found) in differing {
        let share = 100.0 * found.differing as f64 / found.inputs.max(1) as f64;
        let number = |ulp: f64| if (0.01..1e4).contains(&ulp) { format!("{ulp:.1}") } else { format!("{ulp:.0e}") };
        let _ = writeln!(
            table,
            "| `{}` | {share:.2} % | {} | {} | {} |",
            row.function,
            found.discrete,
            number(found.median_ulp),
            number(found.max_ulp)
        );
    }
    table
}
