use super::rungs::{CELLS, FINEST, GREY, GROWING, LAMBERT, LAMBERT_SHADOWED, REFERENCE, RGB, STAGED, UNSCALED, USUAL};
use super::*;
use crate::page::fill;
use crate::{Plot, Report, Row};
use lapidary_plan::Rung;
use lapidary_render::Stage;

/// Adds a rung whose grey frame takes `ms`, half of it in the solver.
fn add(report: &mut Report, rung: &str, ms: f64, nats: Option<f64>) {
    for view in VIEWS {
        let luminance = nats.map(|nats| 0.1 * nats);
        report.rows.push(Row::new(rung, view, "nats", nats, "").timed(Some(ms)));
        report.rows.push(Row::new(rung, view, "luminance", luminance, "").timed(Some(ms)));
        report.rows.push(Row::new(rung, view, "walks", None, "").timed(Some(3.0 * ms)));
        report.rows.push(Row { bytes: Some(20_000), ..Row::new(rung, view, GREY, ms, "ms").timed(Some(ms)) });
        report.rows.push(Row::new(rung, view, RGB, 3.0 * ms, "ms").timed(Some(3.0 * ms)));
    }
    let stages = Stage::ALL.into_iter().zip([1.0, 2.0, 3.0, 0.5 * ms, 4.0]);
    report.rows.extend(stages.map(|(stage, ms)| Row::new(rung, STAGED, stage.name(), ms, "ms")));
    let state = [("passes", 7.0), ("updates", 1234.0), ("active", 0.0)];
    report.rows.extend(state.map(|(measure, count)| Row::new(rung, STAGED, measure, count, "")));
}

fn report(rungs: &[(&str, f64, Option<f64>)]) -> Report {
    let settings = [("width", 512), ("height", 512), ("rounds", 5)];
    let mut report = Report::new("optical_path", "a device".to_owned(), &settings);
    rungs.iter().for_each(|&(rung, ms, nats)| add(&mut report, rung, ms, nats));
    report
}

/// Returns the whole ladder with made-up values: more cells are slower and more accurate, and
/// ping-pong is four times as slow as tiles.
fn whole() -> Report {
    let figures_of = |rung: &'static str| {
        let cells: f64 = rung.rsplit('-').next().and_then(|cells| cells.parse().ok()).unwrap_or(8.0);
        let slow = if rung.starts_with("ping-pong") { 4.0 } else { 1.0 };
        let near = if rung.starts_with("godunov") { 0.25 } else { 1.0 };
        match rung {
            LAMBERT | LAMBERT_SHADOWED => (rung, 5.0, Some(9.0)),
            UNSCALED => (rung, 64.0, None),
            _ => (rung, slow * cells, Some(8.0 * near / cells)),
        }
    };
    let rungs = RUNGS.into_iter().filter(|rung| *rung != REFERENCE).chain([UNSCALED]);
    let mut report = report(&rungs.map(figures_of).collect::<Vec<_>>());
    for (view, measure) in VIEWS.into_iter().flat_map(|view| MEASURES.map(|measure| (view, measure))) {
        report.rows.push(Row::new(REFERENCE, view, measure, None, ""));
    }
    report
}

fn table(report: &Report, name: &str) -> String {
    let tables = tables::tables(report);
    tables.iter().find(|table| table.name == name).expect("a table").markdown()
}

/// Sets a measurement's value.
fn set(report: &mut Report, rung: &str, view: &str, measure: &str, value: f64) {
    let is = |row: &&mut Row| (&*row.rung, &*row.view, &*row.measure) == (rung, view, measure);
    report.rows.iter_mut().find(is).expect("a row").value = Some(value);
}

#[test]
fn every_rung_is_one_of_the_renderers() {
    let options = options();
    assert_eq!(options.rungs.iter().map(Rung::to_string).collect::<Vec<_>>(), RUNGS);
    let names: Vec<String> = Measured::all(&options.rungs).into_iter().map(Measured::name).collect();
    assert_eq!(names.iter().filter(|name| !RUNGS.contains(&name.as_str())).collect::<Vec<_>>(), [UNSCALED]);
    for view in VIEWS {
        let committed = lapidary_snapshots::WalkedReference::of_scene(view).is_some();
        assert_eq!(WALKED.contains(&view), committed, "{view}");
    }
    for solver in GROWING {
        assert!(CELLS.iter().filter(|cells| RUNGS.contains(&format!("{solver}-{cells}").as_str())).count() >= 4);
    }
}

#[test]
fn a_rung_is_dominated_by_a_faster_one_that_errs_no_more_in_any_view() {
    let marked = |report: &Report| -> Vec<String> {
        let ladder = table(report, "optical_path_ladder");
        let marked = ladder.lines().filter(|line| line.ends_with("| dominated |"));
        marked.filter_map(|line| line.split(' ').nth(1).map(str::to_owned)).collect()
    };
    let mut report = report(&[("fast", 1.0, Some(0.5)), ("slow", 2.0, Some(0.5)), ("near", 3.0, Some(0.1))]);
    assert_eq!(marked(&report), ["slow"]);
    set(&mut report, "slow", "dragon", "nats", 0.4);
    assert!(marked(&report).is_empty());
    // The rung that made a view's truth has no error there and is judged by the other views.
    report.rows.retain(|row| (&*row.rung, &*row.view, &*row.measure) != ("slow", "dragon", "nats"));
    assert_eq!(marked(&report), ["slow"]);
    report.rows.iter_mut().filter(|row| row.rung == "slow").for_each(|row| row.ms = None);
    assert!(marked(&report).is_empty());
}

#[test]
fn text_and_tables_show_every_rung() {
    let mut report = whole();
    let text = LADDER.text(&report);
    assert!(RUNGS.iter().all(|rung| text.contains(rung)), "{text}");
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
    set(&mut report, "paper-64", STAGED, "active", 1.0);
    report.rows.push(Row::new("paper-64", STAGED, "rounds of grey", 2.0, ""));
    let stages = table(&report, "optical_path_stages");
    assert!(stages.contains("| paper-64 | 7 | 1234+ |") && stages.contains("| 64.0* |"), "{stages}");
    let page = "<!-- generated: optical_path_growth --><!-- end -->";
    assert!(fill(page, &LADDER, &report).expect("filled").contains("| godunov |"));
    report.rows.retain(|row| row.rung != "ping-pong-6-64");
    assert!(fill(page, &LADDER, &report).expect_err("a part").contains("no time of `ping-pong-6-64`"));
}

#[test]
fn goals_are_judged_by_the_record() {
    let mut report = whole();
    let goals = table(&report, "optical_path_goals");
    for line in ["5.2: 192.0 ms | missed |", "4.0 times; the solve alone 4.0 | met |", "| 0.031 | met |"] {
        assert!(goals.contains(line), "{line}: {goals}");
    }
    assert!(goals.contains("bunny |") && goals.contains("dragon |"), "a goal is for both: {goals}");
    // Lambert's law without shadows is not the baseline.
    set(&mut report, LAMBERT, "bunny", "walks", 0.9);
    set(&mut report, LAMBERT_SHADOWED, "bunny", "walks", 0.5);
    set(&mut report, USUAL, "bunny", "walks", 0.2);
    assert!(table(&report, "optical_path_goals").contains("0.200 and 0.500: 0.40 times | met |"));
    set(&mut report, USUAL, "bunny", "walks", 0.3);
    assert!(table(&report, "optical_path_goals").contains("0.60 times | missed |"));
    report.rows.retain(|row| ![USUAL, "ping-pong-26-128"].contains(&&*row.rung));
    add(&mut report, USUAL, 30.0, Some(0.2));
    add(&mut report, "ping-pong-26-128", 300.0, Some(0.2));
    let goals = table(&report, "optical_path_goals");
    for line in ["11.1: 90.0 ms | met |", "2.3 times; the solve alone 2.3 | missed |", "| 0.200 | missed |"] {
        assert!(goals.contains(line), "{line}: {goals}");
    }
}

#[test]
fn plots_show_every_timed_rung_and_every_solver() {
    let plots = tables::plots(&whole());
    let [error, growth] = [0, 1].map(|index: usize| plots[index].svg());
    for rung in ["godunov-16", FINEST, LAMBERT] {
        assert!(error.contains(&format!(">{rung}</text>")), "{rung}");
    }
    assert!(GROWING.iter().all(|solver| growth.contains(&format!("{solver}, the solve"))), "{growth}");
    assert!(tables::plots(&Report::default()).iter().all(Plot::is_empty));
}
