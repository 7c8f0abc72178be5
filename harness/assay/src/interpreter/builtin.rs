//! WGSL's built-in functions, each as accurate as WGSL says; what inherits its error from an expression is that expression.

use super::Stopped;
use super::machine::{Machine, Site, Slack};
use naga::{MathFunction as Fun, ScalarKind};

/// Appends the result of a built-in function.
pub(super) fn builtin(
    fun: Fun,
    kind: Option<ScalarKind>,
    arguments: &[&[u32]],
    site: Site,
    machine: &mut impl Machine,
    out: &mut Vec<u32>,
) -> Result<(), Stopped> {
    if kind != Some(ScalarKind::Float) {
        return integer(fun, kind == Some(ScalarKind::Sint), arguments, out);
    }
    let value = |argument: usize, index: usize| -> f32 {
        let words = arguments[argument];
        f32::from_bits(words[index % words.len()])
    };
    let vector =
        |argument: usize| -> Vec<f32> { arguments[argument].iter().map(|word| f32::from_bits(*word)).collect() };
    let mut push = |value: f32| out.push(value.to_bits());
    match fun {
        Fun::Dot => push(dot(&vector(0), &vector(1), machine)),
        Fun::Length => push(length(&vector(0), machine)),
        Fun::Distance => {
            let apart: Vec<f32> =
                (0..arguments[0].len()).map(|i| subtract(value(0, i), value(1, i), machine)).collect();
            push(length(&apart, machine));
        }
        Fun::Normalize => {
            let length = length(&vector(0), machine);
            vector(0).iter().for_each(|x| push(divide(*x, length, machine)));
        }
        Fun::Cross => {
            let (a, b) = (vector(0), vector(1));
            for (i, j) in [(1, 2), (2, 0), (0, 1)] {
                let (one, other) = (multiply(a[i], b[j], machine), multiply(a[j], b[i], machine));
                push(subtract(one, other, machine));
            }
        }
        Fun::Reflect => {
            let twice = 2.0 * dot(&vector(1), &vector(0), machine);
            for i in 0..arguments[0].len() {
                let part = multiply(twice, value(1, i), machine);
                push(subtract(value(0, i), part, machine));
            }
        }
        Fun::Refract => {
            let (incident, normal, eta) = (vector(0), vector(1), value(2, 0));
            let cosine = dot(&normal, &incident, machine);
            let squared = multiply(cosine, cosine, machine);
            let rest = multiply(eta, multiply(eta, subtract(1.0, squared, machine), machine), machine);
            let radicand = subtract(1.0, rest, machine);
            machine.decided(site, u32::from(radicand < 0.0));
            let root = machine.round(f64::from(radicand.max(0.0)).sqrt(), Slack::Root);
            let along = add(multiply(eta, cosine, machine), root, machine);
            for (x, n) in incident.iter().zip(&normal) {
                let (one, other) = (multiply(eta, *x, machine), multiply(along, *n, machine));
                let refracted = subtract(one, other, machine);
                push(if radicand < 0.0 { 0.0 } else { refracted });
            }
        }
        _ => {
            for index in 0..arguments.iter().map(|words| words.len()).max().unwrap_or(0) {
                let operands: Vec<f32> = (0..arguments.len()).map(|argument| value(argument, index)).collect();
                let result = scalar(fun, &operands, site, machine);
                push(result.ok_or_else(|| Stopped(format!("cannot evaluate {fun:?} on the CPU")))?);
            }
        }
    }
    Ok(())
}

fn add(a: f32, b: f32, machine: &mut impl Machine) -> f32 {
    machine.round(f64::from(a) + f64::from(b), Slack::Rounded)
}

fn subtract(a: f32, b: f32, machine: &mut impl Machine) -> f32 {
    machine.round(f64::from(a) - f64::from(b), Slack::Rounded)
}

fn multiply(a: f32, b: f32, machine: &mut impl Machine) -> f32 {
    machine.round(f64::from(a) * f64::from(b), Slack::Rounded)
}

fn divide(a: f32, b: f32, machine: &mut impl Machine) -> f32 {
    machine.round(f64::from(a) / f64::from(b), Slack::Ulps(2.5))
}

fn dot(a: &[f32], b: &[f32], machine: &mut impl Machine) -> f32 {
    let mut sum = multiply(a[0], b[0], machine);
    for (a, b) in a.iter().zip(b).skip(1) {
        let product = multiply(*a, *b, machine);
        sum = add(sum, product, machine);
    }
    sum
}

fn length(vector: &[f32], machine: &mut impl Machine) -> f32 {
    let squared = dot(vector, vector, machine);
    machine.round(f64::from(squared).sqrt(), Slack::Root)
}

/// A function of floats, component by component.
fn scalar(fun: Fun, operands: &[f32], site: Site, machine: &mut impl Machine) -> Option<f32> {
    let x = operands[0];
    let exact = f64::from(x);
    let other = operands.get(1).copied().unwrap_or(0.0);
    // Near 1 the logarithm is 0: there it may be off absolutely.
    let logarithm = if (0.5..=2.0).contains(&x) { Slack::Absolute(2f64.powi(-21)) } else { Slack::Ulps(3.0) };
    let power = |x: f64| Slack::Ulps(3.0 + 2.0 * x.abs());
    let mut whole = |value: f32| {
        machine.decided(site, value.to_bits());
        value
    };
    Some(match fun {
        Fun::Abs => x.abs(),
        Fun::Sign => {
            let sign = if x == 0.0 { 0.0 } else { x.signum() };
            whole(sign)
        }
        Fun::Floor => whole(x.floor()),
        Fun::Ceil => whole(x.ceil()),
        Fun::Round => whole(x.round_ties_even()),
        Fun::Trunc => whole(x.trunc()),
        Fun::Fract => {
            let below = whole(x.floor());
            subtract(x, below, machine)
        }
        Fun::Min => {
            machine.decided(site, u32::from(x < other));
            x.min(other)
        }
        Fun::Max => {
            machine.decided(site, u32::from(x > other));
            x.max(other)
        }
        Fun::Clamp => clamp(x, other, operands[2], site, machine),
        Fun::Saturate => clamp(x, 0.0, 1.0, site, machine),
        Fun::Sqrt => machine.round(exact.sqrt(), Slack::Root),
        Fun::InverseSqrt => machine.round(1.0 / exact.sqrt(), Slack::Ulps(2.0)),
        Fun::Exp => machine.round(exact.exp(), power(exact)),
        Fun::Exp2 => machine.round(exact.exp2(), power(exact)),
        Fun::Log => machine.round(exact.ln(), logarithm),
        Fun::Log2 => machine.round(exact.log2(), logarithm),
        Fun::Pow => {
            let base = machine.round(exact.log2(), logarithm);
            let exponent = f64::from(multiply(other, base, machine));
            machine.round(exponent.exp2(), power(exponent))
        }
        Fun::Sin => machine.round(exact.sin(), Slack::Absolute(2f64.powi(-11))),
        Fun::Cos => machine.round(exact.cos(), Slack::Absolute(2f64.powi(-11))),
        Fun::Tan => {
            let sine = machine.round(exact.sin(), Slack::Absolute(2f64.powi(-11)));
            let cosine = machine.round(exact.cos(), Slack::Absolute(2f64.powi(-11)));
            divide(sine, cosine, machine)
        }
        Fun::Asin => machine.round(exact.asin(), Slack::Absolute(6.8e-5)),
        Fun::Acos => machine.round(exact.acos(), Slack::Absolute(6.8e-5)),
        Fun::Atan => machine.round(exact.atan(), Slack::Ulps(4096.0)),
        Fun::Atan2 => machine.round(exact.atan2(f64::from(other)), Slack::Ulps(4096.0)),
        Fun::Mix => {
            let rest = subtract(1.0, operands[2], machine);
            let (one, two) = (multiply(x, rest, machine), multiply(other, operands[2], machine));
            add(one, two, machine)
        }
        Fun::Fma => {
            let product = multiply(x, other, machine);
            add(product, operands[2], machine)
        }
        Fun::Step => {
            machine.decided(site, u32::from(x <= other));
            f32::from(x <= other)
        }
        _ => return None,
    })
}

fn clamp(x: f32, low: f32, high: f32, site: Site, machine: &mut impl Machine) -> f32 {
    machine.decided(site, if x < low { 0 } else { 1 + u32::from(x > high) });
    x.max(low).min(high)
}

fn integer(fun: Fun, is_signed: bool, arguments: &[&[u32]], out: &mut Vec<u32>) -> Result<(), Stopped> {
    let pick = |a: u32, b: u32, least: bool| {
        let below = if is_signed { a.cast_signed() < b.cast_signed() } else { a < b };
        if below == least { a } else { b }
    };
    if fun == Fun::Dot {
        let products = arguments[0].iter().zip(arguments[1]).map(|(a, b)| a.wrapping_mul(*b));
        out.push(products.fold(0, u32::wrapping_add));
        return Ok(());
    }
    for index in 0..arguments[0].len() {
        let at = |argument: usize| arguments[argument][index % arguments[argument].len()];
        out.push(match fun {
            Fun::Min => pick(at(0), at(1), true),
            Fun::Max => pick(at(0), at(1), false),
            Fun::Clamp => pick(pick(at(0), at(1), false), at(2), true),
            Fun::Abs if is_signed => at(0).cast_signed().wrapping_abs().cast_unsigned(),
            Fun::Abs => at(0),
            Fun::Sign => at(0).cast_signed().signum().cast_unsigned(),
            Fun::CountOneBits => at(0).count_ones(),
            Fun::CountLeadingZeros => at(0).leading_zeros(),
            Fun::CountTrailingZeros => at(0).trailing_zeros(),
            Fun::ReverseBits => at(0).reverse_bits(),
            Fun::FirstTrailingBit if at(0) == 0 => u32::MAX,
            Fun::FirstTrailingBit => at(0).trailing_zeros(),
            Fun::FirstLeadingBit if at(0) == 0 => u32::MAX,
            Fun::FirstLeadingBit if !is_signed => 31 - at(0).leading_zeros(),
            _ => return Err(Stopped(format!("cannot evaluate {fun:?} of integers on the CPU"))),
        });
    }
    Ok(())
}
