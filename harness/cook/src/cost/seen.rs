//! Results of a rung in one view: the picture's errors, its temporal stability and its time.

use super::views::{self, View};
use super::{CostError, Errors, MEASURES};
use lapidary_gpu::Gpu;
use lapidary_render as render;
use lapidary_render::{Picture, Settings};
use lapidary_scene::Scene;
use serde::{Deserialize, Serialize};

/// Samples along each side of a pixel in compared and timed pictures. A real-time frame has one;
/// `cook render` takes 4.
pub const SAMPLES: u32 = 1;

/// Results for a rung's picture of a view.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Seen {
    /// Errors against the reference.
    pub errors: Errors,
    /// Frame-to-frame change: RMS of the difference in linear radiance after the camera has turned
    /// by 0.05°, divided by the reference's root mean square.
    pub change: f64,
    /// Milliseconds for the same picture, the minimum over the rounds; `None` if timing was
    /// skipped.
    pub ms: Option<f64>,
}

impl Seen {
    /// Returns the magnitude of one error, by index into [`MEASURES`].
    pub fn of(&self, measure: usize) -> f64 {
        if measure + 1 < MEASURES.len() { self.errors.of(measure) } else { self.change }
    }
}

/// A view with its scene in this frame and the next, and its reference.
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

    /// Renders the view with a rung and compares it; not timed.
    pub(super) fn see(&self, gpu: &Gpu, settings: &Settings) -> Result<Seen, CostError> {
        let now = render::render_means(gpu, &self.scene, settings)?;
        let next = render::render_means(gpu, &self.next, settings)?;
        let change = change(&now, &next, &self.reference);
        Ok(Seen { errors: Errors::between(&now, &self.reference), change, ms: None })
    }
}

/// Returns the RMS difference of two frames divided by the reference's root mean square.
fn change(now: &Picture, next: &Picture, reference: &Picture) -> f64 {
    let channels = |picture: &Picture| -> Vec<f64> {
        picture.linear.iter().flat_map(|pixel| &pixel[..3]).map(|value| f64::from(*value)).collect()
    };
    let power: f64 = channels(reference).iter().map(|value| value * value).sum();
    let apart = channels(now).iter().zip(&channels(next)).map(|(now, next)| (now - next).powi(2)).sum::<f64>();
    (apart / power).sqrt()
}

/// Temporal stability of a rung with more samples. It separates the change that is the stone's own
/// from noise.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Steadiness {
    /// The rung.
    pub rung: String,
    /// Samples per pixel.
    pub samples: u32,
    /// Frame-to-frame change as in [`Seen::change`], averaged over the views.
    pub change: f64,
    /// Frame-to-frame change in the view `brilliant`; `None` if that view was not requested.
    pub brilliant: Option<f64>,
}

/// Measures the stability of the rung that shows the stone, with 1 to 64 samples per pixel.
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
