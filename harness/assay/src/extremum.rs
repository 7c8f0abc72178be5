//! The largest of values that may be no numbers.

/// The larger of two; NaN where one of them is NaN, which `f64::max` drops: the largest of some errors is then NaN, and no bound holds.
pub fn larger<Value: PartialOrd + Copy>(one: Value, other: Value) -> Value {
    // A NaN compares with nothing, itself included.
    if one > other || one.partial_cmp(&one).is_none() { one } else { other }
}

/// The largest of values none of which is negative; NaN where one is, and 0 where there are none.
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
