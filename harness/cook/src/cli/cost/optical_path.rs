//! The ladder of light's ways through stone.

use super::{Arguments, Context, Failure, Outcome, Places, Shown, behind_a_bar};
use lapidary_cook::cost::optical_path::{self, Options, RungReport, plot};
use lapidary_plan::Rung;

pub(super) fn run(context: &Context, arguments: &Arguments) -> Result<Outcome, Failure> {
    arguments.refuse_but(optical_path::TECHNIQUE, &["--rungs", "--rounds"])?;
    let mut options = Options::default();
    if let Some(rounds) = arguments.rounds {
        options.rounds = rounds;
    }
    let draws_no_stone = |rung: &&Rung| match rung {
        Rung::Diffuse(reflectance) => !reflectance.is_lambert(),
        other => !matches!(other, Rung::OpticalPath(_)),
    };
    if let Some(other) = arguments.rungs.iter().find(draws_no_stone) {
        let names = optical_path::RUNGS.join(", ");
        return Err(Failure(format!("`optical_path` has no rung {other}; there are {names}")));
    }
    if !arguments.rungs.is_empty() {
        options.rungs.clone_from(&arguments.rungs);
    }
    let places = Places::new(optical_path::TECHNIQUE, arguments)?;
    let mut report = places.report(|| {
        let gpu = context.gpu()?;
        behind_a_bar(|progress| optical_path::run(gpu, &options, progress))
    })?;
    report.mark_dominated();
    let mut plots = Vec::new();
    if arguments.out.is_some() && report.rungs.iter().any(|rung: &RungReport| rung.grey("ball").is_some()) {
        plots.push(("optical_path_error.svg".to_owned(), plot::error(&report)?));
        if plot::has_growth(&report) {
            plots.push(("optical_path_growth.svg".to_owned(), plot::growth(&report)?));
        }
    }
    let shown = Shown { text: report.text(), rows: serde_json::to_string_pretty(&report.rows())?, plots };
    places.write(&report, &shown)
}
