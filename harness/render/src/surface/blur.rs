//! Texture diffusion of one object: the recipe `texture_irradiance` draws the irradiance, and the
//! recipe `blur_texture` blurs it.

use super::lit::{Light, shared};
use super::texture_diffusion::{Chart, IRRADIANCE_FORMAT, STRETCH_FORMAT, Taps, TextureDiffusion};
use crate::error::RenderError;
use crate::frame::{BindGroupId, Buffer, Builder, PipelineId, PipelineSource, Texture};
use crate::objects::mesh_buffers;
use lapidary_scene::Object;
use lapidary_scene::layout::Layout;

/// Name of the recipe.
const RECIPE: &str = "texture_irradiance";
/// Texels along each side, as in the paper.
pub(crate) const SIDE: u32 = 1024;

/// Textures of an object, and the passes that fill them.
pub(crate) struct Blur {
    textures: TextureDiffusion,
    /// Name of the object.
    name: String,
    pipeline: PipelineId,
    /// Groups for the lights and harmonics, then for the mesh.
    groups: Vec<Option<BindGroupId>>,
    vertices: u32,
    taps: Taps,
    charts: Vec<Chart>,
}

impl Blur {
    /// Creates the passes for `object`, which must have texture coordinates.
    ///
    /// `light` and `constants` are the lights and harmonics with their overrides; the last
    /// parameter holds the mesh's positions, normals and texture coordinates as drawn.
    pub(crate) fn new(
        builder: &mut Builder<'_>,
        (object, name): (&Object, &str),
        (light, constants): (Light<'_>, &[(&str, f64)]),
        [positions, normals, uvs]: [Buffer; 3],
    ) -> Result<Self, RenderError> {
        let pipeline = builder.render_pipeline(&PipelineSource {
            recipe: RECIPE,
            source: &lapidary_wgsl::recipe_source(RECIPE),
            entries: ["texture_irradiance_vertex", "texture_irradiance_fragment"],
            constants,
            formats: &[IRRADIANCE_FORMAT, STRETCH_FORMAT],
            depth: None,
        })?;
        let Layout { repeats, charts } = Layout::of(&object.mesh);
        let textures = TextureDiffusion::new(builder, [SIDE; 2], [repeats.x, repeats.y])?;
        // Halos first: if a halo and a chart's own triangle touch the same texel, the triangle
        // stays.
        let drawn = [&object.mesh.halo[..], &object.mesh.indices].concat();
        let vertices = mesh_buffers::vertices(object, &drawn, [bytemuck::cast_slice(&drawn)])?;
        let shared = shared(builder, light, pipeline)?;
        let indices = builder.storage("indices with halos", bytemuck::cast_slice(&drawn));
        let of_mesh = [(0, positions.into()), (1, indices.into()), (2, normals.into()), (3, uvs.into())];
        let groups = vec![builder.bind(pipeline, 0, &shared), builder.bind(pipeline, 1, &of_mesh)];
        Ok(Self {
            textures,
            name: name.to_owned(),
            pipeline,
            groups,
            vertices,
            taps: Taps::new(object.material.sigma0.unwrap_or_default()),
            charts: merged(charts.into_iter().map(texels).collect()),
        })
    }

    /// Returns the texture that shading looks up.
    pub(crate) fn diffused(&self) -> Texture {
        self.textures.diffused
    }

    /// Draws the irradiance and blurs it.
    pub(crate) fn encode(&self, builder: &mut Builder<'_>) {
        builder.of_object(&self.name, |builder| {
            let draw = builder.draw(self.pipeline, self.groups.clone(), self.vertices);
            builder.draw_to(RECIPE, &[self.textures.irradiance, self.textures.stretch], None, vec![draw]);
            self.textures.encode(builder, &self.taps, &self.charts);
        });
    }
}

/// Returns the texels that a box of texture coordinates touches.
fn texels([low, high]: [glam::Vec2; 2]) -> Chart {
    let place = |value: f32| value.clamp(0.0, SIDE as f32) as u32;
    let (low, high) = ((low * SIDE as f32).floor(), (high * SIDE as f32).ceil());
    Chart { low: [place(low.x), place(low.y)], high: [place(high.x), place(high.y)] }
}

/// Merges boxes that touch, so that boxes blurred separately have a texel between them.
fn merged(mut charts: Vec<Chart>) -> Vec<Chart> {
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
