//! Continuity: both sides of every branch of every function, one ulp apart.

mod branches;

use branches::{Exception, Line};
use lapidary_assay::dispatch::Kernel;
use lapidary_assay::formula::Formula;
use lapidary_assay::interpreter::{Nearest, Program};
use lapidary_assay::property::Settings;
use lapidary_assay::property::seams::{self, Fault, Seam};
use lapidary_cook::check::{self, Source};
use lapidary_cook::formulas;
use lapidary_cookbook as cookbook;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::OnceLock;

fn program(formula: &Formula) -> Program {
    let module = cookbook::module(formula.module).expect("a formula's module");
    Program::new(module.whole, formula.module, formula.function).expect("the cookbook's WGSL is valid")
}

/// Returns the seams of a promised function of the cookbook. They are found once for all tests.
fn seams_of(function: &str) -> &'static [Seam] {
    static SEAMS: OnceLock<BTreeMap<&'static str, Vec<Seam>>> = OnceLock::new();
    let all = SEAMS.get_or_init(|| {
        formulas::promised().map(|formula| (formula.function, seams(&program(formula), formula))).collect()
    });
    &all[function]
}

/// Finds the seams with enough seeds that no branch is missed by chance.
fn seams(program: &Program, formula: &Formula) -> Vec<Seam> {
    (0..2).flat_map(|seed| seams::find(program, formula, seed).expect("the interpreter runs it")).collect()
}

/// The interpreter is a device: it is held to the bounds of the reference device.
#[test]
fn the_interpreter_computes_what_the_shaders_do() {
    let gpu = lapidary_testing::gpu();
    let mut faults = Vec::new();
    for formula in formulas::promised() {
        let (program, tolerance) = (program(formula), check::tolerance(gpu, formula));
        for row in 0..200 {
            let arguments = formula.domain.row(Settings::default().seed, row);
            let mut result = Vec::new();
            if let Err(stopped) = program.run(&arguments, &mut Nearest, &mut result) {
                faults.push(format!("{}: {stopped}", formula.function));
                break;
            }
            let (mirrored, exact) = (formula.mirrored(&arguments), formula.exact(&arguments));
            let verdict = tolerance.judge(&arguments, &result, &mirrored, &exact, &*formula.oracle);
            if !verdict.holds() {
                faults.push(format!("{}: {verdict:?} at {}", formula.function, check::spell(formula, &arguments)));
                break;
            }
        }
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

/// Every branch that compares floats is straddled and the function is continuous there, or the list
/// of exceptions says why not. An outdated line of the list is a fault too.
#[test]
fn every_branch_is_straddled_and_continuous_or_says_why_not() {
    if !lapidary_testing::on_lavapipe("exceptions are listed for it") {
        return;
    }
    let gpu = lapidary_testing::gpu();
    let (mut used, mut faults) = (BTreeSet::new(), BTreeMap::new());
    for formula in formulas::promised() {
        let (program, tolerance) = (program(formula), check::tolerance(gpu, formula));
        let mut kernel = check::kernel(gpu, formula, Source::Cookbook).expect("the cookbook's WGSL compiles");
        let seams = seams_of(formula.function);
        let mut found = |exception: Exception, place: &str, what: &str| {
            used.insert((formula.function, exception, place.to_owned()));
            if !branches::excepts(formula.function, exception, place) {
                let line = format!("{} | {} | {place}", formula.function, exception.name());
                faults.entry(line).or_insert_with(|| what.to_owned());
            }
        };
        for branch in program.branches().iter().filter(|branch| branch.compares_floats) {
            if !seams.iter().any(|seam| seam.parted.contains(&branch.site)) {
                found(Exception::NotStraddled, &branch.condition, "");
            }
        }
        for seam in seams {
            if let Some(jump) = seams::jump(formula, &tolerance, seam) {
                let what = format!("by {jump:e} at {}", check::spell(formula, &seam.sides[0]));
                found(Exception::Jumps, program.line(seam.site), &what);
            }
        }
        for fault in seams::faults(&program, formula, &mut kernel, &tolerance, seams, seams::beside).expect("runs") {
            found(Exception::LeavesTheDomain, &fault.line, &fault.what);
        }
    }
    let is_used = |line: &Line| used.contains(&(line.function, line.exception, line.place.to_owned()));
    let stale = branches::all().iter().filter(|line| !is_used(line));
    faults
        .extend(stale.map(|line| (format!("{} | {}", line.function, line.place), "no exception any more".to_owned())));
    let lines: Vec<String> = faults.iter().map(|(line, what)| format!("{line} | {what}")).collect();
    assert!(lines.is_empty(), "\n{}", lines.join("\n"));
}

/// Returns the faults that seams find in `function` of a source with `from` replaced by `to`.
fn planted(function: &str, from: &str, to: &str) -> Vec<Fault> {
    let gpu = lapidary_testing::gpu();
    let formula = formulas::of_function(function).expect("a formula");
    let source = cookbook::module(formula.module).expect("its module").whole;
    assert_eq!(source.matches(from).count(), 1, "`{from}`");
    let source = source.replace(from, to);
    let program = Program::new(&source, "planted.wgsl", function).expect("valid");
    let mut kernel = Kernel::of_function(gpu, &source, "planted.wgsl", function).expect("compiles");
    let seams = seams(&program, formula);
    seams::faults(&program, formula, &mut kernel, &check::tolerance(gpu, formula), &seams, seams::beside).expect("runs")
}

#[test]
fn a_planted_jump_is_found_at_its_branch() {
    let plants = [
        // Beyond 0.3 the form for a single edge becomes less and less accurate.
        ("cdrf_accurate", "const CDRF_SWITCH: f32 = 0.3f;", "const CDRF_SWITCH: f32 = 0.45f;", "sigma < CDRF_SWITCH"),
        // A knee that is off by a twelfth. There the two pieces differ by three parts in a
        // thousand.
        ("srgb_encode", "0.0031308f", "0.0034f", "0.0034f"),
    ];
    for (function, from, to, seam) in plants {
        let faults = planted(function, from, to);
        assert!(faults.iter().any(|fault| fault.line.contains(seam)), "{function}, {seam}: {faults:?}");
    }
}
