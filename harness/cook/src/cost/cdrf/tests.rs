use super::*;
use crate::cost::Timing;

/// Returns a rung whose lit part takes `ms` with curvature from the screen and half of it with
/// curvature from vertices; its whole frame takes ten more.
fn rung(name: &str, ms: f64, error: f64) -> RungReport {
    let frame = |(part, source): (Part, CurvatureSource)| {
        let lit = if source == CurvatureSource::Screen { ms } else { 0.5 * ms };
        let ms = if part == Part::Lit { lit } else { lit + 10.0 };
        FrameReport {
            part,
            curvature: Some(source),
            vertex_instructions: 10,
            fragment_instructions: 20,
            timing: Some(Timing { ms, median_ms: ms, share: 1.0, encode_us: 1.0, draw_calls: 1 }),
        }
    };
    RungReport {
        rung: name.to_owned(),
        distance: Some(Distance { largest: error, rms: 0.1 * error }),
        residuals: Some(Residuals { free: 0.02, fixed: 0.03 + error }),
        frames: frames::views().map(frame).collect(),
        texture_bytes: 262_144,
        mesh_bytes: 4000,
        dominated: false,
    }
}

/// Returns a rung without curvature.
fn plain(name: &str, ms: f64) -> RungReport {
    let mut rung = rung(name, ms, 0.7);
    rung.frames.retain(|frame| frame.curvature == Some(CurvatureSource::Screen));
    for frame in &mut rung.frames {
        frame.curvature = None;
    }
    rung
}

fn report(rungs: Vec<RungReport>) -> CdrfReport {
    let mut report = CdrfReport {
        adapter: "a device".to_owned(),
        frame: [1920, 1080],
        rounds: 7,
        vertices: 1000,
        spheres: 40,
        rungs,
        tables: vec![TableReport {
            name: "table 4 × 4, RGBA8".to_owned(),
            distance: Distance { largest: 0.25, rms: 0.125 },
        }],
        scenes: Vec::new(),
        spherical_from_circular: Distance { largest: 0.25, rms: 0.125 },
    };
    report.mark_dominated();
    report
}

/// Returns made-up whole pictures: shadows halve the distance and double the time.
fn scene(scene: &str, rung: &str, shadows: bool) -> SceneReport {
    let twice = if shadows { 2.0 } else { 1.0 };
    let timing = Timing { ms: 8.0 * twice, median_ms: 8.0 * twice, share: 1.0, encode_us: 1.0, draw_calls: 1 };
    SceneReport { scene: scene.to_owned(), rung: rung.to_owned(), shadows, walks: 0.4 / twice, timing: Some(timing) }
}

/// Returns the whole ladder with made-up values.
fn whole() -> CdrfReport {
    let mut report = without_scenes();
    report.scenes = SCENES
        .into_iter()
        .flat_map(|of| RUNGS.into_iter().flat_map(move |rung| [false, true].map(|shadows| scene(of, rung, shadows))))
        .collect();
    report
}

fn without_scenes() -> CdrfReport {
    let blur = RungReport { distance: None, residuals: None, ..plain(BLUR, 400.0) };
    report(vec![
        plain(LAMBERT, 20.0),
        rung("wrap", 24.0, 0.3),
        rung(PAPER, 40.0, 2e-3),
        rung("table-257-rgba16f", 50.0, 5e-4),
        rung("table-257-r32f", 60.0, 5e-4),
        rung("cheap", 30.0, 1e-4),
        rung("accurate", 32.0, 1e-7),
        rung("quadrature", 900.0, 5e-7),
        rung(SPHERICAL, 29.0, 1e-6),
        blur,
    ])
}

#[test]
fn every_rung_is_one_of_the_renderers() {
    let options = Options::default();
    assert_eq!(options.rungs.iter().map(|rung| rung.name()).collect::<Vec<_>>(), RUNGS);
}

#[test]
fn a_rung_is_dominated_by_a_faster_one_that_errs_no_more() {
    let marked: Vec<String> = whole().rungs.into_iter().filter(|rung| rung.dominated).map(|rung| rung.rung).collect();
    // Neither the spherical form (faster, with a small error from another function) nor the blur
    // (without any error) beats or is beaten.
    assert_eq!(marked, [PAPER, "table-257-rgba16f", "table-257-r32f", "quadrature"]);
    let untimed = |mut rung: RungReport| {
        rung.frames.iter_mut().for_each(|frame| frame.timing = None);
        rung
    };
    let report = report(vec![rung("cheap", 1.0, 0.1), untimed(rung("wrap", 2.0, 0.2))]);
    assert!(report.rungs.iter().all(|rung| !rung.dominated));
}

#[test]
fn a_rung_that_is_faster_with_one_source_of_curvature_alone_beats_none() {
    let mut quick = rung("cheap", 30.0, 1e-4);
    quick.frames[1].timing = quick.frames[1].timing.map(|timing| Timing { ms: 100.0, ..timing });
    assert!(!report(vec![quick, rung(PAPER, 40.0, 2e-3)]).rungs[1].dominated);
}

#[test]
fn every_rung_view_and_measure_has_a_row() {
    let report = whole();
    let rows = report.rows();
    assert_eq!(rows.len(), RUNGS.len() * 4 * MEASURES.len());
    let row = |rung: &str, view: &str, measure: &str| {
        rows.iter().find(|row| row.rung == rung && row.view == view && row.error_measure == measure).expect("a row")
    };
    assert_eq!(row("cheap", "lit+screen", "largest").ms, Some(30.0));
    assert_eq!(row("cheap", "whole+vertex", "largest").ms, Some(25.0));
    // A rung without curvature has the same time for both sources.
    assert_eq!(row(LAMBERT, "lit+vertex", "rms").ms, Some(20.0));
    assert_eq!(row("cheap", "lit+screen", "walks").error, Some(0.0301));
    assert!(row(BLUR, "lit+screen", "rms").error.is_none() && !row(BLUR, "lit+screen", "rms").dominated);
    assert!(row(PAPER, "lit+screen", "largest").dominated && !row("cheap", "lit+screen", "largest").dominated);
    // The spherical form is comparable by its distance from random walks.
    assert!(row("cheap", "lit+screen", "walks").dominated);
}

#[test]
fn a_report_survives_its_json() {
    let report = whole();
    let json = serde_json::to_string(&report).expect("JSON");
    assert_eq!(serde_json::from_str::<CdrfReport>(&json).expect("a report"), report);
}

#[test]
fn text_and_tables_show_every_rung() {
    use crate::cost::page::{Tables, fill};
    let report = whole();
    assert!(RUNGS.iter().all(|rung| report.text().contains(rung)), "{}", report.text());
    let made = |wanted: &str| {
        let (_, make) = CdrfReport::TABLES.iter().find(|(name, _)| *name == wanted).expect("a table");
        make(&report)
    };
    for name in ["cdrf_ladder", "cdrf_lit", "cdrf_whole"] {
        assert!(RUNGS.iter().all(|rung| made(name).contains(&format!("| {rung} |"))), "{}", made(name));
    }
    assert!(
        made("cdrf_lit").contains("| cheap | 30.0 | +50.0 % | 13.3 | 15.0 | -25.0 % | 26.7 |"),
        "{}",
        made("cdrf_lit")
    );
    assert!(made("cdrf_errors").contains("| `cdrf_accurate` | 1.0e-7 | 1.0e-8 |"), "{}", made("cdrf_errors"));
    assert!(made("cdrf_errors").contains("| table 4 × 4, RGBA8 | 2.5e-1 | 1.2e-1 |"), "{}", made("cdrf_errors"));
    let page = "<!-- generated: cdrf_lit --><!-- end -->";
    assert!(fill(page, &report).expect("filled").contains("| blur |"));
    let part = CdrfReport { rungs: report.rungs[..3].to_vec(), ..report };
    assert!(fill(page, &part).expect_err("a part").contains("no time of `table-257-rgba16f`"));
}

#[test]
fn goals_are_judged_by_the_fastest_rung_that_is_near_enough() {
    use crate::cost::page::Tables;
    let goals = |report: &CdrfReport| {
        let (_, make) = CdrfReport::TABLES.iter().find(|(name, _)| *name == "cdrf_goals").expect("a table");
        make(report)
    };
    let mut report = whole();
    let table = goals(&report);
    // The cheap rung is faster, but only 20 times closer.
    assert!(table.contains("`accurate`: 1.25 times as fast, 20000 times as near | met |"), "{table}");
    assert!(table.contains("`accurate`: +40.0 % | missed |"), "{table}");
    assert!(table.contains("`accurate`: 12.5 times | met |"), "{table}");
    assert!(table.contains("curvature from vertices | `accurate`: -13.3 % | met |"), "{table}");
    report.rungs[6] = rung("accurate", 41.0, 1e-7);
    assert!(goals(&report).contains("`accurate`: 0.98 times as fast, 20000 times as near | missed |"));
}

#[test]
fn a_plot_shows_every_timed_rung_but_the_blur_as_a_line() {
    let svg = plot::svg(&whole()).expect("drawn");
    for name in RUNGS.iter().filter(|name| **name != BLUR) {
        assert!(svg.contains(&format!("\n{name}\n")) || svg.contains(&format!(">{name}<")), "{name}");
    }
    assert!(svg.contains("time of the texture") && svg.ends_with("</svg>\n"));
    let error = plot::svg(&report(Vec::new())).expect_err("nothing").to_string();
    assert!(error.contains("no rung was timed"), "{error}");
}
