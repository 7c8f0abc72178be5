use super::{Device, Direction, Habit, Mode, Reassociation, examine};
use crate::accuracy_line::parse_bounds;
use crate::draws::mix;
use crate::formula::{Formula, formula};
use crate::interpreter::{Assumption, Nearest, Program, Registers};
use crate::property::Settings;
use crate::tolerance::{Tolerance, ulp_of};
use std::collections::BTreeSet;

fn program(source: &str) -> Program {
    Program::new(source, "test.wgsl", "f").expect("valid")
}

/// Returns the result of a function of floats on a device of the given mode.
fn run(program: &Program, mode: Mode, key: u64, arguments: &[f32]) -> f32 {
    let words: Vec<u32> = arguments.iter().map(|argument| argument.to_bits()).collect();
    let mut result = Vec::new();
    program.run(&words, &mut Device::new(mode, key), &mut result).expect("ends");
    f32::from_bits(result[0])
}

fn towards(direction: Direction) -> Mode {
    Mode { direction, ..Mode::IDENTITY }
}

/// An operation: its WGSL, the ranges of its operands, its exact result and its allowed error.
struct Operation {
    expression: &'static str,
    operands: [[f64; 2]; 2],
    exact: fn(f64, f64) -> f64,
    allowed: fn(f64, f64, f64) -> f64,
    /// Whether the allowed error is more than can be reached.
    is_loose: bool,
}

/// Converts units in the last place of the exact result to an absolute error.
fn ulps(ulps: f64, exact: f64) -> f64 {
    ulps * ulp_of(exact)
}

const AROUND: [f64; 2] = [-1e3, 1e3];
const POSITIVE: [f64; 2] = [1e-3, 1e3];

fn operations() -> Vec<Operation> {
    let strict =
        |expression, operands, exact, allowed| Operation { expression, operands, exact, allowed, is_loose: false };
    let loosely =
        |expression, operands, exact, allowed| Operation { expression, operands, exact, allowed, is_loose: true };
    let rounded = |exact, _, _| ulps(1.0, exact);
    let wave = |_, _, _| 2f64.powi(-11);
    vec![
        strict("x + y", [AROUND, AROUND], |x, y| x + y, rounded),
        strict("x - y", [AROUND, AROUND], |x, y| x - y, rounded),
        strict("x * y", [AROUND, AROUND], |x, y| x * y, rounded),
        strict("x / y", [AROUND, POSITIVE], |x, y| x / y, |exact, _, _| ulps(2.5, exact)),
        strict("inverseSqrt(x)", [POSITIVE, AROUND], |x, _| 1.0 / x.sqrt(), |exact, _, _| ulps(2.0, exact)),
        // 2 ulp of the inverse, which may be twice as many of the root, and 2.5 ulp of a quotient.
        loosely("sqrt(x)", [POSITIVE, AROUND], |x, _| x.sqrt(), |exact, _, _| ulps(4.0 + 2.5 + 1e-5, exact)),
        strict("exp(x)", [[-50.0, 50.0], AROUND], |x, _| x.exp(), |exact, x, _| ulps(3.0 + 2.0 * x.abs(), exact)),
        strict("exp2(x)", [[-50.0, 50.0], AROUND], |x, _| x.exp2(), |exact, x, _| ulps(3.0 + 2.0 * x.abs(), exact)),
        strict("log(x)", [[2.5, 1e3], AROUND], |x, _| x.ln(), |exact, _, _| ulps(3.0, exact)),
        strict("log(x)", [[0.5, 2.0], AROUND], |x, _| x.ln(), |_, _, _| 2f64.powi(-21)),
        strict("log2(x)", [[1e-3, 0.4], AROUND], |x, _| x.log2(), |exact, _, _| ulps(3.0, exact)),
        strict("sin(x)", [[-3.0, 3.0], AROUND], |x, _| x.sin(), wave),
        strict("cos(x)", [[-3.0, 3.0], AROUND], |x, _| x.cos(), wave),
        strict("atan(x)", [POSITIVE, AROUND], |x, _| x.atan(), |exact, _, _| ulps(4096.0, exact)),
        strict("atan2(x, y)", [POSITIVE, POSITIVE], f64::atan2, |exact, _, _| ulps(4096.0, exact)),
        loosely("acos(x)", [[0.0, 0.5], AROUND], |x, _| x.acos(), |exact, _, _| ulps(4096.0, exact) + 1e-6),
        loosely("asin(x)", [[0.0, 0.1], AROUND], |x, _| x.asin(), |_, _, _| 6.81e-5 + 4e-6),
        strict("abs(x)", [AROUND, AROUND], |x, _| x.abs(), |_, _, _| 0.0),
        strict("max(x, y)", [AROUND, AROUND], f64::max, |_, _, _| 0.0),
        strict("floor(x)", [AROUND, AROUND], |x, _| x.floor(), |_, _, _| 0.0),
        strict("x * 2.0", [AROUND, AROUND], |x, _| 2.0 * x, |_, _, _| 0.0),
        strict("x - x", [AROUND, AROUND], |_, _| 0.0, |_, _, _| 0.0),
    ]
}

/// Returns the operands of a row, as f32.
fn operands(operation: &Operation, row: u64) -> [f32; 2] {
    let share = |place: u64| (mix(row ^ mix(place)) >> 40) as f64 / (1u64 << 24) as f64;
    let [x, y] = [0, 1].map(|place| {
        let [low, high] = operation.operands[place as usize];
        (low + (high - low) * share(place)) as f32
    });
    [x, y]
}

#[test]
fn each_operation_errs_by_what_it_may_and_no_more() {
    for operation in operations() {
        let program = program(&format!("fn f(x: f32, y: f32) -> f32 {{ return {}; }}", operation.expression));
        for direction in [Direction::Up, Direction::Down, Direction::Outward, Direction::Inward, Direction::Extreme] {
            // Counts by share of the allowed error, in tenths, and by side.
            let (mut histogram, mut sides) = ([0u32; 11], [0u32; 2]);
            for row in 0..2_000 {
                let [x, y] = operands(&operation, row);
                let exact = (operation.exact)(f64::from(x), f64::from(y));
                let allowed = (operation.allowed)(exact, f64::from(x), f64::from(y));
                let error = f64::from(run(&program, towards(direction), row, &[x, y])) - exact;
                if allowed == 0.0 {
                    assert_eq!(error, 0.0, "{} of {x:e}, {y:e}", operation.expression);
                    continue;
                }
                let share = error.abs() / allowed;
                assert!(share <= 1.0 + 1e-9, "{} of {x:e}, {y:e}: {share} of what is allowed", operation.expression);
                histogram[(share * 10.0) as usize] += 1;
                if error != 0.0 {
                    sides[usize::from(error > 0.0)] += 1;
                }
            }
            let (expression, met) = (operation.expression, sides.map(|count| count > 0));
            if sides == [0, 0] {
                continue;
            }
            // Roots and inverse functions seldom use all that they are allowed.
            let full = if operation.is_loose { 5 } else { 9 };
            assert!(histogram[full..].iter().sum::<u32>() > 0, "{expression} {direction:?}: {histogram:?}");
            match direction {
                Direction::Up => assert_eq!(met, [false, true], "{expression}"),
                Direction::Down => assert_eq!(met, [true, false], "{expression}"),
                Direction::Extreme => {
                    assert_eq!(met, [true, true], "{expression}");
                    // Neither side is favoured.
                    assert!(sides[0].abs_diff(sides[1]) < 300, "{expression}: {sides:?}");
                }
                _ => {}
            }
        }
    }
}

#[test]
fn outward_is_larger_and_inward_smaller() {
    let program = program("fn f(x: f32, y: f32) -> f32 { return x / y; }");
    for (x, y) in [(1.1f32, 1.3f32), (-1.1, 1.3), (7.0, -3.0)] {
        let exact = f64::from(x) / f64::from(y);
        let size = |direction| f64::from(run(&program, towards(direction), 0, &[x, y]).abs());
        assert!(size(Direction::Outward) > exact.abs() && size(Direction::Inward) < exact.abs(), "{x} / {y}");
    }
}

#[test]
fn what_is_inherited_errs_as_its_expression() {
    for (one, other) in [
        ("x % y", "x - y * trunc(x / y)"),
        ("tan(x)", "sin(x) / cos(x)"),
        ("mix(x, y, 0.3)", "x * (1.0 - 0.3) + y * 0.3"),
        ("fract(x)", "x - floor(x)"),
        ("fma(x, y, x)", "x * y + x"),
        ("length(vec2f(x, y))", "sqrt(x * x + y * y)"),
        ("dot(vec2f(x, y), vec2f(y, y))", "x * y + y * y"),
        ("distance(vec2f(x, y), vec2f(y, 1.0))", "length(vec2f(x, y) - vec2f(y, 1.0))"),
        ("reflect(vec2f(x, y), vec2f(0.6, 0.8)).y", "y - (2.0 * (0.6 * x + 0.8 * y)) * 0.8"),
    ] {
        let [one_of, other_of] =
            [one, other].map(|text| program(&format!("fn f(x: f32, y: f32) -> f32 {{ return {text}; }}")));
        for direction in [Direction::Nearest, Direction::Up, Direction::Down, Direction::Outward] {
            for (x, y) in [(0.7f32, 1.9f32), (1.3, 0.4), (2.9, 1.1)] {
                let results = [&one_of, &other_of].map(|program| run(program, towards(direction), 0, &[x, y]));
                assert_eq!(results[0], results[1], "{one} {direction:?} at {x}, {y}");
            }
        }
    }
}

#[test]
fn a_share_is_any_share() {
    let program = program("fn f(x: f32) -> f32 { return atan(x); }");
    let (exact, x) = (0.7f64.atan(), 0.7f32);
    let shares = (0..4_000)
        .map(|key| (f64::from(run(&program, towards(Direction::Share), key, &[x])) - exact) / ulps(4096.0, exact));
    let mut histogram = [0u32; 8];
    shares.for_each(|share| histogram[((share + 1.0) * 4.0).clamp(0.0, 7.0) as usize] += 1);
    // 4,000 shares in eight bins: 500 each, with a standard deviation of 21.
    assert!(histogram.iter().all(|count| count.abs_diff(500) < 130), "{histogram:?}");
}

#[test]
fn the_identity_changes_no_bit() {
    let source = "
        fn f(x: f32, y: f32, z: f32) -> vec4f {
            var v = vec3f(x, y, z) * vec3f(y, z, x) + x / max(abs(y), 1e-30);
            for (var i = 0; i < 3; i++) { v = normalize(v) - cross(v, vec3f(z, x, y)); }
            return vec4f(v, exp(-abs(x)) + sin(y) * pow(abs(z), 0.3) + fract(x * 8.0));
        }";
    let program = program(source);
    let odd = [0.0, -0.0, 1e-40, -1e-45, f32::MAX, f32::INFINITY, f32::NAN, 1.5];
    for row in 0..3_000u64 {
        let argument = |place: u64| match mix(row ^ mix(place)) {
            chance if chance & 3 == 0 => odd[(chance >> 8) as usize % odd.len()],
            chance => f32::from_bits((chance >> 16) as u32),
        };
        let arguments = [0, 1, 2].map(|place| argument(place).to_bits());
        let (mut nearest, mut device) = (Vec::new(), Vec::new());
        program.run(&arguments, &mut Nearest, &mut nearest).expect("ends");
        program.run(&arguments, &mut Device::new(Mode::IDENTITY, row), &mut device).expect("ends");
        // All NaNs count as equal.
        let bits = |words: Vec<u32>| {
            words.into_iter().map(|word| if f32::from_bits(word).is_nan() { 0x7fc0_0000 } else { word })
        };
        assert!(bits(nearest.clone()).eq(bits(device.clone())), "{arguments:x?}: {nearest:x?}, {device:x?}");
    }
}

/// The remainder of a sum beyond f64 still decides the rounding.
#[test]
fn a_sum_of_far_apart_magnitudes_is_rounded_either_way() {
    let sum = program("fn f(x: f32, y: f32) -> f32 { return x + y; }");
    let rounded = |direction, x: f32, y: f32| run(&sum, towards(direction), 0, &[x, y]);
    for tiny in [1e-45f32, f32::MIN_POSITIVE, 1e-20] {
        assert_eq!(rounded(Direction::Up, 1.0, tiny), 1.0f32.next_up(), "{tiny:e}");
        assert_eq!(rounded(Direction::Down, 1.0, tiny), 1.0, "{tiny:e}");
        assert_eq!(rounded(Direction::Up, 1.0, -tiny), 1.0, "{tiny:e}");
        assert_eq!(rounded(Direction::Down, 1.0, -tiny), 1.0f32.next_down(), "{tiny:e}");
        assert_eq!(rounded(Direction::Up, f32::MAX, -tiny), f32::MAX, "{tiny:e}");
    }
    // A result that f32 can represent is exact, subnormals included.
    let exact = [(1.0, 2.0, 3.0), (1e-45, 1e-45, 3e-45), (-1.0, 1.0, 0.0), (f32::MIN_POSITIVE, -1e-45, 1.1754942e-38)];
    for (x, y, result) in exact {
        for direction in [Direction::Up, Direction::Down] {
            assert_eq!(rounded(direction, x, y), result, "{x:e} + {y:e}");
        }
    }
    let product = program("fn f(x: f32, y: f32) -> f32 { return x * y; }");
    let subnormal = run(&product, towards(Direction::Up), 0, &[1e-30, 1e-10]);
    assert!(subnormal > 1e-40 && subnormal.is_subnormal());
}

#[test]
fn subnormals_are_flushed_and_zeros_lose_their_sign() {
    let keeps = program("fn f(x: f32) -> f32 { return x * 0.5; }");
    let flushing = Mode { flushes: Habit::Always, ..Mode::IDENTITY };
    assert_eq!(run(&keeps, Mode::IDENTITY, 0, &[f32::MIN_POSITIVE]), 0.5 * f32::MIN_POSITIVE);
    assert_eq!(run(&keeps, flushing, 0, &[f32::MIN_POSITIVE]), 0.0);
    let compared = program("fn f(x: f32) -> f32 { return select(0.0, 1.0, x > 0.0); }");
    assert_eq!([Mode::IDENTITY, flushing].map(|mode| run(&compared, mode, 0, &[1e-40])), [1.0, 0.0]);
    let odd = Mode { finite_math: Habit::Sometimes, ..Mode::IDENTITY };
    let signs: BTreeSet<u32> = (0..64).map(|key| run(&keeps, odd, key, &[0.0]).to_bits()).collect();
    assert_eq!(signs, BTreeSet::from([0, 0x8000_0000]));
    // An operation that only moves a value does not change it.
    let moved = program("fn f(x: f32) -> f32 { var a = array<f32, 2>(x, 1.0); return a[u32(a[1]) - 1u]; }");
    assert_eq!(run(&moved, flushing, 0, &[1e-40]), 1e-40);
}

#[test]
fn what_is_no_number_becomes_anything() {
    let quotient = program("fn f(x: f32) -> f32 { return 1.0 / x; }");
    let odd = Mode { finite_math: Habit::Sometimes, ..Mode::IDENTITY };
    let found: BTreeSet<u32> = (0..200).map(|key| run(&quotient, odd, key, &[0.0]).to_bits()).collect();
    assert!(found.len() > 20 && found.contains(&0), "{} results", found.len());
    let tested = program("fn f(x: f32) -> f32 { return select(0.0, 1.0, x != x); }");
    let found: BTreeSet<u32> = (0..64).map(|key| run(&tested, odd, key, &[f32::NAN]).to_bits()).collect();
    assert_eq!(found.len(), 2, "a comparison of a NaN says nothing");
    let bits =
        program("fn f(x: f32) -> f32 { return select(0.0, 1.0, (bitcast<u32>(x) & 0x7fffffffu) > 0x7f800000u); }");
    assert!((0..64).all(|key| run(&bits, odd, key, &[f32::NAN]) == 1.0), "its bits do");
}

#[test]
fn products_are_fused_with_sums_wherever_they_come_from() {
    let fused = Mode { fuses: Habit::Always, ..Mode::IDENTITY };
    let (x, y) = (1.1f32, 1.2f32);
    let right = x.mul_add(x, -y);
    assert_ne!(right, x * x - y);
    for source in [
        "fn f(x: f32, y: f32) -> f32 { return x * x - y; }",
        "fn f(x: f32, y: f32) -> f32 { return -(y - x * x); }",
        "fn f(x: f32, y: f32) -> f32 { var p = x * x; return p - y; }",
        "fn g(x: f32) -> f32 { return x * x; } fn f(x: f32, y: f32) -> f32 { return g(x) - y; }",
        "fn f(x: f32, y: f32) -> f32 { return dot(vec2f(x, y), vec2f(x, -1.0)); }",
    ] {
        let program = program(source);
        assert_eq!(run(&program, fused, 0, &[x, y]), right, "{source}");
        assert_eq!(run(&program, Mode::IDENTITY, 0, &[x, y]), x * x - y, "{source}");
    }
    // A product stays rounded if its bits were taken.
    let bits = program("fn f(x: f32, y: f32) -> f32 { return bitcast<f32>(bitcast<u32>(x * x)) - y; }");
    assert_eq!(run(&bits, fused, 0, &[x, y]), x * x - y);
}

#[test]
fn chains_are_taken_in_other_orders() {
    let orders = |source: &str, arguments: &[f32]| -> BTreeSet<u32> {
        let program = program(source);
        (0..64).map(|seed| run(&program.reassociated(seed), Mode::IDENTITY, 0, arguments).to_bits()).collect()
    };
    let bits = |values: &[f32]| values.iter().map(|value| value.to_bits()).collect::<BTreeSet<u32>>();
    let sum = "fn f(x: f32, y: f32, z: f32) -> f32 { return x + y - z; }";
    assert_eq!(orders(sum, &[1e8, 1.0, 1e8]), bits(&[0.0, 1.0]));
    let named = "fn f(x: f32, y: f32, z: f32) -> f32 { let s = x + y; return s - z; }";
    assert_eq!(orders(named, &[1e8, 1.0, 1e8]), bits(&[0.0, 1.0]));
    let product = "fn f(x: f32, y: f32, z: f32) -> f32 { return x * y / z; }";
    assert_eq!(orders(product, &[1e30, 1e30, 1e30]), bits(&[f32::INFINITY, 1e30]));
    // A sum of two terms is the same in either order.
    assert_eq!(orders("fn f(x: f32, y: f32) -> f32 { return x + y; }", &[1e8, 1.0]).len(), 1);
    assert_eq!(orders("fn f(x: f32, y: f32, z: f32) -> f32 { return x + y * z; }", &[1.0, 3.0, 0.1]).len(), 1);
}

fn of_one(source: &'static str, exact: fn(f64) -> f64, mirror: fn(f32) -> f32) -> (Formula, &'static str) {
    let exact = move |x: f64| -> f64 { exact(x) };
    (formula("test", "f", mirror, exact, |draws| (draws.between(0.5, 4.0),)).build(), source)
}

/// Returns the ratio of the worst error to the allowed error.
fn worst((formula, source): &(Formula, &'static str), bound: &str) -> f64 {
    let bounds = parse_bounds(bound).expect("bounds");
    let tolerance = Tolerance::new(&formula.arguments, &formula.result, &bounds);
    let settings = Settings { cases: 2_000, seed: 7 };
    let found = examine(formula, (source, "test.wgsl"), &tolerance, settings, Reassociation::Written, &[])
        .expect("runs")
        .examination;
    assert_eq!(found.holds(), found.report.worst_ratio <= 1.0);
    found.report.worst_ratio
}

#[test]
fn an_amplifier_is_flagged_and_an_exact_function_is_not() {
    // The difference keeps the product's rounding, a million times as large.
    let amplifier = of_one(
        "fn f(x: f32) -> f32 { return (x * 1.1 - x) * 1e6; }",
        |x| (x * f64::from(1.1f32) - x) * 1e6,
        |x| (x * 1.1 - x) * 1e6,
    );
    assert!(worst(&amplifier, "12 ulp") > 1.2);
    assert!(worst(&amplifier, "40 ulp") <= 1.0);
    let exact =
        of_one("fn f(x: f32) -> f32 { return abs(max(x * 4.0, 2.0) - 0.5 * x * 0.0); }", |x| 4.0 * x, |x| 4.0 * x);
    assert_eq!(worst(&exact, "0 ulp"), 0.0);
    // A quotient of equal numbers may differ from 1.
    let quotient = of_one("fn f(x: f32) -> f32 { return x / x; }", |_| 1.0, |_| 1.0);
    assert!(worst(&quotient, "0 ulp") > 1.0 && worst(&quotient, "2.5 ulp") <= 1.0);
}

/// Chance rarely meets the worst result; a climb finds it.
#[test]
fn a_climb_finds_what_chance_does_not() {
    let source = "
        fn f(x: f32) -> f32 {
            var product = x;
            for (var i = 0; i < 16; i++) { product = product * 1.1 / 1.1; }
            return product;
        }";
    let program = program(source);
    let error =
        |key: u64| (f64::from(run(&program, towards(Direction::Extreme), key, &[1.3])) - f64::from(1.3f32)).abs();
    let by_chance = (0..200).map(error).fold(0.0, f64::max);
    let (formula, _) = of_one("", |x| x, |x| x);
    let bounds = parse_bounds("1 ulp").expect("bounds");
    let tolerance = Tolerance::new(&formula.arguments, &formula.result, &bounds);
    let found = super::climb::worst(&program, &formula, &tolerance, 3, &[vec![1.3f32.to_bits()]]);
    let worst = found.expect("ends").expect("a row");
    let climbed = (f64::from(f32::from_bits(worst.result[0])) - formula.exact(&worst.arguments)[0]).abs();
    assert!(climbed > 1.5 * by_chance, "{climbed:e} against {by_chance:e}");
}

#[test]
fn what_the_standard_does_not_state_is_named() {
    let assumed = |source: &str, arguments: &[f32]| -> Vec<Assumption> {
        let (program, mut device) = (program(source), Device::new(Mode::IDENTITY, 0));
        let words: Vec<u32> = arguments.iter().map(|argument| argument.to_bits()).collect();
        let mut registers: Registers = program.registers().expect("runs");
        program.run_in(&mut registers, &words, &mut device, &mut Vec::new()).expect("ends");
        device.assumptions().iter().copied().collect()
    };
    let root = "fn f(x: f32) -> f32 { return sqrt(x); }";
    assert_eq!(assumed(root, &[0.0]), [Assumption::Root]);
    assert_eq!(assumed(root, &[1.0]), []);
    assert_eq!(assumed("fn f(x: f32) -> f32 { return 1.0 / x; }", &[1e38]), [Assumption::Quotient]);
    assert_eq!(assumed("fn f(x: f32) -> f32 { return sin(x); }", &[4.0]), [Assumption::Wave]);
    assert_eq!(assumed("fn f(x: f32) -> f32 { return pow(x, 2.0); }", &[0.0]), [Assumption::Power]);
    assert_eq!(assumed("fn f(x: f32) -> f32 { return atan2(x, 1.0); }", &[0.0]), [Assumption::Angle]);
}

#[test]
fn a_quotient_by_more_than_the_range_may_be_nothing() {
    let program = program("fn f(x: f32, y: f32) -> f32 { return x / y; }");
    let flushing = Mode { flushes: Habit::Always, ..Mode::IDENTITY };
    let quotient = |mode: Mode, divisor: f32| run(&program, mode, 0, &[1.5e38, divisor]);
    assert_eq!(quotient(flushing, 1e38), 0.0);
    assert_eq!(quotient(Mode::IDENTITY, 1e38), 1.5);
    // The last divisor whose reciprocal is normal.
    assert_eq!(quotient(flushing, 2f32.powi(126)), 1.5e38 / 2f32.powi(126));
}
