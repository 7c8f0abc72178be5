//! A ladder: its name, and how its report is shown.

use crate::plot::Plot;
use crate::report::Report;
use crate::table::Table;

/// How a ladder's report is shown.
pub struct Ladder {
    /// The ladder's name.
    pub name: &'static str,
    /// Makes the tables.
    pub tables: fn(&Report) -> Vec<Table>,
    /// Makes the plots, of which some may be empty.
    pub plots: fn(&Report) -> Vec<Plot>,
    /// Checks that a report has all that its tables show, and else says what a page would lack.
    pub whole: fn(&Report) -> Result<(), String>,
}

impl Ladder {
    /// Returns all tables of a report as text.
    pub fn text(&self, report: &Report) -> String {
        let tables = (self.tables)(report);
        let tables: Vec<String> = tables.iter().filter(|table| !table.is_empty()).map(Table::text).collect();
        format!("{}: {}\n\n{}", report.technique, report.run(), tables.join("\n"))
    }
}
