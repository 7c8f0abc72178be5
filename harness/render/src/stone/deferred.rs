//! Deferred drawing (the paper's section 4.3.4): the gem recipe fills a geometry buffer, and a
//! lighting pass produces the picture.

use crate::error::RenderError;
use crate::frame::record::Record;
use crate::frame::{Bound, Builder, Depth, PipelineId, PipelineSource, Target, Texture};
use crate::light::lighting::Lighting;
use crate::objects::draws::{self, SceneTarget, Variant};
use crate::picture::Tile;
use crate::picture::formats::{DEPTH_FORMAT, SAMPLE_FORMAT};
use crate::settings::Settings;
use glam::{Mat4, UVec2, Vec3};
use lapidary_scene::Environment;

/// Format of the colour targets: the one that engines use for emission, and precise enough for a
/// normal (2^-11 per component).
pub(crate) const GEOMETRY_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// Recipe of the lighting pass.
pub(crate) const COMPOSITE: &str = "gem_composite";

/// Number of colour targets: emission, normal, reflectance.
pub(crate) const TARGETS: usize = 3;

/// The geometry buffer of one tile and the lighting pass.
pub(crate) struct DeferredPass {
    pipeline: PipelineId,
    environment: Option<Texture>,
    emission: Texture,
    normal: Texture,
    reflectance: Texture,
    depth: Texture,
}

impl DeferredPass {
    /// Creates the passes for the settings' environment and samples; `source` is the composed
    /// recipe of the lighting pass.
    pub(crate) fn new(
        builder: &mut Builder<'_>,
        lighting: &Lighting<'_>,
        settings: &Settings,
        source: &str,
    ) -> Result<Self, RenderError> {
        let map = f64::from(u8::from(matches!(settings.environment, Environment::Map(_))));
        let pipeline = builder.render_pipeline(&PipelineSource {
            recipe: COMPOSITE,
            source,
            entries: ["gem_composite_vertex", "gem_composite_fragment"],
            constants: &[("EFFECT_ENVIRONMENT_MAP", map)],
            formats: &[SAMPLE_FORMAT],
            depth: None,
        })?;
        let [width, height] =
            [settings.width, settings.height].map(|side| settings.samples * side.min(Tile::side(settings.samples)));
        let [emission, normal, reflectance, depth] = [
            ("emission", GEOMETRY_FORMAT),
            ("normal", GEOMETRY_FORMAT),
            ("reflectance", GEOMETRY_FORMAT),
            ("geometry's depth", DEPTH_FORMAT),
        ]
        .map(|(what, format)| builder.target(what, [width, height, 1], format, wgpu::TextureUsages::TEXTURE_BINDING));
        let reads = builder.binds(pipeline, 0, 1);
        let environment = reads.then(|| lighting.environment(builder)).transpose()?;
        Ok(Self { pipeline, environment, emission, normal, reflectance, depth })
    }

    /// Fills the geometry buffer, then lights it.
    pub(crate) fn draw(
        &self,
        builder: &mut Builder<'_>,
        variants: &[Variant],
        (clip_from_world, eye): (Mat4, Vec3),
        samples: Texture,
        size: [u32; 2],
    ) {
        let target = SceneTarget {
            colors: [self.emission, self.normal, self.reflectance].map(Target::from).into(),
            depth: Depth { keep: true, ..self.depth.into() },
            size,
        };
        draws::draw(builder, variants, ("scene", &|_| true), (clip_from_world, eye, &[]), &target);
        // In f64: the inverse of a perspective matrix loses digits that the depth still holds.
        let world_from_clip = clip_from_world.as_dmat4().inverse().as_mat4();
        let view = Record::new("GemCompositeView").with("world_from_clip", world_from_clip).with("eye", eye);
        let uniform = builder.uniform("composite's view", view.with("size", UVec2::from(size).as_vec2()));
        let mut resources: Vec<(u32, Bound)> = vec![(0, uniform.into())];
        resources.extend((2..).zip([self.emission, self.normal, self.reflectance, self.depth].map(Bound::from)));
        resources.extend(self.environment.map(|environment| (1, environment.into())));
        let group = builder.bind(self.pipeline, 0, &resources);
        let draw = builder.draw(self.pipeline, vec![group], 3);
        let [width, height] = size;
        builder.draw_to(COMPOSITE, &[samples], Some([0, 0, width, height]), vec![draw]);
    }
}

#[cfg(test)]
mod tests;
