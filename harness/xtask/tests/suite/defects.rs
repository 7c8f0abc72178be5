//! The list of planted defects, which `./cook test --defects` runs, fits the files that it names.

use lapidary_assay::dispatch;
use lapidary_cookbook::repository;
use lapidary_xtask::defects::{Defect, LIST, read};
use std::collections::BTreeSet;

/// Fewest defects of the list.
const LEAST: usize = 60;

fn list() -> Vec<Defect> {
    let text = std::fs::read_to_string(repository::place().join(LIST)).expect("the list");
    read(&text).unwrap_or_else(|fault| panic!("{fault}"))
}

#[test]
fn every_defect_can_be_planted() {
    let all = list();
    let mut faults = Vec::new();
    for defect in &all {
        let text = std::fs::read_to_string(repository::place().join(&defect.file));
        let planted = text.map_err(|error| format!("{}: {error}", defect.file)).and_then(|text| defect.planted(&text));
        // What is no WGSL any more would be found by every test of its module.
        let module = defect.file.strip_prefix("wgsl/").filter(|name| !name.contains('/'));
        let fault = |text: String| module.and_then(|name| dispatch::parse(&text, name).err());
        faults.extend(planted.map_or_else(Some, |text| fault(text).map(|error| format!("{}: {error}", defect.file))));
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert!(all.len() >= LEAST, "{} defects", all.len());
    let distinct: BTreeSet<(&str, &str, &str)> =
        all.iter().map(|defect| (&*defect.file, &*defect.old, &*defect.new)).collect();
    assert_eq!(distinct.len(), all.len(), "a defect stands in the list twice");
}

#[test]
fn a_list_is_read_and_what_is_none_is_named() {
    let found = read("# A comment.\n\n[wgsl]\n\na sign\nfile a.wgsl\ntest -p a b\n- x +\n-   y\n+ x -\n+   y\n");
    let expected = Defect {
        number: 1,
        kind: "wgsl".to_owned(),
        what: "a sign".to_owned(),
        file: "a.wgsl".to_owned(),
        test: "-p a b".to_owned(),
        old: "x +\n  y".to_owned(),
        new: "x -\n  y".to_owned(),
    };
    assert_eq!(found, Ok(vec![expected.clone()]));
    assert_eq!(expected.planted("(x +\n  y)"), Ok("(x -\n  y)".to_owned()));
    assert!(expected.planted("x +\n  y, x +\n  y").is_err_and(|fault| fault.contains("2 times")));
    for (text, said) in [
        ("a\nfile b\ntest c\n- d\n+ d\n", ":1: lacks"),
        ("a\nfile b\n- d\n+ e\n", ":1: lacks"),
        ("\na\nfile b\nwhat c\n", ":4: neither"),
    ] {
        assert!(read(text).is_err_and(|fault| fault.contains(said)), "{text}");
    }
}
