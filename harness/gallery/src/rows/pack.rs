//! Rows as bytes: columns of 32-bit words, each split into four planes of bytes, from the lowest; then gzip and
//! base64. Bytes that mean the same lie side by side, which halves what gzip leaves.
//!
//! The columns, for n rows:
//! 1. n words for each word of the arguments.
//! 2. n numbers of cases: how many sets of results a row accepts.
//! 3. For each word of the result: n words, the expected result rounded to f32 or the integer; for a float also n
//!    signed words, what rounding took from it, in 1/256 ulp.
//! 4. For each word of the result, over all cases of all rows: for a float, by how many floats the least lies below
//!    the expected one, and by how many the greatest lies above it, signed; otherwise the word itself.
//!
//! Floats are counted in their order, in which both zeros are one.

use super::super::data;
use lapidary_assay::formula::Words;
use lapidary_assay::shape::{Scalar, Shape};
use lapidary_assay::tolerance::{Accepted, ulp_of, word};

/// Returns rows, their exact results and what they accept as gzip in base64.
pub fn packed(result: &Shape, rows: &[Words], exact: &[Vec<f64>], accepted: &[Vec<Accepted>]) -> String {
    let mut bytes = Vec::new();
    let arguments = rows.first().map_or(0, Vec::len);
    for index in 0..arguments {
        column(&mut bytes, rows.iter().map(|row| row[index]));
    }
    column(&mut bytes, accepted.iter().map(|cases| cases.len() as u32));
    for (index, scalar) in result.scalars().into_iter().enumerate() {
        column(&mut bytes, exact.iter().map(|exact| word(scalar, exact[index])));
        if scalar == Scalar::F32 {
            column(&mut bytes, exact.iter().map(|exact| lost(exact[index]).cast_unsigned()));
        }
    }
    for (index, scalar) in result.scalars().into_iter().enumerate() {
        let cases =
            || exact.iter().zip(accepted).flat_map(|(exact, cases)| cases.iter().map(move |case| (exact, case)));
        if scalar == Scalar::F32 {
            let place = |number: f64| ordered(number as f32);
            let below = cases().map(|(exact, case)| place(exact[index]).wrapping_sub(place(case.low[index])));
            column(&mut bytes, below.map(i32::cast_unsigned));
            let above = cases().map(|(exact, case)| place(case.high[index]).wrapping_sub(place(exact[index])));
            column(&mut bytes, above.map(i32::cast_unsigned));
        } else {
            column(&mut bytes, cases().map(|(_, case)| word(scalar, case.low[index])));
        }
    }
    data::packed(&bytes)
}

/// Returns what rounding to f32 takes from a number, in 1/256 ulp.
fn lost(number: f64) -> i32 {
    ((number - f64::from(number as f32)) / ulp_of(number) * 256.0).round() as i32
}

/// Returns the place of a float among all floats; 0 for both zeros.
fn ordered(value: f32) -> i32 {
    let bits = value.to_bits().cast_signed();
    if bits < 0 { i32::MIN.wrapping_sub(bits) } else { bits }
}

fn column(bytes: &mut Vec<u8>, words: impl Iterator<Item = u32> + Clone) {
    for plane in 0..4 {
        bytes.extend(words.clone().map(|word| word.to_le_bytes()[plane]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base64::Engine as _;
    use flate2::read::GzDecoder;
    use std::io::Read as _;

    #[test]
    fn floats_are_counted_across_zero() {
        assert_eq!(ordered(0.0), ordered(-0.0));
        assert_eq!(ordered(f32::from_bits(1)), 1);
        assert_eq!(ordered(-f32::from_bits(1)), -1);
        assert!(ordered(f32::MIN) < ordered(-1.0) && ordered(1.0) < ordered(f32::MAX));
    }

    #[test]
    fn what_is_lost_is_a_share_of_the_ulp() {
        assert_eq!(lost(1.0), 0);
        assert_eq!(lost(1.0 + f64::from(f32::EPSILON) / 4.0), 64);
        assert_eq!(lost(1.0 - f64::from(f32::EPSILON) / 8.0), -64);
    }

    #[test]
    fn columns_lie_in_planes() {
        let rows = [vec![0x0403_0201], vec![0x0807_0605]];
        let accepted = [1.0, 2.0].map(|number| vec![Accepted { low: vec![number], high: vec![number] }]);
        let text = packed(&Shape::Scalar(Scalar::U32), &rows, &[vec![1.0], vec![2.0]], &accepted);
        let zipped = base64::engine::general_purpose::STANDARD.decode(text).expect("base64");
        let mut bytes = Vec::new();
        GzDecoder::new(zipped.as_slice()).read_to_end(&mut bytes).expect("gzip");
        assert_eq!(bytes[..8], [1, 5, 2, 6, 3, 7, 4, 8]);
        let word = |low: [u8; 2]| [low[0], low[1], 0, 0, 0, 0, 0, 0];
        assert_eq!(bytes[8..], [word([1, 1]), word([1, 2]), word([1, 2])].concat());
    }
}
