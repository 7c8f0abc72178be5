//! Accuracy of a device's built-in functions: those of one float over all floats, and those of two,
//! as well as the rounding of sums and products, on samples.

mod binary;
pub mod command;
mod page;
mod unary;

pub use page::{side_by_side, text};

use lapidary_assay::dispatch::DispatchError;
use lapidary_assay::interpreter::{Exact, Float, Slack};
use lapidary_assay::runner::Runner;
use lapidary_assay::slack::allowance::{Accuracy, Wgsl};
use serde::{Deserialize, Serialize};

/// Creates the runner for a function of WGSL source.
pub type Start<'a> = &'a dyn Fn(&str, &str) -> Result<Box<dyn Runner + 'a>, DispatchError>;

/// Measurements of a built-in over a range of its argument.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// The built-in's name in WGSL, or the expression of an infix operator.
    pub name: String,
    /// Description of the range of arguments.
    pub range: String,
    /// Number of arguments tried.
    pub inputs: u64,
    /// Number of results that are not the nearest float.
    pub not_nearest: u64,
    /// Largest error in units in the last place of the exact value, where that is a normal float.
    pub max_ulp: f64,
    /// The argument with that error; two for a function of two.
    pub at: Vec<f32>,
    /// Largest absolute error.
    pub max_absolute: f64,
    /// Largest ratio of the error to the one that WGSL allows; `None` if WGSL states none for the
    /// range.
    pub of_wgsl: Option<f64>,
    /// The argument with that ratio.
    pub of_wgsl_at: Vec<f32>,
    /// Number of subnormal results that were flushed to zero.
    pub flushed: u64,
    /// Number of non-finite results whose exact value is within the range of floats.
    pub nonfinite: u64,
}

impl Measured {
    fn new(name: &str, range: &str, is_stated: bool) -> Self {
        Self {
            name: name.to_owned(),
            range: range.to_owned(),
            inputs: 0,
            not_nearest: 0,
            max_ulp: 0.0,
            at: Vec::new(),
            max_absolute: 0.0,
            of_wgsl: is_stated.then_some(0.0),
            of_wgsl_at: Vec::new(),
            flushed: 0,
            nonfinite: 0,
        }
    }

    /// Adds a result; `reach` returns the error that WGSL allows, `None` if WGSL states none.
    #[inline(always)]
    fn add(&mut self, arguments: &[f32], result: f32, exact: f64, reach: impl FnOnce() -> Option<f64>) {
        self.inputs += 1;
        // The adjacent float may be an infinity.
        if exact.is_nan() || exact.abs() >= f64::from(f32::MAX) {
            return;
        }
        if !result.is_finite() {
            self.nonfinite += 1;
            return;
        }
        let nearest = exact as f32;
        if result == nearest {
            // Half a unit is due to rounding.
            let error = (f64::from(result) - exact).abs();
            self.max_absolute = self.max_absolute.max(error);
            return;
        }
        self.not_nearest += 1;
        if exact != 0.0 && exact.abs() < f64::from(f32::MIN_POSITIVE) && result == 0.0 {
            self.flushed += 1;
            return;
        }
        let error = (f64::from(result) - exact).abs();
        self.max_absolute = self.max_absolute.max(error);
        let ulps = error / lapidary_assay::tolerance::ulp_of(exact);
        if exact.abs() >= f64::from(f32::MIN_POSITIVE) && ulps > self.max_ulp {
            self.max_ulp = ulps;
            self.at = arguments.to_vec();
        }
        if let (Some(reach), Some(share)) = (reach(), &mut self.of_wgsl)
            && error / reach > *share
        {
            // JSON has no infinity.
            *share = (error / reach).min(f64::MAX);
            self.of_wgsl_at = arguments.to_vec();
        }
    }

    fn join(mut self, other: Measured) -> Measured {
        if other.max_ulp > self.max_ulp {
            self.max_ulp = other.max_ulp;
            self.at = other.at;
        }
        self.inputs += other.inputs;
        self.not_nearest += other.not_nearest;
        self.max_absolute = self.max_absolute.max(other.max_absolute);
        if other.of_wgsl > self.of_wgsl {
            self.of_wgsl = other.of_wgsl;
            self.of_wgsl_at = other.of_wgsl_at;
        }
        self.flushed += other.flushed;
        self.nonfinite += other.nonfinite;
        self
    }
}

/// The measurements of a device.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// The device and its driver.
    pub adapter: String,
    /// Distance between the bit patterns tried by functions of one float.
    pub stride: u32,
    /// One row per built-in and range.
    pub rows: Vec<Measured>,
}

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
