//! Continuity: both sides of every branch of every function, one ulp apart.

use lapidary_harness::check::{self, Source};
use lapidary_harness::cookbook;
use lapidary_harness::dispatch::Kernel;
use lapidary_harness::dispatch::shape::{Scalar, Shape};
use lapidary_harness::formula::Formula;
use lapidary_harness::formulas;
use lapidary_harness::interpreter::{Nearest, Program};
use lapidary_harness::property::Settings;
use lapidary_harness::property::seams::{self, Seam};
use lapidary_harness::property::tolerance::number;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::OnceLock;

fn program(formula: &Formula) -> Program {
    let module = cookbook::module(formula.module).expect("a formula's module");
    Program::new(module.source, formula.module, formula.function).expect("the cookbook's WGSL is valid")
}

fn promised() -> impl Iterator<Item = &'static Formula> {
    formulas::all().iter().filter(|formula| formula.benign.is_none())
}

/// The seams of a promised function of the cookbook, found once for all tests.
fn seams_of(function: &str) -> &'static [Seam] {
    static SEAMS: OnceLock<BTreeMap<&'static str, Vec<Seam>>> = OnceLock::new();
    let all =
        SEAMS.get_or_init(|| promised().map(|formula| (formula.function, seams(&program(formula), formula))).collect());
    &all[function]
}

/// From enough seeds that no branch is missed by chance.
fn seams(program: &Program, formula: &Formula) -> Vec<Seam> {
    (0..2).flat_map(|seed| seams::find(program, formula, seed).expect("the interpreter runs it")).collect()
}

/// The interpreter is a device: it is held to the bounds of the reference device.
#[test]
#[ignore = "not yet run to its end over all functions"]
fn the_interpreter_computes_what_the_shaders_do() {
    let gpu = super::gpu();
    let mut faults = Vec::new();
    for formula in promised() {
        let (program, tolerance) = (program(formula), check::tolerance(gpu, formula));
        let scalars: Vec<Scalar> = formula.arguments.iter().flat_map(Shape::scalars).collect();
        for row in 0..200 {
            let arguments = formula.domain.row(Settings::default().seed, row);
            let (mut result, mut mirrored, mut exact) = (Vec::new(), Vec::new(), Vec::new());
            if let Err(stopped) = program.run(&arguments, &mut Nearest, &mut result) {
                faults.push(format!("{}: {stopped}", formula.function));
                break;
            }
            (formula.mirror)(&arguments, &mut mirrored);
            let numbers: Vec<f64> = arguments.iter().zip(&scalars).map(|(w, s)| number(*s, *w)).collect();
            (formula.oracle)(&numbers, &mut exact);
            let verdict = tolerance.judge(&arguments, &result, &mirrored, &exact, &*formula.oracle);
            if !verdict.holds() {
                faults.push(format!("{}: {verdict:?} at {}", formula.function, check::spell(formula, &arguments)));
                break;
            }
        }
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

#[test]
#[ignore = "not yet run to its end over all functions: see tests/branches.txt"]
fn both_sides_of_every_branch_are_within_their_bounds_of_each_other() {
    let gpu = super::gpu();
    let mut faults = Vec::new();
    for formula in promised() {
        let (program, tolerance) = (program(formula), check::tolerance(gpu, formula));
        let mut kernel = check::kernel(gpu, formula, Source::Cookbook).expect("the cookbook's WGSL compiles");
        let seams = seams_of(formula.function);
        let found = seams::faults(&program, formula, &mut kernel, &tolerance, seams).expect("runs");
        faults.extend(found.iter().take(3).map(|fault| format!("{}: {fault}", formula.function)));
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

/// What stands in the place of a condition where it is the mathematics that jumps.
const JUMPS: &str = "jumps";

/// The lines of `tests/branches.txt`: function and condition, each with a reason.
fn exceptions() -> BTreeMap<(String, String), String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/branches.txt");
    let text = std::fs::read_to_string(&path).expect("tests/branches.txt");
    let lines = text.lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
    let parts = |line: &str| -> Option<((String, String), String)> {
        let (function, rest) = line.split_once(": ")?;
        let (condition, why) = rest.rsplit_once(" # ")?;
        Some(((function.to_owned(), condition.to_owned()), why.to_owned()))
    };
    lines.map(|line| parts(line).unwrap_or_else(|| panic!("no `function: condition # reason`: {line}"))).collect()
}

/// A branch that compares floats is straddled, and the mathematics goes on there, or `tests/branches.txt` says why not. A line that is no longer true is
/// a fault too.
#[test]
#[ignore = "tests/branches.txt is not filled yet; this test prints its lines"]
fn every_branch_is_straddled_and_continuous_or_says_why_not() {
    let gpu = super::gpu();
    let exceptions = exceptions();
    let (mut used, mut faults) = (BTreeSet::new(), BTreeSet::new());
    for formula in promised() {
        let (program, tolerance) = (program(formula), check::tolerance(gpu, formula));
        let seams = seams_of(formula.function);
        let mut expect = |condition: &str, is_exception: bool, what: &str| {
            let key = (formula.function.to_owned(), condition.to_owned());
            if is_exception && !exceptions.contains_key(&key) {
                faults.insert(format!("{}: {condition} # {what}", formula.function));
            }
            if is_exception {
                used.insert(key);
            }
        };
        for branch in program.branches().iter().filter(|branch| branch.compares_floats) {
            let straddled = seams.iter().any(|seam| seam.site == branch.site);
            expect(&branch.condition, !straddled, "no inputs on both sides were found");
        }
        let jump = seams.iter().find_map(|seam| Some((seam, seams::jump(formula, &tolerance, seam)?)));
        let what = jump.as_ref().map_or(String::new(), |(seam, jump)| {
            format!("by {jump:e} at `{}`, {}", program.line(seam.site), check::spell(formula, &seam.sides[0]))
        });
        expect(JUMPS, jump.is_some(), &what);
    }
    let stale = exceptions.keys().filter(|key| !used.contains(*key));
    faults.extend(stale.map(|(function, condition)| format!("{function}: {condition}: no exception any more")));
    assert!(faults.is_empty(), "\n{}", faults.into_iter().collect::<Vec<_>>().join("\n"));
}

/// What seams find in `function` of a source in which `from` has become `to`.
fn planted(function: &str, from: &str, to: &str) -> Vec<String> {
    let gpu = super::gpu();
    let formula = formulas::of_function(function).expect("a formula");
    let source = cookbook::module(formula.module).expect("its module").source;
    assert_eq!(source.matches(from).count(), 1, "`{from}`");
    let source = source.replace(from, to);
    let program = Program::new(&source, "planted.wgsl", function).expect("valid");
    let mut kernel = Kernel::of_function(gpu, &source, "planted.wgsl", function).expect("compiles");
    let seams = seams(&program, formula);
    seams::faults(&program, formula, &mut kernel, &check::tolerance(gpu, formula), &seams).expect("runs")
}

#[test]
fn a_planted_jump_is_found_at_its_branch() {
    let plants = [
        // Beyond 0.3 the form at one edge is ever less accurate.
        ("cdrf_accurate", "const CDRF_SWITCH: f32 = 0.3f;", "const CDRF_SWITCH: f32 = 0.45f;", "sigma < CDRF_SWITCH"),
        // A knee that is off by a thousandth, where the two pieces are a few parts in a million apart.
        ("srgb_encode", "0.0031308f", "0.0034f", "0.0034f"),
    ];
    for (function, from, to, at) in plants {
        let faults = planted(function, from, to);
        assert!(faults.iter().any(|fault| fault.contains(at)), "{function}, {at}: {faults:?}");
    }
}
