//! Settings of a run from the environment: its seed and its device.

use lapidary_gpu::{AdapterChoice, Gpu, GpuError};
use std::io::Write as _;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Variable that overrides the seed: a whole number, as a failure prints it.
pub const SEED_VARIABLE: &str = "ASSAY_SEED";
/// Variable that, set to `skip`, lets tests pass without an adapter, with a message.
pub const WITHOUT_ADAPTER_VARIABLE: &str = "ASSAY_WITHOUT_ADAPTER";

/// Returns the seed that the environment names.
///
/// # Errors
/// Returns an error if its value is no whole number.
pub fn seed() -> Result<Option<u64>, String> {
    let Some(seed) = std::env::var_os(SEED_VARIABLE) else { return Ok(None) };
    let seed = seed.to_str().and_then(|seed| seed.parse().ok());
    seed.map(Some).ok_or_else(|| format!("{SEED_VARIABLE} is no whole number"))
}

/// Returns the device that the environment names. Without an adapter, if tests may be skipped,
/// returns `None` and counts the skipped test on standard error.
///
/// # Errors
/// Returns an error if there is no such device.
pub fn gpu(function: &str) -> Result<Option<&'static Gpu>, GpuError> {
    static SKIPPED: AtomicUsize = AtomicUsize::new(0);
    match Gpu::shared(&AdapterChoice::from_environment()) {
        Ok(gpu) => Ok(Some(gpu)),
        Err(GpuError::NoAdapter { .. })
            if std::env::var_os(WITHOUT_ADAPTER_VARIABLE).is_some_and(|value| value == "skip") =>
        {
            let number = SKIPPED.fetch_add(1, Ordering::Relaxed) + 1;
            // Written to the stream itself, since the output of a passing test is not shown.
            let _ = writeln!(
                std::io::stderr(),
                "assay: {function} was not tested: no adapter, and {WITHOUT_ADAPTER_VARIABLE}=skip ({number} so far)"
            );
            Ok(None)
        }
        Err(error) => Err(error),
    }
}
