//! Measurements of built-in functions.

use lapidary_assay::dispatch::DispatchError;
use lapidary_assay::runner::Runner;
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
    pub(super) fn new(name: &str, range: &str, is_stated: bool) -> Self {
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
    pub(super) fn add(&mut self, arguments: &[f32], result: f32, exact: f64, reach: impl FnOnce() -> Option<f64>) {
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

    pub(super) fn join(mut self, other: Measured) -> Measured {
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
