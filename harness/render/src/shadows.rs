//! Shadows on objects that are shaded at their surface alone: the lights' views of all bodies
//! except the clear ones, drawn once for the whole scene.

use super::reflective_shadow_map::{self, ReflectiveShadowMaps};
use super::variant::Part;
use super::{RenderError, Rung, light_views};
use crate::frame::{Bound, Buffer, Builder, PipelineId};
use lapidary_plan::Effect;
use lapidary_scene::{Bounds, Light, Mesh};
use std::collections::HashMap;

/// Texels along a side of a map. A shadow's edge is one texel soft, and detail that stands out by
/// less than a texel casts no shadow.
const SIDE: u32 = 1024;

/// A mesh's positions, indices and normals, as recipes for bodies bind them.
pub(super) struct MeshBuffers {
    pub(super) positions: Buffer,
    pub(super) indices: Buffer,
    pub(super) normals: Buffer,
}

impl MeshBuffers {
    /// Creates the buffers of the current object's mesh.
    pub(super) fn of(builder: &mut Builder<'_>, mesh: &Mesh) -> Self {
        let [positions, indices, normals] = Self::parts(mesh).map(|(what, part)| builder.storage(what, part));
        Self { positions, indices, normals }
    }

    /// Names and contents of the buffers.
    pub(super) fn parts(mesh: &Mesh) -> [(&'static str, &[u8]); 3] {
        [
            ("positions", bytemuck::cast_slice(&mesh.positions)),
            ("indices", bytemuck::cast_slice(&mesh.indices)),
            ("normals", bytemuck::cast_slice(&mesh.normals)),
        ]
    }
}

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
        let casts = |rung: &Rung| matches!(rung, Rung::Diffuse(_) | Rung::OpticalPath(_));
        let casting = || all().filter(|(rung, _)| casts(rung)).map(|(_, drawn)| drawn);
        let bounds = Bounds::of(casting().flat_map(|drawn| drawn.object.mesh.positions.iter().copied()));
        let views = light_views::views(lights, bounds);
        let side = SIDE.min(builder.limits().max_texture_dimension_2d);
        let mut maps = ReflectiveShadowMaps::new(builder, &views, side, "for shadows")?;
        let views = reflective_shadow_map::view_buffer(builder, &views);
        let mut meshes = HashMap::new();
        for drawn in casting() {
            let mesh = &drawn.object.mesh;
            let parts = MeshBuffers::parts(mesh).map(|(_, contents)| contents);
            let vertices = builder.mesh_vertices(drawn.object, &mesh.indices, parts)?;
            let buffers = builder.of_object(&drawn.name, |builder| {
                let buffers = MeshBuffers::of(builder, mesh);
                maps.add(builder, &drawn.name, &buffers, vertices);
                buffers
            });
            meshes.insert(drawn.name.clone(), buffers);
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
