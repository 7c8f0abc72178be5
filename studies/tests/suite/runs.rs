//! Runs of the studies. Nothing timed is asserted.

use crate::succeeds;
use lapidary_ladders::cdrf::sphere_fit::ScaleKind;
use lapidary_ladders::cdrf::spheres::view;
use lapidary_ladders::{Report, Row};
use lapidary_studies::sphere::{self, ALBEDOS, RADII};
use lapidary_testing::program::folder;

/// Returns a report printed as JSON.
fn printed(study: &str, json: &str) -> Report {
    Report::from_json(study, json).unwrap_or_else(|error| panic!("{error}"))
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
    let report = printed("restraint", &report);
    let scenes: Vec<&Row> = report.rows.iter().filter(|row| row.rung == "proxy-8").collect();
    assert_eq!(scenes.len(), 3);
    for Row { view, value, .. } in scenes {
        let limited = |measure: &str| report.value("proxy-8, limited", view, measure).expect("measured");
        assert!(Some(limited("facets")) < *value && (0.0..=1.0).contains(&limited("share of the bound")), "{view}");
    }
    let ways = report.rungs("updates");
    assert_eq!(ways.len(), 3 * 3);
    for ways in ways.chunks(3) {
        let value_of = |way: usize, measure: &str| report.value(ways[way], "bunny", measure).expect("measured");
        assert!((0.05..0.95).contains(&value_of(0, "with matter")), "{ways:?}");
        assert!((0..3).all(|way| value_of(way, "differing") == 0.0 && value_of(way, "passes") > 2.0), "{ways:?}");
        let [one, other, all] = [0, 1, 2].map(|way| value_of(way, "updates"));
        assert!(one < all / 2.0 && other < all / 2.0, "{ways:?}: {one} {other} {all}");
    }
}

#[test]
fn spheres_are_walked_written_and_shown_again() {
    let folder = folder();
    let page = "before\n<!-- generated: sphere_widths --><!-- end -->\n<!-- generated: ladder -->mine<!-- end -->\n";
    std::fs::write(folder.path().join("page.md"), page).expect("a page");
    let arguments =
        ["cost", "sphere", "--walks", "500", "--seed", "3", "--json", "--out", "report", "--fill", "page.md"];
    let report = printed("sphere", &succeeds(folder.path(), &arguments).stdout);
    for (albedo, radius) in ALBEDOS.into_iter().flat_map(|albedo| RADII.map(|radius| (albedo, radius))) {
        for (form, kind) in sphere::FORMS.into_iter().flat_map(|form| ScaleKind::ALL.map(|kind| (form, kind))) {
            for measure in ["sigma", "sigma R", "scale", "residual"] {
                let value = report.value(&sphere::rung(form, kind), &view(albedo, radius), measure);
                assert!(value.is_some_and(|value| value >= 0.0), "{form:?} {kind:?} {albedo} {radius} {measure}");
            }
        }
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
    assert_eq!(text, sphere::LADDER.text(&report));
    // The same seed, the same walks.
    let other = succeeds(folder.path(), &["cost", "sphere", "--walks", "500", "--seed", "3"]).stdout;
    assert_eq!(other, again);
}
