//! Nearness of numbers, as invariants and promises ask for it.

/// Passes where `value` lies within `bound` of `wanted`; the message says by how much it does not.
pub fn near(what: &str, value: f64, wanted: f64, bound: f64) -> Result<(), String> {
    // Written so that a NaN does not pass.
    if (value - wanted).abs() <= bound { Ok(()) } else { Err(format!("{what} is {value}, not {wanted} ± {bound:e}")) }
}
