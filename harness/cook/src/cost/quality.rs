//! The rungs that `--quality` selects, as shown on a ladder's page.

use super::page::{header, row};
use lapidary_plan::ladder::{CUT, Ladder, SAME_TIME, Step};
use lapidary_plan::quality::figure;
use lapidary_plan::{Quality, Technique};
use serde::Serialize;
use std::fmt::Write as _;

/// Returns a table of the rungs selected by each quality of `techniques`, with their errors and
/// times in `report` and the reason why each was chosen.
pub(super) fn table<R: Serialize>(report: &R, techniques: &[Technique]) -> String {
    let mut table = header(&[
        "technique",
        "quality",
        "rung",
        "error",
        "in the worst view",
        "ms",
        "× fast",
        "next cheaper on the hull",
    ]);
    let Ok(record) = serde_json::to_string(report) else { return table };
    for &technique in techniques {
        let Ok(ladder) = Ladder::of_record(technique, &record) else { continue };
        for quality in Quality::ALL {
            let rung = technique.rung(quality).to_string();
            let fast = ladder.step(&technique.rung(Quality::Fast).to_string());
            let (Some(Step { error, worst, ms, .. }), Some(fast)) = (ladder.step(&rung), fast) else { continue };
            let cheaper = ladder.step(&rung).and_then(|step| ladder.next_cheaper(step));
            let cheaper = cheaper.map_or("-".to_owned(), |cheaper| {
                format!(
                    "`{}`: {}, cut by {:.0} %",
                    cheaper.rung,
                    figure(cheaper.error),
                    100.0 * (1.0 - error / cheaper.error)
                )
            });
            row(
                &mut table,
                &[
                    name(technique).to_owned(),
                    quality.to_string(),
                    format!("`{rung}`"),
                    format!("{} {}", ladder.measure, figure(*error)),
                    figure(*worst),
                    format!("{ms:.1}"),
                    format!("{:.1}", ms / fast.ms),
                    cheaper,
                ],
            );
        }
    }
    let _ = writeln!(
        table,
        "\nA default is on the hull of error against time (no faster rung errs less), and cuts the error of the next cheaper there by at least {:.0} %; \
         times within {:.0} % count as one.",
        100.0 * CUT,
        100.0 * SAME_TIME
    );
    table
}

fn name(technique: Technique) -> &'static str {
    match technique {
        Technique::Convex => "clear, convex",
        Technique::Concave => "clear, not convex",
        Technique::Cdrf => "curvature",
        Technique::OpticalPath => "optical paths",
        Technique::Opaque => "opaque",
        Technique::ThinWall => "thin wall",
    }
}
