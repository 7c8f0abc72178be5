//! How figures are shown.

/// Shows an error with three digits.
pub(super) fn figure(error: f64) -> String {
    if error >= 10.0 {
        format!("{error:.1}")
    } else if error >= 1.0 {
        format!("{error:.2}")
    } else {
        format!("{error:.3}")
    }
}
