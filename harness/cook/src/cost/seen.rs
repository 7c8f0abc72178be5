//! A rung in one view: how far its picture is from the reference, how steady, and how long that very picture takes.

use super::views::{self, View};
use super::{CostError, Errors, MEASURES};
use lapidary_gpu::Gpu;
use lapidary_render as render;
use lapidary_render::{Picture, Settings};
use lapidary_scene::Scene;
use serde::{Deserialize, Serialize};

/// Samples along each side of a compared and timed pixel. A real-time frame has one; `cook render` takes 4.
pub const SAMPLES: u32 = 1;

/// A rung's picture of a view.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Seen {
    /// Against the reference.
    pub errors: Errors,
    /// Frame-to-frame change: RMS of the difference in linear radiance when the camera has turned by 0.05°, over the reference's root mean square.
    pub change: f64,
    /// Milliseconds for the same picture, the least of the rounds; none where times were not asked for.
    pub ms: Option<f64>,
}

impl Seen {
    /// The size of the error by the measure of that number in [`MEASURES`].
    pub fn of(&self, measure: usize) -> f64 {
        if measure + 1 < MEASURES.len() { self.errors.of(measure) } else { self.change }
    }
}

/// A view with its scene, in this frame and the next, and its reference.
pub(super) struct Watched {
    pub(super) view: View,
    pub(super) scene: Scene,
    pub(super) next: Scene,
    pub(super) reference: Picture,
}

impl Watched {
    pub(super) fn open(gpu: &Gpu, view: &View) -> Result<Self, CostError> {
        let scene = view.open()?;
        Ok(Self { view: *view, next: views::turned(&scene), reference: view.reference(gpu)?, scene })
    }

    /// The rung's picture, untimed.
    pub(super) fn see(&self, gpu: &Gpu, settings: &Settings) -> Result<Seen, CostError> {
        let now = render::render_means(gpu, &self.scene, settings)?;
        let next = render::render_means(gpu, &self.next, settings)?;
        let change = change(&now, &next, &self.reference);
        Ok(Seen { errors: Errors::between(&now, &self.reference), change, ms: None })
    }
}

/// The root mean square of the difference of two frames, over that of the reference.
fn change(now: &Picture, next: &Picture, reference: &Picture) -> f64 {
    let channels = |picture: &Picture| -> Vec<f64> {
        picture.linear.iter().flat_map(|pixel| &pixel[..3]).map(|value| f64::from(*value)).collect()
    };
    let power: f64 = channels(reference).iter().map(|value| value * value).sum();
    let apart = channels(now).iter().zip(&channels(next)).map(|(now, next)| (now - next).powi(2)).sum::<f64>();
    (apart / power).sqrt()
}

/// How steady a rung is with more samples: what of its change from frame to frame is the stone's, and what is noise.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Steadiness {
    /// The rung.
    pub rung: String,
    /// Of a pixel.
    pub samples: u32,
    /// As [`Seen::change`], the mean over the views.
    pub change: f64,
    /// The same of the view `brilliant`; none where that was not asked for.
    pub brilliant: Option<f64>,
}

/// Of the rung that shows the stone, with 1 to 64 samples a pixel.
pub(super) fn steadiness(gpu: &Gpu, watched: &[Watched]) -> Result<Vec<Steadiness>, CostError> {
    let name = "convex-8+tracker";
    let Ok(rung) = name.parse() else { return Ok(Vec::new()) };
    if watched.is_empty() {
        return Ok(Vec::new());
    }
    let mut found = Vec::new();
    for samples in [1, 2, 4, 8] {
        let settings = Settings { rung, samples, ..Settings::of_size(views::SIDE, views::SIDE) };
        let (mut sum, mut brilliant) = (0.0, None);
        for watched in watched {
            let Seen { change, .. } = watched.see(gpu, &settings)?;
            sum += change;
            if watched.view.name == "brilliant" {
                brilliant = Some(change);
            }
        }
        let change = sum / watched.len() as f64;
        found.push(Steadiness { rung: name.to_owned(), samples: samples * samples, change, brilliant });
    }
    Ok(found)
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
