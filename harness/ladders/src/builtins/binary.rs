//! Built-ins and operators of two and three floats, measured on samples.

use super::measured::{Measured, Start};
use lapidary_assay::dispatch::DispatchError;
use lapidary_assay::draws::mix;
use lapidary_assay::interpreter::{Float, Slack};
use lapidary_assay::slack::allowance::{Accuracy as _, Wgsl};
use rayon::prelude::*;

/// A function of up to three floats.
struct Sampled {
    name: &'static str,
    /// Its WGSL expression in `x`, `y` and `z`.
    expression: &'static str,
    function: Option<Float>,
    exact: fn([f32; 3]) -> f64,
    /// Returns the largest error that WGSL allows; `None` if the row measures something else.
    reach: fn([f32; 3], f64) -> Option<f64>,
    /// Number of arguments that the function uses.
    arguments: usize,
    draw: Draw,
}

/// How arguments are sampled.
#[derive(Clone, Copy)]
enum Draw {
    /// Random bit patterns.
    Bits,
    /// Magnitudes from 2^-16 to 2^16, so that the terms of sums and products are comparable.
    Sizes,
    /// A positive base, and an exponent such that the power is within the range of floats.
    Power,
}

const SAMPLES: u64 = 1 << 24;

/// Rows per dispatch.
const ROWS: u64 = 1 << 16;

fn wide([x, y, z]: [f32; 3]) -> [f64; 3] {
    [x.into(), y.into(), z.into()]
}

const SAMPLED: [Sampled; 8] = [
    Sampled {
        name: "x + y",
        expression: "x + y",
        function: None,
        exact: |row| wide(row)[0] + wide(row)[1],
        reach: |_, exact| Some(Wgsl.reach(None, exact.into(), Slack::Rounded)),
        arguments: 2,
        draw: Draw::Sizes,
    },
    Sampled {
        name: "x * y",
        expression: "x * y",
        function: None,
        exact: |row| wide(row)[0] * wide(row)[1],
        reach: |_, exact| Some(Wgsl.reach(None, exact.into(), Slack::Rounded)),
        arguments: 2,
        draw: Draw::Bits,
    },
    Sampled {
        name: "x / y",
        expression: "x / y",
        function: None,
        exact: |row| wide(row)[0] / wide(row)[1],
        // For other divisors WGSL states nothing.
        reach: |[_, y, _], exact| (y.abs() <= 2f32.powi(126)).then(|| Wgsl.reach(None, exact.into(), Slack::Ulps(2.5))),
        arguments: 2,
        draw: Draw::Bits,
    },
    Sampled {
        name: "x * y + z, unfused",
        expression: "x * y + z",
        function: None,
        exact: |[x, y, z]| f64::from(x * y) + f64::from(z),
        reach: |_, _| None,
        arguments: 3,
        draw: Draw::Sizes,
    },
    Sampled {
        name: "x * y + z, fused",
        expression: "x * y + z",
        function: None,
        exact: |row| wide(row)[0].mul_add(wide(row)[1], wide(row)[2]),
        reach: |_, _| None,
        arguments: 3,
        draw: Draw::Sizes,
    },
    Sampled {
        name: "fma, unfused",
        expression: "fma(x, y, z)",
        function: None,
        exact: |[x, y, z]| f64::from(x * y) + f64::from(z),
        reach: |_, _| None,
        arguments: 3,
        draw: Draw::Sizes,
    },
    Sampled {
        name: "pow",
        expression: "pow(x, y)",
        function: Some(Float::Pow),
        exact: |row| wide(row)[0].powf(wide(row)[1]),
        reach: |row, exact| Some(power(row, exact)),
        arguments: 2,
        draw: Draw::Power,
    },
    Sampled {
        name: "atan2",
        expression: "atan2(x, y)",
        function: Some(Float::Atan2),
        exact: |row| wide(row)[0].atan2(wide(row)[1]),
        reach: |_, exact| Some(Wgsl.reach(None, exact.into(), Slack::Ulps(4096.0))),
        arguments: 2,
        draw: Draw::Sizes,
    },
];

/// Returns the error bound of exp2(y log2(x)): the errors of the logarithm and the product
/// propagate through the power.
fn power([x, y, _]: [f32; 3], exact: f64) -> f64 {
    let (logarithm, slack) = Float::Log2.exact(x, x);
    let product = f64::from(y) * logarithm;
    let exponent = Wgsl.reach(None, logarithm.into(), slack) * f64::from(y).abs()
        + Wgsl.reach(None, product.into(), Slack::Rounded);
    let (_, last) = Float::Exp2.exact(product as f32, 0.0);
    // Not only to first order, since the exponent's error may be large.
    exact * (exponent.exp2() - 1.0) + Wgsl.reach(None, exact.into(), last) * exponent.exp2()
}

pub(super) fn count() -> usize {
    SAMPLED.len()
}

pub(super) fn name(function: Float) -> &'static str {
    SAMPLED.iter().find(|sampled| sampled.function == Some(function)).map_or("", |sampled| sampled.name)
}

impl Draw {
    fn row(self, index: u64) -> [f32; 3] {
        let bits = |place: u64| mix(index ^ mix(place));
        let share = |place: u64| (bits(place) >> 40) as f32 / 16_777_216.0;
        let size = |place: u64| {
            let float =
                f32::from_bits(0x3f80_0000 | (bits(place) >> 41) as u32) * 2f32.powi((bits(place) & 31) as i32 - 16);
            if bits(place) >> 8 & 1 == 0 { float } else { -float }
        };
        let normal = |place: u64| {
            let float = f32::from_bits(bits(place) as u32);
            if float.is_normal() { float } else { 1.0 }
        };
        match self {
            Draw::Bits => [0, 1, 2].map(normal),
            Draw::Sizes => [0, 1, 2].map(size),
            Draw::Power => {
                let base = normal(0).abs();
                let most = 120.0 / base.log2().abs().max(1e-3);
                [base, (2.0 * share(1) - 1.0) * most, 0.0]
            }
        }
    }
}

pub(super) fn measure(start: Start<'_>, tick: &dyn Fn(&str)) -> Result<Vec<Measured>, DispatchError> {
    let mut rows = Vec::new();
    for sampled in &SAMPLED {
        tick(sampled.name);
        let source = format!("fn sampled(x: f32, y: f32, z: f32) -> f32 {{\n    return {};\n}}\n", sampled.expression);
        let mut runner = start(&source, "sampled")?;
        let is_stated = (sampled.reach)([1.0; 3], 1.0).is_some();
        let mut found = Measured::new(sampled.name, "sampled", is_stated);
        let mut results = Vec::new();
        for batch in (0..SAMPLES).step_by(ROWS as usize) {
            let inputs: Vec<[f32; 3]> =
                (batch..batch + ROWS).into_par_iter().map(|row| sampled.draw.row(row)).collect();
            let arguments: Vec<u32> = inputs.iter().flatten().map(|float| float.to_bits()).collect();
            runner.run(&arguments, &mut results)?;
            let part = inputs
                .par_chunks(4_096)
                .zip(results.par_chunks(4_096))
                .map(|(inputs, words)| {
                    let mut part = Measured::new(sampled.name, "sampled", is_stated);
                    for (row, word) in inputs.iter().zip(words) {
                        let exact = (sampled.exact)(*row);
                        let reach = || (sampled.reach)(*row, exact);
                        part.add(&row[..sampled.arguments], f32::from_bits(*word), exact, reach);
                    }
                    part
                })
                .reduce(|| Measured::new(sampled.name, "sampled", is_stated), Measured::join);
            found = found.join(part);
        }
        rows.push(found);
    }
    Ok(rows)
}
