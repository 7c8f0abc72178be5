//! Walks that start from the lights, as light does.
//!
//! Each scattering contributes to the pixel in which the eye sees it, so that one walk serves many
//! pixels, and bright ones most. Where walks are long, far fewer are needed than from the eye.

mod emission;

use super::estimate::{Estimate, Sums};
use super::pass::{Pass, stratum};
use super::walk::{Beginnings, Matter, Ray};
use crate::generator::generator;
use emission::Emission;
use glam::DVec3;
use lapidary_scene::view::View;
use lapidary_scene::{Bounds, Light};
use rand::RngExt as _;
use rand::rngs::Xoshiro256PlusPlus;
use rayon::prelude::*;

/// Number of batches of walks; their spread gives the error.
pub(super) const BATCHES: u32 = 64;

/// Result of a batch of walks.
struct Batch {
    /// Linear RGB radiance of each pixel, row by row.
    radiance: Vec<DVec3>,
    walks: u64,
    scatterings: u64,
    lost: u64,
}

/// Estimates the picture by as many walks as would start from the eye, shared among the lights by
/// their power. Leaves the coverage out.
pub(super) fn estimate(
    matter: &Matter<'_>,
    (lights, bounds): (&[Light], Bounds),
    (view, width, height): (&View, u32, u32),
    samples: u32,
    Pass { beginnings, seed, .. }: Pass,
    note: &(dyn Fn() + Sync),
) -> Estimate {
    let pixels = width as usize * height as usize;
    let emission = Emission::new(lights, bounds);
    let walks = (u64::from(samples) * pixels as u64).div_ceil(BATCHES.into());
    let follow = |number: u32| {
        let random = &mut generator(seed, number.into());
        let batch = Batch::new(matter, &emission, (view, width, pixels), (walks, beginnings), random);
        note();
        batch
    };
    let mut sums = vec![Sums::default(); pixels];
    let mut estimate = Estimate::default();
    // Only some batches at a time, to save memory, and added in order, for the same sums on any
    // number of threads.
    let together = rayon::current_num_threads() as u32;
    for first in (0..BATCHES).step_by(together as usize) {
        let batches: Vec<Batch> = (first..BATCHES.min(first + together)).into_par_iter().map(follow).collect();
        for Batch { radiance, walks, scatterings, lost } in batches {
            sums.iter_mut().zip(radiance).for_each(|(sums, value)| sums.add(value));
            estimate.walks += walks;
            estimate.scatterings += scatterings;
            estimate.lost += lost;
        }
    }
    estimate.radiance = sums.iter().map(|sums| sums.mean(BATCHES)).collect();
    estimate.variance = sums.iter().map(|sums| sums.variance(BATCHES)).collect();
    estimate
}

impl Batch {
    fn new(
        matter: &Matter<'_>,
        emission: &Emission,
        (view, width, pixels): (&View, u32, usize),
        (count, beginnings): (u64, Beginnings),
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
            let outcome = matter.walk_of_light(view, ray, hit, beginnings, random, |[x, y], value| {
                radiance[y as usize * width as usize + x as usize] += flux * value;
            });
            batch.walks += 1;
            batch.scatterings += u64::from(outcome.scatterings);
            batch.lost += u64::from(outcome.lost);
        }
        batch
    }
}

/// Returns the share of each pixel that bodies cover, row by row.
pub(super) fn coverage(
    matter: &Matter<'_>,
    (view, width, height): (&View, u32, u32),
    note: &(dyn Fn() + Sync),
) -> Vec<f32> {
    const SIDE: u32 = 8;
    let centre = |from: u32, cell: u32| f64::from(from) + (f64::from(cell) + 0.5) / f64::from(SIDE);
    let pixel = |x: u32, y: u32| {
        let meets = |sample: &u32| {
            matter.enter(view.eye, view.direction(centre(x, sample % SIDE), centre(y, sample / SIDE))).is_some()
        };
        (0..SIDE * SIDE).filter(meets).count() as f32 / (SIDE * SIDE) as f32
    };
    let row = |y: u32| {
        let row: Vec<f32> = (0..width).map(|x| pixel(x, y)).collect();
        note();
        row
    };
    let rows: Vec<Vec<f32>> = (0..height).into_par_iter().map(row).collect();
    rows.concat()
}
