//! A view as a rung draws it: errors, change to the next frame, and time of one picture.

use super::views::{self, View};
use super::{CostError, Errors, Report, Row};
use crate::cost::timing::{self, Timed};
use lapidary_gpu::Gpu;
use lapidary_render as render;
use lapidary_render::{Picture, Settings};
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
            for (measure, value) in super::MEASURES.into_iter().zip(seen) {
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
fn change(now: &Picture, next: &Picture, reference: &Picture) -> f64 {
    let channels = |picture: &Picture| -> Vec<f64> {
        picture.linear.iter().flat_map(|pixel| &pixel[..3]).map(|value| f64::from(*value)).collect()
    };
    let power: f64 = channels(reference).iter().map(|value| value * value).sum();
    let apart = channels(now).iter().zip(&channels(next)).map(|(now, next)| (now - next).powi(2)).sum::<f64>();
    (apart / power).sqrt()
}

/// The rung whose steadiness is measured with more samples: it shows the stone.
pub(super) const STEADY: &str = "walk-8+tracker";
/// The view's name of a mean over the views.
pub(super) const MEAN: &str = "mean over the views";

/// Adds the change of the rung that shows the stone, with 1 to 64 samples per pixel: what remains
/// with many is the stone's own, the rest is noise.
pub(super) fn steadiness(gpu: &Gpu, watched: &[Watched], report: &mut Report) -> Result<(), CostError> {
    let Ok(rung) = STEADY.parse() else { return Ok(()) };
    for samples in [1, 2, 4, 8] {
        let settings = Settings { rung, samples, ..Settings::of_size(views::SIDE, views::SIDE) };
        let measure = format!("change with {}", samples * samples);
        let mut sum = 0.0;
        for watched in watched {
            let now = render::render_means(gpu, &watched.scene, &settings)?;
            let change = watched.change(gpu, &settings, &now)?;
            sum += change;
            report.rows.push(Row::new(STEADY, watched.view.name, &measure, change, ""));
        }
        let mean = (!watched.is_empty()).then(|| sum / watched.len() as f64);
        report.rows.push(Row::new(STEADY, MEAN, &measure, mean, ""));
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
