//! A scene on the device under compiled recipes, and drawing it.

use super::RenderError;
use super::device::{self, Pipeline};
use super::diffusion::Diffusion;
use super::optical_path::OpticalPaths;
use super::shadows::Shadows;
use crate::record::Record;
use glam::{Mat4, Vec3};
use lapidary_gpu::capture::OfObject;
use lapidary_gpu::{Encoder, Gpu, RenderPass};
use lapidary_plan::Note;

/// Samples are kept in f32: radiance spans more than f16 holds exactly, and references are compared in linear light.
pub(super) const SAMPLE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;
/// Of the depth buffer.
pub(super) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// What a recipe binds in group 0 beside the view.
#[derive(Clone)]
pub(super) enum Shared {
    /// A texture.
    Texture(wgpu::TextureView),
    /// A whole buffer.
    Buffer(wgpu::Buffer),
}

impl Shared {
    /// To be bound.
    pub(super) fn resource(&self) -> wgpu::BindingResource<'_> {
        match self {
            Self::Texture(view) => wgpu::BindingResource::TextureView(view),
            Self::Buffer(buffer) => buffer.as_entire_binding(),
        }
    }
}

/// One object on the device.
pub(super) struct Body {
    /// The object's.
    pub(super) name: String,
    /// From group 1 on; nothing where the pipeline reads nothing of a group.
    pub(super) groups: Vec<Option<wgpu::BindGroup>>,
    pub(super) vertices: u32,
}

impl Body {
    /// Draws it, in one call.
    fn draw(&self, pass: &mut RenderPass<'_>) {
        let _of = OfObject::named(&self.name);
        for (group, bind_group) in (1..).zip(&self.groups) {
            pass.set_bind_group(group, bind_group.as_ref());
        }
        pass.draw(0..self.vertices, 0..1);
    }
}

/// A recipe compiled for the effects that some objects call for, and these.
pub(super) struct Variant {
    pub(super) pipeline: Pipeline,
    /// Of group 0, by binding, from 1 on: what the pipeline reads.
    pub(super) shared: Vec<(u32, Shared)>,
    pub(super) bodies: Vec<Body>,
}

/// Compiled recipes and the scene's objects.
pub(super) struct ScenePass<'gpu> {
    pub(super) gpu: &'gpu Gpu,
    pub(super) variants: Vec<Variant>,
    pub(super) before: Vec<Before<'gpu>>,
}

/// What is done before, once a frame, for the objects to look up.
pub(super) enum Before<'gpu> {
    /// What each light sees of the scene.
    Shadows(Shadows<'gpu>),
    /// Irradiance, drawn into an object's texture and blurred.
    Diffusion(Diffusion<'gpu>),
    /// Paths of light through the objects.
    Paths(OpticalPaths<'gpu>),
}

/// What a pass draws to.
pub(super) struct SceneTarget<'a> {
    pub(super) colors: Vec<&'a wgpu::TextureView>,
    pub(super) depth: &'a wgpu::TextureView,
    /// Whether the depth is wanted afterwards.
    pub(super) keep_depth: bool,
    /// In texels, from the upper left corner.
    pub(super) size: [u32; 2],
}

/// Group 0 of each variant, as one eye sees it.
pub(super) struct View(Vec<Option<wgpu::BindGroup>>);

impl<'gpu> ScenePass<'gpu> {
    /// Without objects.
    pub(super) fn empty(gpu: &'gpu Gpu) -> Self {
        Self { gpu, variants: Vec::new(), before: Vec::new() }
    }

    /// Takes another's objects too.
    pub(super) fn append(&mut self, other: Self) {
        self.variants.extend(other.variants);
        self.before.extend(other.before);
    }

    /// The recipes' group 0 as `eye` sees it.
    pub(super) fn view(&self, clip_from_world: Mat4, eye: Vec3) -> View {
        let device = &self.gpu.device;
        // All recipes' views are alike.
        let view = Record::new("GemView").with("clip_from_world", clip_from_world).with("eye", eye);
        let uniform = device::uniform(device, "view", &view.bytes());
        let of_variant = |variant: &Variant| {
            let mut resources = vec![(0, uniform.as_entire_binding())];
            resources.extend(variant.shared.iter().map(|(binding, shared)| (*binding, shared.resource())));
            variant.pipeline.bind(device, 0, &resources)
        };
        View(self.variants.iter().map(of_variant).collect())
    }

    /// Does what comes before, in passes of its own.
    pub(super) fn prepare(&self, encoder: &mut Encoder) -> Result<(), RenderError> {
        self.before.iter().try_for_each(|before| match before {
            Before::Shadows(shadows) => shadows.encode(encoder),
            Before::Diffusion(diffusion) => diffusion.encode(encoder),
            Before::Paths(paths) => paths.encode(encoder),
        })
    }

    /// The paths of light, where the rung follows any.
    pub(super) fn paths(&self) -> Option<&OpticalPaths<'_>> {
        self.before.iter().find_map(|before| match before {
            Before::Paths(paths) => Some(paths),
            Before::Shadows(_) | Before::Diffusion(_) => None,
        })
    }

    /// What is to be said about the last submitted frame. Waits for it.
    pub(super) fn notes(&self) -> Result<Vec<Note>, RenderError> {
        let of = |before: &Before<'_>| match before {
            Before::Shadows(_) | Before::Diffusion(_) => Ok(Vec::new()),
            Before::Paths(paths) => paths.notes(),
        };
        self.before.iter().map(of).collect::<Result<Vec<_>, _>>().map(|notes| notes.concat())
    }

    /// Draws the objects in one pass: one draw call for each, under its own variant.
    pub(super) fn draw(&self, encoder: &mut Encoder, view: &View, target: &SceneTarget<'_>) {
        let colors: Vec<_> = target.colors.iter().map(|view| device::cleared(view)).collect();
        let store = if target.keep_depth { wgpu::StoreOp::Store } else { wgpu::StoreOp::Discard };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("scene"),
            color_attachments: &colors,
            depth_stencil_attachment: Some(device::cleared_depth(target.depth, store)),
            ..wgpu::RenderPassDescriptor::default()
        });
        let [width, height] = target.size.map(|side| side as f32);
        pass.set_viewport([0.0, 0.0, width, height], 0.0..1.0);
        for (variant, group) in self.variants.iter().zip(&view.0) {
            pass.set_pipeline(&variant.pipeline.raw);
            pass.set_bind_group(0, group.as_ref());
            for body in &variant.bodies {
                body.draw(&mut pass);
            }
        }
    }

    /// How many draw calls a frame takes.
    pub(super) fn draw_calls(&self) -> usize {
        let before = self.before.iter().map(|before| match before {
            Before::Shadows(shadows) => shadows.draw_calls(),
            Before::Diffusion(diffusion) => diffusion.draw_calls(),
            Before::Paths(paths) => paths.draw_calls(),
        });
        let bodies: usize = self.variants.iter().map(|variant| variant.bodies.len()).sum();
        bodies + before.sum::<usize>()
    }
}
