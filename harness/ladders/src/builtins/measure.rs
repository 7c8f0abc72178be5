//! Measures the built-in functions of a device.

use super::measured::{Report, Start};
use super::{binary, unary};
use lapidary_assay::dispatch::DispatchError;

/// Measures a device; `tick` is called with the name of each function.
///
/// # Errors
/// Returns an error if the device fails.
pub fn measure(adapter: &str, start: Start<'_>, stride: u32, tick: &dyn Fn(&str)) -> Result<Report, DispatchError> {
    let mut rows = unary::measure(start, stride, tick)?;
    rows.extend(binary::measure(start, tick)?);
    Ok(Report { adapter: adapter.to_owned(), stride, rows })
}

/// Returns the number of functions for which [`measure`] calls `tick`.
pub fn count() -> usize {
    unary::BUILTINS.len() + binary::count()
}
