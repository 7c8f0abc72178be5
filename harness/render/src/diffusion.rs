//! Texture diffusion of one object: the recipe `texture_irradiance` draws what arrives, the recipe `texture_diffusion` blurs it.

use super::RenderError;
use super::device::{self, Pipeline, PipelineSource};
use super::texture_diffusion::{Chart, IRRADIANCE_FORMAT, STRETCH_FORMAT, Taps, TextureDiffusion};
use super::translucent::{self, Light};
use lapidary_gpu::capture::OfObject;
use lapidary_gpu::{Encoder, Gpu};
use lapidary_scene::Object;
use lapidary_scene::layout::Layout;

/// The recipe's name.
const RECIPE: &str = "texture_irradiance";
/// Texels along each side: the paper's.
pub(super) const SIDE: u32 = 1024;

/// An object's textures, and how they are filled.
pub(super) struct Diffusion<'gpu> {
    gpu: &'gpu Gpu,
    textures: TextureDiffusion<'gpu>,
    /// Of its object.
    name: String,
    pipeline: Pipeline,
    /// Lights and harmonics, then the mesh.
    groups: [Option<wgpu::BindGroup>; 2],
    vertices: u32,
    taps: Taps,
    charts: Vec<Chart>,
}

/// What it reads of the mesh as it is shown.
pub(super) struct MeshBuffers<'a> {
    pub(super) positions: &'a wgpu::Buffer,
    pub(super) normals: &'a wgpu::Buffer,
    pub(super) uvs: &'a wgpu::Buffer,
}

impl<'gpu> Diffusion<'gpu> {
    /// For `object`, which has texture coordinates, under these lights and harmonics, with the overrides that go with them.
    pub(super) fn new(
        gpu: &'gpu Gpu,
        (object, name): (&Object, &str),
        (light, constants): (Light<'_>, &[(&str, f64)]),
        mesh: &MeshBuffers<'_>,
    ) -> Result<Self, RenderError> {
        let pipeline = device::pipeline(
            gpu,
            &PipelineSource {
                recipe: RECIPE,
                source: &lapidary_wgsl::recipe_source(RECIPE),
                entries: ["texture_irradiance_vertex", "texture_irradiance_fragment"],
                constants,
                formats: &[IRRADIANCE_FORMAT, STRETCH_FORMAT],
                depth: None,
            },
        )?;
        let Layout { repeats, charts } = Layout::of(&object.mesh);
        let textures = TextureDiffusion::new(gpu, [SIDE; 2], [repeats.x, repeats.y])?;
        // Halos first, so that of two that touch a texel the chart's own triangle stays.
        let drawn = [&object.mesh.halo[..], &object.mesh.indices].concat();
        let vertices = device::mesh_vertices(gpu, object, &drawn, [bytemuck::cast_slice(&drawn)])?;
        let shared = translucent::shared(light, &pipeline)?;
        let groups = gpu.guarded("uploading a mesh", |device| {
            let contents = bytemuck::cast_slice(&drawn);
            let indices = device::storage(device, "indices with halos", contents);
            let own = [(0, mesh.positions), (1, &indices), (2, mesh.normals), (3, mesh.uvs)];
            let shared: Vec<_> = shared.iter().map(|(binding, shared)| (*binding, shared.resource())).collect();
            let own = own.map(|(binding, buffer)| (binding, buffer.as_entire_binding()));
            [pipeline.bind(device, 0, &shared), pipeline.bind(device, 1, &own)]
        })?;
        Ok(Self {
            gpu,
            textures,
            name: name.to_owned(),
            pipeline,
            groups,
            vertices,
            taps: Taps::new(object.material.sigma0.unwrap_or_default()),
            charts: apart(charts.into_iter().map(texels).collect()),
        })
    }

    /// What shading looks up.
    pub(super) fn diffused(&self) -> wgpu::TextureView {
        device::view(&self.textures.diffused)
    }

    /// Draws what arrives and blurs it.
    pub(super) fn encode(&self, encoder: &mut Encoder) -> Result<(), RenderError> {
        let _of = OfObject::named(&self.name);
        let targets = [&self.textures.irradiance, &self.textures.stretch].map(device::view);
        self.gpu.guarded("drawing irradiance", |_| {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some(RECIPE),
                color_attachments: &targets.each_ref().map(device::cleared),
                ..wgpu::RenderPassDescriptor::default()
            });
            pass.set_pipeline(&self.pipeline.raw);
            for (group, bind_group) in (0..).zip(&self.groups) {
                pass.set_bind_group(group, bind_group.as_ref());
            }
            pass.draw(0..self.vertices, 0..1);
        })?;
        self.textures.encode(encoder, &self.taps, &self.charts)
    }

    /// How many draw calls it takes: the mesh, each chart along u and v, and the gutters.
    pub(super) fn draw_calls(&self) -> usize {
        2 + 2 * self.charts.len()
    }
}

/// The texels that a box of texture coordinates touches.
fn texels([low, high]: [glam::Vec2; 2]) -> Chart {
    let place = |value: f32| value.clamp(0.0, SIDE as f32) as u32;
    let (low, high) = ((low * SIDE as f32).floor(), (high * SIDE as f32).ceil());
    Chart { low: [place(low.x), place(low.y)], high: [place(high.x), place(high.y)] }
}

/// Boxes that touch one another made one: between two that are blurred apart there is a texel.
fn apart(mut charts: Vec<Chart>) -> Vec<Chart> {
    let touch = |a: &Chart, b: &Chart| (0..2).all(|k| a.low[k] <= b.high[k] && b.low[k] <= a.high[k]);
    let mut merged: Vec<Chart> = Vec::new();
    while let Some(mut chart) = charts.pop() {
        while let Some(place) = merged.iter().position(|other| touch(&chart, other)) {
            let other = merged.swap_remove(place);
            for k in 0..2 {
                chart.low[k] = chart.low[k].min(other.low[k]);
                chart.high[k] = chart.high[k].max(other.high[k]);
            }
        }
        merged.push(chart);
    }
    merged
}

#[cfg(test)]
mod tests;
