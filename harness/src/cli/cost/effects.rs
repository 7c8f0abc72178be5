//! What each effect costs.

use super::{Arguments, Context, Failure, Outcome, Places, Shown, behind_a_bar, refuse};
use lapidary_harness::cost::effects::{self, Options};

pub(super) fn run(context: &Context, arguments: &Arguments) -> Result<Outcome, Failure> {
    let ignored = [
        ("--rungs", !arguments.rungs.is_empty()),
        ("--views", !arguments.views.is_empty()),
        ("--walks", arguments.walks.is_some()),
        ("--seed", arguments.seed.is_some()),
        ("--profile", arguments.profile),
    ];
    refuse(effects::TECHNIQUE, &ignored)?;
    let mut options = Options::default();
    options.rounds = arguments.rounds.unwrap_or(options.rounds);
    let places = Places::new(effects::TECHNIQUE, arguments)?;
    let report = places.report(|| {
        let gpu = context.gpu()?;
        behind_a_bar(|progress| effects::run(gpu, &options, progress))
    })?;
    let rows = serde_json::to_string_pretty(&report.rows())?;
    places.write(&report, &Shown { text: report.text(), rows, plots: Vec::new() })
}
