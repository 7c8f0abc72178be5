//! Shadows on what is drawn by its surface alone: what each light sees of all bodies but the clear ones, once for all of a scene.

use super::device::{self, Pipeline, storage};
use super::pass::Shared;
use super::reflective_shadow_map::{self, ReflectiveShadowMaps};
use super::variant::Part;
use super::{RenderError, Rung, light_views};
use lapidary_gpu::capture::OfObject;
use lapidary_gpu::{Encoder, Gpu};
use lapidary_plan::Effect;
use lapidary_scene::{Bounds, Light};
use std::collections::HashMap;

/// Texels of a map along a side. A shadow's edge is that soft, and what stands out less than a texel casts none.
const SIDE: u32 = 1024;
/// Positions, indices and normals of a mesh.
type MeshBuffers = [wgpu::Buffer; 3];

/// The lights' maps.
pub(super) struct Shadows<'gpu> {
    gpu: &'gpu Gpu,
    maps: ReflectiveShadowMaps<'gpu>,
    views: wgpu::Buffer,
    /// Of each body that casts shadows, by its name.
    meshes: HashMap<String, MeshBuffers>,
}

impl<'gpu> Shadows<'gpu> {
    /// For the objects of all parts; nothing where none is to be in shadow.
    pub(super) fn of(gpu: &'gpu Gpu, lights: &[Light], parts: &[Part<'_>]) -> Result<Option<Self>, RenderError> {
        let all = || parts.iter().flat_map(|part| part.objects.iter().map(move |drawn| (part.rung, drawn)));
        if !all().any(|(_, drawn)| drawn.decisions.has(Effect::Shadow)) {
            return Ok(None);
        }
        let casts = |rung: &Rung| matches!(rung, Rung::Diffuse(_) | Rung::OpticalPath(_));
        let casting = || all().filter(|(rung, _)| casts(rung)).map(|(_, drawn)| drawn);
        let bounds = Bounds::of(casting().flat_map(|drawn| drawn.object.mesh.positions.iter().copied()));
        let views = light_views::views(lights, bounds);
        let side = SIDE.min(gpu.device.limits().max_texture_dimension_2d);
        let mut maps = ReflectiveShadowMaps::new(gpu, &views, side, "for shadows")?;
        let views = reflective_shadow_map::view_buffer(gpu, &views)?;
        let mut meshes = HashMap::new();
        for drawn in casting() {
            let _of = OfObject::named(&drawn.name);
            let mesh = &drawn.object.mesh;
            let parts: [(&str, &[u8]); 3] = [
                ("positions", bytemuck::cast_slice(&mesh.positions)),
                ("indices", bytemuck::cast_slice(&mesh.indices)),
                ("normals", bytemuck::cast_slice(&mesh.normals)),
            ];
            let vertices =
                device::mesh_vertices(gpu, drawn.object, &mesh.indices, parts.map(|(_, contents)| contents))?;
            let buffers: MeshBuffers = gpu
                .guarded("uploading a mesh", |device| parts.map(|(what, contents)| storage(device, what, contents)))?;
            maps.add(&drawn.name, buffers.each_ref(), vertices)?;
            meshes.insert(drawn.name.clone(), buffers);
        }
        Ok(Some(Self { gpu, maps, views, meshes }))
    }

    /// A body's positions, indices and normals, which need not be uploaded again.
    pub(super) fn mesh(&self, name: &str) -> Option<&MeshBuffers> {
        self.meshes.get(name)
    }

    /// What `pipeline` reads of bindings 4 and 5 of group 0.
    pub(super) fn shared(&self, pipeline: &Pipeline) -> Vec<(u32, Shared)> {
        let all = [(4, Shared::Buffer(self.views.clone())), (5, Shared::Texture(self.maps.view()))];
        all.into_iter().filter(|(binding, _)| pipeline.binds(0, *binding)).collect()
    }

    /// Draws all maps.
    pub(super) fn encode(&self, encoder: &mut Encoder) -> Result<(), RenderError> {
        Ok(self.gpu.guarded("drawing reflective shadow maps", |_| self.maps.encode(encoder))?)
    }

    /// How many draw calls it takes.
    pub(super) fn draw_calls(&self) -> usize {
        self.maps.draw_calls()
    }
}
