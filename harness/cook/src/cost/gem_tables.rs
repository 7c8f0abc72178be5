//! The gem ladder's tables for the pages of `docs/`.

use super::page::{Table, Tables, header, row};
use super::proxy_sizes::{self as sizes, AtSize};
use super::views::{CONCAVE, VIEWS};
use super::{Choice, Colours, RUNGS, Report, RungReport, Seen, Steadiness, quality};
use lapidary_plan::Technique;
use std::fmt::Write as _;

impl Tables for Report {
    const TABLES: &'static [Table<Self>] = &[
        ("ladder", ladder),
        ("gem_quality", gem_quality),
        ("concave", concave),
        ("steadiness", steadiness),
        ("proxy_sizes", proxy_sizes),
        ("goals", goals),
        ("paper", paper),
        ("colours", colours),
        ("ends", ends),
        ("reflections", reflections),
    ];

    fn whole(&self) -> Result<(), String> {
        let missing = RUNGS.iter().find(|name| self.rung(name).is_none_or(|rung| rung.timing.is_none()));
        if let Some(name) = missing {
            return Err(format!("the report has no time of `{name}`; only the whole ladder, timed, fills a page"));
        }
        if self.views.len() < VIEWS.len() || self.concave.len() < CONCAVE.len() || self.sizes.is_empty() {
            return Err("the report does not hold all views; only the whole ladder fills a page".to_owned());
        }
        Ok(())
    }
}

fn ladder(report: &Report) -> String {
    let Report { frame: [width, height], side, samples, adapter, .. } = report;
    let columns = [
        "rung",
        "ms",
        "× proxy-1",
        "FLIP",
        "worst FLIP",
        "RMSE",
        "energy",
        "change at 0.05°",
        "ms, filled",
        "SPIR-V vertex + fragment",
        "bytes",
        "",
    ];
    let mut table = header(&columns);
    let proxy = report.rung("proxy-1").and_then(RungReport::view_ms);
    for rung in &report.rungs {
        let ms = rung.view_ms();
        let cells = [
            rung.rung.clone(),
            ms.map_or("-".to_owned(), |ms| format!("{ms:.1}")),
            ms.zip(proxy).map_or("-".to_owned(), |(ms, proxy)| format!("{:.2}", ms / proxy)),
            format!("{:.3}", rung.mean(0)),
            format!("{:.3}", rung.worst(0)),
            format!("{:.3}", rung.mean(1)),
            format!("{:.3}", rung.mean(2)),
            format!("{:.3}", rung.mean(3)),
            rung.milliseconds(),
            format!("{} + {}", rung.vertex_instructions, rung.fragment_instructions),
            rung.geometry_bytes.to_string(),
            if rung.dominated { "dominated" } else { "" }.to_owned(),
        ];
        row(&mut table, &cells);
    }
    let _ = writeln!(
        table,
        "\nErrors, change and ms are of the same pictures: {side} × {side} pixels, samples a pixel: {samples}, means over the views, times the \
         least of interleaved rounds. `ms, filled` is of {width} × {height} pixels that the brilliant fills, as the paper has it; * timed on \
         1/16 of them and scaled. On {adapter}."
    );
    table
}

fn gem_quality(report: &Report) -> String {
    quality::table(report, &[Technique::Convex, Technique::Concave])
}

/// Returns the results in the views of concave bodies, for every rung that draws them.
fn concave(report: &Report) -> String {
    let mut columns = vec!["rung".to_owned()];
    columns.extend(report.concave.iter().map(|view| format!("{view}: ms, FLIP, RMSE, change")));
    let mut table = header(&columns.iter().map(String::as_str).collect::<Vec<_>>());
    for rung in report.rungs.iter().filter(|rung| rung.concave.iter().any(Option::is_some)) {
        let cell = |seen: &Option<Seen>| {
            let Some(Seen { errors, change, ms }) = seen else { return "-".to_owned() };
            let ms = ms.map_or("-".to_owned(), |ms| format!("{ms:.1}"));
            format!("{ms}, {:.3}, {:.3}, {change:.3}", errors.flip, errors.rmse)
        };
        let cells: Vec<String> = std::iter::once(rung.rung.clone()).chain(rung.concave.iter().map(cell)).collect();
        row(&mut table, &cells);
    }
    table
}

fn steadiness(report: &Report) -> String {
    let mut table = header(&["rung", "samples a pixel", "change, mean over the views", "change, `brilliant`"]);
    for Steadiness { rung, samples, change, brilliant } in &report.steadiness {
        let brilliant = brilliant.map_or("-".to_owned(), |change| format!("{change:.3}"));
        row(&mut table, &[rung.clone(), samples.to_string(), format!("{change:.3}"), brilliant]);
    }
    table
}

fn proxy_sizes(report: &Report) -> String {
    let mut columns = vec!["stone", "environment", "pixels", sizes::BLACK];
    columns.extend(sizes::RUNGS);
    let mut table = header(&columns);
    let mut pictures: Vec<(&str, &str, u32)> = Vec::new();
    for AtSize { stone, environment, size, .. } in &report.sizes {
        if !pictures.contains(&(stone, environment, *size)) {
            pictures.push((stone, environment, *size));
        }
    }
    for (stone, environment, size) in pictures {
        let cell = |rung: &str| {
            let found = report.sizes.iter().find(|sized| {
                (&*sized.stone, &*sized.environment, sized.size, &*sized.rung) == (stone, environment, size, rung)
            });
            found.map_or("-".to_owned(), |sized| format!("{:.2}, {:.2}", sized.mean, sized.rmse))
        };
        let mut cells = vec![stone.to_owned(), environment.to_owned(), format!("{size} × {size}"), cell(sizes::BLACK)];
        cells.extend(sizes::RUNGS.map(cell));
        row(&mut table, &cells);
    }
    table
}

fn goals(report: &Report) -> String {
    let mut table = header(&["goal", "measured", ""]);
    let times = |slow: &str, fast: &str| report.ratio(slow, fast);
    let mut judge = |goal: &str, measured: Option<f64>, met: &dyn Fn(f64) -> bool, shown: &dyn Fn(f64) -> String| {
        let Some(measured) = measured else { return };
        row(&mut table, &[goal.to_owned(), shown(measured), if met(measured) { "met" } else { "missed" }.to_owned()]);
    };
    let factor = |value: f64| format!("{value:.1} times");
    judge(
        "proxy at least 20 times as fast as the loop over all triangles, one hit each",
        times("triangles-1", "proxy-1"),
        &|value| value >= 20.0,
        &factor,
    );
    judge(
        "proxy at least 8 times as fast as the loop over the facet planes",
        times("convex-1", "proxy-1"),
        &|value| value >= 8.0,
        &factor,
    );
    judge("proxy faster than the BVH", times("bvh-1", "proxy-1"), &|value| value > 1.0, &factor);
    for rung in ["proxy-1", "convex-8"] {
        // The paper's tracker is one shader at two strengths: its time is the lower one.
        let tracker = format!("{rung}+tracker");
        let twins = [format!("{rung}+paper"), format!("{rung}+paper-fitted")].map(|paper| times(&tracker, &paper));
        judge(
            &format!("exact tracker's time within 10 % of the paper's tracker's, `{rung}`"),
            twins[0].zip(twins[1]).map(|(a, b)| a.max(b)),
            &|value| value <= 1.1,
            &|value| format!("{:+.1} %", 100.0 * (value - 1.0)),
        );
    }
    let least = report.colours.iter().map(gain).reduce(f64::min);
    judge(
        "its colours at least 5 times as close to separate wavelengths' as the paper's at its best strength, in the view where they gain least",
        least,
        &|value| value >= 5.0,
        &factor,
    );
    table
}

fn paper(report: &Report) -> String {
    let mut table = header(&["", "the paper (GeForce GTX 760)", "here"]);
    let ms = |name: &str| report.rung(name).map_or("-".to_owned(), RungReport::milliseconds);
    let compared = |name: &str, what: &str| {
        let ratio = report.ratio(name, "proxy-1").map_or("-".to_owned(), |ratio| format!("{ratio:.1}"));
        format!("{} ms, {ratio} times ({what})", ms(name))
    };
    let counts = |name: &str| {
        report.rung(name).map_or("-".to_owned(), |r| format!("{} + {}", r.vertex_instructions, r.fragment_instructions))
    };
    let encodes: Vec<f64> = report.rungs.iter().filter_map(|rung| Some(rung.timing?.encode_us)).collect();
    let (least, most) = encodes.iter().fold((f64::INFINITY, 0f64), |(a, b), &us| (a.min(us), b.max(us)));
    let exact_bytes = report.rung("convex-1").map_or(0, |rung| rung.geometry_bytes);
    let rows = [
        ["proxy, one hit", "3 ms", &format!("{} ms", ms("proxy-1"))],
        [
            "exact: all polygons in a loop",
            "15 ms, 5 times",
            &format!("{}; {}", compared("triangles-1", "all triangles"), compared("convex-1", "facet planes")),
        ],
        ["BVH", "-", &compared("bvh-1", "112 triangles")],
        [
            "CPU for a frame",
            "20 µs for both",
            &format!("{least:.0} to {most:.0} µs, recording and submitting through wgpu"),
        ],
        [
            "shaders, proxy",
            "16 + 160 + 181 slots (vertex, geometry, pixel)",
            &format!(
                "{} SPIR-V instructions (vertex, fragment); +paper {}; +tracker {}",
                counts("proxy-1"),
                counts("proxy-1+paper"),
                counts("proxy-1+tracker")
            ),
        ],
        ["shaders, exact", "16 + 160 + 152 slots", &counts("convex-1")],
        [
            "constants",
            "2304 bytes; exact 15056 bytes",
            &format!("80 bytes of uniforms, 64 of the material in storage; exact {exact_bytes} bytes more"),
        ],
    ];
    for cells in rows {
        row(&mut table, &cells.map(str::to_owned));
    }
    table
}

/// Returns how many times closer the exact tracker is than the paper's at its best strength.
fn gain(colours: &Colours) -> f64 {
    colours.fitted_rms / colours.tracker_rms
}

/// Formats the range of the values as `least to most`.
fn range(values: impl Iterator<Item = f64>, show: impl Fn(f64) -> String) -> String {
    let (least, most) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), value| (a.min(value), b.max(value)));
    format!("{} to {}", show(least), show(most))
}

fn colours(Report { colours, .. }: &Report) -> String {
    let columns = [
        "geometry",
        "pixels that keep together",
        "no dispersion",
        "the paper's, literal",
        "best strength",
        "the paper's at it",
        "exact tracker",
        "gain",
    ];
    let mut table = header(&columns);
    let mut rungs: Vec<&str> = colours.iter().map(|c| c.rung.as_str()).collect();
    rungs.dedup();
    for rung in rungs {
        let here: Vec<&Colours> = colours.iter().filter(|c| c.rung == rung).collect();
        let of = |value: fn(&Colours) -> f64, show: &dyn Fn(f64) -> String| range(here.iter().map(|c| value(c)), show);
        let cells = [
            rung.to_owned(),
            of(|c| 100.0 * c.shared, &|value| format!("{value:.0} %")),
            of(|c| c.none_rms, &|value| format!("{value:.4}")),
            of(|c| c.paper_rms, &|value| format!("{value:.3}")),
            of(|c| f64::from(c.strength), &|value| format!("{value:.4}")),
            of(|c| c.fitted_rms, &|value| format!("{value:.4}")),
            of(|c| c.tracker_rms, &|value| format!("{value:.5}")),
            of(gain, &|value| format!("{value:.0} times")),
        ];
        row(&mut table, &cells);
    }
    table
}

fn ends(Report { choices, .. }: &Report) -> String {
    let mut table = header(&["rung", "end", "FLIP", "RMSE", "energy"]);
    for (rung, choice, [flip, rmse, energy]) in Choice::means(choices) {
        let cells =
            [rung.to_owned(), choice.to_owned(), format!("{flip:.4}"), format!("{rmse:.4}"), format!("{energy:+.4}")];
        row(&mut table, &cells);
    }
    table
}

fn reflections(report: &Report) -> String {
    let mut table = header(&["mesh", "by the table", "by the crown"]);
    for reflection in &report.reflections {
        let percent = |share: f64| format!("{:.1} %", 100.0 * share);
        row(&mut table, &[reflection.mesh.clone(), percent(reflection.table), percent(reflection.crown)]);
    }
    table
}
