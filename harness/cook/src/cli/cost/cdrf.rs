//! The curvature-dependent reflectance's ladder.

use super::{Arguments, Context, Failure, Outcome, Places, Shown, behind_a_bar};
use lapidary_cook::cost::cdrf::{self, CurvatureSource, Options, Part, plot};
use lapidary_plan::Rung;
use lapidary_scene::solver::Reflectance;

pub(super) fn run(context: &Context, arguments: &Arguments) -> Result<Outcome, Failure> {
    arguments.refuse_but(cdrf::TECHNIQUE, &["--rungs", "--rounds"])?;
    let mut options = Options::default();
    if let Some(rounds) = arguments.rounds {
        options.rounds = rounds;
    }
    if !arguments.rungs.is_empty() {
        options.rungs = arguments.rungs.iter().map(|rung| reflectance(*rung)).collect::<Result<_, _>>()?;
    }
    let places = Places::new(cdrf::TECHNIQUE, arguments)?;
    let mut report = places.report(|| {
        let gpu = context.gpu()?;
        behind_a_bar(|progress| cdrf::run(gpu, &options, progress))
    })?;
    report.mark_dominated();
    let timed = |rung: &cdrf::RungReport| {
        rung.distance.is_some() && CurvatureSource::ALL.iter().any(|source| rung.ms(Part::Lit, *source).is_some())
    };
    let mut plots = Vec::new();
    if arguments.out.is_some() && report.rungs.iter().any(timed) {
        plots.push(("cdrf.svg".to_owned(), plot::svg(&report)?));
    }
    let shown = Shown { text: report.text(), rows: serde_json::to_string_pretty(&report.rows())?, plots };
    places.write(&report, &shown)
}

/// A rung of this ladder.
fn reflectance(rung: Rung) -> Result<Reflectance, Failure> {
    match rung {
        Rung::Diffuse(reflectance) if cdrf::RUNGS.contains(&reflectance.name()) => Ok(reflectance),
        other => Err(Failure(format!("`cdrf` has no rung {other}; there are {}", cdrf::RUNGS.join(", ")))),
    }
}
