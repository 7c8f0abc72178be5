//! The largest of several values, which may include NaNs.

/// Returns the larger of two values, or NaN if either is NaN. `f64::max` would drop the NaN; here
/// the largest of several errors is then NaN, and no bound holds.
pub fn larger<Value: PartialOrd + Copy>(one: Value, other: Value) -> Value {
    // A NaN compares with nothing, not even itself.
    if one > other || one.partial_cmp(&one).is_none() { one } else { other }
}

/// Returns the largest of several non-negative values: NaN if one is NaN, 0 if there are no values.
pub fn largest<Value: PartialOrd + Copy + Default>(values: impl IntoIterator<Item = Value>) -> Value {
    values.into_iter().fold(Value::default(), larger)
}

#[cfg(test)]
mod tests {
    use super::{larger, largest};

    #[test]
    fn a_nan_stays() {
        for values in [[1.0, f64::NAN, 2.0], [f64::NAN, 1.0, 2.0], [1.0, 2.0, -f64::NAN]] {
            assert!(largest(values).is_nan(), "{values:?}");
        }
        assert_eq!((largest([1.0f32, 3.0, 2.0]), largest([0.0; 0])), (3.0, 0.0));
        assert_eq!(larger(-0.5, -2.0), -0.5);
    }
}
