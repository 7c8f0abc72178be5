//! The comparison and the search for counterexamples fail when they must. A suite whose comparator
//! accepts NaN, or whose generator misses its edges, checks nothing.

use glam::{DVec3, Vec3};
use lapidary_assay::accuracy_line::{Bound, FieldBound};
use lapidary_assay::draws::Draws;
use lapidary_assay::formula::{Formula, Words, formula};
use lapidary_assay::property::persistence::Regressions;
use lapidary_assay::property::{Check, Report, Settings};
use lapidary_assay::runner::Runner;
use lapidary_assay::shape::{Scalar, Shape};
use lapidary_assay::tolerance::{Tolerance, Verdict};
use lapidary_cook::check::{self, Source};
use lapidary_testing::gpu;

const FLOAT: Shape = Shape::Scalar(Scalar::F32);
const FLAG: Shape = Shape::Scalar(Scalar::Bool);
const NONE: Bound = Bound { ulp: 0.0, absolute: 0.0, relative: 0.0, backward: 0.0 };
/// One unit in the last place of 1.
const ULP: f32 = f32::EPSILON;

fn tolerance(arguments: &[Shape], result: &Shape, bound: Bound) -> Tolerance {
    Tolerance::new(arguments, result, &[FieldBound { field: None, bound }])
}

/// Returns the verdict on a scalar result without arguments.
fn judge(bound: Bound, gpu: f32, mirror: f32, exact: f64) -> Verdict {
    let oracle = |_: &[f64], _: &mut Vec<f64>| panic!("no bound asks for it again");
    tolerance(&[], &FLOAT, bound).judge(&[], &[gpu.to_bits()], &[mirror.to_bits()], &[exact], &oracle)
}

/// Whether a value that shader and mirror share is accepted.
fn accepts(bound: Bound, value: f32, exact: f64) -> bool {
    judge(bound, value, value, exact).holds()
}

const GENEROUS: Bound = Bound { ulp: 1e30, absolute: 1e30, relative: 1e30, backward: 0.0 };

#[test]
fn nan_never_passes() {
    assert!(judge(GENEROUS, 1.0, 1.0, 2.0).holds());
    let nan = judge(GENEROUS, f32::NAN, f32::NAN, f64::NAN);
    assert!(!nan.holds() && nan.nonfinite);
    assert!(!judge(GENEROUS, f32::NAN, 1.0, 1.0).holds());
    let mirror = judge(GENEROUS, 1.0, f32::NAN, 1.0);
    // Only the shader's results count as nonfinite, not the mirror's.
    assert!(!mirror.holds() && !mirror.nonfinite);
    let oracle = judge(GENEROUS, 1.0, 1.0, f64::NAN);
    assert!(!oracle.holds() && !oracle.nonfinite);
}

#[test]
fn infinity_never_passes() {
    for infinity in [f32::INFINITY, f32::NEG_INFINITY] {
        let all = judge(GENEROUS, infinity, infinity, infinity.into());
        assert!(!all.holds() && all.nonfinite);
        assert!(!judge(GENEROUS, infinity, 1.0, 1.0).holds());
        assert!(!judge(GENEROUS, 1.0, infinity, 1.0).holds());
        assert!(!judge(GENEROUS, 1.0, 1.0, infinity.into()).holds());
    }
}

#[test]
fn one_nan_component_fails_the_vector() {
    let one = [1.0f32.to_bits(); 3];
    let oracle = |_: &[f64], _: &mut Vec<f64>| {};
    let tolerance = tolerance(&[], &Shape::Vector(3, Scalar::F32), GENEROUS);
    assert!(tolerance.judge(&[], &one, &one, &[1.0; 3], &oracle).holds());
    for index in 0..3 {
        let mut broken = one;
        broken[index] = f32::NAN.to_bits();
        assert!(!tolerance.judge(&[], &broken, &one, &[1.0; 3], &oracle).holds());
        assert!(!tolerance.judge(&[], &one, &broken, &[1.0; 3], &oracle).holds());
    }
}

#[test]
fn zero_has_no_sign_and_flushing_is_no_error() {
    assert!(judge(NONE, -0.0, 0.0, 0.0).holds());
    assert!(judge(NONE, 0.0, -0.0, -0.0).holds());
    // The largest number that WGSL allows to be flushed, and the first number beyond it, of either
    // sign.
    for sign in [1.0f64, -1.0] {
        assert!(accepts(NONE, 0.0, sign * 2.0 * f64::from(f32::MIN_POSITIVE)));
        assert!(!accepts(NONE, sign as f32 * (2.0 * f32::MIN_POSITIVE).next_up(), 0.0));
    }
}

#[test]
fn an_error_at_the_bound_holds_and_one_ulp_above_fails() {
    let three = Bound { ulp: 3.0, ..NONE };
    for sign in [1.0, -1.0f32] {
        assert!(accepts(three, sign * (1.0 + 3.0 * ULP), sign.into()));
        assert!(!accepts(three, sign * (1.0 + 4.0 * ULP), sign.into()));
    }
    // A correctly rounded result is off by at most half an ulp.
    let half = Bound { ulp: 0.5, ..NONE };
    assert!(accepts(half, 1.0, 1.0 + 0.5 * f64::from(ULP)));
    assert!(!accepts(half, 1.0, 1.0 + 0.51 * f64::from(ULP)));
}

#[test]
fn absolute_and_relative_bounds_are_exact() {
    let bound = 2f64.powi(-10);
    let absolute = Bound { absolute: bound, ..NONE };
    let relative = Bound { relative: bound, ..NONE };
    for (bound, error) in [(absolute, 2f32.powi(-10)), (relative, 2f32.powi(-7))] {
        let edge = 8.0 + error;
        assert!(accepts(bound, edge, 8.0));
        assert!(!accepts(bound, edge.next_up(), 8.0));
    }
    // Terms add up.
    let both = Bound { absolute: bound, relative: bound, ..NONE };
    assert!(accepts(both, 8.0 + 2f32.powi(-7) + 2f32.powi(-10), 8.0));
}

#[test]
fn shader_and_mirror_must_agree_with_each_other() {
    let three = Bound { ulp: 3.0, ..NONE };
    // Each within 3 ulp of the oracle, but 4 ulp apart.
    assert!(accepts(three, 1.0 + 2.0 * ULP, 1.0) && accepts(three, 1.0 - 2.0 * ULP, 1.0));
    assert!(!judge(three, 1.0 + 2.0 * ULP, 1.0 - 2.0 * ULP, 1.0).holds());
    assert!(!judge(three, 1.0, 1.0 + 4.0 * ULP, 1.0).holds());
}

#[test]
fn a_vectors_ulp_is_that_of_its_largest_component() {
    let exact = [1024.0, 1.0, 0.0];
    let one = tolerance(&[], &Shape::Vector(3, Scalar::F32), Bound { ulp: 1.0, ..NONE });
    let oracle = |_: &[f64], _: &mut Vec<f64>| {};
    let accepts = |vector: [f32; 3]| {
        let words = vector.map(f32::to_bits);
        one.judge(&[], &words, &words, &exact, &oracle).holds()
    };
    let edge = 1.0 + 2f32.powi(-13);
    assert!(accepts([1024.0, edge, 2f32.powi(-13)]));
    assert!(!accepts([1024.0, edge.next_up(), 0.0]));
    assert!(!accepts([1024.0, 1.0, 2f32.powi(-13).next_up()]));
    // In an array, each element has its own ulp.
    let array = tolerance(&[], &Shape::Array(Box::new(FLOAT), 3), Bound { ulp: 1.0, ..NONE });
    let words = [1024.0, edge, 0.0].map(f32::to_bits);
    assert!(!array.judge(&[], &words, &words, &exact, &oracle).holds());
}

#[test]
fn each_field_has_its_own_bound() {
    let field = |name: &str, ulp: f64| FieldBound { field: Some(name.to_owned()), bound: Bound { ulp, ..NONE } };
    let pair = Shape::Struct("Pair".to_owned(), vec![("first".to_owned(), FLOAT), ("second".to_owned(), FLOAT)]);
    let tolerance = Tolerance::new(&[], &pair, &[field("first", 0.0), field("second", 2.0)]);
    let oracle = |_: &[f64], _: &mut Vec<f64>| {};
    let accepts = |first: f32, second: f32| {
        let words = [first.to_bits(), second.to_bits()];
        tolerance.judge(&[], &words, &words, &[1.0, 1.0], &oracle).holds()
    };
    assert!(accepts(1.0, 1.0 + 2.0 * ULP));
    assert!(!accepts(1.0 + ULP, 1.0));
    assert!(!accepts(1.0, 1.0 + 3.0 * ULP));
}

#[test]
fn a_discrete_difference_fails() {
    let oracle = |_: &[f64], _: &mut Vec<f64>| {};
    for (shape, right, wrong, exact) in [
        (FLAG, 1u32, 0u32, 1.0),
        (Shape::Scalar(Scalar::U32), 7, 8, 7.0),
        (Shape::Scalar(Scalar::I32), (-7i32).cast_unsigned(), 7, -7.0),
    ] {
        let tolerance = tolerance(&[], &shape, GENEROUS);
        assert!(tolerance.judge(&[], &[right], &[right], &[exact], &oracle).holds());
        assert!(!tolerance.judge(&[], &[wrong], &[right], &[exact], &oracle).holds());
        assert!(!tolerance.judge(&[], &[right], &[wrong], &[exact], &oracle).holds());
        assert!(!tolerance.judge(&[], &[wrong], &[wrong], &[exact], &oracle).holds());
    }
}

#[test]
fn a_flag_may_differ_only_within_the_backward_bound_of_its_threshold() {
    // Whether x = 1 exceeds a threshold a few ulp above it; by the oracle it does not.
    let accepts = |backward: f64, ulps_away: f64, gpu: bool, mirror: bool| {
        let threshold = 1.0 + ulps_away * f64::from(ULP);
        let oracle = |numbers: &[f64], result: &mut Vec<f64>| result.push(f64::from(u8::from(numbers[0] >= threshold)));
        let tolerance = tolerance(&[FLOAT], &FLAG, Bound { backward, ..NONE });
        tolerance.judge(&[1.0f32.to_bits()], &[gpu.into()], &[mirror.into()], &[0.0], &oracle).holds()
    };
    for (gpu, mirror) in [(true, false), (false, true), (true, true)] {
        assert!(accepts(2.0, 1.0, gpu, mirror));
        assert!(accepts(2.0, 2.0, gpu, mirror), "right at the end of the box");
        assert!(!accepts(2.0, 2.01, gpu, mirror));
        assert!(!accepts(0.0, 1.0, gpu, mirror));
    }
    assert!(accepts(0.0, 1.0, false, false));
}

#[test]
fn floats_beside_a_flag_are_those_of_the_same_case() {
    // The value is 0 below the threshold and 100 above it: with "above" set, it must be 100.
    let shape = Shape::Struct("Hit".to_owned(), vec![("value".to_owned(), FLOAT), ("above".to_owned(), FLAG)]);
    let oracle = |numbers: &[f64], result: &mut Vec<f64>| {
        let above = numbers[0] >= 1.0 + f64::from(ULP);
        result.extend(if above { [100.0, 1.0] } else { [0.0, 0.0] });
    };
    let tolerance = tolerance(&[FLOAT], &shape, Bound { backward: 2.0, ..NONE });
    let accepts = |value: f32, above: u32| {
        let words = [value.to_bits(), above];
        tolerance.judge(&[1.0f32.to_bits()], &words, &words, &[0.0, 0.0], &oracle).holds()
    };
    assert!(accepts(0.0, 0) && accepts(100.0, 1));
    assert!(!accepts(50.0, 1) && !accepts(0.0, 1) && !accepts(100.0, 0));
}

/// Returns verdicts on a value of a struct with a flag, for two inputs of 1. `oracle` takes the
/// offset of each input in ulp.
fn beside_a_flag(value: f32, oracle: impl Fn(f64, f64) -> Option<f64>) -> [Verdict; 2] {
    let shape = Shape::Struct("Hit".to_owned(), vec![("value".to_owned(), FLOAT), ("hit".to_owned(), FLAG)]);
    let of_inputs = |numbers: &[f64], result: &mut Vec<f64>| {
        let off = |index: usize| (numbers[index] - 1.0) / f64::from(ULP);
        result.extend(oracle(off(0), off(1)).map_or([0.0, 0.0], |value| [value, 1.0]));
    };
    let tolerance = tolerance(&[FLOAT, FLOAT], &shape, Bound { ulp: 2.0, backward: 8.0, ..NONE });
    let (arguments, words) = ([1.0f32.to_bits(); 2], [value.to_bits(), 1]);
    let mut exact = Vec::new();
    of_inputs(&[1.0, 1.0], &mut exact);
    [Tolerance::judge, Tolerance::judge_thoroughly]
        .map(|by| by(&tolerance, &arguments, &words, &words, &exact, &of_inputs))
}

#[test]
fn an_extremum_where_a_case_ends_is_found() {
    // A ray that approaches a plane's direction until it counts as parallel. There its value is
    // 18 / 0.37.
    let oracle = |along: f64, height: f64| (along > 0.37).then(|| (10.0 + height) / along);
    assert!(beside_a_flag(18.0 / 0.37, oracle)[0].holds());
    assert!(!beside_a_flag(18.001 / 0.37, oracle)[1].holds());
}

#[test]
fn the_highest_of_several_extrema_is_found_thoroughly() {
    let hill = |x: f64, y: f64, steep: f64| (-steep * (x * x + y * y)).exp();
    // From nearly everywhere, the way up leads to the lower one.
    let oracle = |x: f64, y: f64| Some(hill(x + 4.0, y + 4.0, 0.01) + 1.5 * hill(x - 3.3, y - 2.7, 8.0));
    let top = (hill(7.3, 6.7, 0.01) + 1.5) as f32;
    let [quick, thorough] = beside_a_flag(top - 2e-4, oracle);
    assert!(!quick.holds() && thorough.holds(), "{quick:?}, {thorough:?}");
    assert!(!beside_a_flag(top + 2e-3, oracle)[1].holds());
}

#[test]
fn a_case_too_thin_for_corners_is_found_thoroughly() {
    // A triangle seen almost edge-on.
    let oracle = |x: f64, y: f64| (0.0..0.02).contains(&(x - 1.03 * y - 0.3)).then_some(5.0 + x);
    let [quick, thorough] = beside_a_flag(6.0, oracle);
    assert!(!quick.holds() && thorough.holds(), "{quick:?}, {thorough:?}");
    assert!(!beside_a_flag(14.0, oracle)[1].holds());
}

#[test]
fn backward_error_accepts_what_the_input_explains_and_no_more() {
    // x - 1 near 1: an ulp of the input is 1024 ulp of the result.
    let input = 1.0 + 2f32.powi(-10);
    let oracle = |numbers: &[f64], result: &mut Vec<f64>| result.push(numbers[0] - 1.0);
    let accepts = |backward: f64, value: f32| {
        let tolerance = tolerance(&[FLOAT], &FLOAT, Bound { backward, ..NONE });
        tolerance.judge(&[input.to_bits()], &[value.to_bits()], &[value.to_bits()], &[2f64.powi(-10)], &oracle).holds()
    };
    let exact = 2f32.powi(-10);
    for edge in [exact + 2.0 * ULP, exact - 2.0 * ULP] {
        assert!(accepts(2.0, edge));
        assert!(!accepts(1.0, edge));
        assert!(!accepts(0.0, edge));
    }
    assert!(!accepts(2.0, (exact + 2.0 * ULP).next_up()));
    assert!(!accepts(2.0, (exact - 2.0 * ULP).next_down()));
}

#[test]
fn backward_error_reaches_an_extremum_inside_the_box() {
    // (x - y)²: no corner of the box gives the 0 that lies inside it.
    let oracle = |numbers: &[f64], result: &mut Vec<f64>| result.push((numbers[0] - numbers[1]).powi(2));
    let inputs = [1.0 + ULP, 1.0];
    let exact = f64::from(ULP).powi(2);
    // The search ends near the extremum.
    let tolerance = tolerance(&[FLOAT, FLOAT], &FLOAT, Bound { backward: 4.0, absolute: 1e-3 * exact, ..NONE });
    let accepts = |value: f64| {
        let word = (value as f32).to_bits();
        tolerance.judge(&inputs.map(f32::to_bits), &[word], &[word], &[exact], &oracle).holds()
    };
    assert!(accepts(exact) && accepts(0.0) && accepts(81.0 * exact));
    assert!(!accepts(-0.01 * exact) && !accepts(82.0 * exact));
}

#[test]
fn backward_error_reaches_the_one_corner_of_many_where_the_extremum_is() {
    // x₁ - x₂ + x₃ - …: one corner of 65,536 has the greatest sum, and it lies at the end of every
    // input.
    const INPUTS: usize = 16;
    let oracle = |numbers: &[f64], result: &mut Vec<f64>| {
        result.push(numbers.chunks_exact(2).map(|pair| pair[0] - pair[1]).sum());
    };
    let tolerance = tolerance(&[FLOAT; INPUTS], &FLOAT, Bound { backward: 2.0, ..NONE });
    let accepts = |value: f32| {
        let words = [value.to_bits()];
        tolerance.judge(&[1.0f32.to_bits(); INPUTS], &words, &words, &[0.0], &oracle).holds()
    };
    let greatest = 2.0 * INPUTS as f32 * ULP;
    assert!(accepts(greatest) && accepts(-greatest));
    assert!(!accepts(greatest.next_up()) && !accepts(-greatest.next_up()));
}

#[test]
fn backward_error_explains_nothing_where_the_input_does_not_matter() {
    let oracle = |_: &[f64], result: &mut Vec<f64>| result.push(1.0);
    let tolerance = tolerance(&[FLOAT], &FLOAT, Bound { backward: 1000.0, ..NONE });
    let accepts = |value: f32| {
        let words = [value.to_bits()];
        tolerance.judge(&[5.0f32.to_bits()], &words, &words, &[1.0], &oracle).holds()
    };
    assert!(accepts(1.0) && !accepts(1.0 + ULP));
}

/// Length of a wrong reflection relative to the right one, far above any tolerance.
const TOO_LONG: f64 = 1.0 + 1.0 / 64.0;

fn right_mirror(incident: Vec3, normal: Vec3) -> Vec3 {
    incident - 2.0 * normal.dot(incident) * normal
}

fn right_oracle(incident: DVec3, normal: DVec3) -> DVec3 {
    incident - 2.0 * normal.dot(incident) * normal
}

fn wrong_mirror(incident: Vec3, normal: Vec3) -> Vec3 {
    let octant = incident.cmpgt(Vec3::ZERO).all();
    right_mirror(incident, normal) * if octant { TOO_LONG as f32 } else { 1.0 }
}

fn wrong_oracle(incident: DVec3, normal: DVec3) -> DVec3 {
    let octant = incident.cmpgt(DVec3::ZERO).all();
    right_oracle(incident, normal) * if octant { TOO_LONG } else { 1.0 }
}

/// Returns normals along the axes, for which the reflection is exact, so that only deliberate
/// errors fail.
fn inputs(draws: &mut Draws<'_>) -> (Vec3, Vec3) {
    let incident = Vec3::new(draws.signed(-8, 8), draws.signed(-8, 8), draws.signed(-8, 8));
    (incident, draws.pick(&[Vec3::X, Vec3::Y, Vec3::Z]))
}

const MODULE: &str = "refraction";
const FUNCTION: &str = "refraction_reflect";
const SETTINGS: Settings = Settings { cases: 4096, seed: 3 };

fn run(formula: &Formula, settings: Settings, replayed: &[Words]) -> Report {
    let mut kernel = check::kernel(gpu(), formula, Source::Cookbook).unwrap_or_else(|error| panic!("{error}"));
    let tolerance = check::tolerance(gpu(), formula);
    Check { formula, runner: &mut kernel, tolerance: &tolerance }
        .run(settings, replayed)
        .unwrap_or_else(|error| panic!("{error}"))
}

fn in_octant(row: &Words) -> bool {
    row[..3].iter().all(|word| f32::from_bits(*word) > 0.0)
}

/// Returns the number of set mantissa bits: few in a simple input.
fn complexity(row: &Words) -> u32 {
    row.iter().map(|word| (word & 0x007f_ffff).count_ones()).sum()
}

#[test]
fn a_right_formula_passes() {
    let report = run(&formula(MODULE, FUNCTION, right_mirror, right_oracle, inputs).build(), SETTINGS, &[]);
    assert!(report.passed() && report.shrunk.is_none() && report.reason.is_none(), "{report:?}");
    assert_eq!((report.cases, report.failed, report.nonfinite), (SETTINGS.cases, 0, 0));
}

#[test]
fn a_formula_that_is_wrong_in_one_octant_is_caught_there() {
    if !lapidary_testing::on_lavapipe("mirrors are compared on the reference device alone") {
        return;
    }
    for wrong in [
        formula(MODULE, FUNCTION, wrong_mirror, right_oracle, inputs).build(),
        formula(MODULE, FUNCTION, right_mirror, wrong_oracle, inputs).build(),
    ] {
        let report = run(&wrong, SETTINGS, &[]);
        let in_the_octant =
            (0..SETTINGS.cases).filter(|row| in_octant(&wrong.domain.row(SETTINGS.seed, *row))).count() as u64;
        assert!(in_the_octant > SETTINGS.cases / 16);
        assert_eq!(report.failed, in_the_octant);
        assert!(!report.passed() && report.worst_ratio > 1000.0, "{report:?}");
        assert!(
            report.reason.as_deref().is_some_and(|reason| reason.contains("times the allowed error")),
            "{report:?}"
        );

        let shrunk = report.shrunk.expect("a failure is shrunk");
        assert!(in_octant(&report.worst) && in_octant(&shrunk), "{shrunk:x?}");
        assert!(complexity(&shrunk) < complexity(&report.worst) / 2, "{:x?} was shrunk to {shrunk:x?}", report.worst);
        // The shrunk input still fails, alone.
        let alone = run(&wrong, Settings { cases: 0, ..SETTINGS }, &[shrunk]);
        assert_eq!((alone.cases, alone.failed), (1, 1));
    }
}

#[test]
fn the_same_seed_finds_the_same_failure() {
    let wrong = formula(MODULE, FUNCTION, wrong_mirror, right_oracle, inputs).build();
    let found = |seed| {
        let report = run(&wrong, Settings { seed, ..SETTINGS }, &[]);
        (report.failed, report.worst, report.shrunk, report.worst_ratio)
    };
    assert_eq!(found(3), found(3));
    assert_ne!(found(3).1, found(4).1);
}

#[test]
fn an_edge_that_is_never_reached_fails_the_run() {
    let formula = formula(MODULE, FUNCTION, right_mirror, right_oracle, inputs)
        .edge("upwards", |(incident, _)| incident.z > 0.0)
        .edge("longer than the domain has it", |(incident, _)| incident.x > 1e6)
        .build();
    let report = run(&formula, SETTINGS, &[]);
    assert_eq!(report.failed, 0);
    assert!(!report.passed());
    assert_eq!(report.missed_edges().collect::<Vec<_>>(), ["longer than the domain has it"]);
    assert!(report.edges[0].1 > SETTINGS.cases / 4, "{:?}", report.edges);
}

#[test]
fn a_broken_invariant_is_reported_by_name() {
    let formula = formula(MODULE, FUNCTION, right_mirror, right_oracle, inputs)
        .invariant("holds", |_, _: Vec3| Ok(()))
        .invariant("never holds", |_, _: Vec3| Err("so it is".to_owned()))
        .build();
    let report = run(&formula, SETTINGS, &[]);
    assert_eq!(report.failed, SETTINGS.cases);
    assert_eq!(report.reason.as_deref(), Some("never holds: so it is"));
    // If everything fails, the simplest input of all is found: each generator's first choice.
    let simplest = [1.0, 1.0, 1.0, 1.0, 0.0, 0.0f32].map(f32::to_bits);
    assert_eq!(report.shrunk.as_deref(), Some(simplest.as_slice()));
}

#[test]
fn a_broken_pair_is_reported_by_name() {
    if !lapidary_testing::on_lavapipe("pairs are compared on the reference device alone") {
        return;
    }
    let formula = formula(MODULE, FUNCTION, right_mirror, right_oracle, inputs)
        .pair(
            "even",
            |(incident, normal)| (-incident, normal),
            |_, one: Vec3, other: Vec3| {
                if one == other { Ok(()) } else { Err(format!("{one} and {other}")) }
            },
        )
        .build();
    let report = run(&formula, SETTINGS, &[]);
    // Reflection is odd, and no input is zero.
    assert_eq!(report.failed, SETTINGS.cases);
    assert!(report.reason.is_some_and(|reason| reason.starts_with("even: [")));
}

#[test]
fn kept_failures_are_replayed_before_all_others() {
    if !lapidary_testing::on_lavapipe("mirrors are compared on the reference device alone") {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let regressions = Regressions::in_folder(folder.path());
    let kept: Words = [0.5, 0.25, 0.125, 0.0, 0.0, 1.0f32].map(f32::to_bits).to_vec();
    regressions.store(FUNCTION, &kept, "off by much").unwrap_or_else(|error| panic!("{error}"));
    let rows = regressions.load(FUNCTION, kept.len()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(rows, std::slice::from_ref(&kept));

    let wrong = formula(MODULE, FUNCTION, wrong_mirror, right_oracle, inputs).build();
    let alone = run(&wrong, Settings { cases: 0, ..SETTINGS }, &rows);
    assert_eq!((alone.cases, alone.failed), (1, 1));
    assert_eq!(alone.shrunk.as_ref(), Some(&kept));
    // All rows fail alike, and the reported row is the first.
    let all_fail = formula(MODULE, FUNCTION, right_mirror, right_oracle, inputs)
        .invariant("never holds", |_, _: Vec3| Err("so it is".to_owned()))
        .build();
    let report = run(&all_fail, Settings { cases: 100, ..SETTINGS }, &rows);
    assert_eq!((report.cases, report.failed), (101, 101));
    assert_eq!(report.worst, kept);
}

#[test]
#[should_panic(expected = "whole rows")]
fn part_of_a_row_is_no_input() {
    let formula = formula(MODULE, FUNCTION, right_mirror, right_oracle, inputs).build();
    let mut kernel = check::kernel(gpu(), &formula, Source::Cookbook).expect("compiles");
    let words = vec![0; kernel.argument_words() + 1];
    let _ = kernel.run(&words, &mut Words::new());
}

#[test]
fn backward_error_is_no_sum_where_only_one_input_counts() {
    // The larger of two equal inputs moves as far as either, not as far as both together.
    let oracle = |numbers: &[f64], result: &mut Vec<f64>| result.push(numbers[0].max(numbers[1]));
    let tolerance = tolerance(&[FLOAT, FLOAT], &FLOAT, Bound { backward: 2.0, ..NONE });
    let accepts = |value: f32| {
        let words = [value.to_bits()];
        tolerance.judge(&[1.0f32.to_bits(); 2], &words, &words, &[1.0], &oracle).holds()
    };
    assert!(accepts(1.0 + 2.0 * ULP) && accepts(1.0 - 2.0 * ULP));
    assert!(!accepts(1.0 + 3.0 * ULP) && !accepts(1.0 - 3.0 * ULP));
}
