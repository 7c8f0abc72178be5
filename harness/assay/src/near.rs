//! Comparison of numbers in invariants and promises.

/// Checks that `value` lies within `bound` of `wanted`; the error message gives all three.
pub fn near(what: &str, value: f64, wanted: f64, bound: f64) -> Result<(), String> {
    // Written so that a NaN does not pass.
    if (value - wanted).abs() <= bound { Ok(()) } else { Err(format!("{what} is {value}, not {wanted} ± {bound:e}")) }
}
