//! `cook check --wgsl` on other people's files: it finds and reports their contents, and gives an
//! answer for any file.

use lapidary_assay::dispatch;
use lapidary_assay::literal::{Language, call};
use lapidary_assay::property::Settings;
use lapidary_cook::formulas;
use lapidary_cookbook as cookbook;
use lapidary_testing::program::{Answer, cook, cook_in, folder, succeeds};
use serde_json::Value;
use std::path::Path;

/// Returns `refraction_reflect` with another body.
fn reflection(body: &str) -> String {
    format!("fn refraction_reflect(incident: vec3f, normal: vec3f) -> vec3f {{\n{body}\n}}\n")
}

const RIGHT: &str = "    return incident - 2.0f * dot(normal, incident) * normal;";
const WRONG: &str = "    return incident - 1.9f * dot(normal, incident) * normal;";

/// Checks a text with further arguments.
fn check(text: &str, arguments: &[&str]) -> Answer {
    let folder = folder();
    std::fs::write(folder.path().join("mine.wgsl"), text).expect("a file");
    let cases: &[&str] = if arguments.contains(&"--cases") { &[] } else { &["--cases", "1000"] };
    let all = [&["check", "--wgsl", "mine.wgsl"], cases, arguments].concat();
    cook(folder.path(), &all)
}

fn rows(answer: &Answer) -> Value {
    serde_json::from_str(&answer.stdout).unwrap_or_else(|error| panic!("{error}: {answer:?}"))
}

#[test]
fn a_function_is_found_however_it_is_laid_out() {
    for head in ["fn refraction_reflect\n(", "fn\n  refraction_reflect /* so */ (", "@must_use fn refraction_reflect("]
    {
        let text = reflection(WRONG).replace("fn refraction_reflect(", head);
        let answer = check(&text, &[]);
        assert_eq!(answer.code, Some(1), "{head}: {answer:?}");
        assert!(answer.stdout.contains("FAIL refraction_reflect"), "{head}: {answer:?}");
        assert_eq!(check(&reflection(RIGHT).replace("fn refraction_reflect(", head), &[]).code, Some(0), "{head}");
    }
    // A function in a comment does not count.
    let answer = check(&format!("// {}", reflection(RIGHT).replace('\n', " ")), &[]);
    assert_eq!(answer.code, Some(2), "{answer:?}");
}

#[test]
fn what_the_file_lacks_or_has_besides_is_said() {
    let text = format!(
        "{}fn refraction_radicant(x: f32) -> f32 {{ return x; }}\nfn mine() {{ }}\n@group(0) @binding(0) var<uniform> sun: vec3f;\n\
         @compute @workgroup_size(1) fn main() {{ }}\n",
        reflection(RIGHT)
    );
    let said = [
        "note: mine.wgsl: lacks `refraction_relative_index`, `refraction_radicand`, `refraction_refract`",
        "note: mine.wgsl: `refraction_radicant` is no function of module `refraction`, and is not checked; did you mean `refraction_radicand`?",
        "note: mine.wgsl: bindings sun; entry points main belong to no module, and take no part in the check",
    ];
    for filter in [&[] as &[&str], &["refraction"]] {
        let answer = check(&text, filter);
        assert_eq!(answer.code, Some(0), "{answer:?}");
        for part in said {
            assert!(answer.stdout.contains(part), "{part}: {}", answer.stdout);
        }
        let answer = check(&text, &[filter, &["--json"]].concat());
        assert_eq!(rows(&answer).as_array().map(Vec::len), Some(1));
        assert!(said.iter().all(|part| answer.stderr.contains(part)), "{answer:?}");
    }
    // A single requested function is the only one of interest.
    let one = check(&text, &["refraction::reflect"]);
    assert!(!one.stdout.contains("lacks") && !one.stdout.contains("radicant"), "{one:?}");
}

/// Returns the right function with a loop of `turns` iterations before the result.
fn with_turns(turns: &str) -> String {
    reflection(&format!(
        "    var state = 1u;\n    for (var turn = 0u; turn < {turns}; turn++) {{ state = state * 1664525u + 1013904223u; }}\n\
             if (state == 7u) {{ return vec3f(0.0f); }}\n{RIGHT}"
    ))
}

#[test]
fn a_loop_without_an_end_fails_for_that_reason() {
    if !lapidary_testing::on_lavapipe("the limit is its own") {
        return;
    }
    for body in [
        "    var turn = 0u;\n    loop { turn += 2u; if (turn == 1u) { break; } }\n",
        "    var turn = 0u;\n    while (turn < 4294967295u) { turn += 2u; continue; }\n",
        "    var turn = 0u;\n    loop { continuing { turn += 2u; break if turn == 1u; } }\n",
        "    for (var i = 0u; i < 9u; i++) { var turn = 0u; switch i { default: { loop { turn += 2u; if (turn == 1u) { break; } } } } }\n",
    ] {
        let answer = check(&reflection(&format!("{body}{RIGHT}")), &["--json"]);
        assert_eq!(answer.code, Some(1), "{body}: {answer:?}");
        let rows = rows(&answer);
        assert!(rows[0]["stopped"].as_u64().is_some_and(|stopped| stopped > 0), "{body}: {rows}");
        let reason = rows[0]["reason"].as_str().unwrap_or_default();
        assert!(reason.starts_with("took over 65000 turns of its loops") && reason.contains("endless"), "{reason}");
    }
    // Also in a function that it calls.
    let called = format!(
        "fn turns() -> u32 {{ var turn = 0u; loop {{ turn += 2u; if (turn == 1u) {{ break; }} }} return turn; }}\n{}",
        reflection(&format!("    if (turns() == 0u) {{ return incident; }}\n{RIGHT}"))
    );
    let answer = check(&called, &[]);
    assert!(answer.stdout.contains("took over 65000 turns"), "{answer:?}");
}

#[test]
fn a_right_loop_is_judged_up_to_the_limit_and_named_beyond() {
    if !lapidary_testing::on_lavapipe("the limit is its own") {
        return;
    }
    let within = check(&with_turns("60000u"), &["--cases", "200"]);
    assert_eq!(within.code, Some(0), "{within:?}");
    let beyond = check(&with_turns("70000u"), &["--cases", "200"]);
    assert_eq!(beyond.code, Some(1), "{beyond:?}");
    assert!(beyond.stdout.contains("or one too long to be judged here"), "{beyond:?}");
    assert!(beyond.stdout.contains("lavapipe itself would end them without a word after 65535"), "{beyond:?}");
    // A wrong function within the limit fails because it is wrong.
    let wrong = check(&with_turns("600u").replace("2.0f", "1.9f"), &[]);
    assert!(
        wrong.stdout.contains("inputs fail; the worst: unit length") && !wrong.stdout.contains("turns"),
        "{wrong:?}"
    );
}

/// Checks that a file is refused with one line that contains all of `says`.
fn refused(text: &[u8], says: &[&str]) {
    let folder = folder();
    std::fs::write(folder.path().join("mine.wgsl"), text).expect("a file");
    let answer = cook(folder.path(), &["check", "--wgsl", "mine.wgsl", "--cases", "100"]);
    let start = String::from_utf8_lossy(&text[..text.len().min(200)]);
    assert_eq!(answer.code, Some(2), "{start}: {answer:?}");
    assert!(answer.stderr.starts_with("cook: ") && answer.stdout.is_empty(), "{start}: {answer:?}");
    assert_eq!(answer.stderr.trim_end().lines().count(), 1, "{start}: {answer:?}");
    assert!(!answer.stderr.contains("panicked") && !answer.stderr.contains("lapidary_kernel"), "{start}: {answer:?}");
    for part in says {
        assert!(answer.stderr.contains(part), "`{part}`: {start}: {answer:?}");
    }
}

#[test]
fn texts_that_no_compiler_takes_are_refused() {
    let chain = vec!["incident"; 20_001].join(" + ");
    refused(reflection(&format!("return {chain};")).as_bytes(), &["mine.wgsl:2: over 2000 operators"]);
    let nested = format!("return {}incident{};", "(".repeat(5000), ")".repeat(5000));
    refused(reflection(&nested).as_bytes(), &["mine.wgsl:2: brackets lie over 127 deep"]);
    let blocks = format!("{}{}{RIGHT}", "{".repeat(5000), "}".repeat(5000));
    refused(reflection(&blocks).as_bytes(), &["brackets lie over 127 deep"]);
    refused(&vec![b' '; (1 << 20) + 1], &["larger than 1048576 bytes"]);
    refused(b"fn f() -> \xff\xfe {}", &["not UTF-8 text, from byte 10 on"]);
    for empty in ["", "\n\n", "// nothing\n/* at all */", "\u{feff}", "const A: f32 = 1.0f;"] {
        refused(empty.as_bytes(), &["defines no function of the cookbook"]);
    }
}

#[test]
fn sizes_that_no_device_has_are_refused() {
    let variable = |ty: &str| {
        reflection(&format!(
            "var big: {ty};\nbig[u32(abs(incident.x)) % 7u] = 1.0f;\nif (big[u32(abs(normal.x))] > 2.0f) {{ return normal; }}\n{RIGHT}"
        ))
    };
    refused(
        variable("array<f32, 400000000>").as_bytes(),
        &["`refraction_reflect` needs 1600000000 bytes of variables"],
    );
    refused(variable("array<f32, 20000>").as_bytes(), &["WGSL promises 8192"]);
    // Sizes add up, also through calls.
    let halves = format!(
        "fn half() -> f32 {{ var a: array<f32, 9000>; return a[3]; }}\n{}",
        reflection(&format!("var a: array<f32, 9000>;\nif (half() + a[5] > 1.0f) {{ return normal; }}\n{RIGHT}"))
    );
    refused(halves.as_bytes(), &["needs 72000 bytes"]);
    // Each function calls the previous one twice: inlined, that is more than 10^12 expressions.
    let mut doubling = "fn level0(x: f32) -> f32 { return x * 0.5f; }\n".to_owned();
    for level in 1..40 {
        let below = level - 1;
        doubling.push_str(&format!("fn level{level}(x: f32) -> f32 {{ return level{below}(level{below}(x)); }}\n"));
    }
    doubling.push_str(&reflection("    return vec3f(level39(incident.x));"));
    refused(doubling.as_bytes(), &["over 1000000 expressions once its calls are inlined"]);
    let mut chain = "fn level0(x: f32) -> f32 { return x; }\n".to_owned();
    for level in 1..3000 {
        chain.push_str(&format!("fn level{level}(x: f32) -> f32 {{ return level{}(x); }}\n", level - 1));
    }
    chain.push_str(&reflection("    return vec3f(level2999(incident.x));"));
    refused(chain.as_bytes(), &["calls functions 3001 deep, at most 100"]);
    let mut types = "struct S0 { a: f32 }\n".to_owned();
    for level in 1..40 {
        types.push_str(&format!("struct S{level} {{ a: S{} }}\n", level - 1));
    }
    types.push_str(&reflection(&format!("    var s: S39;\n{RIGHT}")));
    refused(types.as_bytes(), &["`S39`", "over 15 deep"]);
    let argument = "fn refraction_reflect(incident: array<bool, 100000000>, normal: vec3f) -> vec3f { return normal; }";
    refused(argument.as_bytes(), &["takes or returns over 16384 numbers"]);
}

#[test]
fn what_is_no_pure_function_gets_a_sentence_of_its_own() {
    let uses = |declaration: &str, body: &str| format!("{declaration}\n{}", reflection(&format!("{body}\n{RIGHT}")));
    let guard = |name: &str| format!("if ({name} > 2.0f) {{ return normal; }}");
    for (declaration, says) in [
        ("@group(0) @binding(0) var<uniform> x: f32;", "mine.wgsl:1: binding `x`"),
        ("@group(0) @binding(0) var<storage, read_write> x: f32;", "mine.wgsl:1: binding `x`"),
        ("var<private> x: f32;", "mine.wgsl:1: `var<private>` `x`"),
        ("var<workgroup> x: f32;", "mine.wgsl:1: `var<workgroup>` `x`"),
        ("override x: f32 = 1.0f;", "mine.wgsl:1: `override` `x`"),
    ] {
        let text = uses(declaration, &guard("x"));
        refused(text.as_bytes(), &[says, "`refraction_reflect` uses", "a module holds pure functions"]);
    }
    let through =
        uses("@group(0) @binding(0) var<uniform> x: f32;\nfn helper() -> f32 { return x; }", &guard("helper()"));
    refused(through.as_bytes(), &["mine.wgsl:1: binding `x`", "reaches through `helper`"]);
    refused(b"@compute @workgroup_size(1) fn refraction_reflect() { }", &["`refraction_reflect` is an entry point"]);
    let clash = uses("fn arrayLength(a: f32) -> f32 { return a; }", "");
    refused(clash.as_bytes(), &["mine.wgsl:1: declares `arrayLength`"]);
}

#[test]
#[cfg(target_os = "linux")]
fn what_never_ends_is_not_read() {
    let folder = folder();
    for path in ["/dev/zero", "/dev/stdin", "/proc/self/fd/0", "."] {
        let answer = cook(folder.path(), &["check", "--wgsl", path]);
        assert_eq!(answer.code, Some(2), "{answer:?}");
        let says = if path == "." { "it is a folder" } else { "it is not a regular file" };
        assert!(answer.stderr.contains(&format!("cannot be read: {says}")), "{answer:?}");
    }
    for arguments in [["cost", "gem", "--from", "/dev/zero"], ["cost", "effects", "--fill", "/dev/zero"]] {
        let answer = cook(folder.path(), &arguments);
        assert_eq!(answer.code, Some(2), "{answer:?}");
        assert!(answer.stderr.contains("/dev/zero: cannot be read: it is not a regular file"), "{answer:?}");
    }
    let pipe = folder.path().join("pipe.wgsl");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.is_ok_and(|status| status.success()), "mkfifo");
    let answer = cook(folder.path(), &["check", "--wgsl", "pipe.wgsl"]);
    assert!(answer.stderr.contains("not a regular file"), "{answer:?}");
}

#[test]
fn odd_but_valid_files_are_checked() {
    let plain = reflection(RIGHT);
    let many: String = (0..20_000).map(|index| format!("fn other{index}() {{ }}\n")).collect();
    for text in [
        format!("\u{feff}{plain}"),
        plain.replace('\n', "\r\n"),
        format!("diagnostic(off, derivative_uniformity);\n{plain}"),
        format!("{plain}{many}"),
        // Names that the kernel's text also uses, without a special meaning here.
        format!("fn compute() -> f32 {{ return 1.0f; }}\nconst x = 1.0f;\nstruct row {{ result: f32 }}\n{plain}"),
        // Large, but never reached.
        format!("var<private> big: array<f32, 400000000>;\nfn far() -> f32 {{ return big[3]; }}\n{plain}"),
    ] {
        let answer = check(&text, &["--cases", "100"]);
        assert_eq!(answer.code, Some(0), "{}: {answer:?}", &text[..60]);
    }
}

#[test]
fn failing_inputs_go_where_they_are_asked_to_and_never_into_a_users_check() {
    let folder = folder();
    let kept = folder.path().join("kept/refraction_reflect.txt");
    let regressions = Path::new(env!("CARGO_MANIFEST_DIR")).join("regressions");
    let run = |text: &str, more: &[&str]| {
        std::fs::write(folder.path().join("mine.wgsl"), text).expect("a file");
        let arguments = [&["check", "refraction::reflect", "--wgsl", "mine.wgsl", "--cases", "500"], more].concat();
        cook(folder.path(), &arguments)
    };
    // Nothing is written without a request.
    let answer = run(&reflection(WRONG), &[]);
    assert_eq!(answer.code, Some(1), "{answer:?}");
    assert!(!answer.stdout.contains("kept in") && !regressions.exists(), "{answer:?}");
    assert_eq!(std::fs::read_dir(folder.path()).expect("the folder").count(), 1);
    let answer = run(&reflection(WRONG), &["--failures", "kept"]);
    assert!(answer.stdout.contains("the input is kept in kept/refraction_reflect.txt"), "{answer:?}");
    assert!(kept.is_file());
    // The kept words are no input of the domain, and would fail every check that reads them.
    let nan = ["7fc00000"; 6].join(" ");
    std::fs::write(&kept, nan).expect("a file");
    assert_eq!(run(&reflection(RIGHT), &["--failures", "kept"]).code, Some(0));
    // The cookbook's own function is tested with them.
    let outcome = cook(folder.path(), &["check", "refraction::reflect", "--cases", "500", "--failures", "kept"]);
    assert_eq!(outcome.code, Some(1), "{outcome:?}");
    assert!(outcome.stdout.contains("kept in kept/refraction_reflect.txt"), "{outcome:?}");
}

#[test]
fn a_failure_is_shown_as_literals_with_what_is_allowed() {
    if !lapidary_testing::on_lavapipe("the answer names it") {
        return;
    }
    let answer = check(&reflection(WRONG), &[]);
    for part in [
        "FAIL refraction_reflect ",
        "is compared with that of its mirror in",
        "\nFAIL refraction_reflect\n",
        " of 1000 inputs fail; the worst: ",
        "    refraction_reflect(vec3f(",
        "    lapidary_refraction::reflect(Vec3::new(",
        "      = vec3f(",
        "      expected vec3f(",
        "    allowed error: ",
        "0 of 1 functions hold, 1 fail.",
    ] {
        assert!(answer.stdout.contains(part), "{part}: {}", answer.stdout);
    }
    let answer = check(&reflection(WRONG), &["--json"]);
    let rows = rows(&answer);
    let failure = &rows[0]["failure"];
    assert_eq!(rows[0]["passed"], false);
    for key in ["wgsl", "rust", "got", "expected", "mirror", "got_rust", "expected_rust", "mirror_rust"] {
        assert!(failure[key].as_str().is_some_and(|text| text.contains('(')), "{key}: {failure}");
    }
    let field = &failure["fields"][0];
    let numbers =
        |key: &str| -> Vec<f64> { field[key].as_array().into_iter().flatten().filter_map(Value::as_f64).collect() };
    let (got, expected, allowed) = (numbers("got"), numbers("expected"), field["allowed"].as_f64().unwrap_or(1e9));
    assert_eq!((got.len(), expected.len()), (3, 3), "{field}");
    let error = got.iter().zip(&expected).map(|(got, expected)| (got - expected).abs()).fold(0.0, f64::max);
    assert!(allowed > 0.0 && allowed < 1e-5 && error > allowed, "{field}");
    // The literal names the input to the last bit.
    let call = failure["wgsl"].as_str().unwrap_or_default();
    assert!(rows[0]["shrunk_input"].as_str().is_some_and(|input| {
        input.split(['(', ')', ',', ' ']).filter(|word| !word.is_empty()).all(|word| call.contains(word))
    }));
}

#[test]
fn every_call_is_valid_wgsl() {
    for formula in formulas::all() {
        let source = cookbook::module(formula.module).expect("a formula's module").whole;
        for row in 0..20 {
            let arguments = formula.domain.row(Settings::default().seed, row);
            let call = call(Language::Wgsl, formula, &arguments);
            let text = format!("{source}\nfn probe() {{ let value = {call}; }}\n");
            dispatch::parse(&text, "probe").unwrap_or_else(|error| panic!("{call}: {error}"));
        }
    }
}

#[test]
fn hard_cases_and_missed_edges_are_shown() {
    let answer = succeeds(folder().path(), &["check", "refraction::refract", "--cases", "1"]);
    let line = answer.stdout.lines().find(|line| line.starts_with("PASS refraction_refract")).expect("a row");
    let formula = formulas::of_function("refraction_refract").expect("a formula");
    let (cases, edges) = (formula.hard_cases.len(), formula.edges.len());
    assert!(cases > 0 && edges > 1, "a formula with both");
    assert!(line.contains(&format!(" {cases}/{cases} ")), "{line}");
    // One input cannot reach all edges.
    assert!(answer.stdout.contains("edge missed: the inputs never reached "), "{}", answer.stdout);
}

/// Returns the text without the parts that differ from run to run: the adapter, and the seconds at
/// the end of a row.
fn settled(text: &str) -> Vec<String> {
    let line = |line: &str| match line.split_once("shader on ") {
        Some((start, _)) => start.to_owned(),
        None if line.starts_with("PASS ") || line.starts_with("FAIL ") => {
            line.rsplit_once(' ').map_or(line, |(start, _)| start.trim_end()).to_owned()
        }
        None => line.trim_end().to_owned(),
    };
    text.trim().lines().map(line).collect()
}

/// The page's example is the output of the command. `LAPIDARY_REFRESH_PAGES=1` rewrites it.
#[test]
fn the_page_shows_what_the_command_prints() {
    if !lapidary_testing::on_lavapipe("the page shows it") {
        return;
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/check.md");
    let page = std::fs::read_to_string(&path).expect("the page");
    let (before, rest) = page.split_once("<!-- captured: ").expect("a place");
    let (arguments, rest) = rest.split_once(" -->\n").expect("a command");
    let (_, after) = rest.split_once("<!-- end -->").expect("an end");
    let folder = folder();
    std::fs::write(folder.path().join("mine.wgsl"), reflection(WRONG)).expect("a file");
    let answer = cook(folder.path(), &arguments.split(' ').collect::<Vec<_>>());
    assert_eq!(answer.code, Some(1), "{answer:?}");
    let shown = rest[..rest.len() - after.len()].trim_start_matches("```text\n");
    let shown = shown.trim_end_matches("<!-- end -->").trim_end().trim_end_matches("```");
    if settled(shown) == settled(&answer.stdout) {
        return;
    }
    assert!(std::env::var_os("LAPIDARY_REFRESH_PAGES").is_some(), "{}\nis not\n{}", shown, answer.stdout);
    let stdout = answer.stdout.trim_end();
    let page = format!("{before}<!-- captured: {arguments} -->\n```text\n{stdout}\n```\n<!-- end -->{after}");
    std::fs::write(&path, page).expect("the page is written");
}

#[test]
fn colour_is_for_terminals() {
    let folder = folder();
    let arguments = ["check", "refraction::reflect", "--cases", "10"];
    let coloured =
        |environment: &[(&str, &str)]| cook_in(folder.path(), &arguments, environment).stdout.contains('\u{1b}');
    assert!(!coloured(&[]));
    assert!(coloured(&[("CLICOLOR_FORCE", "1")]));
    assert!(!coloured(&[("NO_COLOR", "1")]));
}
