//! What the formulas of both files need.

/// Name of the module.
pub(super) const M: &str = "split_sum";

/// Room for rounding on any device in a result of at most 1.
pub(super) const ROUNDED: f64 = 1e-5;
