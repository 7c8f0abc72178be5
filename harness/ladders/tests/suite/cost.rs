//! `cook cost`: the ladder's report holds together. Nothing timed is asserted.

use lapidary_ladders::gem::{Errors, MEASURES, views};
use lapidary_ladders::{LADDERS, Ladder, Report, Row, cdrf, optical_path, page};
use lapidary_render::{FrameTimer, Settings};
use lapidary_scene::Scene;
use lapidary_testing::program::{folder, succeeds};

/// Returns a report printed as JSON.
fn printed(technique: &str, json: &str) -> Report {
    Report::from_json(technique, json).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn every_rung_measure_and_view_has_a_row() {
    let folder = folder();
    let arguments = [
        "cost",
        "gem",
        "--json",
        "--rounds",
        "0",
        "--rungs",
        "surface,proxy-1,convex-4+tracker",
        "--views",
        "sapphire",
    ];
    let report = printed("gem", &succeeds(folder.path(), &arguments).stdout);
    assert!(report.rows.iter().all(|row| row.ms.is_none()));
    let rungs = ["surface", "proxy-1", "convex-4+tracker"];
    assert_eq!(report.rungs("change"), rungs);
    assert!(rungs.iter().all(|rung| MEASURES.iter().all(|figure| report.value(rung, "sapphire", figure).is_some())));
    let error = |rung: &str, view: &str, measure: &str| report.value(rung, view, measure).expect("a number");
    for measure in ["flip", "rmse"] {
        let [surface, proxy, convex] =
            ["surface", "proxy-1", "convex-4+tracker"].map(|rung| error(rung, "sapphire", measure));
        assert!(convex < proxy && convex < surface, "{measure}: {surface} {proxy} {convex}");
    }
}

#[test]
#[ignore = "long; .ci/full runs it"]
fn a_report_is_written_with_plots_when_timed() {
    let folder = folder();
    let arguments =
        ["cost", "gem", "--rounds", "1", "--rungs", "surface,proxy-1", "--views", "octahedron", "--out", "report"];
    let text = succeeds(folder.path(), &arguments).stdout;
    assert!(text.contains("proxy-1") && text.contains("GTX 760") && text.contains("Dominated"), "{text}");
    for file in ["gem.txt", "gem.json", "gem_flip.svg", "gem_rmse.svg"] {
        let contents = std::fs::read_to_string(folder.path().join("report").join(file)).expect(file);
        assert!(contents.contains("proxy-1"), "{file}");
    }
}

/// What is compared is what is timed: the record's errors are those of a picture of its size and samples, of which it has the time.
#[test]
fn errors_and_times_are_of_the_same_pictures() {
    let folder = folder();
    let views = lapidary_testing::sampled(["octahedron", "bunny_stone"], 2);
    let asked = views.join(",");
    let arguments = ["cost", "gem", "--rounds", "1", "--rungs", "bvh-2", "--views", &asked, "--out", "."];
    succeeds(folder.path(), &arguments);
    let text = std::fs::read_to_string(folder.path().join("gem.json")).expect("a report");
    let report = printed("gem", &text);
    let [samples, side] = ["samples", "side"].map(|name| report.setting(name) as u32);
    assert_eq!(report.views("change"), views);
    for name in views {
        let view = views::View::named(name).expect(name);
        let seen = |measure: &str| report.value("bvh-2", name, measure).expect("drawn");
        let rung = "bvh-2".parse().expect("a rung");
        let settings = Settings { rung, samples: samples.isqrt(), ..Settings::of_size(side, side) };
        let scene = view.open().expect("built in");
        let picture =
            |scene: &Scene| lapidary_render::render(lapidary_testing::gpu(), scene, &settings).expect("rendered");
        let (now, next) = (picture(&scene), picture(&views::turned(&scene)));
        let reference = view.reference(lapidary_testing::gpu()).expect("committed");
        let errors = Errors::between(&now, &reference);
        let same = |recorded: f64, found: f64| recorded == found;
        assert!(same(seen("flip"), errors.flip) && same(seen("rmse"), errors.rmse), "{name}: {errors:?}");
        let sum = |value: &dyn Fn(usize, usize) -> f32| -> f64 {
            (0..now.linear.len())
                .flat_map(|k| (0..3).map(move |c| (k, c)))
                .map(|(k, c)| f64::from(value(k, c)).powi(2))
                .sum()
        };
        let difference = sum(&|k, c| now.linear[k][c] - next.linear[k][c]);
        let change = (difference / sum(&|k, c| reference.linear[k][c])).sqrt();
        // The two sum in another order, and one rounds the difference to f32.
        assert!((seen("change") / change - 1.0).abs() < 1e-6 && change > 0.0, "{name}: {} {change}", seen("change"));
        let ms = report.ms("bvh-2", name, "flip");
        assert!(ms.is_some_and(|ms| ms.is_finite() && ms >= 0.0), "{name}");
    }
}

#[test]
fn every_view_has_its_committed_reference() {
    let page = views::VIEWS[0].reference_file().with_file_name("README.md");
    let page = std::fs::read_to_string(page).expect("the references' page");
    for view in views::VIEWS.into_iter().chain(views::CONCAVE).chain(views::SHOWN) {
        let picture = view.reference(lapidary_testing::gpu()).unwrap_or_else(|error| panic!("{error}"));
        let covered = picture.linear.iter().filter(|pixel| pixel[3] > 0.5).count();
        assert!(covered > 1000, "{}: {covered}", view.name);
        assert!(page.contains(&format!("    {}\n", view.command())), "{}", view.command());
    }
}

/// The chain and the chandelier are hundreds of bodies and one draw call.
#[test]
fn many_prisms_are_one_draw_call() {
    for name in ["prism_chain", "chandelier"] {
        let settings = Settings { rung: "proxy-2+tracker".parse().expect("a rung"), ..Settings::of_size(64, 64) };
        let scene = Scene::named(name).expect("built in");
        let frame = FrameTimer::new(lapidary_testing::gpu(), &scene, &settings, None, false).expect("a frame");
        assert_eq!(frame.draw_calls(), 1, "{name}");
    }
}

/// Without times, what is exact: the record holds the same instructions and bytes as a new run.
#[test]
fn what_effects_take_is_as_recorded() {
    let folder = folder();
    succeeds(folder.path(), &["cost", "effects", "--rounds", "0", "--out", "."]);
    let text = std::fs::read_to_string(folder.path().join("effects.json")).expect("a report");
    let found = printed("effects", &text);
    let recorded = record("effects", "lavapipe");
    assert_eq!(found.rows.len(), recorded.rows.len());
    for (found, recorded) in found.rows.iter().zip(&recorded.rows) {
        assert_eq!(*found, Row { ms: None, ..recorded.clone() });
    }
}

/// The records of the repository, and the pages and texts that show them.
#[test]
fn the_pages_show_the_record() {
    let pages: [(&str, &[&str]); LADDERS.len()] = [
        ("gem", &["gem_ladder.md"]),
        ("cdrf", &["cdrf.md", "cdrf_ladder.md", "cdrf_shading.md"]),
        ("optical_path", &["optical_path_ladder.md"]),
        ("effects", &["plan.md"]),
        ("translucent", &["diffusion.md"]),
    ];
    for (ladder, (name, pages)) in LADDERS.iter().zip(pages) {
        assert_eq!(ladder.name, name);
        let folder = "lavapipe";
        let report = record(name, folder);
        let fill: Vec<String> = pages.iter().map(|page| format!("docs/{page}")).collect();
        let again = format!(
            "./cook cost {name} --from docs/measurements/{folder}/{name}.json --out docs/measurements/{folder} --fill {}",
            fill.join(",")
        );
        for page in pages {
            let text = docs(page);
            let tables = (ladder.tables)(&report);
            assert!(tables.iter().any(|table| text.contains(&format!("<!-- generated: {} -->", table.name))), "{page}");
            assert!(page::fill(&text, ladder, &report).expect("filled") == text, "{page} is not the record's: {again}");
        }
        holds_the_tables(ladder, folder, &again);
        for plot in (ladder.plots)(&report) {
            let drawn = docs(&format!("measurements/{folder}/{}", plot.file));
            assert!(drawn == plot.svg(), "{} is not the record's: {again}", plot.file);
        }
    }
    // Of a GPU, when there was one.
    for name in ["gem", "cdrf", "optical_path", "effects", "translucent"] {
        let folder = "docs/measurements/nvidia_h200";
        let again = format!("./cook cost {name} --from {folder}/{name}.json --out {folder}");
        holds_the_tables(ladder(name), "nvidia_h200", &again);
    }
}

/// Asserts that a record's text has the ladder's tables, and nothing else unless a study shares the record.
fn holds_the_tables(ladder: &Ladder, folder: &str, again: &str) {
    let name = ladder.name;
    let (report, text) = (record(name, folder), docs(&format!("measurements/{folder}/{name}.txt")));
    let tables = (ladder.tables)(&report).into_iter().filter(|table| !table.is_empty());
    let all = tables.into_iter().all(|table| text.contains(&format!("\n{}", table.text())));
    let shared = ["gem", "cdrf"].contains(&name);
    assert!(all && (shared || text == ladder.text(&report)), "{name}.txt is not the record's: {again}");
}

fn docs(name: &str) -> String {
    let docs = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
    std::fs::read_to_string(docs.join(name)).expect(name)
}

fn record(name: &str, folder: &str) -> Report {
    printed(name, &docs(&format!("measurements/{folder}/{name}.json")))
}

/// Returns a ladder by its name.
fn ladder(name: &str) -> &'static Ladder {
    LADDERS.iter().find(|ladder| ladder.name == name).expect(name)
}

#[test]
#[ignore = "long; .ci/full runs it"]
fn the_reflectance_is_timed_written_and_shown_again() {
    let folder = folder();
    let arguments = ["cost", "cdrf", "--rungs", "lambert,cheap", "--rounds", "1", "--json", "--out", "report"];
    let report = printed("cdrf", &succeeds(folder.path(), &arguments).stdout);
    assert!(report.technique == "cdrf" && !report.adapter.is_empty());
    for (rung, view) in ["lambert", "cheap"].into_iter().flat_map(|rung| cdrf::VIEWS.map(|view| (rung, view))) {
        for measure in cdrf::MEASURES {
            let row = report.row(rung, view, measure).unwrap_or_else(|| panic!("{rung} {view} {measure}"));
            // A clock may be too coarse to see a frame.
            assert!(row.ms.is_some_and(|ms| ms >= 0.0 && ms.is_finite()), "{row:?}");
        }
        let error = report.value(rung, view, "rms").expect("a number");
        assert!((rung == "cheap") == (error < 0.05), "{rung} {view}: {error}");
    }
    // Lambert's law knows no curvature: its frame is timed once.
    let [screen, vertex] = ["screen", "vertex"].map(|source| report.ms("lambert", &format!("lit+{source}"), "time"));
    assert!(screen.is_some() && screen == vertex, "{screen:?} {vertex:?}");
    let ladder_rows = report.rows.iter().filter(|row| cdrf::VIEWS.contains(&&*row.view)).count();
    let shares = report.rungs("share of the pixels").len();
    assert!(
        ladder_rows >= 2 * 4 * (cdrf::MEASURES.len() + 1) && ladder_rows <= 2 * 4 * 5 + 4 * shares,
        "{ladder_rows}"
    );
    let read = |name: &str| std::fs::read_to_string(folder.path().join("report").join(name)).expect(name);
    let again = succeeds(folder.path(), &["cost", "cdrf", "--from", "report/cdrf.json"]).stdout;
    assert_eq!(again.trim_end(), read("cdrf.txt").trim_end());
    assert!(again.contains("PlayStation 3") && again.contains("over Lambert"), "{again}");
    assert!(read("cdrf.svg").contains("cheap"));
}

#[test]
#[ignore = "long; .ci/full runs it"]
fn ways_through_stone_are_compared_written_and_shown_again() {
    let folder = folder();
    let arguments =
        ["cost", "optical_path", "--rungs", "lambert,godunov-16", "--rounds", "1", "--json", "--out", "report"];
    let report = printed("optical_path", &succeeds(folder.path(), &arguments).stdout);
    let error = |rung: &str, view: &str, measure: &str| {
        let row = report.row(rung, view, measure).unwrap_or_else(|| panic!("{rung} {view} {measure}"));
        let pictured = if measure == "walks" { &optical_path::WALKED[..] } else { &optical_path::COMPARED };
        assert_eq!(row.ms.is_some(), pictured.contains(&view), "{row:?}");
        row.value
    };
    for view in optical_path::VIEWS {
        for measure in ["nats", "luminance"].into_iter().filter(|_| optical_path::COMPARED.contains(&view)) {
            let [lambert, ways] = ["lambert", "godunov-16"]
                .map(|rung| error(rung, view, measure).expect("a closed form, or a finer grid"));
            // Black counts as a cost, and so costs tell more than luminance does, of which deep places have little.
            let share = if measure == "nats" { 0.2 } else { 1.0 };
            assert!(ways > 0.0 && ways < share * lambert, "{view} {measure}: {ways} {lambert}");
        }
        let walked = lapidary_snapshots::WALKED.iter().any(|reference| reference.scene == view);
        assert_eq!(error("godunov-16", view, "walks").is_some(), walked, "{view}");
    }
    let read = |name: &str| std::fs::read_to_string(folder.path().join("report").join(name)).expect(name);
    let again = succeeds(folder.path(), &["cost", "optical_path", "--from", "report/optical_path.json"]).stdout;
    assert_eq!(again.trim_end(), read("optical_path.txt").trim_end());
    assert!(read("optical_path_error.svg").contains("godunov-16"));
    assert!(read("optical_path_growth.svg").contains("godunov, the solve"));
}
