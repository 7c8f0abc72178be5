//! A failure can be run again from what is printed, and work can be shared out.

use crate::program::{cook, succeeds};
use lapidary_harness::check::{self, Source};
use lapidary_harness::cookbook;
use lapidary_harness::formulas;
use lapidary_harness::property::Settings;
use serde_json::Value;
use std::collections::BTreeSet;

fn json(text: &str) -> Vec<Value> {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

#[test]
fn a_failure_runs_again_with_the_command_that_it_prints() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let source = cookbook::module("refraction").expect("a module").source;
    let changed = source.replacen("2.0f * dot", "1.9f * dot", 1);
    std::fs::write(folder.path().join("mine.wgsl"), &changed).expect("a file");
    let formula = formulas::of_function("refraction_reflect").expect("a formula");
    let settings = Settings { cases: 500, seed: crate::seed() };
    let row = check::run(crate::gpu(), formula, Source::Copy("mine.wgsl", &changed), settings).expect("the check runs");
    assert!(!row.passed());
    let mut words = row.reproduce.split_whitespace();
    assert_eq!(words.next(), Some("./cook"));
    let again = cook(folder.path(), &words.chain(["--json"]).collect::<Vec<_>>());
    assert_eq!(again.code, Some(1), "{again:?}");
    let rows = json(&again.stdout);
    assert_eq!(rows[0]["worst_input"], row.worst_input.as_str(), "{}", row.reproduce);
    let said = cook(folder.path(), &row.reproduce.split_whitespace().skip(1).collect::<Vec<_>>());
    assert!(said.stdout.contains(&row.reproduce), "{said:?}");
}

#[test]
fn shards_share_the_functions_between_them() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let functions = |shard: &str| -> Vec<String> {
        let arguments = ["check", "refraction", "--cases", "100", "--json", "--shard", shard];
        let rows = json(&succeeds(folder.path(), &arguments).stdout);
        rows.iter().map(|row| row["function"].as_str().expect("a name").to_owned()).collect()
    };
    let all = functions("1/1");
    let parts = ["1/3", "2/3", "3/3"].map(functions);
    assert_eq!(parts.iter().map(Vec::len).sum::<usize>(), all.len());
    assert_eq!(parts.concat().into_iter().collect::<BTreeSet<_>>(), all.into_iter().collect());
    for wrong in ["0/3", "4/3", "3", "1/0", "a/b"] {
        let answer = cook(folder.path(), &["check", "refraction", "--shard", wrong]);
        assert_eq!(answer.code, Some(2), "{wrong}: {answer:?}");
    }
}
