//! The report as text, and as tables for the pages of `docs/`.

use super::{RUNGS, RestraintReport, SCENES};
use crate::cost::Timing;
use crate::cost::page::{Table, Tables, header, row};
use std::fmt::Write as _;

impl Tables for RestraintReport {
    const TABLES: &'static [Table<Self>] =
        &[("restraint_throughput", throughput), ("restraint_tiles", tiles), ("restraint_variants", variants)];

    fn whole(&self) -> Result<(), String> {
        for (scene, rung) in SCENES.iter().flat_map(|scene| RUNGS.iter().map(move |rung| (scene, rung))) {
            if !self.limited.iter().any(|limited| limited.scene == *scene && limited.rung == *rung) {
                return Err(format!("the report has no `{rung}` of `{scene}`; only a whole report fills a page"));
            }
        }
        if self.tiles.is_empty() { Err("the report has no tiles".to_owned()) } else { Ok(()) }
    }
}

fn milliseconds(timing: Timing) -> String {
    format!("{:.1}", timing.ms)
}

/// Returns the cells of each row after the scene and the rung.
fn throughput_lines(report: &RestraintReport) -> impl Iterator<Item = Vec<String>> {
    report.limited.iter().map(|limited| {
        vec![
            limited.scene.clone(),
            limited.rung.clone(),
            format!("{:.2}", limited.facets_unlimited),
            format!("{:.2}", limited.facets_limited),
            milliseconds(limited.unlimited),
            milliseconds(limited.limited_without_break),
            milliseconds(limited.limited),
            format!("{:+.0} %", -100.0 * limited.saved()),
            format!("{:.2}", limited.largest),
            format!("{}, {:.1} %", limited.largest_encoded, 100.0 * limited.changed),
        ]
    })
}

const THROUGHPUT: [&str; 10] = [
    "scene",
    "rung",
    "facets",
    "limited",
    "ms",
    "limited, no break",
    "limited",
    "time",
    "largest / bound",
    "steps of 8 bits",
];

fn tile_lines(report: &RestraintReport) -> impl Iterator<Item = Vec<String>> {
    report.tiles.iter().flat_map(|tiles| {
        let full = tiles.ways.last().map_or(f64::NAN, |way| way.ms);
        tiles.ways.iter().map(move |way| {
            vec![
                format!("{}-{}", tiles.method, tiles.cells),
                format!("{:.0} %", 100.0 * tiles.with_matter),
                way.way.clone(),
                way.passes.to_string(),
                way.updates.to_string(),
                format!("{:.1}", way.ms),
                format!("{:.2}", way.ms / full),
                way.differing.to_string(),
            ]
        })
    })
}

const TILES: [&str; 8] =
    ["solver", "tiles with matter", "taken up", "passes", "updates", "ms", "of all", "voxels that differ"];

fn throughput(report: &RestraintReport) -> String {
    let [width, height] = report.frame;
    let mut table = header(&THROUGHPUT);
    throughput_lines(report).for_each(|cells| row(&mut table, &cells));
    let _ = writeln!(
        table,
        "\nMilliseconds for {width} × {height} pixels filled by the stone, the least of {} interleaved rounds, on {}.",
        report.rounds, report.adapter
    );
    table
}

fn tiles(report: &RestraintReport) -> String {
    let mut table = header(&TILES);
    tile_lines(report).for_each(|cells| row(&mut table, &cells));
    let _ = writeln!(
        table,
        "\nMilliseconds for a solve, the least of {} interleaved rounds, on {}.",
        report.rounds, report.adapter
    );
    table
}

fn variant_lines(report: &RestraintReport) -> impl Iterator<Item = Vec<String>> {
    let shared = report.variants.ways.last().map_or(f64::NAN, |way| way.timing.ms);
    report.variants.ways.iter().map(move |way| {
        vec![
            way.way.clone(),
            way.instructions.iter().map(usize::to_string).collect::<Vec<_>>().join(", "),
            milliseconds(way.timing),
            format!("{:.2}", way.timing.ms / shared),
            format!("{:.1e}", way.largest),
        ]
    })
}

const VARIANTS: [&str; 5] = ["variant", "instructions", "ms", "of one for all", "largest difference"];

fn variants(report: &RestraintReport) -> String {
    let mut table = header(&VARIANTS);
    variant_lines(report).for_each(|cells| row(&mut table, &cells));
    let [width, height] = report.frame;
    let _ = writeln!(
        table,
        "\nMilliseconds for the clear bodies of `{}`, {width} × {height} pixels, the least of {} interleaved rounds, on {}.",
        report.variants.scene, report.rounds, report.adapter
    );
    table
}

/// Writes columns that are as wide as their widest cell.
fn aligned(text: &mut String, columns: &[&str], lines: &[Vec<String>]) {
    let heads: Vec<String> = columns.iter().map(|&column| column.to_owned()).collect();
    let all: Vec<&Vec<String>> = std::iter::once(&heads).chain(lines).collect();
    let width = |column: usize| all.iter().map(|cells| cells[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns.len()).map(width).collect();
    for cells in all {
        let padded: Vec<String> = cells.iter().zip(&widths).map(|(cell, &width)| format!("{cell:>width$}")).collect();
        let _ = writeln!(text, "{}", padded.join("  "));
    }
}

pub(super) fn text(report: &RestraintReport) -> String {
    let [width, height] = report.frame;
    let mut text = format!("{}, {width}x{height}, least of {} interleaved rounds\n", report.adapter, report.rounds);
    text.push_str("\nRays that end when what they carry can no longer be seen\n");
    aligned(&mut text, &THROUGHPUT, &throughput_lines(report).collect::<Vec<_>>());
    text.push_str(
        "facets: looked for by a ray, in the mean. time: with the limit, against without. largest / bound: the largest difference of radiance times \
         exposure, in 1/510.\nsteps of 8 bits: the largest difference once encoded for a screen, and the share of pixels that differ.\n",
    );
    text.push_str("\nWays through stone, sought in fewer tiles\n");
    aligned(&mut text, &TILES, &tile_lines(report).collect::<Vec<_>>());
    text.push_str("\nStones of several materials\n");
    aligned(&mut text, &VARIANTS, &variant_lines(report).collect::<Vec<_>>());
    text
}
