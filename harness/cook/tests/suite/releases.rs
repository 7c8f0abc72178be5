//! Releases: every module states its release, the tables match the modules, the changelog names the
//! changed functions, and an old copy is recognised however it was pasted.
//!
//! After a change to a module, run `./cook test --refresh`.

use crate::program::{cook, folder, succeeds};
use lapidary_assay::tokens::{items, tokens};
use lapidary_cook::cookbook::release::{self, CURRENT, Change, Hashes, History, Release};
use lapidary_cook::cookbook::{module, modules};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Environment variable; if set, the lines and the table are written instead of compared.
const REFRESH: &str = "LAPIDARY_REFRESH_RELEASE";
const COMMAND: &str = "./cook test --refresh";

fn history() -> &'static History {
    History::of_cookbook()
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../wgsl")
}

/// Returns whether the table is being written. The compiled table is then still the previous one,
/// so it cannot be judged until the next build.
fn is_refreshing() -> bool {
    std::env::var_os(REFRESH).is_some()
}

/// Compares a file with its expected text, or writes it.
fn holds(path: &Path, wanted: &str) {
    let found = std::fs::read_to_string(path).unwrap_or_default();
    if found == wanted {
        return;
    }
    if is_refreshing() {
        std::fs::write(path, wanted).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        return;
    }
    let line = found.lines().zip(wanted.lines()).position(|(found, wanted)| found != wanted).unwrap_or(0);
    let wanted = wanted.lines().nth(line).unwrap_or_default();
    panic!("{}:{}: expected `{wanted}`; refresh it with {COMMAND}", path.display(), line + 1);
}

#[test]
fn every_module_states_its_release_and_the_table_holds_it() {
    let mut hashes = BTreeMap::new();
    // Read the files, which a refresh may just have changed; the compiled modules are the state
    // before.
    for module in modules() {
        let path = root().join(format!("{}.wgsl", module.name));
        let source = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        holds(&path, &release::with_version(&source));
        let naive = std::fs::read_to_string(root().join(format!("naive/{}.wgsl", module.name))).unwrap_or_default();
        let functions = Hashes::of(module.name, &(source.clone() + &naive)).functions;
        hashes.insert(module.name.to_owned(), Hashes { text: release::text_hash(&source), functions });
    }
    let table = Release { release: CURRENT.to_owned(), modules: hashes };
    let table = serde_json::to_string_pretty(&table).expect("plain data") + "\n";
    holds(&root().join(format!("releases/{CURRENT}.json")), &table);
}

#[test]
fn the_tables_are_those_in_the_folder_and_end_with_this_release() {
    let files = std::fs::read_dir(root().join("releases")).expect("the folder");
    let files: BTreeSet<String> =
        files.map(|file| file.expect("a file").file_name().into_string().expect("UTF-8")).collect();
    let tables = history().releases.iter().map(|release| format!("{}.json", release.release));
    assert_eq!(files, tables.collect());
    assert_eq!(history().releases.last().map(|release| release.release.as_str()), Some(CURRENT));
}

/// Returns the functions that differ between two releases, and the new modules.
fn changed(before: &Release, after: &Release) -> BTreeSet<String> {
    let is_new = |module: &&String| !before.modules.contains_key(*module);
    let new: BTreeSet<String> = after.modules.keys().filter(is_new).cloned().collect();
    let of = |release: &Release| -> BTreeMap<String, String> {
        let known = release.modules.iter().filter(|(module, _)| !new.contains(*module));
        known.flat_map(|(_, hashes)| hashes.functions.clone()).collect()
    };
    let (before, after) = (of(before), of(after));
    let names: BTreeSet<&String> = before.keys().chain(after.keys()).collect();
    let functions = names.into_iter().filter(|name| before.get(*name) != after.get(*name)).cloned();
    functions.chain(new.iter().cloned()).collect()
}

#[test]
fn the_changelog_names_every_function_that_changed() {
    if is_refreshing() {
        return;
    }
    for pair in history().releases.windows(2) {
        let named: BTreeSet<&str> = history()
            .changes
            .iter()
            .filter(|change| change.release == pair[1].release)
            .flat_map(|change| change.functions.iter().map(String::as_str))
            .collect();
        let silent: Vec<String> =
            changed(&pair[0], &pair[1]).into_iter().filter(|name| !named.contains(name.as_str())).collect();
        assert!(silent.is_empty(), "CHANGELOG.md, release {}, does not name {silent:?}", pair[1].release);
    }
    // Nor does it name anything that no release has.
    let known: BTreeSet<&str> = history()
        .releases
        .iter()
        .flat_map(|release| &release.modules)
        .flat_map(|(module, hashes)| hashes.functions.keys().chain([module]).map(String::as_str))
        .collect();
    for change in &history().changes {
        assert!(history().releases.iter().any(|release| release.release == change.release), "{change:?}");
        assert!(change.functions.iter().all(|name| known.contains(name.as_str())), "{change:?}");
    }
}

#[test]
fn a_changed_or_new_function_is_noticed() {
    let release = |source: &str| Release {
        release: String::new(),
        modules: [("refraction".to_owned(), Hashes::of("refraction", source))].into(),
    };
    let source = module("refraction").expect("a module").source;
    let none = BTreeSet::new();
    assert_eq!(changed(&release(source), &release(source)), none);
    let other = source.replace("2.0f * dot", "2.1f * dot");
    assert_eq!(changed(&release(source), &release(&other)), ["refraction_reflect".to_owned()].into());
    // A new module is reported by its name.
    let nothing = Release { release: String::new(), modules: BTreeMap::new() };
    assert_eq!(changed(&nothing, &release(source)), ["refraction".to_owned()].into());
    // A changed struct counts for each function that uses it; a changed comment does not count.
    let struct_changed = source.replace("    total: bool,", "    is_total: bool,");
    assert!(changed(&release(source), &release(&struct_changed)).contains("refraction_refract"));
    assert_eq!(changed(&release(source), &release(&source.replace("// ", "// so "))), none);
}

#[test]
fn the_hash_of_a_text_is_stable() {
    // FNV-1a's published value for an empty input.
    assert_eq!(release::text_hash(""), "cbf29ce484222325");
    let text = "// a: b.\n// SPDX-License-Identifier: x\nfn a() {}\n";
    let stated = release::with_version(text);
    assert_eq!(release::with_version(&stated), stated);
    assert_eq!(release::text_hash(&stated.replace('\n', "\r\n")), release::text_hash(text));
    assert_eq!(release::stated(&stated), Some((CURRENT, release::text_hash(text).as_str())));
    assert!(stated.lines().nth(2).is_some_and(|line| line.starts_with("// Version: ")), "{stated}");
}

#[test]
fn changelog_entries_are_read_with_their_functions() {
    let text = "# C\n\n## 0.2.0 (unreleased)\n\n- `a_b`, `c`: mended: so\n  and so.\n- Not one.\n  At all.\n\n## 0.1.0, then\n\n- `a_b`: new.\n";
    let change = |release: &str, functions: &[&str], text: &str| Change {
        release: release.to_owned(),
        functions: functions.iter().map(|name| (*name).to_owned()).collect(),
        text: text.to_owned(),
    };
    let wanted = [change("0.2.0", &["a_b", "c"], "mended: so and so."), change("0.1.0", &["a_b"], "new.")];
    assert_eq!(release::parse_changes(text), wanted);
}

/// `refraction_reflect` of release 0.1.0, reformatted by someone else and pasted into a larger
/// file.
const OLD_REFLECTION: &str = "\
@group(0) @binding(0) var<uniform> normal: vec3f;

fn brightness(incident: vec3f) -> f32 { return dot(incident, normal); }

/* from a cookbook */
fn refraction_reflect(
  incident : vec3f, normal : vec3f
) -> vec3f
{
  return incident - 2.0f*dot(normal,incident)*normal; // 2 (n . r) n
}
";

/// `proxy_geometry_face_normal` of release 0.1.0.
const OLD_FACE_NORMAL: &str = "\
fn proxy_geometry_face_normal(position_first: vec3f, position_second: vec3f, position_third: vec3f) -> vec3f {
    let edge_first = position_second - position_first;
    let edge_second = position_third - position_first;
    let size_first = max(max(abs(edge_first.x), abs(edge_first.y)), abs(edge_first.z));
    let size_second = max(max(abs(edge_second.x), abs(edge_second.y)), abs(edge_second.z));
    if (min(size_first, size_second) == 0.0f) {
        return vec3f(0.0f);
    }
    let first = edge_first / size_first;
    let second = edge_second / size_second;
    let apart = select(second - first, second + first, dot(first, second) < 0.0f);
    let perpendicular = cross(first, apart);
    let squared = dot(perpendicular, perpendicular);
    if (squared == 0.0f) {
        return vec3f(0.0f);
    }
    return perpendicular / sqrt(squared);
}
";

#[test]
fn an_old_copy_is_told_what_was_mended_since_and_fails() {
    let folder = folder();
    std::fs::write(folder.path().join("engine.wgsl"), OLD_FACE_NORMAL).expect("a file");
    let answer = cook(folder.path(), &["check", "proxy_geometry::face_normal", "--wgsl", "engine.wgsl"]);
    assert_eq!(answer.code, Some(1), "{answer:?}");
    for said in
        ["of release 0.1.0", "mended since: `proxy_geometry_face_normal` (0.2.0", "crosses the two shortest edges"]
    {
        assert!(answer.stdout.contains(said), "{said}: {answer:?}");
    }
}

#[test]
fn an_old_copy_is_recognised_in_whatever_file_it_is() {
    let found = Hashes::of("refraction", OLD_REFLECTION);
    let old = &history().releases[0];
    assert_eq!(old.release, "0.1.0");
    assert_eq!(
        found.functions["refraction_reflect"], old.modules["refraction"].functions["refraction_reflect"],
        "what release 0.1.0 had"
    );
    let standing = history().standing("refraction", &["refraction_reflect"], OLD_REFLECTION);
    let folder = folder();
    std::fs::write(folder.path().join("engine.wgsl"), OLD_REFLECTION).expect("a file");
    let arguments = ["check", "refraction::reflect", "--wgsl", "engine.wgsl", "--cases", "1000"];
    let answer = cook(folder.path(), &arguments);
    assert!(standing.describe().lines().all(|line| answer.stdout.contains(&format!("note: {line}\n"))), "{answer:?}");
    let answer = cook(folder.path(), &[arguments.as_slice(), &["--json"]].concat());
    let rows: serde_json::Value = serde_json::from_str(&answer.stdout).expect("JSON");
    let origin = &standing.origins[0];
    assert!(origin.release.is_some() && rows[0]["release"].as_str() == origin.release.as_deref(), "{rows}");
    assert_eq!(rows[0]["changed_since"].as_array().map(Vec::len), Some(origin.changes.len()), "{rows}");
    assert!(answer.stderr.contains("cook: note: this is refraction of release "), "{answer:?}");
}

/// The text of this function was right, but its promise was wrong. A user with an old copy is told;
/// a user with a current copy is not.
#[test]
fn a_promise_that_changed_is_told_to_an_old_copy_of_the_same_text() {
    let told = history().standing("refraction", &["refraction_reflect"], OLD_REFLECTION).describe();
    let wanted = "of the same text since 0.1.0, while what it promises or calls was changed: `refraction_reflect` (0.2.0: promises 9 ulp";
    assert!(told.contains(wanted), "{told}");
    let source = module("refraction").expect("a module").source;
    let told = history().standing("refraction", &["refraction_reflect"], source).describe();
    assert_eq!(told, format!("this is refraction of release {CURRENT}, the cookbook's own"));
}

#[test]
fn what_was_mended_since_is_said() {
    let source = |doubled: &str, halved: &str| {
        format!(
            "const SAMPLE_HALF: f32 = 0.5f;\nfn sample_doubled(x: f32) -> f32 {{ return {doubled}; }}\n\
             fn sample_halved(x: f32) -> f32 {{ return {halved}; }}\nfn sample_same(x: f32) -> f32 {{ return x; }}\n"
        )
    };
    let release = |name: &str, source: &str| Release {
        release: name.to_owned(),
        modules: [("sample".to_owned(), Hashes::of("sample", source))].into(),
    };
    let old = source("x + x", "SAMPLE_HALF * x");
    let middle = source("2.0f * x", "SAMPLE_HALF * x");
    let new = source("2.0f * x", "x * SAMPLE_HALF");
    let changelog = "## 0.3.0\n- `sample_halved`: turned round.\n## 0.2.0\n- `sample_doubled`: mended\n  at last.\n";
    let history = History {
        releases: vec![release("0.1.0", &old), release("0.2.0", &middle), release("0.3.0", &new)],
        changes: release::parse_changes(changelog),
    };
    let names = ["sample_doubled", "sample_halved", "sample_same"];
    let says = |text: &str| history.standing("sample", &names, text).describe();
    assert_eq!(says(&new), "this is sample of release 0.3.0, the cookbook's own");
    let halved = "\n  mended since: `sample_halved` (0.3.0: turned round.)";
    assert_eq!(
        says(&old),
        format!(
            "this is sample of release 0.1.0; the cookbook's is 0.3.0\n  mended since: `sample_doubled` (0.2.0: mended at last.){halved}"
        )
    );
    assert_eq!(says(&middle), format!("this is sample of release 0.2.0; the cookbook's is 0.3.0{halved}"));
    // A changed const counts for the functions that use it.
    let changed = new.replace("0.5f", "0.6f");
    assert_eq!(
        says(&changed),
        "this is sample of release 0.3.0 with changes\n  changed from every release: `sample_halved`"
    );
    assert_eq!(
        says("fn sample_same(x: f32) -> f32 { return -x; }"),
        "this is a changed sample: no release has these functions"
    );
}

#[test]
fn a_current_copy_is_told_and_a_changed_one() {
    let folder = folder();
    let check = |text: &str| {
        std::fs::write(folder.path().join("mine.wgsl"), text).expect("a file");
        let arguments = ["check", "refraction::relative_index", "--wgsl", "mine.wgsl", "--cases", "100"];
        succeeds(folder.path(), &arguments).stdout
    };
    let source = module("refraction").expect("a module").source;
    let current = check(source);
    assert!(current.contains(&format!("this is refraction of release {CURRENT}, the cookbook's own")), "{current}");
    let quotient = "return index_transmitted / index_incident;";
    assert!(source.contains(quotient));
    let own =
        check(&source.replace(quotient, "let quotient = index_transmitted / index_incident;\n    return quotient;"));
    assert!(own.contains("this is a changed refraction: no release has these functions"), "{own}");
    assert!(own.contains(&format!("its header says {CURRENT}: it was changed after it was copied")), "{own}");
}

#[test]
fn every_function_of_a_module_is_in_its_table() {
    if is_refreshing() {
        return;
    }
    let current = history().releases.last().expect("a release");
    for module in modules() {
        let code = tokens(module.whole);
        let functions: BTreeSet<&str> =
            items(&code).iter().filter(|item| item.kind == "fn").map(|item| item.name).collect();
        let documented: BTreeSet<&str> = module.functions.iter().map(|function| function.name.as_str()).collect();
        assert_eq!(functions, documented, "{}", module.name);
        let table: BTreeSet<&str> = current.modules[module.name].functions.keys().map(String::as_str).collect();
        assert_eq!(table, documented, "{}", module.name);
    }
}
