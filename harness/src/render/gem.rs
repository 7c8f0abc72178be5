//! The gem recipe's pass: stones on the device, and drawing them.

use super::device::{self, PipelineSource};
use super::stone::Stone;
use super::{Environment, Geometry, RenderError, Rung, Settings, Spectrum};
use crate::gpu::Gpu;
use crate::scene::Scene;
use glam::{Mat4, Vec3};

/// Samples are kept in f32: radiance spans more than f16 holds exactly, and references are compared in linear light.
pub(super) const SAMPLE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;
/// Of the depth buffer.
pub(super) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// A compiled recipe and the scene's stones.
pub(super) struct GemPass<'gpu> {
    gpu: &'gpu Gpu,
    pipeline: wgpu::RenderPipeline,
    environment: wgpu::TextureView,
    stones: Vec<Stone>,
}

/// What a pass draws to.
pub(super) struct GemTarget<'a> {
    pub(super) colors: Vec<&'a wgpu::TextureView>,
    pub(super) depth: &'a wgpu::TextureView,
    /// Whether the depth is wanted afterwards.
    pub(super) keep_depth: bool,
    /// In texels, from the upper left corner.
    pub(super) size: [u32; 2],
}

/// The overrides of the gem recipes for these settings.
pub(crate) fn constants(scene: &Scene, settings: &Settings) -> Vec<(&'static str, f64)> {
    let flag = |on: bool| if on { 1.0 } else { 0.0 };
    let rung = settings.rung;
    let inside = flag(rung != Rung::Surface);
    let absorbs = settings.absorption && scene.objects.iter().any(|object| object.material.absorbs());
    let (disperses, form, wavelengths) = match rung.spectrum() {
        Spectrum::One => (false, 1, 3),
        Spectrum::Paper => (true, 0, 3),
        Spectrum::Tracker => (true, 1, 3),
        Spectrum::Separate(count) => (true, 2, count),
    };
    vec![
        ("EFFECT_PROXY_GEOMETRY", inside),
        ("EFFECT_CONVEX_TRACE", inside),
        ("EFFECT_BVH_TRACE", inside),
        ("TRAVERSAL_LOOP", flag(rung.geometry() == Geometry::Triangles)),
        ("EFFECT_ENVIRONMENT_MAP", flag(matches!(settings.environment, Environment::Map(_)))),
        ("EFFECT_ABSORPTION", flag(absorbs)),
        ("EFFECT_DISPERSION", flag(disperses)),
        ("DISPERSION_FORM", f64::from(form)),
        ("WAVELENGTHS", f64::from(wavelengths)),
        ("BOUNCES", f64::from(rung.hits())),
        ("REST_FROM_ENVIRONMENT", flag(settings.rest_from_environment)),
        ("LIMIT_DISTANCE", flag(settings.distance_limit.is_some())),
        ("CENTRE_PAPER", flag(settings.paper_centre)),
    ]
}

impl<'gpu> GemPass<'gpu> {
    /// Compiles `source`, the rung's composed recipe, with the fragment entry point `fragment`, and uploads the scene.
    pub(super) fn new(
        gpu: &'gpu Gpu,
        scene: &Scene,
        settings: &Settings,
        source: &str,
        fragment: &str,
        formats: &[wgpu::TextureFormat],
    ) -> Result<Self, RenderError> {
        let pipeline = device::pipeline(
            gpu,
            &PipelineSource {
                recipe: settings.rung.recipe(),
                source,
                entries: ["gem_vertex", fragment],
                constants: &constants(scene, settings),
                formats,
                depth: Some(DEPTH_FORMAT),
            },
        )?;
        let environment = super::environment::texture(gpu, &settings.environment)?;
        let stones: Result<Vec<Stone>, RenderError> =
            scene.objects.iter().map(|object| Stone::upload(gpu, &pipeline, object, settings)).collect();
        Ok(Self { gpu, pipeline, environment, stones: stones? })
    }

    /// The recipe's view: group 0.
    pub(super) fn view(&self, clip_from_world: Mat4, eye: Vec3) -> wgpu::BindGroup {
        let device = &self.gpu.device;
        let mut values = clip_from_world.to_cols_array().to_vec();
        values.extend(eye.to_array());
        let uniform = device::uniform(device, &values);
        let resources = vec![uniform.as_entire_binding(), wgpu::BindingResource::TextureView(&self.environment)];
        device::bind_group(device, &self.pipeline, 0, resources)
    }

    /// Draws the stones: one draw call for each object.
    pub(super) fn draw(&self, encoder: &mut wgpu::CommandEncoder, view: &wgpu::BindGroup, target: &GemTarget<'_>) {
        let colors: Vec<_> = target.colors.iter().map(|view| device::cleared(view)).collect();
        let store = if target.keep_depth { wgpu::StoreOp::Store } else { wgpu::StoreOp::Discard };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("gem"),
            color_attachments: &colors,
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: target.depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store }),
                stencil_ops: None,
            }),
            ..wgpu::RenderPassDescriptor::default()
        });
        let [width, height] = target.size;
        pass.set_viewport(0.0, 0.0, width as f32, height as f32, 0.0, 1.0);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, view, &[]);
        for stone in &self.stones {
            stone.draw(&mut pass);
        }
    }

    /// How many draw calls a frame takes.
    pub(super) fn draw_calls(&self) -> usize {
        self.stones.len()
    }
}
