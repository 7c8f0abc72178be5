//! Frame times measured in one run: several interleaved rounds, with the minimum of each frame.

use lapidary_gpu::Gpu;
use lapidary_render::{FrameTimer, RenderError, Settings};
use lapidary_scene::Scene;
use std::time::Duration;

/// A rung whose frame takes longer than this is timed on fewer pixels.
const SLOW: Duration = Duration::from_secs(4);
/// The factor by which each side of a slow frame is divided.
const REDUCTION: u32 = 4;

/// The times of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timing {
    /// Minimum over the rounds, in milliseconds for the whole frame.
    pub ms: f64,
    /// Median over the rounds, in milliseconds for the whole frame.
    pub median_ms: f64,
    /// Fraction of the frame's pixels that was drawn; the times are divided by it.
    pub share: f64,
    /// CPU time for recording and submitting a frame in microseconds, the minimum over the rounds.
    pub encode_us: f64,
}

/// A frame to time.
pub struct Timed<'a> {
    /// How the frame is rendered.
    pub settings: Settings,
    /// The scene to render.
    pub scene: &'a Scene,
    /// Replacement source of the recipe of the settings' rung; `None` for the original.
    pub source: Option<String>,
    /// Whether the display recipe is applied on top.
    pub displayed: bool,
    /// Whether the time is proportional to the number of pixels, so that fewer may be timed.
    pub scales: bool,
}

impl<'a> Timed<'a> {
    /// Returns the frame of `scene` by the original recipe, all of whose pixels are timed.
    pub fn new(scene: &'a Scene, settings: Settings) -> Self {
        Self { settings, scene, source: None, displayed: false, scales: false }
    }
}

impl Timed<'_> {
    fn frame<'gpu>(&self, gpu: &'gpu Gpu, settings: &Settings) -> Result<FrameTimer<'gpu>, RenderError> {
        FrameTimer::new(gpu, self.scene, settings, self.source.as_deref(), self.displayed)
    }

    /// Returns the frame to time, rendered once, and the fraction of the pixels that it covers.
    fn ready<'gpu>(&self, gpu: &'gpu Gpu) -> Result<(FrameTimer<'gpu>, f64), RenderError> {
        if self.scales {
            let Settings { width, height, .. } = self.settings;
            let reduced = Settings { width: width / REDUCTION, height: height / REDUCTION, ..self.settings.clone() };
            let small = self.frame(gpu, &reduced)?;
            // The first frame includes compilation.
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

/// Times all frames, round by round; not at all if there are no rounds. `progress` receives the
/// number of frames done and the total.
pub fn time(
    gpu: &Gpu,
    timed: &[Timed<'_>],
    rounds: u32,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<Vec<Option<Timing>>, RenderError> {
    if rounds == 0 {
        return Ok(vec![None; timed.len()]);
    }
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
    let timing = |((_, share), times): (&(FrameTimer<'_>, f64), &Vec<lapidary_render::FrameTime>)| {
        let mut totals: Vec<f64> = times.iter().map(|time| time.total.as_secs_f64() * 1e3 / share).collect();
        totals.sort_by(f64::total_cmp);
        let encode = times.iter().map(|time| time.encode.as_secs_f64() * 1e6).fold(f64::INFINITY, f64::min);
        Some(Timing {
            ms: totals.first().copied().unwrap_or(f64::NAN),
            median_ms: totals.get(totals.len() / 2).copied().unwrap_or(f64::NAN),
            share: *share,
            encode_us: encode,
        })
    };
    Ok(frames.iter().zip(&times).map(timing).collect())
}
