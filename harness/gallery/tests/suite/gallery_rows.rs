//! The rows of "Edit a function and check it": the gallery's own script runs and judges them in
//! Chromium, where the cookbook's functions hold and functions with a planted error do not.

use crate::gallery_pages::browser::started;
use lapidary_browser::Page;
use lapidary_cook::check;
use lapidary_cookbook::{self as cookbook, Module};
use lapidary_gallery::rows;
use serde_json::Value;
use std::path::Path;
use tempfile::TempDir;

/// Modules that every run checks: flags beside floats, many branches, whole numbers alone.
const ALWAYS: [&str; 3] = ["refraction", "srgb", "voxelization"];
/// Unless the suite is run whole, one other module in this many is checked.
const ONE_IN: u64 = 24;
/// Most bytes of all rows in the site.
const MOST_BYTES: usize = 9_000_000;

/// Errors planted in functions: the text, and what takes its place.
const PLANTED: [(&str, &str, &str); 6] = [
    ("refraction_reflect", "- 2.0f *", "- 2.00002f *"),
    ("refraction_radicand", "- 1.0f", "- 1.00001f"),
    ("srgb_luminance", "0.7152f", "0.7153f"),
    ("srgb_encode", "1.055f", "1.0551f"),
    ("voxelization_prefix", "<<", ">>"),
    ("voxelization_taxicab", "+", "-"),
];

/// Of the site's script, what the check asks for.
const SITE: &str = "
    window.gallery = {
      waiting: new Map(),
      deliver: (name, value) => gallery.waiting.get(name)(value),
      load: (name) => new Promise((resolve, reject) => {
        gallery.waiting.set(name, resolve);
        const script = document.createElement('script');
        script.src = `data/${name}.js`;
        script.onerror = () => reject(new Error(name));
        document.head.append(script);
      }),
    };";

/// A page with nothing but the script, and the rows of some modules.
fn page(modules: &[&str]) -> Option<(TempDir, Page)> {
    let mut page = started()?;
    let folder = tempfile::tempdir().expect("a folder");
    let summary = rows::write_of(folder.path(), |module| modules.contains(&module.name)).expect("written");
    assert!(summary.functions > 0 && summary.rows >= summary.functions * rows::DRAWN as usize, "{summary:?}");
    let assets = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/assets");
    std::fs::copy(assets.join("check.js"), folder.path().join("check.js")).expect("copied");
    let scripts = format!("<script>{SITE}</script>\n<script src=\"check.js\"></script>");
    let html = format!("<!DOCTYPE html>\n<html>\n<title>Rows</title>\n{scripts}\n</html>\n");
    let index = folder.path().join("index.html");
    std::fs::write(&index, html).expect("written");
    page.open(&format!("file://{}", index.display())).expect("opened");
    Some((folder, page))
}

/// Checks a text's function in the page: rows, those that hold, and all of the answer.
fn checked(page: &mut Page, function: &str, text: &str) -> (u64, u64, Value) {
    let call = format!("gallery.check({}, {})", Value::from(function), Value::from(text));
    let found = page.evaluate(&call).unwrap_or_else(|error| panic!("{function}: {error}"));
    let count = |name: &str| found[name].as_u64().unwrap_or_else(|| panic!("{function}: {found}"));
    (count("rows"), count("held"), found)
}

fn module(name: &str) -> &'static Module {
    cookbook::module(name).expect("a module")
}

#[test]
fn the_cookbooks_functions_hold_in_the_page() {
    let others = cookbook::modules().iter().map(|module| module.name).filter(|name| !ALWAYS.contains(name));
    let modules: Vec<&str> = ALWAYS.into_iter().chain(lapidary_testing::sampled(others, ONE_IN)).collect();
    let Some((_folder, mut page)) = page(&modules) else { return };
    let mut faults = Vec::new();
    for name in modules {
        for formula in check::select(Some(name)).expect("a module") {
            let (rows, held, found) = checked(&mut page, formula.function, module(name).source);
            if held < rows {
                faults.push(format!("{}: {held} of {rows} hold: {found}", formula.function));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert_eq!(page.problems().expect("a list"), [] as [String; 0]);
}

#[test]
fn a_planted_error_does_not_hold_in_the_page() {
    let Some((_folder, mut page)) = page(&ALWAYS) else { return };
    for (function, from, to) in PLANTED {
        let name = ALWAYS.iter().find(|name| function.starts_with(*name)).expect("its module");
        let source = module(name).source;
        let start = source.find(&format!("fn {function}(")).expect("the function");
        let (before, body) = source.split_at(start);
        let (body, after) = body.split_at(body.find("\n}").expect("its end"));
        assert!(body.contains(from), "{function} has no `{from}`");
        let changed = [before, &body.replacen(from, to, 1), after].concat();
        let (rows, held, found) = checked(&mut page, function, &changed);
        assert!(held < rows - rows / 16, "{function} with `{to}`: {held} of {rows} hold");
        assert_eq!(found["worst"]["holds"], false, "{found}");
        assert!(found["worst"]["ratio"].as_f64().is_none_or(|ratio| ratio > 1.0), "{found}");
    }
}

/// A text that does not compile is answered with the compiler's messages, at the text's lines.
#[test]
fn an_error_is_told_at_its_line() {
    let Some((_folder, mut page)) = page(&["refraction"]) else { return };
    let source = module("refraction").source;
    let (rows, held, found) = checked(&mut page, "refraction_reflect", &source.replace("-> vec3f", "-> vec3q"));
    assert_eq!(held, 0, "of {rows}");
    let wrong = source.lines().position(|line| line.contains("-> vec3f")).expect("a line") + 1;
    let first = &found["messages"][0];
    assert_eq!((&first["type"], &first["line"]), (&"error".into(), &wrong.into()), "{found}");
    assert!(first["text"].as_str().is_some_and(|text| text.contains("vec3q")), "{found}");
    // An error in the call that is appended has no line of the text.
    let (_, _, found) = checked(&mut page, "refraction_reflect", "");
    assert!(found["messages"][0]["line"].is_null() && found["worst"].is_null(), "{found}");
}

/// A device that is lost between two checks is replaced.
#[test]
fn a_lost_device_is_replaced() {
    let Some((_folder, mut page)) = page(&["refraction"]) else { return };
    let source = module("refraction").source;
    page.run(
        "const { requestDevice } = GPUAdapter.prototype;
        window.devices = [];
        GPUAdapter.prototype.requestDevice = async function (...values) {
          window.devices.push(await requestDevice.apply(this, values));
          return window.devices.at(-1);
        };",
    )
    .expect("kept");
    for (losses, lose) in ["", "window.devices.at(-1).destroy();"].into_iter().enumerate() {
        page.run(lose).expect("lost");
        let (rows, held, _) = checked(&mut page, "refraction_reflect", source);
        assert_eq!(held, rows);
        assert_eq!(page.evaluate("window.devices.length").expect("a number"), losses + 1);
    }
    // During a check: the first try fails, the second holds.
    let during = format!(
        "const checking = gallery.check('refraction_reflect', {});
        const submit = GPUQueue.prototype.submit;
        GPUQueue.prototype.submit = function (...values) {{
          GPUQueue.prototype.submit = submit;
          window.devices.at(-1).destroy();
          return submit.apply(this, values);
        }};
        const {{ rows, held }} = await checking;
        return [held === rows, window.devices.length];",
        Value::from(source)
    );
    assert_eq!(page.run(&during).expect("an answer"), serde_json::json!([true, 3]));
}

/// Computes the rows of every function, which takes half a minute.
#[test]
fn all_rows_are_small_enough() {
    if !lapidary_testing::whole() {
        eprintln!("gallery_rows: all_rows_are_small_enough: with LAPIDARY_WHOLE=1");
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let started = std::time::Instant::now();
    let summary = rows::write(folder.path()).expect("written");
    println!("{summary:?} in {:.1?}", started.elapsed());
    assert!(summary.bytes <= MOST_BYTES, "{summary:?}");
}
