//! A frame to be timed: a rung's recipe, alone or with the display recipe. It can be run repeatedly
//! and reads nothing back.

use crate::drawing::copies::with_copies_apart;
use crate::drawing::layers::Layers;
use crate::drawing::scene_pass::{ScenePass, scene_pass};
use crate::error::RenderError;
use crate::frame::{Builder, Executor};
use crate::light::lighting::Lighting;
use crate::picture::display;
use crate::picture::formats::SAMPLE_FORMAT;
use crate::settings::Settings;
use crate::volume::diffusion::Diffusions;
use crate::volume::solver::Status;
use crate::volume::stage::Stage;
use glam::Vec2;
use lapidary_gpu::{Gpu, GpuError};
use lapidary_scene::Scene;
use std::ops::Range;
use std::time::{Duration, Instant};

/// A scene on the device and its targets, one sample per pixel.
pub struct FrameTimer<'gpu> {
    gpu: &'gpu Gpu,
    executor: Executor<'gpu>,
    pass: ScenePass,
    /// Ranges of each stage's passes; `None` if the rung follows no light through bodies.
    stages: Option<[Range<usize>; Stage::ALL.len()]>,
    draw_calls: usize,
}

/// Formats of the display's targets. The linear picture is not needed, so its format takes the
/// least memory possible; the other format is a screen's.
const DISPLAY_FORMATS: [wgpu::TextureFormat; 2] = [wgpu::TextureFormat::R8Unorm, wgpu::TextureFormat::Rgba8Unorm];

/// Duration of a frame.
#[derive(Clone, Copy, Debug)]
pub struct FrameTime {
    /// Time from the first command until the device has finished.
    pub total: Duration,
    /// Time on the host: recording and submitting.
    pub encode: Duration,
}

impl<'gpu> FrameTimer<'gpu> {
    /// Texels along each side of the textures of rung `blur`.
    pub const BLUR_SIDE: u32 = crate::surface::blur::SIDE;

    /// Compiles the rung, or another text of its recipe, and uploads the scene. If `displayed`, the
    /// tone curve and the encoding for a screen are included.
    pub fn new(
        gpu: &'gpu Gpu,
        scene: &Scene,
        settings: &Settings,
        source: Option<&str>,
        displayed: bool,
    ) -> Result<Self, RenderError> {
        let scene = &*with_copies_apart(scene, settings);
        let mut builder = Builder::new(Some(gpu));
        let size = [settings.width, settings.height];
        let lighting = Lighting::new(scene, settings, size);
        let pass = scene_pass(&mut builder, &lighting, scene, settings, source)?;
        let [width, height] = size;
        let usage = wgpu::TextureUsages::TEXTURE_BINDING;
        let color = builder.target("samples", [width, height, 1], SAMPLE_FORMAT, usage);
        let stages = pass.prepare(&mut builder);
        let matrix = lapidary_scene::clip_from_world(scene, width, height);
        let view = (matrix, scene.camera.eye);
        let layers = Layers::new(&mut builder, &lighting, settings, color, size)?;
        let start = builder.frame().passes.len();
        layers.draw(&mut builder, &pass.variants, view, size);
        let draw_calls = builder.frame().draw_calls();
        if displayed {
            let pipeline = display::pipeline(&mut builder, 1, settings.backdrop, &DISPLAY_FORMATS)?;
            let groups = display::group(&mut builder, pipeline, color, Vec2::ZERO, settings);
            let usage = wgpu::TextureUsages::empty();
            let targets = DISPLAY_FORMATS.map(|format| builder.target("screen", [width, height, 1], format, usage));
            let draw = builder.draw(pipeline, groups, 3);
            builder.draw_to("display", &targets, None, vec![draw]);
        }
        let shade = start..builder.frame().passes.len();
        let stages = stages.map(|[voxels, maps, seeds, solve]| [voxels, maps, seeds, solve, shade]);
        Ok(Self { gpu, executor: Executor::new(gpu, builder.finish())?, pass, stages, draw_calls })
    }

    /// Draws the frame once and waits.
    pub fn run(&self) -> Result<FrameTime, RenderError> {
        self.timed(0..self.executor.frame().passes.len())
    }

    /// Draws the frame once, with each stage submitted and waited for separately, so the sum
    /// exceeds the time of a frame. Returns `None` if the rung follows no light through bodies.
    pub fn run_stages(&self) -> Result<Option<[Duration; Stage::ALL.len()]>, RenderError> {
        let Some(stages) = &self.stages else { return Ok(None) };
        let mut times = [Duration::ZERO; Stage::ALL.len()];
        for (passes, time) in stages.iter().zip(&mut times) {
            *time = self.timed(passes.clone())?.total;
        }
        Ok(Some(times))
    }

    /// Draws the frame from a stage on, with what the stages before it left the last time: all of it from
    /// [`Stage::Voxels`], what moving lights change from [`Stage::Maps`], what a moving camera changes from
    /// [`Stage::Shade`]. Returns `None` if the rung follows no light through bodies.
    ///
    /// # Errors
    /// If the device rejects a pass or is lost.
    pub fn run_from(&self, stage: Stage) -> Result<Option<FrameTime>, RenderError> {
        let Some(stages) = &self.stages else { return Ok(None) };
        let passes = stages[stage as usize].start..self.executor.frame().passes.len();
        Ok(Some(self.timed(passes)?))
    }

    /// Takes over the fluence of another frame of the same bodies, on which the next one of this begins if its
    /// settings ask for a warm start.
    ///
    /// # Errors
    /// If the device is lost, or if the other frame has other bodies or grids of another size.
    pub fn continue_from(&self, before: &Self) -> Result<(), RenderError> {
        let fluences = |timer: &Self| timer.pass.diffusions().flat_map(Diffusions::fluences).collect::<Vec<_>>();
        let [ours, others] = [fluences(self), fluences(before)];
        if ours.len() != others.len() {
            let reason =
                format!("it has {} bodies through which light diffuses, the other {}", ours.len(), others.len());
            return Err(GpuError::Device { what: "continuing a frame".to_owned(), reason }.into());
        }
        for (ours, other) in ours.into_iter().zip(others) {
            let words = before.executor.words(other)?;
            self.executor.write_buffer(ours, bytemuck::cast_slice(&words))?;
        }
        Ok(())
    }

    /// Returns what the last frame left of each body's equations of diffusion, as shares of their right side in
    /// each channel; empty unless the settings ask for residuals. Waits for the device.
    ///
    /// # Errors
    /// If the device is lost.
    pub fn residuals(&self) -> Result<Vec<[f64; 3]>, RenderError> {
        let all = self.pass.diffusions().map(|diffusions| diffusions.residuals(&self.executor));
        Ok(all.collect::<Result<Vec<_>, _>>()?.concat())
    }

    /// Submits some passes and waits.
    fn timed(&self, passes: Range<usize>) -> Result<FrameTime, RenderError> {
        let start = Instant::now();
        self.executor.run_passes(passes, |_, _| {})?;
        let encode = start.elapsed();
        let waited = self.gpu.device.poll(wgpu::PollType::wait_indefinitely());
        waited.map_err(|error| GpuError::Device { what: "drawing a frame".to_owned(), reason: error.to_string() })?;
        Ok(FrameTime { total: start.elapsed(), encode })
    }

    /// Returns the progress of each body's path solver in the last frame drawn; for several
    /// channels, that of the last channel. Waits for the device.
    pub fn solved(&self) -> Result<Vec<Status>, RenderError> {
        let statuses = self.pass.paths().map(|paths| paths.statuses(&self.executor));
        Ok(statuses.collect::<Result<Vec<_>, _>>()?.concat())
    }

    /// Returns the bytes allocated for following light paths, uniforms excluded.
    pub fn path_bytes(&self) -> u64 {
        let frame = self.executor.frame();
        let paths: u64 = self.pass.paths().map(|paths| paths.bytes(frame)).sum();
        paths + self.pass.diffusions().map(|diffusions| diffusions.bytes(frame)).sum::<u64>()
    }

    /// Returns the number of draw calls that the scene takes.
    pub fn draw_calls(&self) -> usize {
        self.draw_calls
    }
}
