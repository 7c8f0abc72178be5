//! Long checks by the real binary: in parts, on several machines, ended and resumed; and a machine
//! without a browser.

use crate::program::{cook, cook_in, folder, succeeds};

const LONG: [&str; 4] = ["check", "refraction::relative_index", "--cases", "3000000"];

fn with<'a>(more: &[&'a str]) -> Vec<&'a str> {
    LONG.into_iter().chain(more.iter().copied()).collect()
}

fn cases(json: &str) -> u64 {
    let rows: serde_json::Value = serde_json::from_str(json).expect("JSON");
    assert_eq!(rows.as_array().map(Vec::len), Some(1), "{json}");
    rows[0]["cases"].as_u64().expect("a number")
}

#[test]
fn shards_become_one_and_a_run_goes_on_where_it_ended() {
    let folder = folder();
    let shard = |number: &str| {
        let file = format!("{}.json", &number[..1]);
        succeeds(folder.path(), &with(&["--record", &file, "--shard", number]));
        file
    };
    let [one, two] = ["1/2", "2/2"].map(shard);
    // Three parts of 2^20 cases: two in one shard and one in the other.
    let merged = succeeds(folder.path(), &["check", "--merge", &one, &two, "--record", "all.json", "--json"]);
    assert_eq!(cases(&merged.stdout), 3 << 20);
    let short = cook(folder.path(), &["check", "--merge", &one]);
    assert_eq!(short.code, Some(2), "{short:?}");
    assert!(short.stderr.contains("2 of 3 parts are done"), "{}", short.stderr);
    // The parts of one shard are not repeated: only the missing part runs, and the row counts all.
    std::fs::copy(folder.path().join(&one), folder.path().join("half.json")).expect("copied");
    let gone_on = succeeds(folder.path(), &with(&["--record", "half.json", "--json"]));
    assert_eq!(cases(&gone_on.stdout), 3 << 20);
    let quick = |file: &str| {
        serde_json::from_str::<serde_json::Value>(&std::fs::read_to_string(folder.path().join(file)).expect(file))
            .expect("JSON")
    };
    assert_eq!(quick("half.json")["rows"][0]["max_ulp"], quick("all.json")["rows"][0]["max_ulp"]);
    for (arguments, word) in [
        (with(&["--record", &one, "--seed", "1", "--portable"]), "another device"),
        (vec!["check", "refraction", "--cases", "3000000", "--record", &one], "parts"),
        (vec!["check", "--merge", &one, &one], "another holds as well"),
        (vec!["check", "--merge", "none.json"], "cannot be read"),
    ] {
        let answer = cook(folder.path(), &arguments);
        assert_eq!((answer.code, answer.stderr.contains(word)), (Some(2), true), "{arguments:?}: {}", answer.stderr);
    }
}

#[test]
fn without_a_browser_functions_are_skipped_and_counted() {
    let folder = folder();
    let none = folder.path().to_string_lossy().into_owned();
    let check = ["check", "refraction", "--browser"];
    let skipped = cook_in(folder.path(), &check, &[("PATH", &none), ("LAPIDARY_CHROMIUM", "")]);
    assert_eq!((skipped.code, skipped.stdout.as_str()), (Some(0), ""), "{skipped:?}");
    assert!(skipped.stderr.contains("4 functions skipped: no Chromium or Chrome is on the PATH"), "{}", skipped.stderr);
    let required = cook_in(folder.path(), &check, &[("PATH", &none), ("LAPIDARY_CHROMIUM", "required")]);
    assert_eq!(required.code, Some(2), "{required:?}");
}
