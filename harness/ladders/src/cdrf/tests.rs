use super::rungs::{BLUR, LAMBERT, PAPER};
use super::*;
use crate::page::fill;
use crate::report::{Report, Row, TIME};
use crate::{Plot, Timing};

/// Adds a rung whose lit part takes `ms` with curvature from the screen and half of it from
/// vertices, if it uses any; its whole frame takes ten more.
fn add(report: &mut Report, rung: &str, ms: f64, error: Option<f64>, curved: bool) {
    for view in VIEWS {
        let lit = if view.ends_with("vertex") && curved { 0.5 * ms } else { ms };
        let ms = if view.starts_with("lit") { lit } else { lit + 10.0 };
        let errors = error.map(|error| [error, 0.1 * error, 0.02, 0.03 + error]);
        for (place, measure) in MEASURES.into_iter().enumerate() {
            report.rows.push(Row::new(rung, view, measure, errors.map(|values| values[place]), "").timed(Some(ms)));
        }
        let row = Row { bytes: Some(262_144), instructions: vec![10, 20], ..Row::new(rung, view, "", None, "") };
        report.add_time(row, Some(&Timing { ms, median_ms: ms, share: 1.0, encode_us: 1.0 }));
    }
}

/// Returns the whole ladder with made-up values.
fn whole() -> Report {
    let settings = [("width", 1920), ("height", 1080), ("rounds", 7), ("spheres", 40)];
    let mut report = Report::new("cdrf", "a device".to_owned(), &settings);
    let rungs = [
        (LAMBERT, 20.0, 0.7),
        ("wrap", 24.0, 0.3),
        (PAPER, 40.0, 2e-3),
        ("table-257-rgba16f", 50.0, 5e-4),
        ("table-257-r32f", 60.0, 5e-4),
        ("cheap", 30.0, 1e-4),
        ("accurate", 32.0, 1e-7),
        ("quadrature", 900.0, 5e-7),
        (SPHERICAL, 29.0, 1e-6),
    ];
    for (rung, ms, error) in rungs {
        add(&mut report, rung, ms, Some(error), rung != LAMBERT);
    }
    add(&mut report, BLUR, 400.0, None, false);
    let table = error::Distance { largest: 0.25, rms: 0.125 };
    report.rows.extend(table.rows("table 4 × 4, RGBA8", TABLE));
    report.rows.push(Row::new("cheap", &scenes::view("skin", true), "walks", 0.2, "").timed(Some(16.0)));
    report
}

fn table(report: &Report, name: &str) -> String {
    let tables = tables::tables(report);
    tables.iter().find(|table| table.name == name).expect("a table").markdown()
}

/// Returns the rungs marked as dominated in the text.
fn dominated(report: &Report) -> Vec<String> {
    let text = LADDER.text(report);
    let marked = text.lines().filter_map(|line| line.strip_suffix("dominated")?.split_whitespace().next());
    marked.map(str::to_owned).collect()
}

#[test]
fn every_rung_is_one_of_the_renderers() {
    let options = options();
    assert_eq!(options.rungs.iter().map(|rung| rung.name()).collect::<Vec<_>>(), RUNGS);
}

#[test]
fn a_rung_is_dominated_by_a_faster_one_that_errs_no_more() {
    // Neither the spherical form (faster, with a small error from another function) nor the blur
    // (without any error) beats or is beaten.
    assert_eq!(dominated(&whole()), [PAPER, "table-257-rgba16f", "table-257-r32f", "quadrature"]);
    let mut untimed = whole();
    untimed.rows.iter_mut().filter(|row| row.rung == "cheap").for_each(|row| row.ms = None);
    untimed.rows.retain(|row| ["cheap", PAPER].contains(&&*row.rung));
    assert!(dominated(&untimed).is_empty());
}

#[test]
fn a_rung_that_is_faster_with_one_source_of_curvature_alone_beats_none() {
    let mut report = whole();
    report.rows.retain(|row| ["cheap", PAPER].contains(&&*row.rung));
    assert_eq!(dominated(&report), [PAPER]);
    report
        .rows
        .iter_mut()
        .filter(|row| row.rung == "cheap" && row.view == "lit+vertex")
        .for_each(|row| row.ms = Some(100.0));
    assert!(dominated(&report).is_empty());
}

#[test]
fn text_and_tables_show_every_rung() {
    let report = whole();
    let text = LADDER.text(&report);
    assert!(RUNGS.iter().all(|rung| text.contains(rung)), "{text}");
    for name in ["cdrf_ladder", "cdrf_lit", "cdrf_whole"] {
        let made = table(&report, name);
        assert!(RUNGS.iter().all(|rung| made.contains(&format!("| {rung} |"))), "{made}");
    }
    let lit = table(&report, "cdrf_lit");
    assert!(lit.contains("| cheap | 30.0 | +50.0 % | 13.3 | 10 + 20 | 15.0 | -25.0 % | 26.7 | 10 + 20 |"), "{lit}");
    let errors = table(&report, "cdrf_errors");
    assert!(errors.contains("| `cdrf_accurate` | 1.0e-7 | 1.0e-8 |"), "{errors}");
    assert!(errors.contains("| table 4 × 4, RGBA8 | 2.5e-1 | 1.2e-1 |"), "{errors}");
    assert!(table(&report, "cdrf_scenes").contains("| cheap | cast | 0.200 | 16.0 |"));
    let page = "<!-- generated: cdrf_lit --><!-- end -->";
    assert!(fill(page, &LADDER, &report).expect("filled").contains("| blur |"));
    let mut part = report;
    part.rows.retain(|row| !row.rung.starts_with("table-257"));
    assert!(fill(page, &LADDER, &part).expect_err("a part").contains("no time of `table-257-rgba16f`"));
}

#[test]
fn goals_are_judged_by_the_fastest_rung_that_is_near_enough() {
    let mut report = whole();
    let goals = table(&report, "cdrf_goals");
    // The cheap rung is faster, but only 20 times closer.
    assert!(goals.contains("`accurate`: 1.25 times as fast, 20000 times as near | met |"), "{goals}");
    assert!(goals.contains("`accurate`: +40.0 % | missed |"), "{goals}");
    assert!(goals.contains("`accurate`: 12.5 times | met |"), "{goals}");
    assert!(goals.contains("curvature from vertices | `accurate`: -13.3 % | met |"), "{goals}");
    report.rows.retain(|row| row.rung != "accurate");
    add(&mut report, "accurate", 41.0, Some(1e-7), true);
    let goals = table(&report, "cdrf_goals");
    assert!(goals.contains("`accurate`: 0.98 times as fast, 20000 times as near | missed |"), "{goals}");
}

#[test]
fn a_plot_shows_every_timed_rung_but_the_blur_as_a_line() {
    let svg = tables::plots(&whole())[0].svg();
    for name in RUNGS.iter().filter(|name| **name != BLUR) {
        assert!(svg.contains(&format!(">{name}</text>")), "{name}");
    }
    assert!(svg.contains("time of the texture") && svg.ends_with("</svg>\n"));
    assert!(tables::plots(&Report::default()).iter().all(Plot::is_empty));
    assert_eq!(whole().rungs(TIME).len(), RUNGS.len());
}
