//! What each effect costs.

use super::{Arguments, Context, Failure, Outcome, Places, Shown, behind_a_bar};
use lapidary_cook::cost::effects::{self, Options};

pub(super) fn run(context: &Context, arguments: &Arguments) -> Result<Outcome, Failure> {
    arguments.refuse_but(effects::TECHNIQUE, &["--rounds"])?;
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
