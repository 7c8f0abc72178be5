//! Errors of a rung's function against the one that it approximates.

use crate::error::CostError;
use crate::report::Row;
use glam::{UVec2, Vec3};
use lapidary_cdrf::{self as mirror, oracle};
use lapidary_gpu::Gpu;
use lapidary_render as render;
use lapidary_render::cdrf::table::{self, Table};
use lapidary_scene::solver::{Format, Reflectance};
use rayon::prelude::*;

/// Reflectance as a function of cosine and width in radians.
pub type Function = Box<dyn Fn(f32, f32) -> f32 + Sync>;

/// Distance between two functions of the angle and the width.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// Largest difference, for angles from 0 to 180° and widths from 0 to 3, sampled more densely
    /// near the terminator at small widths.
    pub largest: f64,
    /// Root mean square over the same angles and widths, both uniform.
    pub rms: f64,
}

impl Distance {
    /// Returns the rows of a rung in a view.
    pub(super) fn rows(self, rung: &str, view: &str) -> [Row; 2] {
        [("largest", self.largest), ("rms", self.rms)].map(|(measure, value)| Row::new(rung, view, measure, value, ""))
    }
}

/// Cosine, width and exact value.
type Sample = (f32, f32, f64);

/// Exact values of a function at the sample points of the comparison.
pub struct Samples {
    /// Angles from 0 to 180° by widths from 0 to 3, both uniform; used for the root mean square.
    everywhere: Vec<Sample>,
    /// Dense samples near the terminator at small widths, where tables are least accurate; used for
    /// the largest error only.
    at_the_kink: Vec<Sample>,
}

impl Samples {
    /// Samples a function in f64.
    pub fn of(exact: impl Fn(f64, f64) -> f64 + Sync) -> Self {
        let sample = |cosine: f32, sigma: f32| (cosine, sigma, exact(cosine.into(), sigma.into()));
        let angles = (0..=360).into_par_iter().map(|index| (f64::from(index) * 0.5).to_radians().cos() as f32);
        let cosines = (-150..=150).into_par_iter().map(|index: i32| index as f32 * 0.0002);
        Self {
            everywhere: angles
                .flat_map_iter(|cosine| (0..=300).map(move |index| (cosine, index as f32 * 0.01)))
                .map(|(cosine, sigma)| sample(cosine, sigma))
                .collect(),
            at_the_kink: cosines
                .flat_map_iter(|cosine| (0..=100).map(move |index| (cosine, index as f32 * 0.0005)))
                .map(|(cosine, sigma)| sample(cosine, sigma))
                .collect(),
        }
    }

    /// Samples the convolution.
    pub fn of_the_convolution() -> Self {
        Self::of(oracle::accurate)
    }

    /// Returns the distance of `function` from the sampled one.
    pub fn distance(&self, function: impl Fn(f32, f32) -> f32) -> Distance {
        let error = |(cosine, sigma, exact): &Sample| (f64::from(function(*cosine, *sigma)) - exact).abs();
        // A NaN counts as the largest error.
        let larger = |largest: f64, error: f64| if error > largest || error.is_nan() { error } else { largest };
        let largest = self.everywhere.iter().chain(&self.at_the_kink).map(error).fold(0.0, larger);
        let squares: f64 = self.everywhere.iter().map(|sample| error(sample).powi(2)).sum();
        Distance { largest, rms: (squares / self.everywhere.len() as f64).sqrt() }
    }
}

/// Bakes a table with this many texels per side and the tint (1, 1, 1).
///
/// # Errors
/// Returns an error if the device fails while baking it.
pub fn baked(gpu: &Gpu, side: u32, format: Format) -> Result<Table, CostError> {
    let size = UVec2::splat(side);
    let texels = table::bake(gpu, size, Vec3::ONE).map_err(render::RenderError::from)?;
    Ok(Table::new(size, format, &texels))
}

/// Returns a rung's function: the mirror, which `cook check` compares with the shader, or a lookup
/// in the table that the shader bakes. `None` if the reflected light at a point depends on more
/// than the angle and the width.
///
/// # Errors
/// Returns an error as in [`baked`].
pub fn function(gpu: &Gpu, reflectance: Reflectance) -> Result<Option<Function>, CostError> {
    Ok(Some(match reflectance {
        Reflectance::Lambert | Reflectance::LambertShadowed => Box::new(|cosine, _| mirror::lambert(cosine)),
        Reflectance::Wrap => Box::new(mirror::wrap),
        Reflectance::Table(side, format) => {
            let table = baked(gpu, side, format)?;
            Box::new(move |cosine, sigma| table.lookup(cosine, sigma).x)
        }
        Reflectance::Cheap | Reflectance::Power => Box::new(mirror::cheap),
        Reflectance::Accurate => Box::new(mirror::accurate),
        Reflectance::Quadrature => Box::new(mirror::quadrature),
        Reflectance::Spherical => Box::new(mirror::spherical),
        Reflectance::Drift | Reflectance::Blur => return Ok(None),
    }))
}

/// The compared tables: texels per side, format, and the format's name.
const TABLES: [(u32, Format, &str); 7] = [
    (256, Format::Rgba8, "RGBA8 (the paper's)"),
    (257, Format::Rgba8, "RGBA8"),
    (65, Format::Rgba16Float, "RGBA16F"),
    (256, Format::Rgba16Float, "RGBA16F"),
    (257, Format::Rgba16Float, "RGBA16F"),
    (257, Format::R32Float, "R32F"),
    (1025, Format::R32Float, "R32F"),
];

/// Returns the distances of tables of several sizes and formats from the convolution, including the
/// first table with a lookup that omits the half-texel offset.
///
/// # Errors
/// Returns an error as in [`baked`].
pub fn tables(gpu: &Gpu, convolution: &Samples) -> Result<Vec<(String, Distance)>, CostError> {
    let mut found = Vec::new();
    for (index, (side, format, name)) in TABLES.into_iter().enumerate() {
        let table = baked(gpu, side, format)?;
        let distance = convolution.distance(|cosine, sigma| table.lookup(cosine, sigma).x);
        found.push((format!("table {side} × {side}, {name}"), distance));
        if index == 0 {
            let distance = convolution.distance(|cosine, sigma| table.sampled_naive(cosine, sigma).x);
            found.push(("the same, half a texel left out".to_owned(), distance));
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_distance_is_what_was_added() {
        let samples = Samples::of_the_convolution();
        let exact = |cosine: f32, sigma: f32| oracle::accurate(cosine.into(), sigma.into()) as f32;
        let none = samples.distance(exact);
        assert!(none.largest < 1e-7 && none.rms < 1e-7, "{none:?}");
        let shifted = samples.distance(|cosine, sigma| exact(cosine, sigma) + 0.25);
        assert!((shifted.largest - 0.25).abs() < 1e-6 && (shifted.rms - 0.25).abs() < 1e-6, "{shifted:?}");
        // Wrong at one place near the terminator, between the samples of the mean: the largest
        // error shows it, the mean does not.
        let spiked = |cosine: f32, sigma: f32| {
            exact(cosine, sigma) + if (cosine - 0.0006).abs() < 1e-5 && sigma < 0.004 { 0.5 } else { 0.0 }
        };
        let spiked = samples.distance(spiked);
        assert!((spiked.largest - 0.5).abs() < 1e-6 && spiked.rms < 1e-7, "{spiked:?}");
        let lost = samples.distance(|cosine, sigma| if cosine < 0.5 { f32::NAN } else { exact(cosine, sigma) });
        assert!(lost.largest.is_nan() && lost.rms.is_nan(), "{lost:?}");
    }
}
