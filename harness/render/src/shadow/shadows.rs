//! Shadows on objects that are shaded at their surface alone: the lights' views of all bodies that may
//! stand between a light and such an object, drawn once for the whole scene.

use super::casters::{Caster, casters_on};
use super::colored_shadow::ColoredShadows;
use super::light_views;
use super::reflective_shadow_map::{self, ReflectiveShadowMaps};
use crate::error::RenderError;
use crate::frame::{Bound, Buffer, Builder, PipelineId};
use crate::light::lighting::Lighting;
use crate::objects::mesh_buffers::MeshBuffers;
use crate::objects::part::{Drawn, Part};
use lapidary_plan::Effect;
use lapidary_plan::Rung;
use lapidary_plan::casting::{self, Casting};
use lapidary_scene::Bounds;

/// Texels along a side of a map. A shadow's edge is one texel soft, and detail that stands out by
/// less than a texel casts no shadow.
const SIDE: u32 = 1024;
/// The same if there are more than one view of some light: a lamp among the objects.
const SIDE_AROUND: u32 = 512;

/// The lights' maps.
pub(crate) struct Shadows {
    views: Buffer,
    /// Bodies that let no light through; `None` if none casts a shadow.
    opaque: Option<ReflectiveShadowMaps>,
    /// Clear stones; `None` if none casts a shadow.
    stones: Option<ColoredShadows>,
}

impl Shadows {
    /// Creates the maps for the objects of all parts; returns `None` if no object receives shadows.
    pub(crate) fn of(
        builder: &mut Builder<'_>,
        lighting: &Lighting<'_>,
        parts: &[Part<'_>],
    ) -> Result<Option<Self>, RenderError> {
        let on_surfaces = || parts.iter().filter(|part| matches!(part.rung, Rung::Diffuse(_)));
        let lit = || on_surfaces().flat_map(|part| &part.objects);
        let is_entered = |drawn: &&Drawn<'_>| drawn.decisions.has(Effect::TranslucentShadow);
        // A body that light comes through is in its own way, whether or not it casts a shadow.
        let entered: Vec<&Drawn<'_>> = lit().filter(is_entered).collect();
        let mut opaque = casters(lighting, lit(), (Effect::Shadow, Casting::Opaque));
        opaque.retain(|(name, _)| entered.iter().all(|drawn| drawn.name != *name));
        let stones = casters(lighting, lit(), (Effect::ColoredShadow, Casting::Clear));
        let casting = opaque.iter().chain(&stones).map(|(_, body)| *body);
        let seen = casting.chain(entered.iter().map(|drawn| drawn.object)).map(casting::bounds);
        let Some(bounds) = seen.reduce(Bounds::joined) else { return Ok(None) };
        let lights = &lighting.scene.lights;
        let views = light_views::views(lights, bounds, None);
        reflective_shadow_map::check_views(builder, &views)?;
        let side = if views.len() > lights.len() { SIDE_AROUND } else { SIDE };
        let side = side.min(builder.limits().max_texture_dimension_2d);
        let buffer = reflective_shadow_map::view_buffer(builder, &views);
        let opaque = if opaque.is_empty() && entered.is_empty() {
            None
        } else {
            let mut maps = ReflectiveShadowMaps::new(builder, &views, side, "for shadows")?;
            for Drawn { name, object, .. } in entered {
                let shape = lighting.shapes.of(builder, name, object)?;
                let mesh = builder.of_object(name, |builder| MeshBuffers::of(builder, shape, object))?;
                maps.add(builder, name, &mesh)?;
            }
            for (name, body) in opaque {
                let shape = lighting.shapes.of(builder, &name, body)?;
                maps.add_caster(builder, &name, &shape)?;
            }
            Some(maps)
        };
        let stones = if stones.is_empty() { None } else { Some(ColoredShadows::new(builder, &views, side, &stones)?) };
        Ok(Some(Self { views: buffer, opaque, stones }))
    }

    /// Returns the resources of bindings 4, 5 and 10 of group 0 that `pipeline` reads.
    pub(crate) fn shared(&self, builder: &Builder<'_>, pipeline: PipelineId) -> Vec<(u32, Bound)> {
        let mut all = vec![(4, self.views.into())];
        all.extend(self.opaque.as_ref().map(|maps| (5, maps.layers())));
        all.extend(self.stones.as_ref().map(|stones| (10, stones.layers())));
        all.into_iter().filter(|(binding, _)| builder.binds(pipeline, 0, *binding)).collect()
    }

    /// Draws all maps.
    pub(crate) fn encode(&self, builder: &mut Builder<'_>) {
        if let Some(maps) = &self.opaque {
            maps.encode(builder);
        }
        if let Some(stones) = &self.stones {
            stones.encode(builder);
        }
    }
}

/// Returns the bodies of this kind that may keep light from those with this effect.
fn casters<'a, 'b: 'c, 'c>(
    lighting: &Lighting<'a>,
    lit: impl Iterator<Item = &'c Drawn<'b>>,
    (effect, kind): (Effect, Casting),
) -> Vec<Caster<'a>> {
    let lit: Vec<_> = lit
        .filter(|drawn| drawn.decisions.has(effect))
        .map(|drawn| (drawn.object, casting::bounds(drawn.object)))
        .collect();
    casters_on(lighting, &lit, kind)
}
