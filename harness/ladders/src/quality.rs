//! The rungs that `--quality` selects, as shown on a ladder's page.

use crate::report::Report;
use crate::table::Table;
use lapidary_plan::ladder::{CUT, Ladder, SAME_TIME, Step};
use lapidary_plan::quality::figure;
use lapidary_plan::{Quality, Technique};

/// Returns a table of the rungs selected by each quality of `techniques`, with their errors and
/// times in `report` and the reason why each was chosen.
pub(crate) fn table(name: &'static str, report: &Report, techniques: &[Technique]) -> Table {
    let ladders = techniques.iter().filter_map(|&technique| {
        let record = report.json().ok()?;
        Some((technique, Ladder::of_record(technique, &record).ok()?))
    });
    let ladders: Vec<(Technique, Ladder)> = ladders.collect();
    let mut lines: Vec<(Technique, Quality, &Step, &Step, Option<&Step>)> = Vec::new();
    for (technique, ladder) in &ladders {
        let Some(fast) = ladder.step(&technique.rung(Quality::Fast).to_string()) else { continue };
        for quality in Quality::ALL {
            let step = ladder.step(&technique.rung(quality).to_string());
            lines.extend(step.map(|step| (*technique, quality, step, fast, ladder.next_cheaper(step))));
        }
    }
    let measure = ladders.first().map_or("error", |(_, ladder)| ladder.measure);
    Table::of(name, "The rung of each quality", lines)
        .column("technique", |(technique, ..)| shown(*technique).to_owned())
        .column("quality", |(_, quality, ..)| quality.to_string())
        .column("rung", |(_, _, step, ..)| format!("`{}`", step.rung))
        .column("error", |(_, _, step, ..)| format!("{measure} {}", figure(step.error)))
        .column("in the worst view", |(_, _, step, ..)| figure(step.worst))
        .column("ms", |(_, _, step, ..)| format!("{:.1}", step.ms))
        .column("× fast", |(_, _, step, fast, _)| format!("{:.1}", step.ms / fast.ms))
        .column("next cheaper on the front", |(_, _, step, _, cheaper)| {
            cheaper.map_or("-".to_owned(), |cheaper| {
                let cut = 100.0 * (1.0 - step.error / cheaper.error);
                format!("`{}`: {}, cut by {cut:.0} %", cheaper.rung, figure(cheaper.error))
            })
        })
        .note(format!(
            "A default is on the Pareto front (no faster rung errs less), and cuts the error of the next \
             cheaper there by at least {:.0} %; times within {:.0} % count as one.",
            100.0 * CUT,
            100.0 * SAME_TIME
        ))
}

fn shown(technique: Technique) -> &'static str {
    match technique {
        Technique::Convex => "clear, convex",
        Technique::Concave => "clear, not convex",
        Technique::Cdrf => "curvature",
        Technique::Translucent => "light through the body",
        Technique::OpticalPath => "optical paths",
        Technique::Diffusion => "diffusion",
        Technique::Opaque => "opaque",
        Technique::ThinWall => "thin wall",
        Technique::Among => "clear, among other bodies",
    }
}
