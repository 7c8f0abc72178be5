//! Bad usage and bad input: exit code 2, one clear line that names what is wrong, nothing on stdout.

use crate::studies;
use lapidary_ladders::Report;
use lapidary_testing::program::folder;
use std::path::Path;

/// Arguments, where `{}` stands for a folder of bad files, and what must be said.
const ROWS: &[(&str, &[&str])] = &[
    ("cost skin", &["unrecognized subcommand 'skin'"]),
    ("cost gem --profile --from {}/none.json", &["--profile", "--from"]),
    ("cost gem --from {}/none.json", &["none.json: ", "cannot be read"]),
    ("cost gem --from {}/text.glb", &["text.glb: ", "not a gem.json"]),
    ("studies gem --beside {}/none.json", &["none.json: ", "cannot be read"]),
    ("studies gem --beside {}/empty.json", &["empty.json: ", "not a gem.json"]),
    ("studies gem --beside {}/elsewhere.json", &["elsewhere.json: ", "measured on another device"]),
    ("studies cdrf --profile", &["unexpected argument '--profile'"]),
    ("cost restraint --rungs surface", &["`restraint` has no rung surface", "convex-8"]),
    ("cost restraint --rounds 0", &["`restraint` compares times"]),
    ("cost sphere --rungs proxy-1", &["unexpected argument '--rungs'"]),
    ("cost sphere --views brilliant", &["unexpected argument '--views'"]),
    ("cost sphere --rounds 7", &["unexpected argument '--rounds'"]),
    ("cost sphere --profile", &["unexpected argument '--profile'"]),
    ("cost sphere --walks 0", &["--walks"]),
    ("cost sphere --from {}/none.json", &["none.json: ", "cannot be read"]),
    ("cost sphere --from {}/text.glb", &["text.glb: ", "not a sphere.json"]),
    ("cost sphere --from {}/empty.json --walks 9", &["--walks", "--from"]),
    (
        "cost sphere --from {}/empty.json --fill {}/page.md",
        &["page.md: ", "no fits of a sphere of albedo 0.8 and radius 2"],
    ),
    ("cost sphere --fill {}/none.md", &["none.md: ", "cannot be read"]),
    ("cost sphere --fill {}/bad.md", &["bad.md: ", "no table `other`", "sphere_widths"]),
];

fn write_bad_files(folder: &Path) {
    let write = |name: &str, text: &str| std::fs::write(folder.join(name), text).expect("a file");
    write("text.glb", "solid stone");
    write("page.md", "<!-- generated: sphere_widths --><!-- end -->\n");
    write("bad.md", "<!-- generated: other -->\n<!-- end -->\n");
    write("empty.json", &Report::new("sphere", String::new(), &[]).json().expect("JSON"));
    write("elsewhere.json", &Report::new("gem", "another device".to_owned(), &[]).json().expect("JSON"));
}

#[test]
fn the_studies_refuse_bad_input() {
    let folder = folder();
    write_bad_files(folder.path());
    let before = std::fs::read_dir(folder.path()).expect("a folder").count();
    let place = folder.path().to_str().expect("a path in UTF-8");
    for (arguments, says) in ROWS {
        let words: Vec<String> = arguments.split_whitespace().map(|word| word.replace("{}", place)).collect();
        let answer = studies(folder.path(), &words.iter().map(String::as_str).collect::<Vec<_>>());
        let what = format!("{arguments}: {answer:#?}");
        assert_eq!((answer.code, answer.stdout.as_str()), (Some(2), ""), "{what}");
        assert!(answer.stderr.starts_with("cook: ") && answer.stderr.trim_end().lines().count() == 1, "{what}");
        for part in *says {
            assert!(answer.stderr.contains(part), "`{part}` is not said by {what}");
        }
        assert_eq!(std::fs::read_dir(folder.path()).expect("a folder").count(), before, "{what}");
    }
}
