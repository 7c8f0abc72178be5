//! The recipe `colored_shadow`: clear stones as the lights see them, one layer of a texture for each
//! view.

use super::casters::Caster;
use super::light_views::LightView;
use super::reflective_shadow_map::view_groups;
use crate::error::RenderError;
use crate::frame::record::Record;
use crate::frame::{BindGroupId, Blend, Bound, Builder, Pass, PipelineId, PipelineSource, RenderPass, Target, Texture};
use crate::objects::mesh_buffers::ShapeBuffers;
use glam::Vec3;
use lapidary_plan::casting;
use lapidary_scene::Object;

const RECIPE: &str = "colored_shadow";
/// Format of a texel: optical depths, and a depth from 0 to 1. Every device blends it.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// No stone: all light passes, and whatever is seen lies before the first stone.
const NOTHING: [f64; 4] = [0.0, 0.0, 0.0, 1.0];
/// The least share of light that a stone's base colour lets through.
const LEAST: f32 = 1e-4;

/// The maps and the resources that draw them.
pub(crate) struct ColoredShadows {
    pipeline: PipelineId,
    texture: Texture,
    /// One bind group for each view, in order.
    views: Vec<Option<BindGroupId>>,
    /// Each stone's name, its bind group, and the number of vertices to draw.
    stones: Vec<(String, Option<BindGroupId>, u32)>,
}

impl ColoredShadows {
    /// Creates maps of `side` × `side` texels for `views`, of which there must be at least one.
    pub(crate) fn new(
        builder: &mut Builder<'_>,
        views: &[LightView],
        side: u32,
        stones: &[Caster<'_>],
    ) -> Result<Self, RenderError> {
        let source = PipelineSource {
            recipe: RECIPE,
            source: &lapidary_wgsl::recipe_source(RECIPE),
            entries: ["colored_shadow_vertex", "colored_shadow_fragment"],
            constants: &[],
            formats: &[FORMAT],
            depth: None,
        };
        let blend = Blend { color: wgpu::BlendOperation::Add, alpha: wgpu::BlendOperation::Min };
        let pipeline = builder.render_pipeline_with(&source, None, Some(blend))?;
        let size = [side, side, views.len() as u32];
        let texture = builder.target("shadows of clear stones", size, FORMAT, wgpu::TextureUsages::TEXTURE_BINDING);
        let of_views: Vec<_> = views.iter().map(|from| from.view).collect();
        let views = view_groups(builder, pipeline, &of_views);
        let mut drawn = Vec::new();
        for (name, stone) in stones {
            // Copies of several colours have a bind group for each.
            let colored = stone.copies.as_ref().is_some_and(|copies| copies.is_coloured());
            let bodies = if colored { stone.apart() } else { vec![(*stone).clone()] };
            for body in &bodies {
                let (group, vertices) = builder.of_object(name, |builder| {
                    let ShapeBuffers { positions, indices, vertices } = ShapeBuffers::of(builder, body)?;
                    let record = builder.record("stone in the light", record_of(body));
                    let resources = [(0, record.into()), (1, positions.into()), (2, indices.into())];
                    Ok::<_, RenderError>((builder.bind(pipeline, 1, &resources), vertices))
                })?;
                drawn.push((name.clone(), group, vertices));
            }
        }
        Ok(Self { pipeline, texture, views, stones: drawn })
    }

    /// Returns the texture with all layers, for binding.
    pub(crate) fn layers(&self) -> Bound {
        Bound::Texture(self.texture, wgpu::TextureViewDimension::D2Array)
    }

    /// Draws all maps.
    pub(crate) fn encode(&self, builder: &mut Builder<'_>) {
        for (layer, view) in (0..).zip(&self.views) {
            let draw = |(name, stone, vertices): &(String, Option<BindGroupId>, u32)| {
                let groups = vec![*view, *stone];
                builder.of_object(name, |builder| builder.draw(self.pipeline, groups, *vertices))
            };
            let draws = self.stones.iter().map(draw).collect();
            builder.pass(Pass::Render(RenderPass {
                name: RECIPE.to_owned(),
                targets: vec![Target { texture: self.texture, layer, clear: Some(NOTHING) }],
                depth: None,
                viewport: None,
                draws,
            }));
        }
    }
}

/// Fills `ColoredShadowStone` of the recipe.
fn record_of(stone: &Object) -> Record {
    let material = &stone.material;
    let absorption = lapidary_absorption::coefficient(material.attenuation_color, material.attenuation_distance);
    // The base colour is passed once by light that enters and leaves.
    let surface = -0.5 * material.base_color.max(Vec3::splat(LEAST)).map(f32::ln);
    let record = Record::new("ColoredShadowStone").with("absorption", absorption).with("index", material.ior);
    record.with("surface", surface).with("centre", casting::bounds(stone).centre())
}
