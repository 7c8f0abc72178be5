//! Slack: every function keeps its portable bounds on devices that err as far as WGSL allows.

use lapidary_assay::accuracy_line::Accuracy;
use lapidary_assay::property::{DEFAULT_CASES, Settings};
use lapidary_assay::slack::Reassociation;
use lapidary_cook::check::{self, On, Row, Source};
use lapidary_cook::formulas;

fn examined(function: &str, source: Source<'_>, settings: Settings) -> Row {
    let formula = formulas::of_function(function).unwrap_or_else(|| panic!("no function `{function}`"));
    check::run(On::Slack(Reassociation::Written), formula, source, settings).expect("the interpreter runs it")
}

/// Describes the failure and how to reproduce it.
fn described(row: &Row) -> String {
    let Row { function, failed, worst_ratio, reason, worst_choices, reproduce, .. } = row;
    let broken: Vec<&String> =
        row.broken_hard_cases.iter().chain(&row.broken_promises).chain(&row.broken_branches).collect();
    format!(
        "{function}: {failed} failed, {worst_ratio} of its bound, {reason:?}, {worst_choices:?}, {broken:?}; {reproduce}"
    )
}

/// Random inputs of a function: the interpreter takes as long for a quarter as a device for all. `.ci/full` runs more,
/// from more seeds.
fn cases() -> u64 {
    if lapidary_testing::whole() { DEFAULT_CASES } else { DEFAULT_CASES / 4 }
}

#[test]
fn every_function_holds_on_every_device_that_wgsl_allows() {
    let settings = Settings { cases: cases(), seed: lapidary_testing::seed() };
    let mut faults = Vec::new();
    for formula in formulas::promised() {
        let row = examined(formula.function, Source::Cookbook, settings);
        // Reaching the edges is left to the runs on adapters.
        if !row.is_right() {
            faults.push(described(&row));
        }
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

/// WGSL lets a compiler reorder sums of three and more terms, and products. A function whose
/// portable bound needs the written order says so in its `Accuracy:` line, and does fail in another
/// order, from a fixed seed.
#[test]
fn what_reassociation_breaks_is_named() {
    let mut faults = Vec::new();
    for formula in formulas::promised() {
        let accuracy = &check::documentation(formula).accuracy;
        let named = matches!(accuracy, Accuracy::Bounded { order_kept: true, .. });
        let on = On::Slack(Reassociation::Reordered);
        let run = |settings| check::run(on, formula, Source::Cookbook, settings).expect("the interpreter runs it");
        let row = if named {
            // Most of them fail early.
            let few = run(Settings { cases: DEFAULT_CASES / 16, ..Settings::default() });
            if few.is_right() { run(Settings { cases: 4 * DEFAULT_CASES, ..Settings::default() }) } else { few }
        } else {
            run(Settings { cases: cases() / 4, seed: lapidary_testing::seed() })
        };
        if !row.is_right() && !named {
            faults.push(format!("write `order kept` where it stands, or mend it: {}", described(&row)));
        }
        if named && row.is_right() {
            faults.push(format!("{} holds in any order; its line says `order kept`", formula.function));
        }
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

/// Change that the reference device forgives.
struct Forgiven {
    function: &'static str,
    from: &'static str,
    to: &'static str,
}

/// Changes that pass on lavapipe, which rounds to nearest, fuses nothing and keeps NaNs, but fail
/// on another device.
const FORGIVEN: [Forgiven; 4] = [
    // A NaN recognised as unequal to itself.
    Forgiven { function: "cdrf_finite", from: "if magnitude > 0x7f800000u {", to: "if !(value == value) {" },
    // A quotient of equal numbers that must be 1.
    Forgiven {
        function: "fresnel_dielectric",
        from: "return min(0.5f * (s * s + p * p), 1.0f);",
        to: "return 0.5f * (s * s + p * p);",
    },
    // Total reflection recognised by a quotient that must be exact.
    Forgiven { function: "random_walk_boundary", from: "if g == 0.0f || u <", to: "if u <" },
    // The floor of a rounded value, subtracted from a fused one.
    Forgiven { function: "cdrf_texels", from: "max(at - floor(at), vec2f(0.0f))", to: "at - floor(at)" },
];

#[test]
fn what_lavapipe_forgives_is_found() {
    let gpu = lapidary_testing::gpu();
    for Forgiven { function, from, to } in FORGIVEN {
        let formula = formulas::of_function(function).expect("a formula");
        let module = lapidary_cookbook::module(formula.module).expect("its module");
        assert_eq!(module.source.matches(from).count(), 1, "{function}: {from}");
        let changed = module.source.replace(from, to);
        let copy = Source::Copy("mine.wgsl", &changed);
        let settings = Settings { cases: DEFAULT_CASES, ..Settings::default() };
        if gpu.is_lavapipe() {
            let row = check::run(gpu, formula, copy, settings).expect("runs");
            assert!(row.passed(), "lavapipe does not forgive it: {}", described(&row));
        }
        assert!(!examined(function, copy, settings).passed(), "{function}: {to}");
    }
}
