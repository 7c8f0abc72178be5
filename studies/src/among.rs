//! Tables of a study among those of the ladder whose report it shares.

use lapidary_ladders::Table;

/// Puts a study's tables behind the ladder's table with that name. One that the report has nothing for is left out, so
/// that a page keeps it.
pub(crate) fn insert(tables: &mut Vec<Table>, behind: &str, added: impl IntoIterator<Item = Table>) {
    let place = tables.iter().position(|table| table.name == behind).map_or(tables.len(), |before| before + 1);
    tables.splice(place..place, added.into_iter().filter(|table| !table.is_empty()));
}
