//! Walks that start from the lights, as light does.
//!
//! Each scattering contributes to the pixel in which the eye sees it, so that one walk serves many
//! pixels, and bright ones most. Where walks are long, far fewer are needed than from the eye.

mod emission;

use super::walk::{Matter, Ray};
use super::{Pixel, Rendering, Settings, generator, stratum};
use emission::Emission;
use glam::DVec3;
use lapidary_scene::view::View;
use lapidary_scene::{Bounds, Light};
use rand::RngExt as _;
use rand::rngs::Xoshiro256PlusPlus;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// Number of batches of walks; their spread gives the error.
const BATCHES: u32 = 64;

/// Result of a batch of walks.
struct Batch {
    /// Linear RGB radiance of each pixel, row by row.
    radiance: Vec<DVec3>,
    walks: u64,
    scatterings: u64,
    lost: u64,
}

/// Renders with as many walks as would start from the eye, shared among the lights by their power.
pub(super) fn render(
    matter: &Matter<'_>,
    (lights, bounds): (&[Light], Bounds),
    view: &View,
    settings: &Settings<'_>,
    progress: &(dyn Fn(u64, u64) + Sync),
) -> Rendering {
    let &Settings { width, height, samples_per_pixel, seed, .. } = settings;
    let pixels = width as usize * height as usize;
    let emission = Emission::new(lights, bounds);
    let walks = (u64::from(samples_per_pixel) * pixels as u64).div_ceil(BATCHES.into());
    let done = AtomicU64::new(0);
    let all = u64::from(BATCHES + height);
    let note = || progress(done.fetch_add(1, Ordering::Relaxed) + 1, all);
    let follow = |number: u32| {
        let batch = Batch::new(matter, &emission, (view, width, pixels), walks, &mut generator(seed, number.into()));
        note();
        batch
    };
    let (mut sums, mut squares) = (vec![DVec3::ZERO; pixels], vec![DVec3::ZERO; pixels]);
    let mut counts = [0; 3];
    // Only some batches at a time, to save memory, and added in order, for the same sums on any
    // number of threads.
    let together = rayon::current_num_threads() as u32;
    for first in (0..BATCHES).step_by(together as usize) {
        let batches: Vec<Batch> = (first..BATCHES.min(first + together)).into_par_iter().map(follow).collect();
        for Batch { radiance, walks, scatterings, lost } in batches {
            for ((sum, square), value) in sums.iter_mut().zip(&mut squares).zip(radiance) {
                *sum += value;
                *square += value * value;
            }
            counts.iter_mut().zip([walks, scatterings, lost]).for_each(|(count, more)| *count += more);
        }
    }
    let row = |y: u32| {
        let row: Vec<f32> = (0..width).map(|x| coverage(matter, view, (x, y))).collect();
        note();
        row
    };
    let coverage: Vec<Vec<f32>> = (0..height).into_par_iter().map(row).collect();
    let of_batches = |(sum, square): (&DVec3, &DVec3)| Pixel { radiance: *sum, squares: *square, ..Pixel::default() };
    let batches = || sums.iter().zip(&squares).map(of_batches);
    let pixel = |(pixel, coverage): (Pixel, &f32)| {
        let [red, green, blue, _] = pixel.linear(BATCHES);
        [red, green, blue, *coverage]
    };
    let [walks, scatterings, lost] = counts;
    Rendering {
        linear: batches().zip(coverage.iter().flatten()).map(pixel).collect(),
        standard_error: batches().map(|pixel| pixel.standard_error(BATCHES)).collect(),
        walks,
        scatterings,
        lost,
    }
}

impl Batch {
    fn new(
        matter: &Matter<'_>,
        emission: &Emission,
        (view, width, pixels): (&View, u32, usize),
        count: u64,
        random: &mut Xoshiro256PlusPlus,
    ) -> Self {
        let mut batch = Self { radiance: vec![DVec3::ZERO; pixels], walks: 0, scatterings: 0, lost: 0 };
        for number in 0..count {
            let Some((ray, power)) = emission.emit(stratum(number, count, random), random.random()) else { break };
            let Ray { position, direction } = ray;
            // There is no light outside a spot's cone.
            let Some(hit) = matter.enter(position, direction).filter(|_| power != DVec3::ZERO) else { continue };
            let flux = power / count as f64;
            let radiance = &mut batch.radiance;
            let outcome = matter.walk_of_light(view, ray, hit, random, |[x, y], value| {
                radiance[y as usize * width as usize + x as usize] += flux * value;
            });
            batch.walks += 1;
            batch.scatterings += u64::from(outcome.scatterings);
            batch.lost += u64::from(outcome.lost);
        }
        batch
    }
}

/// Returns the share of a pixel that bodies cover.
fn coverage(matter: &Matter<'_>, view: &View, (x, y): (u32, u32)) -> f32 {
    const SIDE: u32 = 8;
    let at = |from: u32, cell: u32| f64::from(from) + (f64::from(cell) + 0.5) / f64::from(SIDE);
    let meets =
        |sample: &u32| matter.enter(view.eye, view.direction(at(x, sample % SIDE), at(y, sample / SIDE))).is_some();
    (0..SIDE * SIDE).filter(meets).count() as f32 / (SIDE * SIDE) as f32
}
