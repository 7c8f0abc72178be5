//! Tracked colours against those of separate wavelengths through the same geometry, so that dispersion alone differs.

use super::views::View;
use super::{CostError, Strength};
use crate::gpu::Gpu;
use crate::pixel::{Shading, Stone, Viewer};
use crate::render::{self, Picture, Rung, Settings, Spectrum};
use crate::scene::Scene;
use serde::{Deserialize, Serialize};

/// Side of the pictures that are compared, one sample a pixel, so that a pixel is one ray.
const SIDE: u32 = 256;

/// How far the colours of a rung's trackers are from three separate wavelengths', where all three meet the same facets.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Colours {
    /// Geometry and hits.
    pub rung: String,
    /// The view's name.
    pub view: String,
    /// Share of the stone's pixels whose three wavelengths meet the same facets throughout.
    pub shared: f64,
    /// RMS of the difference in radiance there: no dispersion at all.
    pub none_rms: f64,
    /// The paper's tracker, as printed.
    pub paper_rms: f64,
    /// The paper's tracker at its best-fit strength.
    pub fitted_rms: f64,
    /// The exact tracker.
    pub tracker_rms: f64,
}

fn settings(rung: Rung, strength: f32) -> Settings {
    Settings { rung, samples: 1, dispersion_strength: strength, ..Settings::of_size(SIDE, SIDE) }
}

fn with_spectrum(rung: Rung, spectrum: Spectrum) -> Rung {
    match rung {
        Rung::Inside { geometry, hits, .. } => Rung::Inside { geometry, hits, spectrum },
        other => other,
    }
}

/// Sum of squared differences over the pixels of `mask`, and how many values that were.
fn squares(one: &Picture, other: &Picture, mask: &[bool]) -> (f64, f64) {
    let pixels = one.linear.iter().zip(&other.linear).zip(mask).filter(|(_, masked)| **masked);
    pixels.fold((0.0, 0.0), |(sum, count), ((one, other), _)| {
        let difference: f64 = (0..3).map(|k| f64::from(one[k] - other[k]).powi(2)).sum();
        (sum + difference, count + 3.0)
    })
}

fn rms(pairs: impl IntoIterator<Item = (f64, f64)>) -> f64 {
    let (sum, count) = pairs.into_iter().fold((0.0, 0.0), |total, pair| (total.0 + pair.0, total.1 + pair.1));
    (sum / count).sqrt()
}

/// The strength of `rung`, which follows the paper's dispersion, that comes nearest to separate wavelengths over all scenes:
/// the best of a grid over all magnitudes, then golden sections about it.
pub(super) fn fit(gpu: &Gpu, rung: Rung, scenes: &[Scene]) -> Result<Strength, CostError> {
    let separate = with_spectrum(rung, Spectrum::Separate(3));
    let targets: Vec<Picture> =
        scenes.iter().map(|scene| render::render(gpu, scene, &settings(separate, 1.0))).collect::<Result<_, _>>()?;
    let error = |strength: f32| -> Result<f64, CostError> {
        let mut pairs = Vec::new();
        for (scene, target) in scenes.iter().zip(&targets) {
            let picture = render::render(gpu, scene, &settings(rung, strength))?;
            pairs.push(squares(&picture, target, &vec![true; picture.linear.len()]));
        }
        Ok(rms(pairs))
    };
    const STEPS: i32 = 14;
    let step = |k: i32| 2f32.powf(-0.75 * k as f32);
    let mut best = (f64::INFINITY, 0);
    for k in 0..STEPS {
        let found = error(step(k))?;
        if found < best.0 {
            best = (found, k);
        }
    }
    let (mut low, mut high) = (step(best.1 + 1), step(best.1 - 1));
    const GOLDEN: f32 = 0.618_034;
    for _ in 0..6 {
        let (left, right) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
        if error(left)? < error(right)? { high = right } else { low = left }
    }
    let middle = 0.5 * (low + high);
    let refined = error(middle)?;
    let (fitted_rms, fitted) = if refined < best.0 { (refined, middle) } else { (best.0, step(best.1)) };
    let (literal_rms, none_rms) = (error(1.0)?, error(0.0)?);
    Ok(Strength { rung: rung.to_string(), fitted, literal_rms, fitted_rms, none_rms })
}

/// The colours of every rung that was fitted, in every view.
pub(super) fn colours(
    gpu: &Gpu,
    views: &[View],
    scenes: &[Scene],
    strengths: &[Strength],
) -> Result<Vec<Colours>, CostError> {
    let mut found = Vec::new();
    for strength in strengths {
        let Ok(paper) = strength.rung.parse::<Rung>() else { continue };
        for (view, scene) in views.iter().zip(scenes) {
            let picture =
                |spectrum, strength| render::render(gpu, scene, &settings(with_spectrum(paper, spectrum), strength));
            let separate = picture(Spectrum::Separate(3), 1.0)?;
            let mask = shared(scene, with_spectrum(paper, Spectrum::Separate(3)), &separate)?;
            let covered = separate.linear.iter().filter(|pixel| pixel[3] > 0.0).count();
            let difference = |picture: &Picture| rms([squares(picture, &separate, &mask)]);
            let without = Rung::Inside { geometry: paper.geometry(), hits: paper.hits(), spectrum: Spectrum::One };
            found.push(Colours {
                rung: without.to_string(),
                view: view.name.to_owned(),
                shared: mask.iter().filter(|masked| **masked).count() as f64 / covered as f64,
                none_rms: difference(&picture(Spectrum::One, 1.0)?),
                paper_rms: difference(&picture(Spectrum::Paper, 1.0)?),
                fitted_rms: difference(&picture(Spectrum::Paper, strength.fitted)?),
                tracker_rms: difference(&picture(Spectrum::Tracker, 1.0)?),
            });
        }
    }
    Ok(found)
}

/// Which pixels show the stone by three wavelengths that meet the same facets, and are totally reflected at the same.
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
