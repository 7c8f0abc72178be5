//! Cost of each effect.

use super::{Context, Failure, Outcome, Places, Report, Shown, behind_a_bar, number};
use lapidary_cook::cost::effects::{self, Options};

/// Cost of each effect alone, of none, and of all: time, instructions and bytes.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Rounds of timing; 0 skips timing.
    #[arg(long, default_value_t = Options::default().rounds, conflicts_with = "from", value_parser = number::whole(0..=u32::MAX))]
    rounds: u32,
    #[command(flatten)]
    report: Report,
}

pub(super) fn run(context: &Context, arguments: &Arguments) -> Result<Outcome, Failure> {
    let options = Options { rounds: arguments.rounds, ..Options::default() };
    let places = Places::new(effects::TECHNIQUE, &arguments.report)?;
    let report = places.report(|| {
        let gpu = context.gpu()?;
        behind_a_bar(|progress| effects::run(gpu, &options, progress))
    })?;
    let rows = serde_json::to_string_pretty(&report.rows())?;
    places.write(&report, &Shown { text: report.text(), rows, plots: Vec::new() })
}
