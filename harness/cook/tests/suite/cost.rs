//! `cook cost`: the ladder's report holds together. Nothing timed is asserted.

use crate::program::{folder, succeeds};
use lapidary_cook::cost::cdrf::{self, CdrfReport};
use lapidary_cook::cost::effects::EffectsReport;
use lapidary_cook::cost::optical_path::{self, OpticalPathReport};
use lapidary_cook::cost::page::{self, Tables};
use lapidary_cook::cost::restraint::RestraintReport;
use lapidary_cook::cost::sphere::Form;
use lapidary_cook::cost::sphere::{ALBEDOS, Law, RADII, Row, SphereReport};
use lapidary_cook::cost::{Errors, MEASURES, Report, views};
use lapidary_reference::random_walk;
use lapidary_render::{FrameTimer, Settings};
use lapidary_scene::Scene;
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
        "sapphire",
    ];
    let rows: Value = serde_json::from_str(&succeeds(folder.path(), &arguments).stdout).expect("JSON alone");
    let rows = rows.as_array().expect("an array");
    assert_eq!(rows.len(), 3 * MEASURES.len());
    let error = |rung: &str, view: &str, measure: &str| {
        let row = rows.iter().find(|row| row["rung"] == rung && row["view"] == view && row["error_measure"] == measure);
        let row = row.unwrap_or_else(|| panic!("{rung} {view} {measure}"));
        assert_eq!(row["technique"], "gem");
        assert!(row["ms"].is_null() && row["dominated"] == false);
        row["error"].as_f64().expect("a number")
    };
    for measure in ["flip", "rmse"] {
        let [surface, proxy, convex] =
            ["surface", "proxy-1", "convex-4+tracker"].map(|rung| error(rung, "sapphire", measure));
        assert!(convex < proxy && convex < surface, "{measure}: {surface} {proxy} {convex}");
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

/// What is compared is what is timed: the record's errors are those of a picture of its size and samples, of which it has the time.
#[test]
fn errors_and_times_are_of_the_same_pictures() {
    let folder = folder();
    let views = ["octahedron", "bunny_stone"];
    let asked = views.join(",");
    let arguments = ["cost", "gem", "--rounds", "1", "--rungs", "bvh-2", "--views", &asked, "--out", "."];
    succeeds(folder.path(), &arguments);
    let text = std::fs::read_to_string(folder.path().join("gem.json")).expect("a report");
    let report: Report = serde_json::from_str(&text).expect("a report");
    let samples = report.samples.isqrt();
    assert_eq!(
        (samples * samples, &*report.views, &*report.concave),
        (report.samples, &[views[0].to_owned()][..], &[views[1].to_owned()][..])
    );
    let rung = &report.rungs[0];
    for (name, seen) in views.into_iter().zip([rung.views[0], rung.concave[0]]) {
        let (view, seen) = (views::View::named(name).expect(name), seen.expect("drawn"));
        let settings =
            Settings { rung: "bvh-2".parse().expect("a rung"), samples, ..Settings::of_size(report.side, report.side) };
        let scene = view.open().expect("built in");
        let picture = |scene: &Scene| lapidary_render::render(super::gpu(), scene, &settings).expect("rendered");
        let (now, next) = (picture(&scene), picture(&views::turned(&scene)));
        let reference = view.reference(super::gpu()).expect("committed");
        let errors = Errors::between(&now, &reference);
        // A number's last digit may be lost on its way through JSON.
        let same = |recorded: f64, found: f64| (recorded / found - 1.0).abs() < 1e-12;
        assert!(
            same(seen.errors.flip, errors.flip) && same(seen.errors.rmse, errors.rmse),
            "{name}: {seen:?} {errors:?}"
        );
        let sum = |of: &dyn Fn(usize, usize) -> f32| -> f64 {
            (0..now.linear.len())
                .flat_map(|k| (0..3).map(move |c| (k, c)))
                .map(|(k, c)| f64::from(of(k, c)).powi(2))
                .sum()
        };
        let apart = sum(&|k, c| now.linear[k][c] - next.linear[k][c]);
        let change = (apart / sum(&|k, c| reference.linear[k][c])).sqrt();
        // The two sum in another order, and one rounds the difference to f32.
        assert!((seen.change / change - 1.0).abs() < 1e-6 && change > 0.0, "{name}: {} {change}", seen.change);
        assert!(seen.ms.is_some_and(|ms| ms.is_finite() && ms >= 0.0), "{name}");
    }
}

#[test]
fn every_view_has_its_committed_reference() {
    let page = views::VIEWS[0].reference_file().with_file_name("README.md");
    let page = std::fs::read_to_string(page).expect("the references' page");
    for view in views::VIEWS.into_iter().chain(views::CONCAVE).chain(views::SHOWN) {
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
        let scene = Scene::named(name).expect("built in");
        let frame = FrameTimer::new(super::gpu(), &scene, &settings, None, false).expect("a frame");
        assert_eq!(frame.draw_calls(), 1, "{name}");
    }
}

#[test]
fn a_profile_cuts_every_frame() {
    let folder = folder();
    let text = succeeds(folder.path(), &["cost", "gem", "--profile", "--rounds", "1", "--out", "."]).stdout;
    assert!(folder.path().join("gem_profile.txt").exists());
    let is_time = |word: &&str| word.contains('.') && word.parse::<f64>().is_ok_and(|ms| ms.is_finite() && ms >= 0.0);
    let times = text.split_whitespace().filter(is_time);
    assert_eq!(times.count(), 7, "{text}");
}

/// Tiles without matter, or that cannot change, cost time and change no cost; rays that are followed on cost time and change nothing that can
/// be seen.
#[test]
fn restraint_changes_nothing() {
    let folder = folder();
    let arguments = ["cost", "restraint", "--rungs", "proxy-8", "--rounds", "1", "--out", "."];
    succeeds(folder.path(), &arguments);
    let report = std::fs::read_to_string(folder.path().join("restraint.json")).expect("a report");
    let report: RestraintReport = serde_json::from_str(&report).expect("a report");
    assert_eq!((report.limited.len(), report.tiles.len()), (3, 3));
    for limited in &report.limited {
        let fewer = limited.facets_limited < limited.facets_unlimited;
        assert!(fewer && (0.0..=1.0).contains(&limited.largest), "{limited:?}");
    }
    for tiles in &report.tiles {
        assert!((0.05..0.95).contains(&tiles.with_matter), "{tiles:?}");
        assert!(tiles.ways.iter().all(|way| way.differing == 0 && way.passes > 2), "{tiles:?}");
        let [one, other, all] = [0, 1, 2].map(|way: usize| tiles.ways[way].updates);
        assert!(one < all / 2 && other < all / 2, "{tiles:?}");
    }
}

/// Without times, what is exact: the record holds the same instructions and bytes as a new run.
#[test]
fn what_effects_take_is_as_recorded() {
    let folder = folder();
    succeeds(folder.path(), &["cost", "effects", "--rounds", "0", "--out", "."]);
    let text = std::fs::read_to_string(folder.path().join("effects.json")).expect("a report");
    let found: EffectsReport = serde_json::from_str(&text).expect("a report");
    let recorded: EffectsReport = record("measurements/lavapipe/effects.json");
    assert_eq!(found.studies.len(), recorded.studies.len());
    for (found, recorded) in found.studies.iter().zip(&recorded.studies) {
        for (found_frame, recorded_frame) in found.frames.iter().zip(&recorded.frames) {
            let untimed = lapidary_cook::cost::effects::Frame { timing: None, ..recorded_frame.clone() };
            assert_eq!(*found_frame, untimed, "{} by {}", recorded.scene, recorded.rung);
        }
        assert_eq!(found.frames.len(), recorded.frames.len());
    }
}

/// The records of the repository, and the pages that show them.
#[test]
fn the_pages_show_the_record() {
    let gem: Report = record("measurements/lavapipe/gem.json");
    holds(&gem, "gem", "lavapipe", &["gem_ladder.md", "gem_proxy.md"]);
    let cdrf: CdrfReport = record("measurements/lavapipe/cdrf.json");
    holds(&cdrf, "cdrf", "lavapipe", &["cdrf.md", "cdrf_ladder.md", "cdrf_shading.md"]);
    assert_eq!(docs("measurements/lavapipe/cdrf.txt"), cdrf.text());
    let paths: OpticalPathReport = record("measurements/lavapipe/optical_path.json");
    holds(&paths, "optical_path", "lavapipe", &["optical_path_ladder.md"]);
    assert_eq!(docs("measurements/lavapipe/optical_path.txt"), paths.text());
    let restraint: RestraintReport = record("measurements/lavapipe/restraint.json");
    holds(&restraint, "restraint", "lavapipe", &["gem.md", "optical_path.md", "plan.md"]);
    assert_eq!(docs("measurements/lavapipe/restraint.txt"), restraint.text());
    let effects: EffectsReport = record("measurements/lavapipe/effects.json");
    holds(&effects, "effects", "lavapipe", &["plan.md"]);
    assert_eq!(docs("measurements/lavapipe/effects.txt"), effects.text());
    let sphere: SphereReport = record("measurements/random_walk/sphere.json");
    holds(&sphere, "sphere", "random_walk", &["cdrf.md"]);
}

fn docs(name: &str) -> String {
    let docs = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
    std::fs::read_to_string(docs.join(name)).expect(name)
}

fn record<R: serde::de::DeserializeOwned>(name: &str) -> R {
    serde_json::from_str(&docs(name)).expect(name)
}

fn holds<R: Tables>(report: &R, technique: &str, folder: &str, pages: &[&str]) {
    for page in pages {
        let text = docs(page);
        assert!(R::TABLES.iter().any(|(name, _)| text.contains(&format!("<!-- generated: {name} -->"))), "{page}");
        let fill: Vec<String> = pages.iter().map(|page| format!("docs/{page}")).collect();
        let again = format!(
            "./cook cost {technique} --from docs/measurements/{folder}/{technique}.json --fill {}",
            fill.join(",")
        );
        assert!(page::fill(&text, report).expect("filled") == text, "{page} is not the record's: {again}");
    }
}

/// The spheres' fits and rules are what this code makes of the recorded walks, and new walks of another seed agree with those.
#[test]
fn the_record_of_spheres_is_what_walks_give() {
    let record: SphereReport = record("measurements/random_walk/sphere.json");
    let again = SphereReport::of(record.walks, record.seed, record.profiles.clone());
    assert_eq!(docs("measurements/random_walk/sphere.txt"), record.text());
    // Another platform's exponential moves the bottom of a flat valley, and hardly what is left there.
    let near = |found: f64, recorded: f64, part: f64| (found - recorded).abs() <= part * recorded.abs() + 1e-5;
    let all = |report: &SphereReport| [&report.rows[..], &report.rows_with_unscattered].concat();
    assert_eq!(all(&again).len(), 2 * record.rows.len());
    for (found, recorded) in all(&again).iter().zip(&all(&record)) {
        let same = |row: &Row| (row.albedo, row.radius, row.form, row.scale_kind);
        assert_eq!(same(found), same(recorded));
        assert!(near(found.residual, recorded.residual, 1e-4), "{found:?} {recorded:?}");
        assert!(
            near(found.sigma, recorded.sigma, 5e-3) && near(found.scale, recorded.scale, 5e-3),
            "{found:?} {recorded:?}"
        );
        let [found_error, recorded_error] = [found, recorded].map(|row| row.sigma_radius_error.unwrap_or_default());
        assert!(near(found_error, recorded_error, 2e-2), "{found:?} {recorded:?}");
    }
    // What the page says of all light, and what it advises.
    let is_for_all = |law: &&Law| law.form == Form::Circular && law.albedo.is_none();
    let law = record.laws_with_unscattered.iter().find(is_for_all).expect("a law");
    assert!(docs("cdrf.md").contains(&format!("σR = {:.2} R^{:.2}", law.factor, law.exponent)), "{law:?}");
    let law = record.laws.iter().find(|law| law.form == Form::Circular && law.albedo.is_none()).expect("a law");
    let [factor, power] = [format!("{:.1}", law.factor), format!("{:.2}", 1.0 - law.exponent)];
    assert!(docs("cdrf.md").contains(&format!("σ = {factor} (κℓ)^{power}")), "{law:?}");
    assert_eq!((again.laws.len(), again.choices.len()), (record.laws.len(), record.choices.len()));
    for (found, recorded) in again.laws.iter().zip(&record.laws) {
        assert_eq!((found.form, found.albedo, found.radii), (recorded.form, recorded.albedo, recorded.radii));
        assert!(near(found.factor, recorded.factor, 5e-3), "{found:?} {recorded:?}");
        assert!(near(found.exponent, recorded.exponent, 5e-3), "{found:?} {recorded:?}");
    }
    for (found, recorded) in again.choices.iter().zip(&record.choices) {
        assert_eq!((found.form, found.albedo, found.radii), (recorded.form, recorded.albedo, recorded.radii));
        assert!(near(found.sigma0, recorded.sigma0, 5e-3), "{found:?} {recorded:?}");
        assert!(near(found.residual, recorded.residual, 1e-4), "{found:?} {recorded:?}");
    }
    for (albedo, radius) in [(0.8, 10.0), (0.99, 3.0)] {
        let walked = random_walk::profile(radius, albedo, 100_000, record.seed ^ 0xabcd);
        let recorded = record.profile(albedo, radius).expect("a sphere");
        let squares = (0..random_walk::BINS).map(|bin| {
            let error = walked.standard_error[bin].hypot(recorded.standard_error[bin]);
            // Where nothing left the sphere there is no error to measure by.
            let apart = walked.exitance[bin] - recorded.exitance[bin];
            if error > 0.0 { (apart / error).powi(2) } else { 0.0 }
        });
        // Chi squared of 36 intervals: 36 in the mean, its deviation 8.5.
        let chi_squared: f64 = squares.sum();
        assert!(chi_squared < 36.0 + 4.0 * 8.5, "albedo {albedo}, radius {radius}: {chi_squared}");
    }
}

#[test]
fn the_reflectance_is_timed_written_and_shown_again() {
    let folder = folder();
    let arguments = ["cost", "cdrf", "--rungs", "lambert,cheap", "--rounds", "1", "--json", "--out", "report"];
    let rows: Value = serde_json::from_str(&succeeds(folder.path(), &arguments).stdout).expect("JSON alone");
    let rows = rows.as_array().expect("an array");
    assert_eq!(rows.len(), 2 * 4 * cdrf::MEASURES.len());
    for row in rows {
        assert!(row["technique"] == "cdrf" && row["adapter"].is_string(), "{row}");
        let number = |row: &Value, of: &str| row[of].as_f64().expect("a number");
        // A clock may be too coarse to see a frame.
        assert!(number(row, "ms") >= 0.0 && number(row, "ms").is_finite(), "{row}");
        // Which of the two is faster in one frame on a busy machine is chance; what the row makes of its time is not.
        let beats = |other: &Value| {
            other["view"] == row["view"]
                && other["error_measure"] == row["error_measure"]
                && number(other, "ms") <= number(row, "ms")
                && number(other, "error") < number(row, "error")
        };
        assert!(row["dominated"] == rows.iter().any(beats), "{row}");
        assert!((row["rung"] == "cheap") == (number(row, "error") < 0.05), "{row}");
    }
    let read = |name: &str| std::fs::read_to_string(folder.path().join("report").join(name)).expect(name);
    let again = succeeds(folder.path(), &["cost", "cdrf", "--from", "report/cdrf.json"]).stdout;
    assert_eq!(again.trim_end(), read("cdrf.txt").trim_end());
    assert!(again.contains("PlayStation 3") && again.contains("+ Lambert"), "{again}");
    assert!(read("cdrf.svg").contains("cheap"));
}

#[test]
fn ways_through_stone_are_compared_written_and_shown_again() {
    let folder = folder();
    let arguments =
        ["cost", "optical_path", "--rungs", "lambert,godunov-16", "--rounds", "1", "--json", "--out", "report"];
    let rows: Value = serde_json::from_str(&succeeds(folder.path(), &arguments).stdout).expect("JSON alone");
    let rows = rows.as_array().expect("an array");
    assert_eq!(rows.len(), 2 * optical_path::VIEWS.len() * optical_path::MEASURES.len());
    let error = |rung: &str, view: &str, measure: &str| {
        let row = rows.iter().find(|row| row["rung"] == rung && row["view"] == view && row["error_measure"] == measure);
        let row = row.unwrap_or_else(|| panic!("{rung} {view} {measure}"));
        let pictured = if measure == "walks" { &optical_path::WALKED[..] } else { &optical_path::COMPARED };
        assert_eq!(row["ms"].is_number(), pictured.contains(&view), "{row}");
        assert!(row["technique"] == "optical_path" && row["adapter"].is_string(), "{row}");
        row["error"].as_f64()
    };
    for view in optical_path::VIEWS {
        for measure in ["nats", "luminance"].into_iter().filter(|_| optical_path::COMPARED.contains(&view)) {
            let [lambert, ways] = ["lambert", "godunov-16"]
                .map(|rung| error(rung, view, measure).expect("a closed form, or a finer grid"));
            // Black counts as a cost, and so costs tell more than luminance does, of which deep places have little.
            let share = if measure == "nats" { 0.2 } else { 1.0 };
            assert!(ways > 0.0 && ways < share * lambert, "{view} {measure}: {ways} {lambert}");
        }
        let walked = lapidary_cook::snapshot::WALKED.iter().any(|reference| reference.scene == view);
        assert_eq!(error("godunov-16", view, "walks").is_some(), walked, "{view}");
    }
    let read = |name: &str| std::fs::read_to_string(folder.path().join("report").join(name)).expect(name);
    let again = succeeds(folder.path(), &["cost", "optical_path", "--from", "report/optical_path.json"]).stdout;
    assert_eq!(again.trim_end(), read("optical_path.txt").trim_end());
    assert!(read("optical_path_error.svg").contains("godunov-16"));
    assert!(read("optical_path_growth.svg").contains("godunov, the solve"));
}

#[test]
fn spheres_are_walked_written_and_shown_again() {
    let folder = folder();
    let page = "before\n<!-- generated: sphere_widths --><!-- end -->\n<!-- generated: ladder -->mine<!-- end -->\n";
    std::fs::write(folder.path().join("page.md"), page).expect("a page");
    let arguments =
        ["cost", "sphere", "--walks", "500", "--seed", "3", "--json", "--out", "report", "--fill", "page.md"];
    let rows: Value = serde_json::from_str(&succeeds(folder.path(), &arguments).stdout).expect("JSON alone");
    let rows = rows.as_array().expect("an array");
    assert_eq!(rows.len(), ALBEDOS.len() * RADII.len() * 6);
    for row in rows {
        for field in ["albedo", "radius", "sigma", "sigma_radius", "scale", "residual"] {
            assert!(row[field].as_f64().is_some_and(|value| value >= 0.0), "{field}: {row}");
        }
        assert!(row["form"].is_string() && row["scale_kind"].is_string(), "{row}");
    }
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).expect(name);
    let text = read("report/sphere.txt");
    let again = succeeds(folder.path(), &["cost", "sphere", "--from", "report/sphere.json"]).stdout;
    assert_eq!(again.trim_end(), text.trim_end());
    for plot in ["report/sphere_sigma.svg", "report/sphere_profile.svg"] {
        assert!(read(plot).ends_with("</svg>\n"), "{plot}");
    }
    let filled = read("page.md");
    assert!(filled.contains("| 0.99 |") && filled.contains("<!-- generated: ladder -->mine<!-- end -->"), "{filled}");
    // The same seed, the same walks.
    let other = succeeds(folder.path(), &["cost", "sphere", "--walks", "500", "--seed", "3"]).stdout;
    assert_eq!(other, again);
}
