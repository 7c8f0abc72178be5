//! A smooth rise.

/// Rises from 0 at `from` to 1 at `to`, which may be the smaller, with no slope at either.
pub(crate) fn smoothstep(from: f64, to: f64, at: f64) -> f64 {
    let share = ((at - from) / (to - from)).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}
