//! The ladder's tables for the pages of `docs/`.

use super::scenes::SIDE;
use super::table::{NONE, milliseconds, over_lambert, residuals, scientific, under_blur};
use super::{
    ANALYTIC, BLUR, CdrfReport, CurvatureSource, Distance, PAPER, Part, RUNGS, RungReport, SCENES, SceneReport, frames,
};
use crate::cost::page::{Table, Tables, bytes, header, judged, row};
use crate::cost::quality;
use lapidary_plan::Technique;
use std::fmt::Write as _;

impl Tables for CdrfReport {
    const TABLES: &'static [Table<Self>] = &[
        ("cdrf_errors", errors),
        ("cdrf_ladder", ladder),
        ("cdrf_quality", |report| quality::table(report, &[Technique::Cdrf])),
        ("cdrf_lit", |report| times(report, Part::Lit)),
        ("cdrf_whole", |report| times(report, Part::Whole)),
        ("cdrf_scenes", scenes),
        ("cdrf_goals", goals),
        ("cdrf_paper", paper),
    ];

    fn whole(&self) -> Result<(), String> {
        let timed = |rung: &RungReport| frames::views().all(|(part, source)| rung.ms(part, source).is_some());
        match RUNGS.iter().find(|name| !self.rung(name).is_some_and(timed)) {
            Some(name) => {
                Err(format!("the report has no time of `{name}`; only the whole ladder, timed, fills a page"))
            }
            None if self.scenes.is_empty() || self.scenes.iter().any(|scene| scene.timing.is_none()) => {
                Err("the report has no times of pictures beside random walks; measure it anew".to_owned())
            }
            None => Ok(()),
        }
    }
}

/// Returns the table of whole pictures compared with random walks.
fn scenes(report: &CdrfReport) -> String {
    let mut columns = vec!["rung".to_owned(), "shadows".to_owned()];
    columns.extend(SCENES.iter().flat_map(|scene| [format!("{scene}, from walks"), "ms".to_owned()]));
    let mut table = header(&columns.iter().map(String::as_str).collect::<Vec<_>>());
    for rung in &report.rungs {
        for shadows in [false, true] {
            let mut cells = vec![rung.rung.clone(), if shadows { "cast" } else { "none" }.to_owned()];
            for name in SCENES {
                let is =
                    |scene: &&SceneReport| scene.scene == name && scene.rung == rung.rung && scene.shadows == shadows;
                let found = report.scenes.iter().find(is);
                let ms =
                    found.and_then(|scene| scene.timing).map_or(NONE.to_owned(), |timing| format!("{:.1}", timing.ms));
                cells.extend([found.map_or(NONE.to_owned(), |scene| format!("{:.3}", scene.walks)), ms]);
            }
            row(&mut table, &cells);
        }
    }
    let _ = writeln!(
        table,
        "\nOf pictures of {SIDE} × {SIDE} pixels, one sample each, curvature from vertices; two by two pixels are compared with one of the walks'. \
         Milliseconds for the same pictures, the least of {} interleaved rounds, on {}.",
        report.rounds, report.adapter
    );
    table
}

/// Compares functions and tables by their errors alone.
fn errors(report: &CdrfReport) -> String {
    let mut table = header(&["rung", "largest error", "mean error"]);
    let mut add = |name: String, Distance { largest, rms }: Distance| {
        row(&mut table, &[name, scientific(Some(largest)), scientific(Some(rms))]);
    };
    let functions = |names: &'static [&'static str]| {
        let found = names.iter().filter_map(|name| report.rung(name)?.distance.map(|distance| (*name, distance)));
        found.map(|(name, distance)| (format!("`cdrf_{name}`"), distance))
    };
    let tables = report.tables.iter().map(|table| (table.name.clone(), table.distance));
    for (name, distance) in functions(&["lambert", "wrap"]).chain(tables).chain(functions(&ANALYTIC)) {
        add(name, distance);
    }
    table
}

fn ladder(report: &CdrfReport) -> String {
    let columns = [
        "rung",
        "largest error",
        "RMS error",
        "from random walks, scale free / fixed",
        "textures",
        "mesh",
        "fragment shader, lit: screen, vertex",
        "",
    ];
    let mut table = header(&columns);
    for rung in &report.rungs {
        let counts: Vec<String> = rung
            .frames
            .iter()
            .filter(|frame| frame.part == Part::Lit)
            .map(|frame| frame.fragment_instructions.to_string())
            .collect();
        let cells = [
            rung.rung.clone(),
            scientific(rung.distance.map(|distance| distance.largest)),
            scientific(rung.distance.map(|distance| distance.rms)),
            residuals(rung),
            bytes(rung.texture_bytes),
            bytes(rung.mesh_bytes),
            counts.join(", "),
            if rung.dominated { "dominated" } else { "" }.to_owned(),
        ];
        row(&mut table, &cells);
    }
    let Distance { largest, rms } = report.spherical_from_circular;
    let _ = writeln!(
        table,
        "\nFrom the convolution on the circle `spherical` is {} at most and {} in the mean: it is another function, and its errors above are \
         those from its own definition. Random walks: {} spheres. The timed mesh has {} vertices.",
        scientific(Some(largest)),
        scientific(Some(rms)),
        report.spheres,
        report.vertices
    );
    table
}

fn times(report: &CdrfReport, part: Part) -> String {
    let columns = [
        "rung",
        "curvature from the screen, ms",
        "over Lambert",
        "blur ÷ it",
        "from vertices, ms",
        "over Lambert",
        "blur ÷ it",
    ];
    let mut table = header(&columns);
    for rung in &report.rungs {
        let mut cells = vec![rung.rung.clone()];
        for source in CurvatureSource::ALL {
            cells.extend([
                milliseconds(rung, part, source),
                over_lambert(report, &rung.rung, part, source),
                under_blur(report, &rung.rung, part, source),
            ]);
        }
        row(&mut table, &cells);
    }
    let [width, height] = report.frame;
    let _ = writeln!(
        table,
        "\nMilliseconds for {width} × {height} pixels, the least of {} interleaved rounds, on {}. * timed on 1/16 of the pixels and scaled. \
         `lambert` and `blur` know no curvature, and were timed once.",
        report.rounds, report.adapter
    );
    table
}

/// Describes the source of curvature in words.
fn words(source: CurvatureSource) -> &'static str {
    match source {
        CurvatureSource::Screen => "curvature from the screen",
        CurvatureSource::Vertex => "curvature from vertices",
    }
}

/// Returns how many times closer to the convolution a rung is than the paper's table, by the
/// measure in which it gains less.
fn nearer(report: &CdrfReport, name: &str) -> Option<f64> {
    let [paper, rung] = [report.rung(PAPER)?.distance?, report.rung(name)?.distance?];
    Some((paper.largest / rung.largest).min(paper.rms / rung.rms))
}

fn goals(report: &CdrfReport) -> String {
    let mut table = header(&["goal", "measured", ""]);
    // The fastest rung without a table that is close enough; the other goals apply to it too.
    let near_enough = |name: &&str| nearer(report, name).is_some_and(|times| times >= 100.0);
    for source in CurvatureSource::ALL {
        let of = |part, slow: &str, fast: &str| report.ratio(slow, fast, part, source).unwrap_or(f64::NAN);
        let fast = |name: &&&str| of(Part::Lit, PAPER, name);
        let best = ANALYTIC.iter().filter(|name| near_enough(name)).max_by(|a, b| fast(a).total_cmp(&fast(b)));
        let Some(best) = best else { continue };
        let with = words(source);
        let (faster, times) = (of(Part::Lit, PAPER, best), nearer(report, best).unwrap_or(f64::NAN));
        judged(
            &mut table,
            &format!(
                "a rung without a table, faster than `{PAPER}` and at least 100 times as near to the convolution; {with}"
            ),
            format!("`{best}`: {faster:.2} times as fast, {times:.0} times as near"),
            faster > 1.0,
        );
        let over = of(Part::Whole, best, super::LAMBERT) - 1.0;
        judged(
            &mut table,
            &format!("its whole frame within 25 % of Lambert's; {with}"),
            format!("`{best}`: {:+.1} %", 100.0 * over),
            over <= 0.25,
        );
        for (part, what) in [(Part::Lit, "its lit part"), (Part::Whole, "its whole frame")] {
            let faster = of(part, BLUR, best);
            judged(
                &mut table,
                &format!("{what} at least 10 times as fast as by the texture's blur; {with}"),
                format!("`{best}`: {faster:.1} times"),
                faster >= 10.0,
            );
        }
    }
    table
}

fn paper(report: &CdrfReport) -> String {
    const SHOWN: [&str; 3] = [PAPER, "cheap", "accurate"];
    let columns: Vec<String> = std::iter::once(String::new()).chain(SHOWN.map(|name| format!("`{name}`"))).collect();
    let mut table = header(&columns.iter().map(String::as_str).collect::<Vec<_>>());
    type Figure = fn(&CdrfReport, &str, Part, CurvatureSource) -> String;
    let figures: [(&str, &str, Figure); 2] = [
        ("over Lambert", "+5.5 %", over_lambert),
        ("times as fast as a blur in a texture of 1024 × 1024", "4.8", under_blur),
    ];
    for (what, papers, figure) in figures {
        row(&mut table, &[format!("{what}, the paper's"), papers.to_owned(), NONE.to_owned(), NONE.to_owned()]);
        for (part, source) in frames::views() {
            let part_name = if part == Part::Lit { "lit part" } else { "whole frame" };
            let mut cells = vec![format!("{what}, {part_name}, {}", words(source))];
            cells.extend(SHOWN.map(|name| figure(report, name, part, source)));
            row(&mut table, &cells);
        }
    }
    table
}
