//! Reflective shadow maps of all lights: the recipe of that name, a layer of one texture for each view.

use super::RenderError;
use super::device::{self, Pipeline, PipelineSource};
use super::light_views::LightView;
use super::pass::DEPTH_FORMAT;
use crate::record::Record;
use lapidary_gpu::capture::OfObject;
use lapidary_gpu::{Encoder, Gpu};
use lapidary_reflective_shadow_map::{REFLECTIVE_SHADOW_MAP_NOTHING, ReflectiveShadowMapView};

const RECIPE: &str = "reflective_shadow_map";
/// World position and N·L: neither can do with f16.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

/// The maps and how they are drawn.
pub(super) struct ReflectiveShadowMaps<'gpu> {
    gpu: &'gpu Gpu,
    pipeline: Pipeline,
    texture: wgpu::Texture,
    depth: wgpu::TextureView,
    /// One for each view, in order.
    views: Vec<Option<wgpu::BindGroup>>,
    /// Each object's name and mesh, and how many vertices draw it.
    meshes: Vec<(String, Option<wgpu::BindGroup>, u32)>,
}

impl<'gpu> ReflectiveShadowMaps<'gpu> {
    /// Maps of `side` texels a side for `views`, of which there is at least one; `whose` tells them from others.
    pub(super) fn new(gpu: &'gpu Gpu, views: &[LightView], side: u32, whose: &str) -> Result<Self, RenderError> {
        let limit = gpu.device.limits().max_texture_array_layers;
        if views.len() > limit as usize {
            return Err(RenderError::TooManyViews { views: views.len(), limit });
        }
        let pipeline = device::pipeline_culling(
            gpu,
            &PipelineSource {
                recipe: RECIPE,
                source: &lapidary_wgsl::recipe_source(RECIPE),
                entries: ["reflective_shadow_map_vertex", "reflective_shadow_map_fragment"],
                constants: &[],
                formats: &[FORMAT],
                depth: Some(DEPTH_FORMAT),
            },
            None,
        )?;
        let (texture, depth, views) = gpu.guarded("allocating reflective shadow maps", |device| {
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label: Some(&format!("reflective shadow maps {whose}")),
                size: wgpu::Extent3d { width: side, height: side, depth_or_array_layers: views.len() as u32 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: FORMAT,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            });
            let depth = device::target(
                device,
                &format!("depth of maps {whose}"),
                [side; 2],
                DEPTH_FORMAT,
                wgpu::TextureUsages::empty(),
            );
            let depth = device::view(&depth);
            let group = |view: &LightView| {
                let contents = fill(view.view, Record::new("ReflectiveShadowMapView")).bytes();
                let uniform = device::uniform(device, "view of a light", &contents);
                pipeline.bind(device, 0, &[(0, uniform.as_entire_binding())])
            };
            (texture, depth, views.iter().map(group).collect())
        })?;
        Ok(Self { gpu, pipeline, texture, depth, views, meshes: Vec::new() })
    }

    /// Adds an object: its name, its positions, indices and normals, and how many vertices draw it.
    pub(super) fn add(&mut self, name: &str, mesh: [&wgpu::Buffer; 3], vertices: u32) -> Result<(), RenderError> {
        let group = self.gpu.guarded("binding a mesh", |device| {
            let [positions, indices, normals] = mesh.map(wgpu::Buffer::as_entire_binding);
            self.pipeline.bind(device, 1, &[(0, positions), (1, indices), (2, normals)])
        })?;
        self.meshes.push((name.to_owned(), group, vertices));
        Ok(())
    }

    /// All layers.
    pub(super) fn view(&self) -> wgpu::TextureView {
        self.texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..wgpu::TextureViewDescriptor::default()
        })
    }

    /// Width, height and layers.
    pub(super) fn size(&self) -> [u32; 3] {
        let size = self.texture.size();
        [size.width, size.height, size.depth_or_array_layers]
    }

    /// Draws all maps.
    pub(super) fn encode(&self, encoder: &mut Encoder) {
        for (layer, group) in (0..).zip(&self.views) {
            let view = self.texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2),
                base_array_layer: layer,
                array_layer_count: Some(1),
                ..wgpu::TextureViewDescriptor::default()
            });
            let nothing = wgpu::Color { a: REFLECTIVE_SHADOW_MAP_NOTHING.into(), ..wgpu::Color::TRANSPARENT };
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some(RECIPE),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations { load: wgpu::LoadOp::Clear(nothing), store: wgpu::StoreOp::Store },
                })],
                depth_stencil_attachment: Some(device::cleared_depth(&self.depth, wgpu::StoreOp::Discard)),
                ..wgpu::RenderPassDescriptor::default()
            });
            pass.set_pipeline(&self.pipeline.raw);
            pass.set_bind_group(0, group.as_ref());
            for (name, mesh, vertices) in &self.meshes {
                let _of = OfObject::named(name);
                pass.set_bind_group(1, mesh.as_ref());
                pass.draw(0..*vertices, 0..1);
            }
        }
    }

    /// Bytes of the maps and their depth.
    pub(super) fn bytes(&self) -> u64 {
        let [width, height, layers] = self.size().map(u64::from);
        let texel = |format: wgpu::TextureFormat| u64::from(format.block_copy_size(None).unwrap_or_default());
        width * height * (layers * texel(FORMAT) + texel(DEPTH_FORMAT))
    }

    /// How many draw calls it takes.
    pub(super) fn draw_calls(&self) -> usize {
        self.views.len() * self.meshes.len()
    }
}

/// The part `light_views`: `array<LightView>`.
pub(super) fn view_buffer(gpu: &Gpu, views: &[LightView]) -> Result<wgpu::Buffer, RenderError> {
    let entry = |from: &LightView| {
        let record = Record::new("LightView").within("view", |record| fill(from.view, record));
        record.with("light", from.light).bytes()
    };
    let views: Vec<u8> = views.iter().flat_map(entry).collect();
    Ok(gpu.guarded("uploading views", |device| device::storage(device, "views of lights", &views))?)
}

/// Fills a `ReflectiveShadowMapView` of the recipes.
fn fill(view: ReflectiveShadowMapView, record: Record) -> Record {
    let ReflectiveShadowMapView { origin, lamp, axis, extent, near, far } = view;
    let record = record.with("origin", origin).with("lamp", lamp).with("axis", axis);
    record.with("extent", extent).with("near", near).with("far", far)
}
