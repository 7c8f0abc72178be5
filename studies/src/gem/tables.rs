//! The tables and the plot of the gem's studies, among the ladder's own.

use super::growth as facets;
use super::proxy_sizes as sizes;
use super::reflection::PARTS;
use crate::among::insert;
use lapidary_ladders::Report;
use lapidary_ladders::gem::LADDER;
use lapidary_ladders::gem::growth::{GROWTH, grown, power_of};
use lapidary_ladders::plot::{self, Axis, Plot, Series};
use lapidary_ladders::table::{Table, figure};

/// Returns the studies' own tables: of small sizes, of the number of facets, and of reflections.
pub(crate) fn own(report: &Report) -> [Table; 3] {
    [proxy_sizes(report), growth(report), reflections(report)]
}

/// Returns the ladder's tables with the studies' own among them.
pub(super) fn tables(report: &Report) -> Vec<Table> {
    let [sizes, growth, reflections] = own(report);
    let mut tables = (LADDER.tables)(report);
    insert(&mut tables, "steadiness", [sizes, growth]);
    insert(&mut tables, "ends", [reflections]);
    tables
}

/// Returns the ladder's plots and the study's own.
pub(super) fn plots(report: &Report) -> Vec<Plot> {
    let mut plots = (LADDER.plots)(report);
    plots.push(growth_plot(report));
    plots
}

fn proxy_sizes(report: &Report) -> Table {
    let views = report.views("mean");
    let part = |view: &str, index: usize| view.split(", ").nth(index).unwrap_or_default().to_owned();
    let title = "The proxy at small sizes, 16 samples a pixel: mean radiance over the reference's, and RMSE";
    let mut lines = Table::of("proxy_sizes", title, views)
        .column("stone", |view| part(view, 0))
        .column("environment", |view| part(view, 1))
        .column("pixels", |view| part(view, 2));
    for rung in std::iter::once(sizes::BLACK).chain(sizes::RUNGS) {
        lines = lines.column(rung, |view| {
            ["mean", "rmse"].map(|measure| figure(report.value(rung, view, measure), 2)).join(", ")
        });
    }
    lines.note("")
}

fn growth(report: &Report) -> Table {
    let title = "Milliseconds for a frame that a brilliant fills, by its number of facets, and the power with which \
                 they grow";
    let mut lines = Table::of("growth", title, report.rungs(GROWTH)).column("rung", |rung| (*rung).to_owned());
    for view in report.views(GROWTH) {
        lines = lines.column(view, |rung| figure(report.ms(rung, view, GROWTH), 0));
    }
    lines.column("power", |rung| figure(power_of(report, rung), 2)).note("")
}

fn reflections(report: &Report) -> Table {
    let title = "Total internal reflection at the first hit, brilliant face-up, share of the rays";
    let mut lines =
        Table::of("reflections", title, report.rungs("reflected")).column("mesh", |mesh| (*mesh).to_owned());
    for part in PARTS {
        let share = |mesh: &str| report.value(mesh, part, "reflected").map(|share| 100.0 * share);
        lines = lines.column(format!("by the {part}"), |mesh| format!("{} %", figure(share(mesh), 1)));
    }
    lines.note("")
}

/// Plots times against the number of facets.
fn growth_plot(report: &Report) -> Plot {
    let rungs = facets::RUNGS.into_iter().zip(plot::COLORS);
    let lines = rungs.map(|(rung, color)| Series::line(rung, color, 2, grown(report, rung)).dotted());
    Plot {
        file: "gem_growth.svg",
        caption: format!("Time by number of facets, {}, {}", report.size(), report.adapter),
        x: Axis::log("facets of the stone").with_ticks([20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0]),
        y: Axis::log("milliseconds a frame that the stone fills (least of interleaved rounds)"),
        series: lines.filter(|line| !line.points.is_empty()).collect(),
    }
}
