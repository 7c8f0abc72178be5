//! A view as a rung draws it: errors, change to the next frame, and time of one picture.

use super::error::Errors;
use super::rungs::{FILLED, MEASURES};
use super::views::{self, View};
use crate::error::CostError;
use crate::report::{Report, Row};
use crate::timing::{self, Timed};
use lapidary_gpu::Gpu;
use lapidary_render as render;
use lapidary_render::{GemOptions, Picture, Settings};
use lapidary_scene::Scene;

/// Samples along each side of a pixel in compared and timed pictures. A real-time frame has one;
/// `cook render` takes 4.
pub const SAMPLES: u32 = 1;

/// A view with its scene in this frame and the next, and its reference.
pub(super) struct Watched {
    pub(super) view: View,
    pub(super) scene: Scene,
    next: Scene,
    pub(super) reference: Picture,
}

impl Watched {
    pub(super) fn open(gpu: &Gpu, view: &View) -> Result<Self, CostError> {
        let scene = view.open()?;
        Ok(Self { view: *view, next: views::turned(&scene), reference: view.reference(gpu)?, scene })
    }

    /// Adds the errors and the change of each rung's picture, with its time.
    pub(super) fn see(
        &self,
        gpu: &Gpu,
        rounds: u32,
        rungs: &[(&str, Settings)],
        report: &mut Report,
    ) -> Result<(), CostError> {
        let mut seen = Vec::new();
        for (_, settings) in rungs {
            let now = render::render_means(gpu, &self.scene, settings)?;
            let Errors { flip, rmse, energy } = Errors::between(&now, &self.reference);
            seen.push([flip, rmse, energy, self.change(gpu, settings, &now)?]);
        }
        let timed: Vec<Timed<'_>> =
            rungs.iter().map(|(_, settings)| Timed::new(&self.scene, settings.clone())).collect();
        let timings = timing::time(gpu, &timed, rounds, &mut |_, _| {})?;
        for (((rung, _), seen), timing) in rungs.iter().zip(seen).zip(timings) {
            for (measure, value) in MEASURES.into_iter().zip(seen) {
                let row = Row::new(rung, self.view.name, measure, value, "");
                report.rows.push(row.timed(timing.map(|timing| timing.ms)));
            }
        }
        Ok(())
    }

    /// Returns the change of a picture to the next frame.
    fn change(&self, gpu: &Gpu, settings: &Settings, now: &Picture) -> Result<f64, CostError> {
        Ok(change(now, &render::render_means(gpu, &self.next, settings)?, &self.reference))
    }
}

/// Returns the RMS difference in linear radiance of two frames, divided by the reference's root mean
/// square.
pub fn change(now: &Picture, next: &Picture, reference: &Picture) -> f64 {
    let channels = |picture: &Picture| -> Vec<f64> {
        picture.linear.iter().flat_map(|pixel| &pixel[..3]).map(|value| f64::from(*value)).collect()
    };
    let power: f64 = channels(reference).iter().map(|value| value * value).sum();
    let difference = channels(now).iter().zip(&channels(next)).map(|(now, next)| (now - next).powi(2)).sum::<f64>();
    (difference / power).sqrt()
}

/// The rung whose steadiness is measured with more samples: it shows the stone.
pub(super) const STEADY: &str = "walk-8+tracker";
/// The view's name of a mean over the views.
pub(super) const MEAN: &str = "mean over the views";

/// The ways to sample a pixel: name, samples along each side, and whether facets' edges are smoothed.
const WAYS: [(&str, u32, bool); 5] =
    [("1", 1, false), ("1, edges smoothed", 1, true), ("4", 2, false), ("16", 4, false), ("64", 8, false)];
/// What is measured of each way: the error to the reference, the distance from the rung's own picture
/// of 64 samples, and the change to the next frame.
pub(super) const STEADINESS: [&str; 3] = ["flip with ", "apart with ", "change with "];

/// Adds the errors and the change of the rung that shows the stone, with 1 to 64 samples per pixel and
/// with smoothed edges: what remains with many is the stone's own, the rest is noise. Ways of one
/// sample per pixel are timed, in every view and in a frame that the brilliant fills.
pub(super) fn steadiness(
    gpu: &Gpu,
    (rounds, [width, height]): (u32, [u32; 2]),
    watched: &[Watched],
    report: &mut Report,
) -> Result<(), CostError> {
    let Ok(rung) = STEADY.parse() else { return Ok(()) };
    let settings = |samples: u32, footprint: bool| {
        let gem = GemOptions { footprint, ..GemOptions::default() };
        Settings { rung, samples, gem, ..Settings::of_size(views::SIDE, views::SIDE) }
    };
    let once = WAYS.map(|(_, samples, footprint)| (samples == 1).then(|| settings(1, footprint)));
    let mut sums = [[0.0; STEADINESS.len() + 1]; WAYS.len()];
    for watched in watched {
        let converged = render::render_means(gpu, &watched.scene, &settings(8, false))?;
        let timed: Vec<_> = once.iter().flatten().map(|once| Timed::new(&watched.scene, once.clone())).collect();
        let mut timings = timing::time(gpu, &timed, rounds, &mut |_, _| {})?.into_iter();
        for ((way, samples, footprint), sums) in WAYS.into_iter().zip(&mut sums) {
            let settings = settings(samples, footprint);
            let now = render::render_means(gpu, &watched.scene, &settings)?;
            let flip = Errors::between(&now, &watched.reference).flip;
            let values = [flip, change(&now, &converged, &converged), watched.change(gpu, &settings, &now)?];
            let timing = if samples == 1 { timings.next().flatten() } else { None };
            let ms = timing.map(|timing| timing.ms);
            for (measure, value) in STEADINESS.into_iter().zip(values) {
                let row = Row::new(STEADY, watched.view.name, &format!("{measure}{way}"), value, "");
                report.rows.push(row.timed(ms));
            }
            let added = values.into_iter().chain(ms);
            sums.iter_mut().zip(added).for_each(|(sum, value)| *sum += value);
        }
    }
    let brilliant = Scene::named("brilliant")?;
    let filled = views::filled(&brilliant);
    let frames = once.iter().flatten().map(|once| Settings { width, height, ..once.clone() });
    let timed: Vec<_> = frames.map(|settings| Timed { scales: true, ..Timed::new(&filled, settings) }).collect();
    let mut timings = timing::time(gpu, &timed, rounds, &mut |_, _| {})?.into_iter();
    let count = watched.len().max(1) as f64;
    for ((way, samples, _), [values @ .., ms]) in WAYS.into_iter().zip(sums) {
        let once = (samples == 1 && rounds > 0).then_some(ms / count);
        for (measure, sum) in STEADINESS.into_iter().zip(values) {
            let row = Row::new(STEADY, MEAN, &format!("{measure}{way}"), sum / count, "");
            report.rows.push(row.timed(once));
        }
        if samples == 1 {
            let ms = timings.next().flatten().map(|timing| timing.ms);
            report.rows.push(Row::new(STEADY, FILLED, &format!("time with {way}"), None, "").timed(ms));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(values: [f32; 2]) -> Picture {
        let linear = values.map(|value| [value, 0.0, 0.0, 1.0]).to_vec();
        Picture { width: 2, height: 1, linear, encoded: Vec::new(), lost: None, walked: None, notes: Vec::new() }
    }

    #[test]
    fn change_is_the_difference_of_frames_over_the_references_power() {
        let found = change(&picture([1.0, 2.0]), &picture([1.0, 0.5]), &picture([3.0, 4.0]));
        assert!((found - 1.5 / 5.0).abs() < 1e-12, "{found}");
    }

    #[test]
    fn the_next_frame_is_seen_from_a_twentieth_of_a_degree_aside() {
        for view in views::VIEWS {
            let scene = view.open().expect("built in");
            let (now, next) = (scene.camera, views::turned(&scene).camera);
            let [from, to] = [now, next].map(|camera| (camera.eye - camera.target).as_dvec3());
            let angle = from.cross(to).length().atan2(from.dot(to)).to_degrees();
            assert!((angle - 0.05).abs() < 1e-3, "{}: {angle}", view.name);
            assert!((to.length() / from.length() - 1.0).abs() < 1e-6 && now.target == next.target);
        }
    }
}
