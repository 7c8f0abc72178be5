//! Inserts a report's tables between marks in the pages of `docs/`, so that no figure is copied by
//! hand.

use super::Report;
use super::cdrf::CdrfReport;
use super::effects::EffectsReport;
use super::optical_path::OpticalPathReport;
use super::restraint::RestraintReport;
use super::sphere::SphereReport;
use std::fmt::Write as _;

/// The mark before a generated table, followed by the table's name.
const BEGIN: &str = "<!-- generated: ";
/// The mark after a generated table.
const END: &str = "<!-- end -->";

/// Name of the README's table of modules, which belongs to no report.
pub const MODULES: &str = "modules";

/// Name of the table of built-in functions by device.
pub const BUILTINS: &str = "builtins";

/// Name of the table of functions whose bits differ between devices.
pub const DIFFERENCES: &str = "differences";

/// A table's name, and the function that makes it from a report.
pub type Table<R> = (&'static str, fn(&R) -> String);

/// A report whose tables appear on pages.
pub trait Tables: Sized + 'static {
    /// The report's tables; their names are unique across all reports.
    const TABLES: &'static [Table<Self>];

    /// Checks that the report holds everything that its tables show.
    ///
    /// # Errors
    ///
    /// Returns a message that says what is missing: the page would have gaps.
    fn whole(&self) -> Result<(), String>;
}

/// Returns the names of all tables.
fn names() -> Vec<&'static str> {
    fn of<R: Tables>() -> impl Iterator<Item = &'static str> {
        R::TABLES.iter().map(|(name, _)| *name)
    }
    let paths = of::<OpticalPathReport>().chain(of::<RestraintReport>()).chain(of::<EffectsReport>());
    of::<Report>()
        .chain(of::<CdrfReport>())
        .chain(of::<SphereReport>())
        .chain(paths)
        .chain([MODULES, BUILTINS, DIFFERENCES])
        .collect()
}

/// Checks that a page's marks are well formed.
///
/// # Errors
///
/// Returns an error if a mark has no end, or if no table has its name.
pub fn check(page: &str) -> Result<(), String> {
    with_tables(page, |_| None).map(|_| ())
}

/// Returns `page` with its marked tables regenerated from `report`; tables of other reports stay as
/// they are.
///
/// # Errors
///
/// Returns an error as in [`check`], or if the report is not [whole](Tables::whole).
pub fn fill<R: Tables>(page: &str, report: &R) -> Result<String, String> {
    report.whole()?;
    remake(page, report)
}

/// Returns `page` with the table called `name` replaced by `table`.
///
/// # Errors
///
/// Returns an error as in [`check`].
pub fn with_table(page: &str, name: &str, table: &str) -> Result<String, String> {
    with_tables(page, |marked| (marked == name).then(|| format!("\n{table}")))
}

fn remake<R: Tables>(page: &str, report: &R) -> Result<String, String> {
    with_tables(page, |name| {
        let (_, make) = R::TABLES.iter().find(|(table, _)| *table == name)?;
        Some(format!("\n{}", make(report)))
    })
}

/// Returns `page` with the text between each pair of marks replaced by what `make` returns for the
/// table's name; `None` keeps the existing text.
fn with_tables(page: &str, make: impl Fn(&str) -> Option<String>) -> Result<String, String> {
    let mut filled = String::new();
    let mut rest = page;
    while let Some((before, marked)) = rest.split_once(BEGIN) {
        let (name, after) = marked.split_once(" -->").ok_or(format!("`{BEGIN}` without `-->`"))?;
        let (old, after) = after.split_once(END).ok_or(format!("`{BEGIN}{name} -->` without `{END}`"))?;
        if !names().contains(&name) {
            return Err(format!("no table `{name}`; there are {}", names().join(", ")));
        }
        let table = make(name).unwrap_or_else(|| old.to_owned());
        let _ = write!(filled, "{before}{BEGIN}{name} -->{table}{END}");
        rest = after;
    }
    filled.push_str(rest);
    Ok(filled)
}

/// Returns the first two lines of a table.
pub(super) fn header(columns: &[&str]) -> String {
    format!("| {} |\n|{}\n", columns.join(" | "), "---|".repeat(columns.len()))
}

/// Appends a row to a table.
pub(super) fn row(table: &mut String, cells: &[String]) {
    let _ = writeln!(table, "| {} |", cells.join(" | "));
}

/// Formats a number of bytes.
pub(super) fn bytes(count: u64) -> String {
    match count {
        0 => "0".to_owned(),
        1..10_000 => format!("{count} B"),
        10_000..10_000_000 => format!("{:.0} KiB", count as f64 / 1024.0),
        _ => format!("{:.0} MiB", count as f64 / f64::from(1 << 20)),
    }
}

/// Appends a goal's row to a table.
pub(super) fn judged(table: &mut String, goal: &str, measured: String, met: bool) {
    row(table, &[goal.to_owned(), measured, if met { "met" } else { "missed" }.to_owned()]);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn report() -> Report {
        serde_json::from_str(
            r#"{"adapter": "a device", "views": [], "concave": [], "side": 4, "samples": 1, "frame": [2, 1], "rungs": [],
            "colours": [], "choices": [], "steadiness": [], "sizes": [], "reflections": [{"mesh": "exact", "table": 1.0, "crown": 0.5}]}"#,
        )
        .expect("a report")
    }

    #[test]
    fn what_is_marked_is_made_anew_and_the_rest_stays() {
        let page = "before\n<!-- generated: reflections -->\nold\n<!-- end -->\nafter\n";
        let fill = |page: &str| remake(page, &report()).expect("filled");
        let filled = fill(page);
        assert!(filled.starts_with("before\n<!-- generated: reflections -->\n| mesh |"), "{filled}");
        assert!(filled.contains("| exact | 100.0 % | 50.0 % |\n<!-- end -->\nafter\n") && !filled.contains("old"));
        assert_eq!(fill(&filled), filled);
        assert_eq!(fill("no marks"), "no marks");
    }

    #[test]
    fn marks_that_are_wrong_are_refused() {
        for page in ["<!-- generated: ladder -->", "<!-- generated: other -->\n<!-- end -->", "<!-- generated: "] {
            assert!(check(page).is_err(), "{page}");
        }
        assert_eq!(check("<!-- generated: ladder --><!-- end -->"), Ok(()));
    }

    #[test]
    fn tables_of_other_reports_stay() {
        let page = "<!-- generated: ladder -->\nmine\n<!-- end -->\n";
        let empty = SphereReport::of(1, 1, Vec::new());
        assert_eq!(remake(page, &empty).expect("filled"), page);
        assert!(fill(page, &empty).expect_err("it holds nothing").contains("albedo"));
    }

    #[test]
    fn no_two_tables_have_one_name() {
        let mut all = names();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), names().len());
    }

    #[test]
    fn a_part_of_the_ladder_fills_no_page() {
        let error = fill("<!-- generated: ladder --><!-- end -->", &report()).expect_err("nothing was timed");
        assert!(error.contains("surface"), "{error}");
    }
}
