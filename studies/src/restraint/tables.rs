//! The tables of what restraint saves.

use super::limit::{LIMITED, NO_BREAK};
use super::rungs::{RUNGS, SCENES};
use lapidary_ladders::Report;
use lapidary_ladders::table::{Table, figure, scientific};

/// Checks that a report has every scene by every rung, and tiles.
pub(super) fn whole(report: &Report) -> Result<(), String> {
    for (scene, rung) in SCENES.iter().flat_map(|scene| RUNGS.iter().map(move |rung| (scene, rung))) {
        if report.ms(rung, scene, "facets").is_none() {
            return Err(format!("the report has no `{rung}` of `{scene}`; only a whole report fills a page"));
        }
    }
    let others = report.rows.iter().filter(|row| ["updates", "variant"].contains(&row.measure.as_str()));
    let (timed, untimed): (Vec<_>, Vec<_>) = others.partition(|row| row.ms.is_some());
    if timed.is_empty() || !untimed.is_empty() {
        return Err("the report has no times of tiles or variants".to_owned());
    }
    Ok(())
}

pub(super) fn tables(report: &Report) -> Vec<Table> {
    vec![throughput(report), tiles(report), variants(report)]
}

/// Returns the ways that a measure was taken in, as full name, rung and way, with the view.
fn ways<'r>(report: &'r Report, measure: &str) -> Vec<(&'r str, &'r str, &'r str, &'r str)> {
    let rows = report.rows.iter().filter(|row| row.measure == measure);
    rows.filter_map(|row| row.rung.split_once(", ").map(|(rung, way)| (&*row.rung, rung, way, &*row.view))).collect()
}

fn throughput(report: &Report) -> Table {
    let rows = report.rows.iter().filter(|row| row.measure == "facets" && !row.rung.contains(", "));
    let lines: Vec<(&str, &str)> = rows.map(|row| (&*row.view, &*row.rung)).collect();
    let with = |rung: &str, way: &str| format!("{rung}, {way}");
    let value = |(scene, rung): &(&str, &str), measure: &str| report.value(&with(rung, LIMITED), scene, measure);
    let ms = |(scene, rung): &(&str, &str)| report.ms(rung, scene, "facets");
    let limited = |(scene, rung): &(&str, &str)| report.ms(&with(rung, LIMITED), scene, "facets");
    Table::of("restraint_throughput", "Rays that end when what they carry can no longer be seen", lines)
        .column("scene", |(scene, _)| (*scene).to_owned())
        .column("rung", |(_, rung)| (*rung).to_owned())
        .column("facets", |(scene, rung)| figure(report.value(rung, scene, "facets"), 2))
        .column("limited", |line| figure(value(line, "facets"), 2))
        .column("ms", |line| figure(ms(line), 1))
        .column("limited, no break", |(scene, rung)| {
            figure(report.ms(&with(rung, NO_BREAK), scene, "share of the bound"), 1)
        })
        .column("limited", |line| figure(limited(line), 1))
        .column("time", |line| {
            let saved = limited(line).zip(ms(line)).map(|(limited, ms)| 100.0 * (limited / ms - 1.0));
            saved.map_or("-".to_owned(), |saved| format!("{saved:+.0} %"))
        })
        .column("largest / bound", |line| figure(value(line, "share of the bound"), 2))
        .column("steps of 8 bits", |line| {
            let changed = value(line, "changed").map(|changed| 100.0 * changed);
            format!("{}, {} %", figure(value(line, "steps"), 0), figure(changed, 1))
        })
        .note(format!(
            "Milliseconds for {} pixels filled by the stone, {}. Facets: looked for by a ray, in the mean. Time: with \
             the limit, against without. Largest / bound: the largest difference of radiance times exposure, in 1/510. \
             Steps of 8 bits: the largest difference once encoded for a screen, and the share of pixels that differ.",
            report.size(),
            report.run()
        ))
}

fn tiles(report: &Report) -> Table {
    let lines = ways(report, "updates");
    let value = |line: &(&str, &str, &str, &str), measure: &str| report.value(line.0, line.3, measure);
    let ms = |line: &(&str, &str, &str, &str)| report.ms(line.0, line.3, "updates");
    // The last way of a solver takes up all tiles.
    let all = |line: &(&str, &str, &str, &str)| ms(lines.iter().rev().find(|other| other.1 == line.1)?);
    Table::of("restraint_tiles", "Paths through stone, sought in fewer tiles", &lines[..])
        .column("solver", |line| line.1.to_owned())
        .column("tiles with matter", |line| {
            format!("{} %", figure(value(line, "with matter").map(|share| 100.0 * share), 0))
        })
        .column("taken up", |line| line.2.to_owned())
        .column("passes", |line| figure(value(line, "passes"), 0))
        .column("updates", |line| figure(value(line, "updates"), 0))
        .column("ms", |line| figure(ms(line), 1))
        .column("of all", |line| figure(ms(line).zip(all(line)).map(|(ms, all)| ms / all), 2))
        .column("voxels that differ", |line| figure(value(line, "differing"), 0))
        .note(format!("Milliseconds for a solve, {}.", report.run()))
}

fn variants(report: &Report) -> Table {
    let lines = ways(report, "variant");
    let row = |line: &(&str, &str, &str, &str)| report.row(line.0, line.3, "variant");
    let ms = |line: &(&str, &str, &str, &str)| row(line)?.ms;
    let shared = lines.last().and_then(ms);
    let scene = lines.first().map_or("", |line| line.3);
    Table::of("restraint_variants", "Stones of several materials", lines)
        .column("variant", |line| line.2.to_owned())
        .column("instructions", |line| {
            let counts = row(line).map_or(&[][..], |row| &row.instructions);
            counts.iter().map(u32::to_string).collect::<Vec<_>>().join(", ")
        })
        .column("ms", |line| figure(ms(line), 1))
        .column("of one for all", |line| figure(ms(line).zip(shared).map(|(ms, shared)| ms / shared), 2))
        .column("largest difference", |line| scientific(row(line).and_then(|row| row.value)))
        .note(format!("Milliseconds for the clear bodies of `{scene}`, {} pixels, {}.", report.size(), report.run()))
}
