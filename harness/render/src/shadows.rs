//! Shadows on objects that are shaded at their surface alone: the lights' views of all bodies
//! except the clear ones, drawn once for the whole scene.

use super::mesh_buffers::MeshBuffers;
use super::reflective_shadow_map::{self, ReflectiveShadowMaps};
use super::variant::Part;
use super::{RenderError, Rung, light_views};
use crate::frame::{Bound, Buffer, Builder, PipelineId};
use lapidary_plan::Effect;
use lapidary_scene::{Bounds, Light};
use std::collections::HashMap;

/// Texels along a side of a map. A shadow's edge is one texel soft, and detail that stands out by
/// less than a texel casts no shadow.
const SIDE: u32 = 1024;

/// The lights' maps.
pub(super) struct Shadows {
    maps: ReflectiveShadowMaps,
    views: Buffer,
    /// Buffers of each body that casts shadows, by its name.
    meshes: HashMap<String, MeshBuffers>,
}

impl Shadows {
    /// Creates the maps for the objects of all parts; returns `None` if no object receives shadows.
    pub(super) fn of(
        builder: &mut Builder<'_>,
        lights: &[Light],
        parts: &[Part<'_>],
    ) -> Result<Option<Self>, RenderError> {
        let all = || parts.iter().flat_map(|part| part.objects.iter().map(move |drawn| (part.rung, drawn)));
        if !all().any(|(_, drawn)| drawn.decisions.has(Effect::Shadow)) {
            return Ok(None);
        }
        let casts = |rung: &Rung| matches!(rung, Rung::Diffuse(_) | Rung::OpticalPath(_) | Rung::Diffusion(_));
        let casting = || all().filter(|(rung, _)| casts(rung)).map(|(_, drawn)| drawn);
        let bounds = Bounds::of(casting().flat_map(|drawn| drawn.object.mesh.positions.iter().copied()));
        let views = light_views::views(lights, bounds);
        let side = SIDE.min(builder.limits().max_texture_dimension_2d);
        let mut maps = ReflectiveShadowMaps::new(builder, &views, side, "for shadows")?;
        let views = reflective_shadow_map::view_buffer(builder, &views);
        let mut meshes = HashMap::new();
        for drawn in casting() {
            let mesh = builder.of_object(&drawn.name, |builder| {
                let mesh = MeshBuffers::of(builder, drawn.object)?;
                maps.add(builder, &drawn.name, &mesh);
                Ok::<_, RenderError>(mesh)
            })?;
            meshes.insert(drawn.name.clone(), mesh);
        }
        Ok(Some(Self { maps, views, meshes }))
    }

    /// Returns a body's positions, indices and normals, so that they need not be stored twice;
    /// `None` if it casts no shadow.
    pub(super) fn mesh(&self, name: &str) -> Option<&MeshBuffers> {
        self.meshes.get(name)
    }

    /// Returns the resources of bindings 4 and 5 of group 0 that `pipeline` reads.
    pub(super) fn shared(&self, builder: &Builder<'_>, pipeline: PipelineId) -> Vec<(u32, Bound)> {
        let all = [(4, self.views.into()), (5, self.maps.layers())];
        all.into_iter().filter(|(binding, _)| builder.binds(pipeline, 0, *binding)).collect()
    }

    /// Draws all maps.
    pub(super) fn encode(&self, builder: &mut Builder<'_>) {
        self.maps.encode(builder);
    }
}
