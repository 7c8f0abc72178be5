use super::*;
use crate::cost::page::{Tables, fill};

/// Returns a rung whose grey frame takes `ms`, half of it in the solver.
fn rung(name: &str, ms: f64, nats: f64) -> RungReport {
    let timing = |ms: f64, stages| PathTiming { ms, median_ms: ms, rounds: 5, stages };
    let distance = Distance { nats: Some(nats), luminance: Some(0.1 * nats), walks: None };
    RungReport {
        rung: name.to_owned(),
        distances: vec![distance; VIEWS.len()],
        times: vec![
            ViewTimes {
                grey: Some(timing(ms, Some([1.0, 2.0, 3.0, 0.5 * ms, 4.0]))),
                rgb: Some(timing(3.0 * ms, None))
            };
            VIEWS.len()
        ],
        solved: Some(Solved { passes: 7, updates: 1234, active: 0 }),
        bytes: 20_000,
        dominated: false,
    }
}

fn report(rungs: Vec<RungReport>) -> OpticalPathReport {
    let mut report = OpticalPathReport { adapter: "a device".to_owned(), frame: [512, 512], rounds: 5, rungs };
    report.mark_dominated();
    report
}

/// Returns the whole ladder with made-up values: more cells are slower and more accurate, and
/// ping-pong is four times as slow as tiles.
fn whole() -> OpticalPathReport {
    let of = |name: &str| {
        let cells: f64 = name.rsplit('-').next().and_then(|cells| cells.parse().ok()).unwrap_or(8.0);
        let slow = if name.starts_with("ping-pong") { 4.0 } else { 1.0 };
        let near = if name.starts_with("godunov") { 0.25 } else { 1.0 };
        match name {
            LAMBERT | LAMBERT_SHADOWED => RungReport { solved: None, bytes: 0, ..rung(name, 5.0, 9.0) },
            REFERENCE => {
                let times = vec![ViewTimes::default(); VIEWS.len()];
                RungReport { times, distances: vec![Distance::default(); VIEWS.len()], ..rung(name, 1.0, 1.0) }
            }
            _ => rung(name, slow * cells, 8.0 * near / cells),
        }
    };
    let mut rungs: Vec<RungReport> = RUNGS.into_iter().map(of).collect();
    rungs.insert(3, RungReport { distances: vec![Distance::default(); VIEWS.len()], ..rung(UNSCALED, 64.0, 1.0) });
    report(rungs)
}

fn table(report: &OpticalPathReport, name: &str) -> String {
    let (_, make) = OpticalPathReport::TABLES.iter().find(|(table, _)| *table == name).expect("a table");
    make(report)
}

#[test]
fn every_rung_is_one_of_the_renderers() {
    let options = Options::default();
    assert_eq!(options.rungs.iter().map(Rung::to_string).collect::<Vec<_>>(), RUNGS);
    let names: Vec<String> = Measured::all(&options.rungs).into_iter().map(Measured::name).collect();
    assert_eq!(names.iter().filter(|name| !RUNGS.contains(&name.as_str())).collect::<Vec<_>>(), [UNSCALED]);
    for view in VIEWS {
        let committed = crate::snapshot::WalkedReference::of_scene(view).is_some();
        assert_eq!(WALKED.contains(&view), committed, "{view}");
    }
    for solver in GROWING {
        assert!(CELLS.iter().filter(|cells| RUNGS.contains(&format!("{solver}-{cells}").as_str())).count() >= 4);
    }
}

#[test]
fn a_rung_is_dominated_by_a_faster_one_that_errs_no_more_in_any_view() {
    let marked = |report: &OpticalPathReport| -> Vec<String> {
        report.rungs.iter().filter(|rung| rung.dominated).map(|rung| rung.rung.clone()).collect()
    };
    let mut rungs = vec![rung("fast", 1.0, 0.5), rung("slow", 2.0, 0.5), rung("near", 3.0, 0.1)];
    assert_eq!(marked(&report(rungs.clone())), ["slow"]);
    rungs[1].distances[2].nats = Some(0.4);
    assert!(marked(&report(rungs.clone())).is_empty());
    // The rung that made a view's truth has no error there and is judged by the other views.
    rungs[1].distances[2].nats = None;
    assert_eq!(marked(&report(rungs.clone())), ["slow"]);
    rungs[1].times.clear();
    assert!(marked(&report(rungs)).is_empty());
    assert!(!whole().rung(REFERENCE).expect("listed").dominated);
}

#[test]
fn every_rung_view_and_measure_has_a_row() {
    let report = whole();
    let rows = report.rows();
    assert_eq!(rows.len(), (RUNGS.len() + 1) * VIEWS.len() * MEASURES.len());
    let row = |rung: &str, view: &str, measure: &str| {
        rows.iter().find(|row| row.rung == rung && row.view == view && row.error_measure == measure).expect("a row")
    };
    assert_eq!(row("godunov-64", "ball", "nats").ms, Some(64.0));
    assert_eq!(row("godunov-64", "dragon", "luminance").error, Some(0.1 * 8.0 * 0.25 / 64.0));
    assert!(row("godunov-64", "bunny", "walks").error.is_none());
    // A distance from walks is listed with the time for three channels.
    assert_eq!(row("godunov-64", "bunny", "walks").ms, Some(192.0));
    assert!(row("tiled-26-64", "ball", "nats").dominated && !row("godunov-16", "ball", "nats").dominated);
    assert!(row(REFERENCE, "ball", "nats").error.is_none() && row(REFERENCE, "ball", "nats").ms.is_none());
}

#[test]
fn a_report_survives_its_json() {
    let report = whole();
    let json = serde_json::to_string(&report).expect("JSON");
    assert_eq!(serde_json::from_str::<OpticalPathReport>(&json).expect("a report"), report);
}

#[test]
fn text_and_tables_show_every_rung() {
    let mut report = whole();
    assert!(RUNGS.iter().all(|rung| report.text().contains(rung)), "{}", report.text());
    let ladder = table(&report, "optical_path_ladder");
    assert!(
        RUNGS.iter().filter(|rung| **rung != REFERENCE).all(|rung| ladder.contains(&format!("| {rung} |"))),
        "{ladder}"
    );
    assert!(
        ladder.contains("| godunov-64 | 0.031, 0.0031 | 64.0 | 0.031, 0.0031 | 64.0 | 0.031, 0.0031 | 64.0 | 20 KiB |"),
        "{ladder}"
    );
    let walks = table(&report, "optical_path_walks");
    assert!(RUNGS.iter().chain(&[UNSCALED]).all(|rung| walks.contains(&format!("| {rung} |"))), "{walks}");
    assert!(walks.contains("| godunov-64 | - | 192.0 | - | 192.0 | - | 192.0 | - | 192.0 |"), "{walks}");
    let stages = table(&report, "optical_path_stages");
    assert!(stages.contains("| tiled-6-64 | 7 | 1234 | 1.0 | 2.0 | 3.0 | 32.0 | 4.0 | 64.0 |"), "{stages}");
    assert!(!stages.contains("| reference |"), "{stages}");
    // Times proportional to the cells along an edge.
    let growth = table(&report, "optical_path_growth");
    assert!(growth.contains("| tiled-26 | 8.0, 16.0 |") && growth.contains("| 1.0, from 64 |"), "{growth}");
    assert!(growth.contains("| 256.0, 512.0 | - |"), "{growth}");
    report.rungs[2].solved = Some(Solved { passes: 9, updates: 5, active: 1 });
    report.rungs[2].times[1].grey.as_mut().expect("timed").rounds = 2;
    let stages = table(&report, "optical_path_stages");
    assert!(stages.contains("| paper-64 | 9 | 5+ |") && stages.contains("| 64.0* |"), "{stages}");
    let page = "<!-- generated: optical_path_growth --><!-- end -->";
    assert!(fill(page, &report).expect("filled").contains("| godunov |"));
    report.rungs.remove(4);
    assert!(fill(page, &report).expect_err("a part").contains("no time of `ping-pong-6-64`"));
}

#[test]
fn goals_are_judged_by_the_record() {
    let mut report = whole();
    let goals = table(&report, "optical_path_goals");
    for line in ["5.2: 192.0 ms | missed |", "4.0 times; the solve alone 4.0 | met |", "| 0.031 | met |"] {
        assert!(goals.contains(line), "{line}: {goals}");
    }
    assert_eq!(goals.matches("| no picture by random walks is committed | open |").count(), WALKED.len(), "{goals}");
    assert!(goals.contains("bunny |") && goals.contains("dragon |"), "a goal is for both: {goals}");
    let walked = |report: &mut OpticalPathReport, name: &str, error| {
        let rung = report.rungs.iter_mut().find(|rung| rung.rung == name).expect("a rung");
        rung.distances[1].walks = Some(error);
    };
    // Lambert's law without shadows is not the baseline.
    walked(&mut report, LAMBERT, 0.9);
    walked(&mut report, LAMBERT_SHADOWED, 0.5);
    walked(&mut report, USUAL, 0.2);
    assert!(table(&report, "optical_path_goals").contains("0.200 and 0.500: 0.40 times | met |"));
    walked(&mut report, USUAL, 0.3);
    assert!(table(&report, "optical_path_goals").contains("0.60 times | missed |"));
    for (name, ms) in [(USUAL, 30.0), ("ping-pong-26-128", 300.0)] {
        let at = report.rungs.iter().position(|rung| rung.rung == name).expect("a rung");
        report.rungs[at] = rung(name, ms, 0.2);
    }
    let goals = table(&report, "optical_path_goals");
    for line in ["11.1: 90.0 ms | met |", "2.3 times; the solve alone 2.3 | missed |", "| 0.200 | missed |"] {
        assert!(goals.contains(line), "{line}: {goals}");
    }
}

#[test]
fn plots_show_every_timed_rung_and_every_solver() {
    let report = whole();
    let svg = plot::error(&report).expect("drawn");
    for rung in report
        .rungs
        .iter()
        .filter(|rung| rung.distance("ball").nats.is_some() && rung.ms().is_some() && !rung.dominated)
    {
        let name = &rung.rung;
        assert!(svg.contains(&format!("\n{name}\n")) || svg.contains(&format!(">{name}<")), "{name}");
    }
    let growth = plot::growth(&report).expect("drawn");
    assert!(GROWING.iter().all(|solver| growth.contains(&format!("{solver}, the solve"))), "{growth}");
    let empty = super::tests::report(Vec::new());
    assert!(plot::error(&empty).expect_err("nothing").to_string().contains("no rung was timed"));
    assert!(!plot::has_growth(&empty) && plot::growth(&empty).is_err() && plot::has_growth(&report));
}
