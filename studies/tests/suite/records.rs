//! The records of the studies in the repository, and the pages and texts that show them.

use lapidary_cookbook::repository;
use lapidary_ladders::cdrf::spheres::profiles;
use lapidary_ladders::{Ladder, Report, Row, page};
use lapidary_reference::random_walk;
use lapidary_studies::list::{STUDIES, tables};
use lapidary_studies::sphere;

#[test]
fn the_pages_show_the_records() {
    let pages: [(&str, &[&str]); STUDIES.len()] = [
        ("gem", &["gem_ladder.md", "gem_proxy.md"]),
        ("cdrf", &["cdrf.md", "cdrf_ladder.md", "cdrf_shading.md"]),
        ("outside", &["gem.md"]),
        ("dynamic", &["diffusion.md"]),
        ("restraint", &["gem.md", "optical_path.md", "plan.md"]),
        ("sphere", &["cdrf.md"]),
    ];
    for (study, (name, pages)) in STUDIES.iter().zip(pages) {
        assert_eq!(study.name, name);
        let folder = if name == "sphere" { "random_walk" } else { "lavapipe" };
        let report = record(name, folder);
        let fill: Vec<String> = pages.iter().map(|page| format!("docs/{page}")).collect();
        let again = format!(
            "./cook cost {name} --from docs/measurements/{folder}/{name}.json --out docs/measurements/{folder} --fill {}",
            fill.join(",")
        );
        for page in pages {
            let text = docs(page);
            let tables = (study.tables)(&report);
            assert!(tables.iter().any(|table| text.contains(&mark(table.name))), "{page}");
            assert!(page::fill(&text, study, &report).expect("filled") == text, "{page} is not the record's: {again}");
        }
        let text = docs(&format!("measurements/{folder}/{name}.txt"));
        assert!(text == study.text(&report), "{name}.txt is not the record's: {again}");
        for plot in (study.plots)(&report) {
            let drawn = docs(&format!("measurements/{folder}/{}", plot.file));
            assert!(drawn == plot.svg(), "{} is not the record's: {again}", plot.file);
        }
    }
    // Of a GPU, when there was one.
    for name in ["gem", "cdrf", "dynamic"] {
        let folder = "docs/measurements/nvidia_h200";
        let text = docs(&format!("measurements/nvidia_h200/{name}.txt"));
        let again = format!("./cook cost {name} --from {folder}/{name}.json --out {folder}");
        assert!(text == study(name).text(&record(name, "nvidia_h200")), "{name}.txt is not the record's: {again}");
    }
}

/// The records of ladders that hold a study's rows too show all of the study's tables.
#[test]
fn no_table_of_a_study_is_left_out() {
    let shown: Vec<&str> = STUDIES
        .iter()
        .flat_map(|study| {
            let folder = if study.name == "sphere" { "random_walk" } else { "lavapipe" };
            (study.tables)(&record(study.name, folder)).into_iter().map(|table| table.name)
        })
        .collect();
    for name in tables() {
        assert!(shown.contains(&name), "{name}");
    }
}

/// A report of the ladder alone fills the ladder's tables, and leaves the studies'.
#[test]
fn what_was_not_measured_is_left_on_the_page() {
    let mut report = record("gem", "lavapipe");
    report.rows.retain(|row| row.measure != "growth");
    let page = format!("{}old<!-- end -->\n{}old<!-- end -->\n", mark("growth"), mark("steadiness"));
    let filled = page::fill(&page, study("gem"), &report).expect("filled");
    assert!(
        filled.contains(&format!("{}old<", mark("growth"))) && !filled.contains(&format!("{}old", mark("steadiness")))
    );
}

fn mark(table: &str) -> String {
    format!("<!-- generated: {table} -->")
}

fn docs(name: &str) -> String {
    std::fs::read_to_string(repository::place().join("docs").join(name)).expect(name)
}

fn record(name: &str, folder: &str) -> Report {
    let json = docs(&format!("measurements/{folder}/{name}.json"));
    Report::from_json(name, &json).unwrap_or_else(|error| panic!("{error}"))
}

/// Returns a study by its name.
fn study(name: &str) -> &'static Ladder {
    STUDIES.iter().find(|study| study.name == name).expect(name)
}

/// The spheres' fits and rules are what this code makes of the recorded walks, and new walks of another seed agree with those.
#[test]
fn the_record_of_spheres_is_what_walks_give() {
    let record = record("sphere", "random_walk");
    let profiles = profiles(&record);
    let again = sphere::report(record.setting("walks"), record.setting("seed"), &profiles);
    assert_eq!(again.rows.len(), record.rows.len());
    for (found, recorded) in again.rows.iter().zip(&record.rows) {
        let same = |row: &Row| (row.rung.clone(), row.view.clone(), row.measure.clone(), row.value.is_some());
        assert_eq!(same(found), same(recorded));
        // Another platform's exponential moves the bottom of a flat valley, and hardly what is left there.
        let part = match &*found.measure {
            "residual" | "one sigma0" | "by the law" | "own best" | "lambert" => 1e-4,
            "error of sigma R" | "worst" => 2e-2,
            measure if measure.starts_with("exitance") || measure.starts_with("standard error") => 1e-12,
            _ => 5e-3,
        };
        if let Some((value, recorded)) = found.value.zip(recorded.value) {
            assert!((value - recorded).abs() <= part * recorded.abs() + 1e-5, "{found:?} {recorded}");
        }
    }
    // What the page says of all light, and what it advises.
    let law = |rung: &str| ["factor", "exponent"].map(|fact| record.value(rung, "all albedos", fact).expect("a law"));
    let [factor, exponent] = law("circular, all light");
    assert!(docs("cdrf.md").contains(&format!("σR = {factor:.2} R^{exponent:.2}")), "{factor} {exponent}");
    let [factor, exponent] = law("circular");
    assert!(docs("cdrf.md").contains(&format!("σ = {factor:.1} (κℓ)^{:.2}", 1.0 - exponent)), "{factor} {exponent}");
    for (albedo, radius) in [(0.8, 10.0), (0.99, 3.0)] {
        let walked = random_walk::profile(radius, albedo, 100_000, record.setting("seed") ^ 0xabcd);
        let is = |sphere: &&random_walk::Profile| (sphere.albedo, sphere.radius) == (albedo, radius);
        let recorded = profiles.iter().find(is).expect("a sphere");
        let squares = (0..random_walk::BINS).map(|bin| {
            let error = walked.standard_error[bin].hypot(recorded.standard_error[bin]);
            // Where nothing left the sphere there is no error to measure by.
            let difference = walked.exitance[bin] - recorded.exitance[bin];
            if error > 0.0 { (difference / error).powi(2) } else { 0.0 }
        });
        // Chi squared of 36 intervals: 36 in the mean, its deviation 8.5.
        let chi_squared: f64 = squares.sum();
        assert!(chi_squared < 36.0 + 4.0 * 8.5, "albedo {albedo}, radius {radius}: {chi_squared}");
    }
}
