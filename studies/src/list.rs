//! All studies.

use crate::{cdrf, dynamic, gem, outside, restraint, sphere};
use lapidary_ladders::{Ladder, Report};

/// All studies; those of a ladder are shown with it.
pub const STUDIES: [Ladder; 6] =
    [gem::LADDER, cdrf::LADDER, outside::LADDER, dynamic::LADDER, restraint::LADDER, sphere::LADDER];

/// Returns the names of the studies' own tables.
pub fn tables() -> Vec<&'static str> {
    let report = Report::default();
    let alone = [outside::LADDER, dynamic::LADDER, restraint::LADDER, sphere::LADDER];
    let alone = alone.iter().flat_map(|study| (study.tables)(&report));
    let of_ladders = gem::tables::own(&report).into_iter().chain(cdrf::tables::own(&report));
    of_ladders.chain(alone).map(|table| table.name).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use lapidary_ladders::page;

    #[test]
    fn pages_know_the_studies_tables() {
        let mut names = tables();
        names.sort_unstable();
        let mut known = page::STUDIED.to_vec();
        known.sort_unstable();
        assert_eq!(names, known);
    }

    #[test]
    fn nothing_measured_fills_no_page() {
        for study in &STUDIES {
            assert!((study.whole)(&Report::default()).is_err(), "{}", study.name);
        }
    }
}
