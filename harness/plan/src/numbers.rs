//! Formats numbers for the reasons of decisions.

use glam::Vec3;

/// Formats a number to three significant digits, and one of more than nine as a power of ten.
pub(super) fn short(value: f32) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    if value.abs() >= 1e9 {
        return format!("{value:.2e}");
    }
    let digits = (2 - value.abs().log10().floor() as i32).clamp(0, 6) as usize;
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// Formats a share in percent.
pub(crate) fn percent(share: f32) -> String {
    format!("{} %", (100.0 * share).round())
}

/// Formats a colour as three numbers, or as one if its channels are the same.
pub(super) fn triple(value: Vec3) -> String {
    let [red, green, blue] = value.to_array().map(short);
    if red == green && green == blue { red } else { format!("({red}, {green}, {blue})") }
}
