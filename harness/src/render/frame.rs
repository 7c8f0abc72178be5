//! One frame of a rung's recipe alone, to be timed: drawn again and again, nothing brought back.

use super::pass::{DEPTH_FORMAT, SAMPLE_FORMAT, ScenePass, SceneTarget};
use super::{RenderError, Settings, camera, device, scene_pass};
use crate::cookbook;
use crate::gpu::{Gpu, GpuError};
use crate::scene::Scene;
use std::time::{Duration, Instant};

/// A scene on the device and what it is drawn to, one sample a pixel.
pub struct Frame<'gpu> {
    gpu: &'gpu Gpu,
    pass: ScenePass<'gpu>,
    view: wgpu::BindGroup,
    color: wgpu::TextureView,
    depth: wgpu::TextureView,
    size: [u32; 2],
}

/// How long a frame took.
#[derive(Clone, Copy, Debug)]
pub struct FrameTime {
    /// From the first command to the device's last word.
    pub total: Duration,
    /// The host's part: recording and submitting.
    pub encode: Duration,
}

impl<'gpu> Frame<'gpu> {
    /// Compiles the rung and uploads the scene.
    pub fn new(gpu: &'gpu Gpu, scene: &Scene, settings: &Settings) -> Result<Self, RenderError> {
        Self::of_source(gpu, scene, settings, &cookbook::recipe_source(settings.rung.recipe()))
    }

    /// The same of another text of the rung's recipe.
    pub fn of_source(gpu: &'gpu Gpu, scene: &Scene, settings: &Settings, source: &str) -> Result<Self, RenderError> {
        let pass = scene_pass(gpu, scene, settings, source)?;
        let size = [settings.width, settings.height];
        let [color, depth] = gpu.guarded("allocating a frame", |device| {
            [SAMPLE_FORMAT, DEPTH_FORMAT]
                .map(|format| device::view(&device::target(device, size, format, wgpu::TextureUsages::empty())))
        })?;
        let matrix =
            camera::clip_from_world(&scene.camera, &scene.bounds(), size[0], size[1], super::Tile::whole(size));
        let view = pass.view(matrix, scene.camera.eye);
        Ok(Self { gpu, pass, view, color, depth, size })
    }

    /// Draws it once and waits.
    pub fn run(&self) -> Result<FrameTime, RenderError> {
        let start = Instant::now();
        let mut encoder = self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let target = SceneTarget { colors: vec![&self.color], depth: &self.depth, keep_depth: false, size: self.size };
        self.pass.prepare(&mut encoder)?;
        self.pass.draw(&mut encoder, &self.view, &target);
        self.gpu.queue.submit([encoder.finish()]);
        let encode = start.elapsed();
        let waited = self.gpu.device.poll(wgpu::PollType::wait_indefinitely());
        waited.map_err(|error| GpuError::Device { what: "drawing a frame".to_owned(), reason: error.to_string() })?;
        Ok(FrameTime { total: start.elapsed(), encode })
    }

    /// How many draw calls it takes.
    pub fn draw_calls(&self) -> usize {
        self.pass.draw_calls()
    }
}
