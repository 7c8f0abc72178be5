//! The measured accuracy of lapidary's reference device, as a device's accuracy.

use super::measured::{Measured, Report};
use super::unary;
use lapidary_assay::interpreter::{Exact, Float, Slack};
use lapidary_assay::slack::allowance::{Accuracy, Wgsl};

/// Measured accuracy of lapidary's reference device: `docs/measurements/lavapipe/builtins.json`.
#[derive(Debug)]
pub struct Lavapipe {
    report: Report,
}

impl Lavapipe {
    /// Returns the contents of the record.
    ///
    /// # Errors
    /// Returns an error if it is not such a record.
    pub fn recorded() -> Result<Lavapipe, serde_json::Error> {
        let text = include_str!("../../../../docs/measurements/lavapipe/builtins.json");
        Ok(Lavapipe { report: serde_json::from_str(text)? })
    }

    /// Returns the row of a function for an argument; `None` if it was not measured.
    fn of(&self, function: Float, argument: f32) -> Option<&Measured> {
        let name = unary::name(function);
        let range = unary::range(function, argument);
        self.report.rows.iter().find(|row| row.name == name && range.is_none_or(|range| row.range == range))
    }
}

impl Accuracy for Lavapipe {
    fn reach(&self, function: Option<(Float, f32)>, exact: Exact, slack: Slack) -> f64 {
        let wgsl = Wgsl.reach(function, exact, slack);
        if wgsl == 0.0 {
            return 0.0;
        }
        let unit = lapidary_assay::tolerance::ulp_of(exact.value);
        // Sums, products and quotients are rounded to the nearest float: the record says so too.
        let measured = function.and_then(|(function, argument)| self.of(function, argument)).map_or(0.0, |row| {
            let by_share = row.of_wgsl.map_or(f64::INFINITY, |share| share * wgsl);
            (row.max_ulp * unit).min(row.max_absolute).min(by_share)
        });
        measured.max(0.5 * unit)
    }
}
