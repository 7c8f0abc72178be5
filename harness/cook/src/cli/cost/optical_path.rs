//! Ladder of optical paths through stone.

use super::{Context, Failure, Outcome, Places, Report, Shown, behind_a_bar, number, parse_rung};
use lapidary_cook::cost::optical_path::{self, Options, RungReport, plot};
use lapidary_plan::Rung;

/// Ladder of optical paths through stone, by solver, neighbours and grid size. Takes minutes.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Rungs to measure, comma-separated; all by default.
    #[arg(long, value_delimiter = ',', value_parser = parse_rung, conflicts_with = "from")]
    rungs: Vec<Rung>,
    /// Rounds of timing; 0 skips timing.
    #[arg(long, default_value_t = Options::default().rounds, conflicts_with = "from", value_parser = number::whole(0..=u32::MAX))]
    rounds: u32,
    #[command(flatten)]
    report: Report,
}

pub(super) fn run(context: &Context, arguments: &Arguments) -> Result<Outcome, Failure> {
    let mut options = Options { rounds: arguments.rounds, ..Options::default() };
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
    let places = Places::new(optical_path::TECHNIQUE, &arguments.report)?;
    let mut report = places.report(|| {
        let gpu = context.gpu()?;
        behind_a_bar(|progress| optical_path::run(gpu, &options, progress))
    })?;
    report.mark_dominated();
    let mut plots = Vec::new();
    if arguments.report.out.is_some() && report.rungs.iter().any(|rung: &RungReport| rung.grey("ball").is_some()) {
        plots.push(("optical_path_error.svg".to_owned(), plot::error(&report)?));
        if plot::has_growth(&report) {
            plots.push(("optical_path_growth.svg".to_owned(), plot::growth(&report)?));
        }
    }
    let shown = Shown { text: report.text(), rows: serde_json::to_string_pretty(&report.rows())?, plots };
    places.write(&report, &shown)
}
