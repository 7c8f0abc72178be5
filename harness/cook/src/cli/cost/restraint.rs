//! What restraint saves.

use super::{Arguments, Context, Failure, Outcome, Places, Shown, behind_a_bar};
use lapidary_cook::cost::restraint::{self, Options};
use lapidary_plan::Rung;

pub(super) fn run(context: &Context, arguments: &Arguments) -> Result<Outcome, Failure> {
    arguments.refuse_but(restraint::TECHNIQUE, &["--rungs", "--rounds"])?;
    if let Some(rung) = arguments.rungs.iter().find(|rung| !matches!(rung, Rung::Inside { .. })) {
        return Err(Failure(format!(
            "`restraint` has no rung {rung}, whose rays end at once; take one such as convex-8"
        )));
    }
    let mut options = Options::default();
    match arguments.rounds {
        Some(0) => return Err(Failure("`restraint` is nothing but times; take at least 1 round".to_owned())),
        Some(rounds) => options.rounds = rounds,
        None => {}
    }
    if !arguments.rungs.is_empty() {
        options.rungs.clone_from(&arguments.rungs);
    }
    let places = Places::new(restraint::TECHNIQUE, arguments)?;
    let report = places.report(|| {
        let gpu = context.gpu()?;
        behind_a_bar(|progress| restraint::run(gpu, &options, progress))
    })?;
    let rows = serde_json::to_string_pretty(&report.rows())?;
    places.write(&report, &Shown { text: report.text(), rows, plots: Vec::new() })
}
