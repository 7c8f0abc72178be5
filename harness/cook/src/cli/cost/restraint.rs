//! Savings from restraint.

use super::{Context, Failure, Outcome, Places, Report, Shown, behind_a_bar, number, parse_rung};
use lapidary_cook::cost::restraint::{self, Options};
use lapidary_plan::Rung;

/// Savings from skipping work that a pixel or a tile does not need. Ends rays whose contribution
/// can no longer be seen, traces optical paths only in tiles with matter, and compares one recipe
/// variant per material with one for all. Takes minutes.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Rungs to measure, comma-separated; all by default.
    #[arg(long, value_delimiter = ',', value_parser = parse_rung, conflicts_with = "from")]
    rungs: Vec<Rung>,
    /// Rounds of timing, at least 1.
    #[arg(long, default_value_t = Options::default().rounds, conflicts_with = "from", value_parser = number::whole(1..=u32::MAX))]
    rounds: u32,
    #[command(flatten)]
    report: Report,
}

pub(super) fn run(context: &Context, arguments: &Arguments) -> Result<Outcome, Failure> {
    if let Some(rung) = arguments.rungs.iter().find(|rung| !matches!(rung, Rung::Inside { .. })) {
        return Err(Failure(format!(
            "`restraint` has no rung {rung}, whose rays end at once; take one such as convex-8"
        )));
    }
    let mut options = Options { rounds: arguments.rounds, ..Options::default() };
    if !arguments.rungs.is_empty() {
        options.rungs.clone_from(&arguments.rungs);
    }
    let places = Places::new(restraint::TECHNIQUE, &arguments.report)?;
    let report = places.report(|| {
        let gpu = context.gpu()?;
        behind_a_bar(|progress| restraint::run(gpu, &options, progress))
    })?;
    let rows = serde_json::to_string_pretty(&report.rows())?;
    places.write(&report, &Shown { text: report.text(), rows, plots: Vec::new() })
}
