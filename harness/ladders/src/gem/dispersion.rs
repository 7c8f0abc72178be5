//! Compares tracked colours with those of separate wavelengths through the same geometry, so that
//! only the dispersion differs.

use super::views::View;
use crate::error::CostError;
use crate::report::Row;
use lapidary_assay::golden_section::golden_section;
use lapidary_gpu::Gpu;
use lapidary_plan::{Rung, Spectrum};
use lapidary_render as render;
use lapidary_render::pixel::{Shading, Stone, Viewer};
use lapidary_render::{GemOptions, Picture, Settings};
use lapidary_scene::Scene;

/// Width and height of the compared pictures; there is one sample per pixel, so that a pixel is one
/// ray.
const SIDE: u32 = 256;

/// Difference between the colours of a rung's trackers and those of three separate wavelengths,
/// where all three meet the same facets.
#[derive(Clone, Debug)]
pub(super) struct Colours {
    /// The rung's geometry and number of hits.
    pub rung: String,
    /// The view's name.
    pub view: String,
    /// Fraction of the stone's pixels in which the three wavelengths meet the same facets
    /// throughout.
    pub shared: f64,
    /// RMS difference in radiance over these pixels without dispersion.
    pub none_rms: f64,
    /// RMS difference with the paper's tracker as printed.
    pub paper_rms: f64,
    /// The factor of eq. (12) that fits the paper's tracker best in this view and over these
    /// pixels.
    pub strength: f32,
    /// RMS difference with the paper's tracker at that strength.
    pub fitted_rms: f64,
    /// RMS difference with the exact tracker.
    pub tracker_rms: f64,
}

impl Colours {
    /// Names of the measures, in the order of [`Self::rows`].
    pub(super) const MEASURES: [&str; 6] = ["shared", "undispersed", "paper", "strength", "fitted", "tracker"];

    /// Returns the rows of the geometry and the view.
    pub(super) fn rows(&self) -> impl Iterator<Item = Row> + '_ {
        let Self { shared, none_rms, paper_rms, strength, fitted_rms, tracker_rms, .. } = *self;
        let values = [shared, none_rms, paper_rms, strength.into(), fitted_rms, tracker_rms];
        Self::MEASURES
            .into_iter()
            .zip(values)
            .map(|(measure, value)| Row::new(&self.rung, &self.view, measure, value, ""))
    }
}

fn settings(rung: Rung, strength: f32) -> Settings {
    let gem = GemOptions { dispersion_strength: strength, ..GemOptions::default() };
    Settings { rung, samples: 1, gem, ..Settings::of_size(SIDE, SIDE) }
}

fn with_spectrum(rung: Rung, spectrum: Spectrum) -> Rung {
    match rung {
        Rung::Inside { geometry, hits, .. } => Rung::Inside { geometry, hits, spectrum },
        other => other,
    }
}

/// Returns the RMS difference over the pixels of `mask`.
fn difference(one: &Picture, other: &Picture, mask: &[bool]) -> f64 {
    let pixels = one.linear.iter().zip(&other.linear).zip(mask).filter(|(_, masked)| **masked);
    let (sum, count) = pixels.fold((0.0, 0.0), |(sum, count), ((one, other), _)| {
        let difference: f64 = (0..3).map(|k| f64::from(one[k] - other[k]).powi(2)).sum();
        (sum + difference, count + 3.0)
    });
    (sum / count).sqrt()
}

/// Returns the position and the value of the minimum of `error`: 0, or the best of a grid over all
/// magnitudes, refined by golden-section search.
fn least(mut error: impl FnMut(f32) -> Result<f64, CostError>) -> Result<(f32, f64), CostError> {
    const STEPS: i32 = 14;
    let step = |k: i32| 2f32.powf(-0.75 * k as f32);
    let mut best = (0.0, error(0.0)?);
    let mut take = |strength: f32, best: &mut (f32, f64)| -> Result<f64, CostError> {
        let found = error(strength)?;
        if found < best.1 {
            *best = (strength, found);
        }
        Ok(found)
    };
    let mut nearest = 0;
    for k in 0..STEPS {
        if take(step(k), &mut best)? == best.1 {
            nearest = k;
        }
    }
    let around = [step(nearest + 1), step(nearest - 1)].map(f64::from);
    golden_section(around, 6, |strength| take(strength as f32, &mut best))?;
    Ok(best)
}

/// Measures the colours for the geometry and hits of `paper` in a view, and fits the paper's
/// tracker to it.
pub(super) fn colours(gpu: &Gpu, paper: Rung, view: &View, scene: &Scene) -> Result<Colours, CostError> {
    let picture = |spectrum, strength| render::render(gpu, scene, &settings(with_spectrum(paper, spectrum), strength));
    let separate = picture(Spectrum::Separate(3), 1.0)?;
    let mask = shared(scene, with_spectrum(paper, Spectrum::Separate(3)), &separate)?;
    let covered = separate.linear.iter().filter(|pixel| pixel[3] > 0.0).count();
    let error = |spectrum, strength| -> Result<f64, CostError> {
        Ok(difference(&picture(spectrum, strength)?, &separate, &mask))
    };
    let (strength, fitted_rms) = least(|strength| error(Spectrum::Paper, strength))?;
    Ok(Colours {
        rung: with_spectrum(paper, Spectrum::One).to_string(),
        view: view.name.to_owned(),
        shared: mask.iter().filter(|masked| **masked).count() as f64 / covered as f64,
        none_rms: error(Spectrum::One, 1.0)?,
        paper_rms: error(Spectrum::Paper, 1.0)?,
        strength,
        fitted_rms,
        tracker_rms: error(Spectrum::Tracker, 1.0)?,
    })
}

/// Returns the pixels in which all three wavelengths meet the same facets and are totally reflected
/// at the same ones.
fn shared(scene: &Scene, rung: Rung, picture: &Picture) -> Result<Vec<bool>, CostError> {
    let settings = settings(rung, 1.0);
    let viewer = Viewer::new(scene, SIDE, SIDE);
    let object = &scene.objects[0];
    let (shading, stone) = (Shading::new(&object.material, &settings), Stone::new(object, &settings)?);
    let pixels = (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| (column, row)));
    Ok(pixels
        .zip(&picture.linear)
        .map(|((column, row), pixel)| {
            let seen = viewer.see(&object.mesh, f64::from(column) + 0.5, f64::from(row) + 0.5);
            let (Some(seen), true) = (seen, pixel[3] > 0.0) else { return false };
            let rays = shading.pixel(&stone, seen, scene.camera.eye).rays;
            rays.windows(2).all(|pair| pair[0] == pair[1])
        })
        .collect())
}

#[cfg(test)]
mod tests {
    use super::least;

    #[test]
    fn the_least_is_found_wherever_it_is() {
        for lowest in [0.9f32, 0.1, 0.0031, 0.0009] {
            let (found, error) = least(|strength| Ok(f64::from((strength / lowest).ln().abs()))).expect("no error");
            assert!((found / lowest - 1.0).abs() < 0.1 && error < 0.1, "{lowest}: {found} {error}");
        }
        assert_eq!(least(|strength| Ok(f64::from(strength))).expect("no error"), (0.0, 0.0));
    }
}
