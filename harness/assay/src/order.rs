//! Floats in their order, as whole numbers.

/// Maps a float's bits to a number that grows with the float and keeps both zeros apart.
pub(crate) fn ordered(bits: u32) -> u32 {
    if bits >> 31 == 0 { bits | 0x8000_0000 } else { !bits }
}

/// Maps such a number back to the float's bits.
pub(crate) fn unordered(number: u32) -> u32 {
    if number >> 31 == 1 { number & 0x7fff_ffff } else { !number }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_grow_with_their_floats() {
        let floats = [f32::MIN, -1.0, -f32::from_bits(1), -0.0, 0.0, f32::from_bits(1), 1.0, f32::MAX];
        let numbers = floats.map(|float| ordered(float.to_bits()));
        assert!(numbers.is_sorted_by(|one, next| one < next), "{numbers:?}");
        assert_eq!(numbers.map(unordered), floats.map(f32::to_bits));
    }
}
