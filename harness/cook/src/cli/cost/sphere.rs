//! The translucent sphere.

use super::{Arguments, Failure, Outcome, Places, Shown, behind_a_bar};
use lapidary_cook::cost::sphere::{self, plot};

/// Walks through each sphere: half a minute on two cores.
const WALKS: u64 = 1_000_000;

pub(super) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    arguments.refuse_but("sphere", &["--walks", "--seed"])?;
    let places = Places::new("sphere", arguments)?;
    let report = places.report(|| {
        let walks = arguments.walks.map_or(WALKS, u64::from);
        behind_a_bar(|progress| Ok(sphere::run(walks, arguments.seed.unwrap_or(1), progress)))
    })?;
    let mut plots = Vec::new();
    if arguments.out.is_some() {
        plots.push(("sphere_sigma.svg".to_owned(), plot::sigma(&report)?));
        plots.push(("sphere_profile.svg".to_owned(), plot::profile(&report)?));
    }
    let shown = Shown { text: report.text(), rows: serde_json::to_string_pretty(&report.rows)?, plots };
    places.write(&report, &shown)
}
