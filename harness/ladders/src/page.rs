//! Inserts a report's tables between marks in the pages of `docs/`, so that no figure is copied by
//! hand.

use crate::ladder::Ladder;
use crate::list::LADDERS;
use crate::report::Report;
use std::fmt::Write as _;

/// The mark before a generated table, followed by the table's name.
const BEGIN: &str = "<!-- generated: ";
/// The mark after a generated table.
const END: &str = "<!-- end -->";

/// Name of the table of modules, docs/modules.md, which belongs to no report.
pub const MODULES: &str = "modules";

/// Name of the table of rungs by quality, of `docs/choosing.md`.
pub const CHOICES: &str = "choices";

/// Name of the table of built-in functions by device.
pub const BUILTINS: &str = "builtins";

/// Name of the table of functions whose bits differ between devices.
pub const DIFFERENCES: &str = "differences";

/// Names of the tables of studies (`./cook studies`), some of them of a ladder's report.
pub const STUDIED: [&str; 22] = [
    "proxy_sizes",
    "growth",
    "reflections",
    "cdrf_law",
    "cdrf_shadows",
    "cdrf_head",
    "cdrf_zones",
    "cdrf_law_goals",
    "outside",
    "dynamic",
    "dynamic_goals",
    "restraint_throughput",
    "restraint_tiles",
    "restraint_variants",
    "sphere_walks",
    "sphere_widths",
    "sphere_widths_with_unscattered",
    "sphere_residuals",
    "sphere_albedos",
    "sphere_laws",
    "sphere_choices",
    "sphere_fits",
];

/// Returns the names of all tables.
fn names() -> Vec<&'static str> {
    let names_of = |ladder: &Ladder| (ladder.tables)(&Report::default()).into_iter().map(|table| table.name);
    LADDERS.iter().flat_map(names_of).chain(STUDIED).chain([MODULES, CHOICES, BUILTINS, DIFFERENCES]).collect()
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
/// Returns an error as in [`check`], or if the report lacks figures that a page shows.
pub fn fill(page: &str, ladder: &Ladder, report: &Report) -> Result<String, String> {
    (ladder.whole)(report)?;
    let tables = (ladder.tables)(report);
    with_tables(page, |name| Some(format!("\n{}", tables.iter().find(|table| table.name == name)?.markdown())))
}

/// Returns `page` with the table called `name` replaced by `table`.
///
/// # Errors
///
/// Returns an error as in [`check`].
pub fn with_table(page: &str, name: &str, table: &str) -> Result<String, String> {
    with_tables(page, |marked| (marked == name).then(|| format!("\n{table}")))
}

/// Returns `page` with the text between each pair of marks replaced by what `make` returns for the
/// table's name; `None` keeps the existing text.
fn with_tables(page: &str, make: impl Fn(&str) -> Option<String>) -> Result<String, String> {
    let names = names();
    let mut filled = String::new();
    let mut rest = page;
    while let Some((before, marked)) = rest.split_once(BEGIN) {
        let (name, after) = marked.split_once(" -->").ok_or(format!("`{BEGIN}` without `-->`"))?;
        let (old, after) = after.split_once(END).ok_or(format!("`{BEGIN}{name} -->` without `{END}`"))?;
        if !names.contains(&name) {
            return Err(format!("no table `{name}`; there are {}", names.join(", ")));
        }
        let table = make(name).unwrap_or_else(|| old.to_owned());
        let _ = write!(filled, "{before}{BEGIN}{name} -->{table}{END}");
        rest = after;
    }
    filled.push_str(rest);
    Ok(filled)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Row, Table};

    /// A ladder of a single table, which lists the report's rungs.
    const SMALL: Ladder = Ladder {
        name: "small",
        tables: |report| {
            vec![Table::of("steadiness", "", report.rungs("a")).column("rung", |r| (*r).to_owned()).note("")]
        },
        plots: |_| Vec::new(),
        whole: |report| if report.rows.is_empty() { Err("it is empty".to_owned()) } else { Ok(()) },
    };

    #[test]
    fn what_is_marked_is_made_anew_and_the_rest_stays() {
        let mut report = Report::default();
        let page = "before\n<!-- generated: steadiness -->\nold\n<!-- end -->\n<!-- generated: ladder -->\nmine\n<!-- end -->\n";
        assert_eq!(fill(page, &SMALL, &report), Err("it is empty".to_owned()));
        report.rows.push(Row::new("proxy-1", "view", "a", 1.0, ""));
        let filled = fill(page, &SMALL, &report).expect("filled");
        assert_eq!(filled, page.replace("old", "| rung |\n|---|\n| proxy-1 |"));
        assert_eq!(fill(&filled, &SMALL, &report).expect("filled"), filled);
        assert_eq!(fill("no marks", &SMALL, &report).expect("filled"), "no marks");
    }

    #[test]
    fn marks_that_are_wrong_are_refused() {
        for page in ["<!-- generated: ladder -->", "<!-- generated: other -->\n<!-- end -->", "<!-- generated: "] {
            assert!(check(page).is_err(), "{page}");
        }
        assert_eq!(check("<!-- generated: ladder --><!-- end -->"), Ok(()));
    }

    #[test]
    fn no_two_tables_have_one_name() {
        let mut all = names();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), names().len());
    }

    #[test]
    fn nothing_measured_fills_no_page() {
        for ladder in &LADDERS {
            assert!((ladder.whole)(&Report::default()).is_err(), "{}", ladder.name);
        }
    }
}
