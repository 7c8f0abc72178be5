//! FLIP, the difference of two pictures as an observer sees it who flips between them.
//!
//! This is LDR-FLIP, for pictures as displayed: P. Andersson, J. Nilsson, T. Akenine-Möller, M. Oskarsson,
//! K. Åström and M. D. Fairchild, "FLIP: A Difference Evaluator for Alternating Images", Proceedings of the ACM on
//! Computer Graphics and Interactive Techniques 3(2), 2020 (High Performance Graphics). Each pixel's error goes from
//! 0, no visible difference, to 1. Filters follow the sensitivity of the eye, at [`PIXELS_PER_DEGREE`].
//!
//! ```
//! let (reference, test) = ([200, 100, 50, 200, 100, 50], [200, 100, 50, 190, 100, 50]);
//! let errors = lapidary_flip::flip((2, 1), &reference, &test);
//! assert!(errors[0] < errors[1]);
//! assert_eq!(lapidary_flip::mean(&lapidary_flip::flip((2, 1), &reference, &reference)), 0.0);
//! ```

mod color;
mod filter;
mod magma;
mod rows;

pub use magma::magma;

use color::{hyab, perceived};
use filter::{Features, Sensitivity};
use rows::{Row, Rows};

/// Pixels per degree of visual angle: a display 0.7 m wide of 3840 pixels, seen from 0.7 m, as in the paper.
pub const PIXELS_PER_DEGREE: f32 = 67.0;

// Source of the constants: Andersson et al. 2020, colour metric (q_c, p_c, p_t) and feature metric (q_f).

/// Exponent that compresses large differences of colour.
const COLOR_EXPONENT: f32 = 0.7;
/// Share of the largest difference of colour that is mapped to [`KNEE_ERROR`].
const KNEE: f32 = 0.4;
/// Error of a difference of colour at the knee. All larger ones share the rest.
const KNEE_ERROR: f32 = 0.95;
/// Exponent that raises small differences of features.
const FEATURE_EXPONENT: f32 = 0.5;

/// Returns the error of each pixel, 0 to 1, row by row from the top, of a test picture against a reference. Both are
/// sRGB, row by row, 3 bytes a pixel, of this width and height. Exchanging them changes nothing. Beyond the edges,
/// pictures go on as at the edge. Without pixels there are no errors.
///
/// Source: Andersson et al. 2020, with the filters separated as in NVIDIA's implementation.
///
/// # Panics
/// Panics if a picture does not have `3 * width * height` bytes.
pub fn flip((width, height): (u32, u32), reference: &[u8], test: &[u8]) -> Vec<f32> {
    let (width, height) = (width as usize, height as usize);
    for (which, picture) in [("reference", reference), ("test picture", test)] {
        let bytes = picture.len();
        assert_eq!(bytes, 3 * width * height, "the {which} has {bytes} bytes for {width} x {height} pixels");
    }
    if width * height == 0 {
        return Vec::new();
    }
    let sensitivity = Sensitivity::new(PIXELS_PER_DEGREE);
    let features = Features::new(PIXELS_PER_DEGREE);
    let range = ColorRange::new();
    let [reference, test] = [reference, test].map(|picture| Rows::new(picture, width, &sensitivity, &features));
    let mut seen = [(); 2].map(|()| Row::new(width));
    let mut errors = vec![0.0; width * height];
    for (y, errors) in errors.chunks_exact_mut(width).enumerate() {
        for (row, rows) in seen.iter_mut().zip([&reference, &test]) {
            rows.filter_columns(y, &sensitivity, &features, row);
        }
        let [reference, test] = &seen;
        for (x, error) in errors.iter_mut().enumerate() {
            let color = range.error(hyab(reference.color(x), test.color(x)));
            *error = combined(color, feature_error(reference.features(x), test.features(x)));
        }
    }
    errors
}

/// Returns the mean of errors, 0 if there are none: how the paper's authors pool a picture into one number. All
/// pixels weigh the same.
pub fn mean(errors: &[f32]) -> f32 {
    let sum: f64 = errors.iter().map(|error| f64::from(*error)).sum();
    (sum / errors.len().max(1) as f64) as f32
}

/// The range of compressed differences of colour: 0 to `largest`, with a knee between.
struct ColorRange {
    knee: f32,
    largest: f32,
}

impl ColorRange {
    /// The largest difference in the gamut of sRGB is that of green and blue.
    fn new() -> Self {
        let [green, blue] = [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(perceived);
        let largest = hyab(green, blue).powf(COLOR_EXPONENT);
        Self { knee: KNEE * largest, largest }
    }

    /// Maps a difference of colour to 0 to 1.
    fn error(&self, difference: f32) -> f32 {
        let compressed = difference.powf(COLOR_EXPONENT);
        if compressed < self.knee {
            return KNEE_ERROR / self.knee * compressed;
        }
        let beyond = (compressed - self.knee) / (self.largest - self.knee);
        // Rounding may exceed the largest.
        KNEE_ERROR + (1.0 - KNEE_ERROR) * beyond.min(1.0)
    }
}

/// Maps the difference of two edges and two points to 0 to 1.
fn feature_error([edge, point]: [f32; 2], [other_edge, other_point]: [f32; 2]) -> f32 {
    let largest = (edge - other_edge).abs().max((point - other_point).abs());
    // A derivative reaches 1 along x and along y, so √2 together, which rounding may exceed.
    (largest * std::f32::consts::FRAC_1_SQRT_2).min(1.0).powf(FEATURE_EXPONENT)
}

/// Raises a difference of colour where features differ too.
fn combined(color: f32, feature: f32) -> f32 {
    color.powf(1.0 - feature)
}
