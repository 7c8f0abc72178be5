//! What restraint saves.

use super::{Context, Failure, Outcome, Places, Report, Shown, behind_a_bar, number, parse_rung};
use lapidary_cook::cost::restraint::{self, Options};
use lapidary_plan::Rung;

/// What is saved by work that a pixel or a tile has no use for: rays that end when what they carry can no longer be seen, and ways
/// through stone sought in tiles with matter alone; and a variant of the recipe for each material beside one for all. Takes minutes.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Rungs to measure, comma-separated; all where left out.
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
