//! `cook cost`: the ladder's report holds together. Nothing timed is asserted.

use crate::program::{folder, succeeds};
use lapidary_harness::cost::{MEASURES, page, views};
use lapidary_harness::render::{Frame, Settings};
use lapidary_harness::scene::Scene;
use serde_json::Value;

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
        "brilliant,sapphire",
    ];
    let rows: Value = serde_json::from_str(&succeeds(folder.path(), &arguments).stdout).expect("JSON alone");
    let rows = rows.as_array().expect("an array");
    assert_eq!(rows.len(), 3 * 2 * MEASURES.len());
    let error = |rung: &str, view: &str, measure: &str| {
        let row = rows.iter().find(|row| row["rung"] == rung && row["view"] == view && row["error_measure"] == measure);
        let row = row.unwrap_or_else(|| panic!("{rung} {view} {measure}"));
        assert_eq!(row["technique"], "gem");
        assert!(row["ms"].is_null() && row["dominated"] == false);
        row["error"].as_f64().expect("a number")
    };
    for view in ["brilliant", "sapphire"] {
        for measure in ["flip", "rmse"] {
            let [surface, proxy, convex] =
                ["surface", "proxy-1", "convex-4+tracker"].map(|rung| error(rung, view, measure));
            assert!(convex < proxy && convex < surface, "{view} {measure}: {surface} {proxy} {convex}");
        }
    }
}

#[test]
fn a_report_is_written_with_plots_when_timed() {
    let folder = folder();
    let arguments =
        ["cost", "gem", "--rounds", "1", "--rungs", "surface,proxy-1", "--views", "octahedron", "--out", "report"];
    let text = succeeds(folder.path(), &arguments).stdout;
    assert!(text.contains("proxy-1") && text.contains("GTX 760") && text.contains("dominated"), "{text}");
    for file in ["gem.txt", "gem.json", "gem_flip.svg", "gem_rmse.svg"] {
        let contents = std::fs::read_to_string(folder.path().join("report").join(file)).expect(file);
        assert!(contents.contains("proxy-1"), "{file}");
    }
}

#[test]
fn every_view_has_its_committed_reference() {
    let page = views::VIEWS[0].reference_file().with_file_name("README.md");
    let page = std::fs::read_to_string(page).expect("the references' page");
    for view in views::VIEWS.into_iter().chain(views::SHOWN) {
        let picture = view.reference(super::gpu()).unwrap_or_else(|error| panic!("{error}"));
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
        let frame = Frame::new(super::gpu(), &Scene::named(name).expect("built in"), &settings).expect("a frame");
        assert_eq!(frame.draw_calls(), 1, "{name}");
    }
}

#[test]
fn a_profile_cuts_every_frame() {
    let folder = folder();
    let text = succeeds(folder.path(), &["cost", "gem", "--profile", "--rounds", "1", "--out", "."]).stdout;
    assert!(folder.path().join("gem_profile.txt").exists());
    let times =
        text.split_whitespace().filter(|word| word.parse::<f64>().is_ok_and(|ms| ms > 0.0) && word.contains('.'));
    assert_eq!(times.count(), 7, "{text}");
}

/// The record of the repository, and the pages that show it.
#[test]
fn the_pages_show_the_record() {
    let docs = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs");
    let read = |name: &str| std::fs::read_to_string(docs.join(name)).expect(name);
    let report = serde_json::from_str(&read("measurements/lavapipe/gem.json")).expect("a report");
    for page in ["gem_ladder.md", "gem_proxy.md"] {
        let text = read(page);
        assert!(text.contains("<!-- generated: "), "{page}");
        let again =
            "./cook cost gem --from docs/measurements/lavapipe/gem.json --fill docs/gem_ladder.md,docs/gem_proxy.md";
        assert!(page::fill(&text, &report).expect("filled") == text, "{page} is not the record's: {again}");
    }
}
