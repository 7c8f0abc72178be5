//! A failure can be reproduced with the printed command, and work can be divided into shards.

use super::json;
use lapidary_assay::property::persistence::Regressions;
use lapidary_assay::property::{Check, Settings};
use lapidary_assay::runner::Runner;
use lapidary_cook::check::{self, Source};
use lapidary_cook::formulas;
use lapidary_cookbook as cookbook;
use lapidary_testing::program::{cook, succeeds};
use std::collections::BTreeSet;
use std::path::Path;

#[test]
fn a_failure_runs_again_with_the_command_that_it_prints() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let source = cookbook::module("refraction").expect("a module").source;
    let changed = source.replacen("2.0f * dot", "1.9f * dot", 1);
    std::fs::write(folder.path().join("mine.wgsl"), &changed).expect("a file");
    let formula = formulas::of_function("refraction_reflect").expect("a formula");
    let settings = Settings { cases: 500, seed: lapidary_testing::seed() };
    let row = check::run(lapidary_testing::gpu(), formula, Source::Copy("mine.wgsl", &changed), settings)
        .expect("the check runs");
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

#[test]
fn inputs_that_were_once_wrong_are_right() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/once_wrong");
    let once_wrong = Regressions::in_folder(&folder);
    let mut wrong = Vec::new();
    let mut inputs = 0;
    for formula in formulas::all() {
        let mut kernel =
            check::kernel(lapidary_testing::gpu(), formula, Source::Cookbook).expect("the cookbook's WGSL compiles");
        let tolerance = check::tolerance(lapidary_testing::gpu(), formula);
        let rows = once_wrong.load(formula.function, kernel.argument_words()).expect("a file of inputs");
        inputs += rows.len();
        let mut check = Check { formula, runner: &mut kernel, tolerance: &tolerance };
        for row in rows {
            let report = check.run(Settings { cases: 0, seed: 0 }, &[row]).expect("the check runs");
            if report.failed > 0 {
                let words: Vec<String> = report.worst.iter().map(|word| format!("{word:08x}")).collect();
                let why = report.reason.unwrap_or_default();
                wrong.push(format!("{} {}: {why}", formula.function, words.join(" ")));
            }
        }
    }
    for file in folder.read_dir().expect("a folder") {
        let name = file.expect("an entry").file_name().into_string().expect("a name");
        let function = name.strip_suffix(".txt").expect("a list of inputs");
        assert!(formulas::of_function(function).is_some(), "{name} is of no function that there is");
    }
    assert!(inputs > 0);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
