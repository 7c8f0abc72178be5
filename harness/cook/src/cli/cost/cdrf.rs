//! Ladder of the curvature-dependent reflectance.

use super::{Context, Failure, Outcome, Places, Report, Shown, behind_a_bar, number, parse_rung};
use lapidary_cook::cost::cdrf::{self, CurvatureSource, Options, Part, plot};
use lapidary_plan::Rung;
use lapidary_scene::solver::Reflectance;

/// Ladder of the curvature-dependent reflectance, timed against Lambert's law and a blur in a
/// texture.
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
    if !arguments.rungs.is_empty() {
        options.rungs = arguments.rungs.iter().map(|rung| reflectance(*rung)).collect::<Result<_, _>>()?;
    }
    let places = Places::new(cdrf::TECHNIQUE, &arguments.report)?;
    let mut report = places.report(|| {
        let gpu = context.gpu()?;
        behind_a_bar(|progress| cdrf::run(gpu, &options, progress))
    })?;
    report.mark_dominated();
    let timed = |rung: &cdrf::RungReport| {
        rung.distance.is_some() && CurvatureSource::ALL.iter().any(|source| rung.ms(Part::Lit, *source).is_some())
    };
    let mut plots = Vec::new();
    if arguments.report.out.is_some() && report.rungs.iter().any(timed) {
        plots.push(("cdrf.svg".to_owned(), plot::svg(&report)?));
    }
    let shown = Shown { text: report.text(), rows: serde_json::to_string_pretty(&report.rows())?, plots };
    places.write(&report, &shown)
}

/// Parses a rung of this ladder.
fn reflectance(rung: Rung) -> Result<Reflectance, Failure> {
    match rung {
        Rung::Diffuse(reflectance) if cdrf::RUNGS.contains(&reflectance.name()) => Ok(reflectance),
        other => Err(Failure(format!("`cdrf` has no rung {other}; there are {}", cdrf::RUNGS.join(", ")))),
    }
}
