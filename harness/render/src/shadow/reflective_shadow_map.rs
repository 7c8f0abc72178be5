//! Reflective shadow maps of all lights, drawn by the recipe of that name: one layer of a texture
//! for each view.

use super::light_views::LightView;
use crate::error::RenderError;
use crate::frame::record::Record;
use crate::frame::{
    BindGroupId, Bound, Buffer, Builder, Frame, Pass, PipelineId, PipelineSource, RenderPass, Target, Texture,
};
use crate::objects::mesh_buffers::{MeshBuffers, ShapeBuffers};
use crate::picture::formats::DEPTH_FORMAT;
use lapidary_reflective_shadow_map::{REFLECTIVE_SHADOW_MAP_NOTHING, ReflectiveShadowMapView};

const RECIPE: &str = "draw_light_map";
/// Format of a texel: world position and N·L, for neither of which f16 is enough.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

/// The maps and the resources that draw them.
pub(crate) struct ReflectiveShadowMaps {
    texture: Texture,
    depth: Texture,
    side: u32,
    views: Vec<ReflectiveShadowMapView>,
    /// Draws the bodies that light enters, once there are any.
    entered: Option<Drawer>,
    /// Draws the bodies that only keep light from others, once there are any.
    casting: Option<Drawer>,
}

/// A variant of the recipe and the meshes that it draws.
struct Drawer {
    pipeline: PipelineId,
    /// One bind group for each view, in order.
    views: Vec<Option<BindGroupId>>,
    /// Each object's name, its mesh's bind group, and the number of vertices to draw.
    meshes: Vec<(String, Option<BindGroupId>, u32)>,
}

impl Drawer {
    fn new(
        builder: &mut Builder<'_>,
        views: &[ReflectiveShadowMapView],
        casts_only: bool,
    ) -> Result<Self, RenderError> {
        let source = PipelineSource {
            recipe: RECIPE,
            source: &lapidary_wgsl::recipe_source(RECIPE),
            entries: ["draw_light_map_vertex", "draw_light_map_fragment"],
            constants: &[("DRAW_LIGHT_MAP_CASTS_ONLY", f64::from(u8::from(casts_only)))],
            formats: &[FORMAT],
            depth: Some(DEPTH_FORMAT),
        };
        let pipeline = builder.of_object("", |builder| builder.render_pipeline_with(&source, None, None))?;
        let views = view_groups(builder, pipeline, views);
        Ok(Self { pipeline, views, meshes: Vec::new() })
    }
}

/// Returns the bind group 0 of each view of a light, for a pipeline that draws what the light sees.
pub(crate) fn view_groups(
    builder: &mut Builder<'_>,
    pipeline: PipelineId,
    views: &[ReflectiveShadowMapView],
) -> Vec<Option<BindGroupId>> {
    let group = |builder: &mut Builder<'_>, view: &ReflectiveShadowMapView| {
        let record = fill(*view, Record::new("ReflectiveShadowMapView"));
        let uniform = builder.uniform("view of a light", record);
        builder.bind(pipeline, 0, &[(0, uniform.into())])
    };
    builder.of_object("", |builder| views.iter().map(|view| group(builder, view)).collect())
}

impl ReflectiveShadowMaps {
    /// Creates maps of `side` × `side` texels for `views`, of which there must be at least one;
    /// `whose` tells them from other maps.
    pub(crate) fn new(
        builder: &mut Builder<'_>,
        views: &[LightView],
        side: u32,
        whose: &str,
    ) -> Result<Self, RenderError> {
        check_views(builder, views)?;
        let size = [side, side, views.len() as u32];
        let usage = wgpu::TextureUsages::TEXTURE_BINDING;
        let texture = builder.target(&format!("reflective shadow maps {whose}"), size, FORMAT, usage);
        let usage = wgpu::TextureUsages::empty();
        let depth = builder.target(&format!("depth of maps {whose}"), [side, side, 1], DEPTH_FORMAT, usage);
        let views = views.iter().map(|from| from.view).collect();
        Ok(Self { texture, depth, side, views, entered: None, casting: None })
    }

    /// Adds a body that light enters, by its name and its mesh.
    pub(crate) fn add(&mut self, builder: &mut Builder<'_>, name: &str, mesh: &MeshBuffers) -> Result<(), RenderError> {
        Self::add_to(&mut self.entered, &self.views, builder, name, (&mesh.shape, Some(mesh.normals)))
    }

    /// Adds a body that keeps light from others, by its name and its shape.
    pub(crate) fn add_caster(
        &mut self,
        builder: &mut Builder<'_>,
        name: &str,
        shape: &ShapeBuffers,
    ) -> Result<(), RenderError> {
        Self::add_to(&mut self.casting, &self.views, builder, name, (shape, None))
    }

    fn add_to(
        drawer: &mut Option<Drawer>,
        views: &[ReflectiveShadowMapView],
        builder: &mut Builder<'_>,
        name: &str,
        (shape, normals): (&ShapeBuffers, Option<Buffer>),
    ) -> Result<(), RenderError> {
        if drawer.is_none() {
            *drawer = Some(Drawer::new(builder, views, normals.is_none())?);
        }
        let Some(drawer) = drawer else { return Ok(()) };
        let mut resources: Vec<(u32, Bound)> = vec![(0, shape.positions.into()), (1, shape.indices.into())];
        resources.extend(normals.map(|normals| (2, normals.into())));
        let group = builder.of_object(name, |builder| builder.bind(drawer.pipeline, 1, &resources));
        drawer.meshes.push((name.to_owned(), group, shape.vertices));
        Ok(())
    }

    /// Returns the texture with all layers, for binding.
    pub(crate) fn layers(&self) -> Bound {
        Bound::Texture(self.texture, wgpu::TextureViewDimension::D2Array)
    }

    /// Width, height and number of layers.
    pub(crate) fn size(&self) -> [u32; 3] {
        [self.side, self.side, self.views.len() as u32]
    }

    /// Draws all maps.
    pub(crate) fn encode(&self, builder: &mut Builder<'_>) {
        for layer in 0..self.views.len() {
            let mut draws = Vec::new();
            for drawer in self.entered.iter().chain(&self.casting) {
                for (name, mesh, vertices) in &drawer.meshes {
                    let groups = vec![drawer.views[layer], *mesh];
                    draws.push(builder.of_object(name, |builder| builder.draw(drawer.pipeline, groups, *vertices)));
                }
            }
            let clear = [0.0, 0.0, 0.0, REFLECTIVE_SHADOW_MAP_NOTHING.into()];
            builder.pass(Pass::Render(RenderPass {
                name: RECIPE.to_owned(),
                targets: vec![Target { texture: self.texture, layer: layer as u32, clear: Some(clear) }],
                depth: Some(self.depth.into()),
                viewport: None,
                draws,
            }));
        }
    }

    /// Size in bytes of the maps and their depth.
    pub(crate) fn bytes(&self, frame: &Frame) -> u64 {
        [self.texture, self.depth].map(|texture| frame.resource(texture).bytes()).iter().sum()
    }
}

/// Rejects more views than a texture has layers.
pub(crate) fn check_views(builder: &Builder<'_>, views: &[LightView]) -> Result<(), RenderError> {
    let limit = builder.limits().max_texture_array_layers;
    if views.len() > limit as usize {
        return Err(RenderError::TooManyViews { views: views.len(), limit });
    }
    Ok(())
}

/// Creates the buffer of the part `light_views`: `array<LightView>`.
pub(crate) fn view_buffer(builder: &mut Builder<'_>, views: &[LightView]) -> Buffer {
    let entry = |from: &LightView| {
        let record = Record::new("LightView").within("view", |record| fill(from.view, record));
        record.with("light", from.light)
    };
    // A host may move the lights.
    let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
    builder.records("views of lights", views.iter().map(entry).collect(), usage)
}

/// Fills a `ReflectiveShadowMapView` of the recipes.
fn fill(view: ReflectiveShadowMapView, record: Record) -> Record {
    let ReflectiveShadowMapView { origin, lamp, axis, extent, near, far } = view;
    let record = record.with("origin", origin).with("lamp", lamp).with("axis", axis);
    record.with("extent", extent).with("near", near).with("far", far)
}
