//! The deferred way (the paper's section 4.3.4): the gem recipe fills a geometry buffer, and a lighting pass makes the picture.

use super::device::{self, PipelineSource};
use super::gem::{DEPTH_FORMAT, GemPass, GemTarget, SAMPLE_FORMAT};
use super::{Environment, RenderError, Settings, TILE};
use crate::cookbook;
use crate::gpu::Gpu;
use glam::{Mat4, Vec3};

/// Of both colour targets: what engines use for emission, and enough for a normal (2^-11 a component).
pub(super) const GEOMETRY_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// The geometry buffer of one tile and the lighting pass.
pub(super) struct DeferredPass<'gpu> {
    gpu: &'gpu Gpu,
    pipeline: wgpu::RenderPipeline,
    environment: wgpu::TextureView,
    emission: wgpu::TextureView,
    normal_reflectance: wgpu::TextureView,
    depth: wgpu::TextureView,
}

impl<'gpu> DeferredPass<'gpu> {
    /// For the settings' environment and samples.
    pub(super) fn new(gpu: &'gpu Gpu, settings: &Settings) -> Result<Self, RenderError> {
        let map = f64::from(u8::from(matches!(settings.environment, Environment::Map(_))));
        let pipeline = device::pipeline(
            gpu,
            &PipelineSource {
                recipe: "gem_composite",
                source: &cookbook::recipe_source("gem_composite"),
                entries: ["gem_composite_vertex", "gem_composite_fragment"],
                constants: &[("EFFECT_ENVIRONMENT_MAP", map)],
                formats: &[SAMPLE_FORMAT],
                depth: None,
            },
        )?;
        let size = [TILE * settings.samples; 2];
        let [emission, normal_reflectance, depth] = gpu.guarded("allocating a geometry buffer", |device| {
            [GEOMETRY_FORMAT, GEOMETRY_FORMAT, DEPTH_FORMAT]
                .map(|format| device::view(&device::target(device, size, format, wgpu::TextureUsages::TEXTURE_BINDING)))
        })?;
        let environment = super::environment::texture(gpu, &settings.environment)?;
        Ok(Self { gpu, pipeline, environment, emission, normal_reflectance, depth })
    }

    /// Fills the geometry buffer, then lights it.
    pub(super) fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        gem: &GemPass<'_>,
        clip_from_world: Mat4,
        eye: Vec3,
        samples: &wgpu::TextureView,
        size: [u32; 2],
    ) {
        let target = GemTarget {
            colors: vec![&self.emission, &self.normal_reflectance],
            depth: &self.depth,
            keep_depth: true,
            size,
        };
        gem.draw(encoder, &gem.view(clip_from_world, eye), &target);
        let device = &self.gpu.device;
        // In f64: the inverse of a perspective matrix loses digits that the depth still holds.
        let mut values = clip_from_world.as_dmat4().inverse().as_mat4().to_cols_array().to_vec();
        values.extend([eye.x, eye.y, eye.z, 0.0, size[0] as f32, size[1] as f32]);
        let uniform = device::uniform(device, &values);
        let textures = [&self.environment, &self.emission, &self.normal_reflectance, &self.depth];
        let mut resources = vec![uniform.as_entire_binding()];
        resources.extend(textures.map(wgpu::BindingResource::TextureView));
        let group = device::bind_group(device, &self.pipeline, 0, resources);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("gem_composite"),
            color_attachments: &[device::cleared(samples)],
            ..wgpu::RenderPassDescriptor::default()
        });
        pass.set_viewport(0.0, 0.0, size[0] as f32, size[1] as f32, 0.0, 1.0);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }
}
