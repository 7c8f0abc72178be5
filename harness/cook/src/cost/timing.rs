//! Times of frames in one run: interleaved, several rounds, the least of each.

use lapidary_gpu::Gpu;
use lapidary_render::{FrameTimer, RenderError, Settings};
use lapidary_scene::Scene;
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// A rung slower than this is timed on fewer pixels.
const SLOW: Duration = Duration::from_secs(4);
/// Each side of the frame is divided by this then.
const REDUCTION: u32 = 4;

/// A rung's time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Timing {
    /// The least of the rounds, in milliseconds for the whole frame.
    pub ms: f64,
    /// The median of the rounds.
    pub median_ms: f64,
    /// What share of the frame's pixels was drawn; the times are scaled up by it.
    pub share: f64,
    /// Microseconds of the host for recording and submitting a frame: the least of the rounds.
    pub encode_us: f64,
    /// Draw calls of a frame.
    pub draw_calls: usize,
}

/// What to time.
pub struct Timed<'a> {
    /// How.
    pub settings: Settings,
    /// What.
    pub scene: &'a Scene,
    /// Another text of the recipe of the settings' rung.
    pub source: Option<String>,
    /// With the display recipe on top.
    pub displayed: bool,
    /// Whether its time goes with its pixels, so that it may be timed on fewer of them.
    pub scales: bool,
}

impl Timed<'_> {
    fn frame<'gpu>(&self, gpu: &'gpu Gpu, settings: &Settings) -> Result<FrameTimer<'gpu>, RenderError> {
        FrameTimer::new(gpu, self.scene, settings, self.source.as_deref(), self.displayed)
    }

    /// The frame that is drawn, once drawn, and its share of the pixels.
    fn ready<'gpu>(&self, gpu: &'gpu Gpu) -> Result<(FrameTimer<'gpu>, f64), RenderError> {
        if self.scales {
            let Settings { width, height, .. } = self.settings;
            let reduced = Settings { width: width / REDUCTION, height: height / REDUCTION, ..self.settings.clone() };
            let small = self.frame(gpu, &reduced)?;
            // The first frame compiles.
            small.run()?;
            let pixels = f64::from(width * height) / f64::from(reduced.width * reduced.height);
            if small.run()?.total.mul_f64(pixels) > SLOW {
                return Ok((small, 1.0 / pixels));
            }
        }
        let frame = self.frame(gpu, &self.settings)?;
        frame.run()?;
        Ok((frame, 1.0))
    }
}

/// Times all of them, round by round. `progress` is told how many frames of how many are done.
pub fn time(
    gpu: &Gpu,
    timed: &[Timed<'_>],
    rounds: u32,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<Vec<Timing>, RenderError> {
    let total = timed.len() as u64 * (u64::from(rounds) + 1);
    let mut frames = Vec::new();
    for (done, timed) in (1..).zip(timed) {
        frames.push(timed.ready(gpu)?);
        progress(done, total);
    }
    let mut times = vec![Vec::new(); frames.len()];
    let mut done = timed.len() as u64;
    for _ in 0..rounds {
        for ((frame, _), times) in frames.iter().zip(&mut times) {
            times.push(frame.run()?);
            done += 1;
            progress(done, total);
        }
    }
    let timing = |((frame, share), times): (&(FrameTimer<'_>, f64), &Vec<lapidary_render::FrameTime>)| {
        let mut totals: Vec<f64> = times.iter().map(|time| time.total.as_secs_f64() * 1e3 / share).collect();
        totals.sort_by(f64::total_cmp);
        let encode = times.iter().map(|time| time.encode.as_secs_f64() * 1e6).fold(f64::INFINITY, f64::min);
        Timing {
            ms: totals.first().copied().unwrap_or(f64::NAN),
            median_ms: totals.get(totals.len() / 2).copied().unwrap_or(f64::NAN),
            share: *share,
            encode_us: encode,
            draw_calls: frame.draw_calls(),
        }
    };
    Ok(frames.iter().zip(&times).map(timing).collect())
}
