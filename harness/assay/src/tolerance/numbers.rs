//! Words as numbers, their sizes and units in the last place.

use crate::shape::{Scalar, Shape};

/// An oracle on numbers.
pub type OracleFn<'a> = &'a dyn Fn(&[f64], &mut Vec<f64>);

/// Converts a word to the number that it represents.
pub fn number(scalar: Scalar, word: u32) -> f64 {
    match scalar {
        Scalar::F32 => f64::from(f32::from_bits(word)),
        Scalar::I32 => f64::from(word.cast_signed()),
        Scalar::U32 => f64::from(word),
        Scalar::Bool => f64::from(u8::from(word != 0)),
    }
}

/// Converts a value's words to the numbers that they represent.
pub fn numbers(shape: &Shape, words: &[u32]) -> Vec<f64> {
    words.iter().zip(shape.scalars()).map(|(word, scalar)| number(scalar, *word)).collect()
}

/// Converts a number to the nearest word.
pub fn word(kind: Scalar, number: f64) -> u32 {
    match kind {
        Scalar::F32 => (number as f32).to_bits(),
        Scalar::I32 => (number as i32).cast_unsigned(),
        Scalar::U32 => number as u32,
        Scalar::Bool => u32::from(number != 0.0),
    }
}

/// Returns the unit in the last place of an f32 of this size, whatever its sign; below the smallest
/// normal, the unit of the smallest normal.
pub fn ulp_of(value: f64) -> f64 {
    let magnitude = value.abs();
    if magnitude.is_nan() || magnitude < f64::from(f32::MIN_POSITIVE) {
        return 2f64.powi(-149);
    }
    // The exponent bits alone give the power of two below `magnitude`, without a logarithm per row.
    f64::from_bits(magnitude.min(f64::from(f32::MAX)).to_bits() & 0x7ff0_0000_0000_0000) * 2f64.powi(-23)
}

pub(super) fn largest(values: &[f64]) -> f64 {
    values
        .iter()
        .fold(0.0, |largest, value| if value.abs() > largest || value.is_nan() { value.abs() } else { largest })
}
