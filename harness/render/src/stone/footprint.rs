//! Facets' edges smoothed from one sample per pixel: the gem recipe also writes shares of the
//! neighbours, and a second pass mixes them.

use crate::error::RenderError;
use crate::frame::record::Record;
use crate::frame::{Bound, Builder, PipelineId, PipelineSource, Texture};
use crate::picture::formats::SAMPLE_FORMAT;
use crate::settings::Settings;
use glam::UVec2;
use lapidary_plan::Effect;

/// Formats of the colour targets: the picture, and shares, for which eight bits suffice.
pub(crate) const FORMATS: [wgpu::TextureFormat; 2] = [SAMPLE_FORMAT, wgpu::TextureFormat::Rgba8Unorm];

/// Recipe of the second pass.
const RESOLVE: &str = "gem_resolve";

/// Whether the settings ask for smoothed edges.
pub(crate) fn is_on(settings: &Settings) -> bool {
    settings.gem.footprint && !settings.gem.deferred && !settings.without.has(Effect::Footprint)
}

/// The targets of one tile and the second pass.
pub(crate) struct FootprintPass {
    pipeline: PipelineId,
    pub(crate) radiance: Texture,
    pub(crate) neighbours: Texture,
}

impl FootprintPass {
    /// Creates the passes for pictures of up to `width` by `height` samples; `None` if the settings do
    /// not ask for them.
    pub(crate) fn of(
        builder: &mut Builder<'_>,
        settings: &Settings,
        [width, height]: [u32; 2],
    ) -> Result<Option<Self>, RenderError> {
        if !is_on(settings) {
            return Ok(None);
        }
        let pipeline = builder.render_pipeline(&PipelineSource {
            recipe: RESOLVE,
            source: &lapidary_wgsl::recipe_source(RESOLVE),
            entries: ["gem_resolve_vertex", "gem_resolve_fragment"],
            constants: &[],
            formats: &[SAMPLE_FORMAT],
            depth: None,
        })?;
        let [radiance, neighbours] = [("radiance", FORMATS[0]), ("neighbours", FORMATS[1])].map(|(what, format)| {
            builder.target(what, [width, height, 1], format, wgpu::TextureUsages::TEXTURE_BINDING)
        });
        Ok(Some(Self { pipeline, radiance, neighbours }))
    }

    /// Mixes each sample with its neighbours.
    pub(crate) fn resolve(&self, builder: &mut Builder<'_>, samples: Texture, size: [u32; 2]) {
        let view = Record::new("GemResolveView").with("size", UVec2::from(size));
        let uniform = builder.uniform("resolve's view", view);
        let resources: [(u32, Bound); 3] =
            [(0, uniform.into()), (1, self.radiance.into()), (2, self.neighbours.into())];
        let group = builder.bind(self.pipeline, 0, &resources);
        let draw = builder.draw(self.pipeline, vec![group], 3);
        let [width, height] = size;
        builder.draw_to(RESOLVE, &[samples], Some([0, 0, width, height]), vec![draw]);
    }
}
