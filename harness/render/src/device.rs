//! Pipelines and buffers, made in one way for every pass.

use super::RenderError;
use crate::shader::{Bindings, Shader};
use lapidary_gpu::{Device, Gpu, capture};
use lapidary_scene::Object;

/// What a pass is compiled from.
pub(super) struct PipelineSource<'a> {
    /// The recipe's name, for messages.
    pub(super) recipe: &'a str,
    /// Its composed text.
    pub(super) source: &'a str,
    /// Its vertex and fragment entry points.
    pub(super) entries: [&'a str; 2],
    /// Values of its overrides; those that the text does not declare are left out.
    pub(super) constants: &'a [(&'a str, f64)],
    /// Formats of its colour targets.
    pub(super) formats: &'a [wgpu::TextureFormat],
    /// The depth buffer's format, for solids.
    pub(super) depth: Option<wgpu::TextureFormat>,
}

/// A compiled pass, and the bindings that are left of its recipe.
#[derive(Debug)]
pub(super) struct Pipeline {
    pub(super) raw: wgpu::RenderPipeline,
    bindings: Bindings,
}

impl Pipeline {
    /// Whether it reads this binding.
    pub(super) fn binds(&self, group: u32, binding: u32) -> bool {
        self.bindings.has(group, binding)
    }

    /// The bind group of those of `resources`, by number, that it reads. Nothing where it reads none in this group.
    pub(super) fn bind(
        &self,
        device: &Device,
        group: u32,
        resources: &[(u32, wgpu::BindingResource<'_>)],
    ) -> Option<wgpu::BindGroup> {
        self.bindings.bind(device, |group| self.raw.get_bind_group_layout(group), group, resources)
    }
}

/// Compiles a pass. A closed body shows its front; a full-screen triangle has no back to speak of.
pub(super) fn pipeline(gpu: &Gpu, from: &PipelineSource<'_>) -> Result<Pipeline, RenderError> {
    pipeline_culling(gpu, from, from.depth.map(|_| wgpu::Face::Back))
}

/// The same with the faces that are not drawn, if any.
pub(super) fn pipeline_culling(
    gpu: &Gpu,
    from: &PipelineSource<'_>,
    cull_mode: Option<wgpu::Face>,
) -> Result<Pipeline, RenderError> {
    let name = from.recipe;
    let shader = Shader::new(name, from.source, &from.entries, from.constants)?;
    let [vertex, fragment] = from.entries;
    let raw = gpu.guarded(&format!("compiling recipe `{name}`"), |device| {
        let module = shader.upload(device);
        let targets: Vec<Option<wgpu::ColorTargetState>> =
            from.formats.iter().map(|format| Some((*format).into())).collect();
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(name),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some(vertex),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState { cull_mode, ..wgpu::PrimitiveState::default() },
            depth_stencil: from.depth.map(|format| wgpu::DepthStencilState {
                format,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Less),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some(fragment),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    })?;
    capture::render_pipeline(&raw, || shader.description(name));
    Ok(Pipeline { raw, bindings: shader.bindings() })
}

/// A buffer with contents, by what it holds.
pub(super) fn buffer(device: &Device, what: &str, contents: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
    device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some(what), contents, usage })
}

/// A texture with contents, to be sampled or loaded: of this width, height and depth or number of layers, layer by layer.
pub(super) fn texture(
    gpu: &Gpu,
    what: &str,
    (dimension, format): (wgpu::TextureDimension, wgpu::TextureFormat),
    [width, height, depth_or_array_layers]: [u32; 3],
    contents: &[u8],
) -> wgpu::Texture {
    let descriptor = wgpu::TextureDescriptor {
        label: Some(what),
        size: wgpu::Extent3d { width, height, depth_or_array_layers },
        mip_level_count: 1,
        sample_count: 1,
        dimension,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    };
    gpu.device.create_texture_with_data(&gpu.queue, &descriptor, wgpu::util::TextureDataOrder::LayerMajor, contents)
}

/// How many vertices draw `object`, whose parts are to be storage buffers.
///
/// # Errors
/// Where this device cannot hold one of the parts.
pub(super) fn mesh_vertices<'a>(
    gpu: &Gpu,
    object: &Object,
    indices: &[u32],
    parts: impl IntoIterator<Item = &'a [u8]>,
) -> Result<u32, RenderError> {
    let limits = gpu.device.limits();
    let limit = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
    let too_large = |bytes: u64| RenderError::TooLarge { what: format!("mesh `{}`", object.name), bytes, limit };
    if let Some(bytes) = parts.into_iter().map(|part| part.len() as u64).find(|bytes| *bytes > limit) {
        return Err(too_large(bytes));
    }
    u32::try_from(indices.len()).map_err(|_| too_large(size_of_val(indices) as u64))
}

/// A uniform buffer.
pub(super) fn uniform(device: &Device, what: &str, contents: &[u8]) -> wgpu::Buffer {
    buffer(device, what, contents, wgpu::BufferUsages::UNIFORM)
}

/// A buffer to be read as storage.
pub(super) fn storage(device: &Device, what: &str, contents: &[u8]) -> wgpu::Buffer {
    buffer(device, what, contents, wgpu::BufferUsages::STORAGE)
}

/// A texture that can be drawn to, `size` being width and height.
pub(super) fn target(
    device: &Device,
    what: &str,
    [width, height]: [u32; 2],
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some(what),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | usage,
        view_formats: &[],
    })
}

/// The whole of a texture.
pub(super) fn view(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

/// A colour attachment that starts empty.
pub(super) fn cleared(view: &wgpu::TextureView) -> Option<wgpu::RenderPassColorAttachment<'_>> {
    Some(wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT), store: wgpu::StoreOp::Store },
    })
}

/// A depth attachment that starts at the greatest depth.
pub(super) fn cleared_depth(
    view: &wgpu::TextureView,
    store: wgpu::StoreOp,
) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store }),
        stencil_ops: None,
    }
}
