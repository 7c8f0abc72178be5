//! The translucent sphere.

use super::{Failure, Outcome, Places, Report, Shown, behind_a_bar, number};
use lapidary_cook::cost::sphere::{self, plot};

/// Walks through each sphere: half a minute on two cores.
const WALKS: u64 = 1_000_000;

/// Compares the curvature-dependent reflectance with random walks through spheres, on the CPU.
/// Takes half a minute.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Random walks through each sphere.
    #[arg(long, value_name = "N", default_value_t = WALKS, conflicts_with = "from", value_parser = number::whole(1..=u64::MAX))]
    walks: u64,
    /// Seed of the walks; the same seed gives the same walks.
    #[arg(long, default_value_t = 1, conflicts_with = "from", value_parser = number::whole(0..=u64::MAX))]
    seed: u64,
    #[command(flatten)]
    report: Report,
}

pub(super) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let places = Places::new("sphere", &arguments.report)?;
    let report =
        places.report(|| behind_a_bar(|progress| Ok(sphere::run(arguments.walks, arguments.seed, progress))))?;
    let mut plots = Vec::new();
    if arguments.report.out.is_some() {
        plots.push(("sphere_sigma.svg".to_owned(), plot::sigma(&report)?));
        plots.push(("sphere_profile.svg".to_owned(), plot::profile(&report)?));
    }
    let shown = Shown { text: report.text(), rows: serde_json::to_string_pretty(&report.rows)?, plots };
    places.write(&report, &shown)
}
