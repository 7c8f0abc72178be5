//! The tables of the reflectance's studies, among the ladder's own.

use super::{head, law};
use crate::among::insert;
use lapidary_ladders::cdrf::LADDER;
use lapidary_ladders::{Report, Table};

/// Returns the studies' own tables.
pub(crate) fn own(report: &Report) -> [Table; 5] {
    [law::table(report), law::shadows_table(report), head::table(report), law::zones_table(report), law::goals(report)]
}

/// Returns the ladder's tables with the studies' own among them.
pub(super) fn tables(report: &Report) -> Vec<Table> {
    let mut tables = (LADDER.tables)(report);
    insert(&mut tables, "cdrf_scenes", own(report));
    tables
}
