//! A scene on the device under one compiled recipe, and drawing it.

use super::diffusion::Diffusion;
use super::optical_path::OpticalPaths;
use super::{Note, RenderError, device};
use crate::gpu::Gpu;
use glam::{Mat4, Vec3};

/// Samples are kept in f32: radiance spans more than f16 holds exactly, and references are compared in linear light.
pub(super) const SAMPLE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;
/// Of the depth buffer.
pub(super) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// What a recipe binds in group 0 beside the view.
pub(super) enum Shared {
    /// A texture.
    Texture(wgpu::TextureView),
    /// A whole buffer.
    Buffer(wgpu::Buffer),
}

/// One object on the device.
pub(super) struct Body {
    /// Group 1, then group 2 where the recipe has one.
    pub(super) groups: Vec<wgpu::BindGroup>,
    pub(super) vertices: u32,
}

impl Body {
    /// Draws it, in one call.
    fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        for (group, bind_group) in (1..).zip(&self.groups) {
            pass.set_bind_group(group, bind_group, &[]);
        }
        pass.draw(0..self.vertices, 0..1);
    }
}

/// A compiled recipe and the scene's objects.
pub(super) struct ScenePass<'gpu> {
    pub(super) gpu: &'gpu Gpu,
    pub(super) pipeline: wgpu::RenderPipeline,
    /// Group 0 from binding 1 on.
    pub(super) shared: Vec<Shared>,
    pub(super) bodies: Vec<Body>,
    pub(super) before: Vec<Before<'gpu>>,
}

/// What is done before, once a frame, for the objects to look up.
pub(super) enum Before<'gpu> {
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

impl ScenePass<'_> {
    /// The recipe's group 0 as `eye` sees it.
    pub(super) fn view(&self, clip_from_world: Mat4, eye: Vec3) -> wgpu::BindGroup {
        let device = &self.gpu.device;
        let mut values = clip_from_world.to_cols_array().to_vec();
        values.extend(eye.to_array());
        let uniform = device::uniform(device, &values);
        let mut resources = vec![uniform.as_entire_binding()];
        resources.extend(self.shared.iter().map(|shared| match shared {
            Shared::Texture(view) => wgpu::BindingResource::TextureView(view),
            Shared::Buffer(buffer) => buffer.as_entire_binding(),
        }));
        device::bind_group(device, &self.pipeline, 0, resources)
    }

    /// Does what comes before, in passes of its own.
    pub(super) fn prepare(&self, encoder: &mut wgpu::CommandEncoder) -> Result<(), RenderError> {
        self.before.iter().try_for_each(|before| match before {
            Before::Diffusion(diffusion) => diffusion.encode(encoder),
            Before::Paths(paths) => paths.encode(encoder),
        })
    }

    /// The paths of light, where the rung follows any.
    pub(super) fn paths(&self) -> Option<&OpticalPaths<'_>> {
        self.before.iter().find_map(|before| match before {
            Before::Paths(paths) => Some(paths),
            Before::Diffusion(_) => None,
        })
    }

    /// What is to be said about the last submitted frame. Waits for it.
    pub(super) fn notes(&self) -> Result<Vec<Note>, RenderError> {
        let of = |before: &Before<'_>| match before {
            Before::Diffusion(_) => Ok(Vec::new()),
            Before::Paths(paths) => paths.notes(),
        };
        self.before.iter().map(of).collect::<Result<Vec<_>, _>>().map(|notes| notes.concat())
    }

    /// Draws the objects: one draw call for each.
    pub(super) fn draw(&self, encoder: &mut wgpu::CommandEncoder, view: &wgpu::BindGroup, target: &SceneTarget<'_>) {
        let colors: Vec<_> = target.colors.iter().map(|view| device::cleared(view)).collect();
        let store = if target.keep_depth { wgpu::StoreOp::Store } else { wgpu::StoreOp::Discard };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("scene"),
            color_attachments: &colors,
            depth_stencil_attachment: Some(device::cleared_depth(target.depth, store)),
            ..wgpu::RenderPassDescriptor::default()
        });
        let [width, height] = target.size;
        pass.set_viewport(0.0, 0.0, width as f32, height as f32, 0.0, 1.0);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, view, &[]);
        for body in &self.bodies {
            body.draw(&mut pass);
        }
    }

    /// How many draw calls a frame takes.
    pub(super) fn draw_calls(&self) -> usize {
        let before = self.before.iter().map(|before| match before {
            Before::Diffusion(diffusion) => diffusion.draw_calls(),
            Before::Paths(paths) => paths.draw_calls(),
        });
        self.bodies.len() + before.sum::<usize>()
    }
}
