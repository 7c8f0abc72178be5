//! Reflective shadow maps of all lights, drawn by the recipe of that name: one layer of a texture
//! for each view.

use super::RenderError;
use super::light_views::LightView;
use super::mesh_buffers::MeshBuffers;
use super::pass::DEPTH_FORMAT;
use crate::frame::{
    BindGroupId, Bound, Buffer, Builder, Frame, Pass, PipelineId, PipelineSource, RenderPass, Target, Texture,
};
use crate::record::Record;
use lapidary_reflective_shadow_map::{REFLECTIVE_SHADOW_MAP_NOTHING, ReflectiveShadowMapView};

const RECIPE: &str = "reflective_shadow_map";
/// Format of a texel: world position and N·L, for neither of which f16 is enough.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

/// The maps and the resources that draw them.
pub(super) struct ReflectiveShadowMaps {
    pipeline: PipelineId,
    texture: Texture,
    depth: Texture,
    side: u32,
    /// One bind group for each view, in order.
    views: Vec<Option<BindGroupId>>,
    /// Each object's name, its mesh's bind group, and the number of vertices to draw.
    meshes: Vec<(String, Option<BindGroupId>, u32)>,
}

impl ReflectiveShadowMaps {
    /// Creates maps of `side` × `side` texels for `views`, of which there must be at least one;
    /// `whose` tells them from other maps.
    pub(super) fn new(
        builder: &mut Builder<'_>,
        views: &[LightView],
        side: u32,
        whose: &str,
    ) -> Result<Self, RenderError> {
        let limit = builder.limits().max_texture_array_layers;
        if views.len() > limit as usize {
            return Err(RenderError::TooManyViews { views: views.len(), limit });
        }
        let source = PipelineSource {
            recipe: RECIPE,
            source: &lapidary_wgsl::recipe_source(RECIPE),
            entries: ["reflective_shadow_map_vertex", "reflective_shadow_map_fragment"],
            constants: &[],
            formats: &[FORMAT],
            depth: Some(DEPTH_FORMAT),
        };
        let pipeline = builder.render_pipeline_culling(&source, None)?;
        let size = [side, side, views.len() as u32];
        let usage = wgpu::TextureUsages::TEXTURE_BINDING;
        let texture = builder.target(&format!("reflective shadow maps {whose}"), size, FORMAT, usage);
        let usage = wgpu::TextureUsages::empty();
        let depth = builder.target(&format!("depth of maps {whose}"), [side, side, 1], DEPTH_FORMAT, usage);
        let mut group = |from: &LightView| {
            let record = fill(from.view, Record::new("ReflectiveShadowMapView"));
            let uniform = builder.uniform("view of a light", record);
            builder.bind(pipeline, 0, &[(0, uniform.into())])
        };
        let views = views.iter().map(&mut group).collect();
        Ok(Self { pipeline, texture, depth, side, views, meshes: Vec::new() })
    }

    /// Adds an object by its name and its mesh.
    pub(super) fn add(&mut self, builder: &mut Builder<'_>, name: &str, mesh: &MeshBuffers) {
        let MeshBuffers { positions, indices, normals, vertices } = *mesh;
        let resources = [(0, positions.into()), (1, indices.into()), (2, normals.into())];
        let group = builder.bind(self.pipeline, 1, &resources);
        self.meshes.push((name.to_owned(), group, vertices));
    }

    /// Returns the texture with all layers, for binding.
    pub(super) fn layers(&self) -> Bound {
        Bound::Texture(self.texture, wgpu::TextureViewDimension::D2Array)
    }

    /// Width, height and number of layers.
    pub(super) fn size(&self) -> [u32; 3] {
        [self.side, self.side, self.views.len() as u32]
    }

    /// Draws all maps.
    pub(super) fn encode(&self, builder: &mut Builder<'_>) {
        for (layer, view) in (0..).zip(&self.views) {
            let draw = |(name, mesh, vertices): &(String, Option<BindGroupId>, u32)| {
                let groups = vec![*view, *mesh];
                builder.of_object(name, |builder| builder.draw(self.pipeline, groups, *vertices))
            };
            let draws = self.meshes.iter().map(draw).collect();
            let clear = [0.0, 0.0, 0.0, REFLECTIVE_SHADOW_MAP_NOTHING.into()];
            builder.pass(Pass::Render(RenderPass {
                name: RECIPE.to_owned(),
                targets: vec![Target { texture: self.texture, layer, clear: Some(clear) }],
                depth: Some(self.depth.into()),
                viewport: None,
                draws,
            }));
        }
    }

    /// Size in bytes of the maps and their depth.
    pub(super) fn bytes(&self, frame: &Frame) -> u64 {
        [self.texture, self.depth].map(|texture| frame.resource(texture).bytes()).iter().sum()
    }
}

/// Creates the buffer of the part `light_views`: `array<LightView>`.
pub(super) fn view_buffer(builder: &mut Builder<'_>, views: &[LightView]) -> Buffer {
    let entry = |from: &LightView| {
        let record = Record::new("LightView").within("view", |record| fill(from.view, record));
        record.with("light", from.light)
    };
    builder.records("views of lights", views.iter().map(entry).collect(), wgpu::BufferUsages::STORAGE)
}

/// Fills a `ReflectiveShadowMapView` of the recipes.
fn fill(view: ReflectiveShadowMapView, record: Record) -> Record {
    let ReflectiveShadowMapView { origin, lamp, axis, extent, near, far } = view;
    let record = record.with("origin", origin).with("lamp", lamp).with("axis", axis);
    record.with("extent", extent).with("near", near).with("far", far)
}
