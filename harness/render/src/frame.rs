//! One frame of a rung's recipe, alone or with the display recipe, to be timed: drawn again and again, nothing brought back.

use super::device::{Pipeline, PipelineSource};
use super::lighting::Lighting;
use super::pass::{DEPTH_FORMAT, SAMPLE_FORMAT, ScenePass, SceneTarget, View};
use super::{RenderError, Settings, Stage, device, scene_pass};
use crate::solver::Status;
use glam::{UVec2, Vec2};
use lapidary_gpu::{Encoder, Gpu, GpuError};
use lapidary_scene::Scene;
use std::time::{Duration, Instant};

/// A scene on the device and what it is drawn to, one sample a pixel.
pub struct Frame<'gpu> {
    gpu: &'gpu Gpu,
    pass: ScenePass<'gpu>,
    view: View,
    color: wgpu::TextureView,
    depth: wgpu::TextureView,
    size: [u32; 2],
    display: Option<Display>,
}

/// The display recipe over a whole frame.
struct Display {
    pipeline: Pipeline,
    group: Option<wgpu::BindGroup>,
    targets: [wgpu::TextureView; DISPLAY_FORMATS.len()],
}

/// Of the display's targets. The linear picture is of no use here and takes the least memory that there is; the other is a screen's.
const DISPLAY_FORMATS: [wgpu::TextureFormat; 2] = [wgpu::TextureFormat::R8Unorm, wgpu::TextureFormat::Rgba8Unorm];

impl Display {
    fn new(gpu: &Gpu, color: &wgpu::TextureView, settings: &Settings) -> Result<Self, RenderError> {
        let recipe = "display";
        let source = PipelineSource {
            recipe,
            source: &lapidary_wgsl::recipe_source(recipe),
            entries: ["display_vertex", "display_fragment"],
            constants: &[("SAMPLES", 1.0)],
            formats: &DISPLAY_FORMATS,
            depth: None,
        };
        let pipeline = device::pipeline(gpu, &source)?;
        let size = [settings.width, settings.height];
        let (group, targets) = gpu.guarded("allocating a screen", |device| {
            let values = super::display::frame(Vec2::ZERO, UVec2::from(size).as_vec2(), settings.exposure);
            let frame = device::uniform(device, "frame", &values);
            let resources = [(0, frame.as_entire_binding()), (1, wgpu::BindingResource::TextureView(color))];
            let target =
                |format| device::view(&device::target(device, "screen", size, format, wgpu::TextureUsages::empty()));
            (pipeline.bind(device, 0, &resources), DISPLAY_FORMATS.map(target))
        })?;
        Ok(Self { pipeline, group, targets })
    }

    fn draw(&self, encoder: &mut Encoder) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("display"),
            color_attachments: &self.targets.each_ref().map(device::cleared),
            ..wgpu::RenderPassDescriptor::default()
        });
        pass.set_pipeline(&self.pipeline.raw);
        pass.set_bind_group(0, self.group.as_ref());
        pass.draw(0..3, 0..1);
    }
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
    /// Texels along each side of the textures of rung `blur`.
    pub const BLUR_SIDE: u32 = super::diffusion::SIDE;

    /// Compiles the rung and uploads the scene.
    pub fn new(gpu: &'gpu Gpu, scene: &Scene, settings: &Settings) -> Result<Self, RenderError> {
        Self::of(gpu, scene, settings, None)
    }

    /// The same of another text of the rung's recipe.
    pub fn of_source(gpu: &'gpu Gpu, scene: &Scene, settings: &Settings, source: &str) -> Result<Self, RenderError> {
        Self::of(gpu, scene, settings, Some(source))
    }

    fn of(gpu: &'gpu Gpu, scene: &Scene, settings: &Settings, source: Option<&str>) -> Result<Self, RenderError> {
        let pass = scene_pass(gpu, &Lighting::new(gpu, scene, settings), scene, settings, source)?;
        let size = [settings.width, settings.height];
        let [color, depth] = gpu.guarded("allocating a frame", |device| {
            use wgpu::TextureUsages as Usage;
            [("samples", SAMPLE_FORMAT, Usage::TEXTURE_BINDING), ("depth", DEPTH_FORMAT, Usage::empty())]
                .map(|(what, format, usage)| device::view(&device::target(device, what, size, format, usage)))
        })?;
        let matrix = lapidary_scene::clip_from_world(scene, size[0], size[1]);
        let view = pass.view(matrix, scene.camera.eye);
        Ok(Self { gpu, pass, view, color, depth, size, display: None })
    }

    /// The same with the tone curve and the encoding for a screen on top.
    pub fn displayed(self, settings: &Settings) -> Result<Self, RenderError> {
        let display = Some(Display::new(self.gpu, &self.color, settings)?);
        Ok(Self { display, ..self })
    }

    /// Draws it once and waits.
    pub fn run(&self) -> Result<FrameTime, RenderError> {
        self.timed(|encoder| {
            self.pass.prepare(encoder)?;
            self.draw(encoder);
            Ok(())
        })
    }

    /// Draws it once, each stage submitted and waited for by itself, so that together they take longer than a frame. None where the rung
    /// follows no light through bodies.
    pub fn run_stages(&self) -> Result<Option<[Duration; Stage::ALL.len()]>, RenderError> {
        let Some(paths) = self.pass.paths() else { return Ok(None) };
        let mut times = [Duration::ZERO; Stage::ALL.len()];
        for (stage, time) in Stage::ALL.into_iter().zip(&mut times) {
            let run = self.timed(|encoder| {
                if stage == Stage::Shade {
                    self.draw(encoder);
                }
                paths.encode_stage(encoder, stage)
            })?;
            *time = run.total;
        }
        Ok(Some(times))
    }

    fn draw(&self, encoder: &mut Encoder) {
        let target = SceneTarget { colors: vec![&self.color], depth: &self.depth, keep_depth: false, size: self.size };
        self.pass.draw(encoder, &self.view, &target);
        if let Some(display) = &self.display {
            display.draw(encoder);
        }
    }

    /// Submits what `record` does and waits.
    fn timed(&self, record: impl FnOnce(&mut Encoder) -> Result<(), RenderError>) -> Result<FrameTime, RenderError> {
        let start = Instant::now();
        let mut encoder = self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        record(&mut encoder)?;
        self.gpu.queue.submit([encoder.finish()]);
        let encode = start.elapsed();
        let waited = self.gpu.device.poll(wgpu::PollType::wait_indefinitely());
        waited.map_err(|error| GpuError::Device { what: "drawing a frame".to_owned(), reason: error.to_string() })?;
        Ok(FrameTime { total: start.elapsed(), encode })
    }

    /// How far the solvers of light's ways came in the last frame that was drawn, body by body; of several channels, in the last. Waits for
    /// the device.
    pub fn solved(&self) -> Result<Vec<Status>, RenderError> {
        self.pass.paths().map_or(Ok(Vec::new()), |paths| paths.statuses())
    }

    /// Bytes of what is allocated to find light's ways, but for uniforms.
    pub fn path_bytes(&self) -> u64 {
        self.pass.paths().map_or(0, |paths| paths.bytes())
    }

    /// How many draw calls the scene takes.
    pub fn draw_calls(&self) -> usize {
        self.pass.draw_calls()
    }
}
