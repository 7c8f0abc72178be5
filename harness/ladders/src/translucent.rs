//! Bodies through which light comes: the distance of each technique from random walks, and the time
//! of the same pictures.

use crate::error::CostError;
use crate::ladder::Ladder;
use crate::optical_path::{Measured, WALKED, Walks, settings};
use crate::options::{Options, Progress};
use crate::quality;
use crate::report::{Report, Row};
use crate::table::{Goal, Table, figure};
use crate::timing::{self, Timed};
use lapidary_gpu::Gpu;
use lapidary_plan::Rung;
use lapidary_plan::Technique;
use lapidary_scene::Scene;

/// The ladder.
pub const LADDER: Ladder = Ladder { name: "translucent", tables, plots: |_| Vec::new(), whole };

/// The rungs: Lambert's law, optical paths, diffusion, and the walks themselves.
pub const RUNGS: [&str; 11] = [
    "lambert",
    LAMBERT_SHADOWED,
    "tiled-26-32",
    "godunov-32",
    "godunov-64",
    "godunov-128",
    "diffusion-32",
    "diffusion-64",
    "diffusion-limited-64",
    "diffusion-128",
    REFERENCE,
];
/// What one would use without either technique.
const LAMBERT_SHADOWED: &str = "lambert-shadowed";
/// Random walks.
const REFERENCE: &str = "reference";
/// The measures: distance after the best exposure, as both pictures are, and that exposure.
const MEASURES: [&str; 3] = ["walks", "walks, exposure 1", "exposure"];
/// The largest share of the distance of Lambert's law with shadows, by rung, that is a goal.
pub const SHARES: [(&str, f64); 2] = [("diffusion-64", 0.6), ("diffusion-128", 0.5)];

/// Returns what to measure by default.
pub fn options() -> Options {
    Options { rounds: 5, frame: [512, 512], rungs: RUNGS.iter().filter_map(|name| name.parse().ok()).collect() }
}

/// Measures each rung in each view that has a picture by random walks.
///
/// # Errors
/// Returns an error if a committed picture is damaged or if the device fails.
pub fn run(gpu: &Gpu, options: &Options, progress: Progress<'_>) -> Result<Report, CostError> {
    let [width, height] = options.frame;
    let settings_of = [("width", width), ("height", height), ("rounds", options.rounds)];
    let mut report = Report::new(LADDER.name, gpu.describe(), &settings_of.map(|(name, value)| (name, value.into())));
    for (done, view) in (0..).zip(WALKED) {
        progress("comparing and timing views", done, WALKED.len() as u64);
        let Some(walks) = Walks::of(gpu, view)? else { continue };
        let scene = Scene::named(view)?;
        let measured: Vec<Measured> =
            options.rungs.iter().map(|rung| Measured { rung: *rung, unscaled: false }).collect();
        let drawn = |variant: &&Measured| variant.rung != Rung::Reference;
        let timed: Vec<Timed<'_>> = measured
            .iter()
            .filter(drawn)
            .map(|variant| Timed::new(&scene, settings(view, *variant, options.frame)))
            .collect();
        let mut timings = timing::time(gpu, &timed, options.rounds, &mut |_, _| {})?.into_iter();
        for variant in &measured {
            let timing = if drawn(&variant) { timings.next().flatten() } else { None };
            for (measure, value) in MEASURES.into_iter().zip(walks.distances(gpu, *variant)?) {
                let row = Row::new(&variant.rung.to_string(), view, measure, value, "");
                report.rows.push(row.timed(timing.map(|timing| timing.ms)));
            }
        }
    }
    Ok(report)
}

fn tables(report: &Report) -> Vec<Table> {
    let quality = quality::table("translucent_quality", report, &[Technique::Translucent, Technique::Diffusion]);
    vec![table(report), goals(report), quality]
}

fn whole(report: &Report) -> Result<(), String> {
    let has = |rung: &&str| WALKED.iter().all(|view| report.value(rung, view, MEASURES[0]).is_some());
    let timed = |rung: &&str| WALKED.iter().all(|view| report.ms(rung, view, MEASURES[0]).is_some());
    match RUNGS.iter().find(|rung| !has(rung) || **rung != REFERENCE && !timed(rung)) {
        Some(rung) => Err(format!("the report has no time of `{rung}`; only the whole ladder, timed, fills a page")),
        None => Ok(()),
    }
}

fn table(report: &Report) -> Table {
    let mut lines = Table::of("translucent", "Light through bodies, beside random walks", report.rungs(MEASURES[0]))
        .column("rung", |rung| (*rung).to_owned());
    for view in WALKED {
        lines = lines
            .column(view, |rung| {
                let [best, one, _] = MEASURES.map(|measure| report.value(rung, view, measure));
                format!("{}, {}", figure(best, 3), figure(one, 3))
            })
            .column("ms", |rung| figure(report.ms(rung, view, MEASURES[0]), 1));
    }
    lines.note(format!(
        "Distance of linear radiance from the committed pictures by random walks, over their root mean square: after \
         the best exposure, and at exposure 1. Two by two of {} pixels of one sample are compared with one of the \
         walks', and are what is timed, in three channels. Of the reference: its own standard error. Times: {}.",
        report.size(),
        report.run()
    ))
}

fn goals(report: &Report) -> Table {
    let mut goals = Vec::new();
    for (rung, most) in SHARES {
        for view in WALKED {
            let share = |measure: &str| {
                Some(report.value(rung, view, measure)? / report.value(LAMBERT_SHADOWED, view, measure)?)
            };
            if let (Some(best), Some(one)) = (share(MEASURES[0]), share(MEASURES[1])) {
                let goal = format!("{view}, `{rung}`: at most {most} of the distance of Lambert's law with shadows");
                let measured = format!("{best:.2} at the best exposures, {one:.2} at exposure 1");
                goals.push(Goal::new(goal, measured, best <= most && one <= most));
            }
        }
    }
    for view in ["bunny", "dragon"] {
        goals.extend(report.ms("diffusion-64", view, MEASURES[0]).map(|ms| {
            let goal = format!("{view}, `diffusion-64`: 10 frames a second in three channels");
            Goal::new(goal, format!("{:.1}: {ms:.1} ms", 1000.0 / ms), ms <= 100.0)
        }));
    }
    Goal::table("translucent_goals", goals)
}
