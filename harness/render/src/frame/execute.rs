//! A frame on a wgpu device: everything is created once, then run any number of times.

use super::handles::{Bound, Buffer, Sampler, Texture};
use super::pass::{ComputePass, Depth, Pass, Read, RenderPass, Target, Workgroups};
use super::pipeline::{BindGroup, Blend, Pipeline, PipelineKind};
use super::resource::{Contents, Resource, ResourceKind, texel_bytes};
use super::shader::Shader;
use super::whole::Frame;
use lapidary_gpu::{Gpu, GpuError};
use std::borrow::Cow;
use std::ops::Range;
use wgpu::util::DeviceExt as _;

/// A frame's resources and pipelines on a device.
#[derive(Debug)]
pub struct Executor<'gpu> {
    gpu: &'gpu Gpu,
    frame: Frame,
    resources: Vec<Made>,
    pipelines: Vec<Compiled>,
    bind_groups: Vec<wgpu::BindGroup>,
}

/// A resource on the device.
#[derive(Debug)]
enum Made {
    Buffer(wgpu::Buffer),
    Texture(wgpu::Texture),
    Sampler(wgpu::Sampler),
}

/// A pipeline on the device.
#[derive(Debug)]
enum Compiled {
    Render(wgpu::RenderPipeline),
    Compute(wgpu::ComputePipeline),
}

impl Compiled {
    fn layout(&self, group: u32) -> wgpu::BindGroupLayout {
        match self {
            Self::Render(pipeline) => pipeline.get_bind_group_layout(group),
            Self::Compute(pipeline) => pipeline.get_bind_group_layout(group),
        }
    }
}

impl<'gpu> Executor<'gpu> {
    /// Creates everything that the frame contains.
    ///
    /// # Errors
    /// If the device rejects a shader or runs out of memory.
    pub fn new(gpu: &'gpu Gpu, mut frame: Frame) -> Result<Self, GpuError> {
        let make = |resource: &Resource| {
            let what = format!("making `{}`", resource.name);
            if resource.is_left_out() {
                let reason = "its contents were left out: the frame was made without a device".to_owned();
                return Err(GpuError::Device { what, reason });
            }
            gpu.guarded(&what, |_| made(gpu, resource))
        };
        let resources = frame.resources.iter().map(make).collect::<Result<_, _>>()?;
        // The device holds them now.
        frame.resources.iter_mut().for_each(Resource::leave_out);
        let compile = |pipeline: &Pipeline| {
            gpu.guarded(&format!("compiling `{}` of recipe `{}`", pipeline.name, pipeline.shader.recipe()), |device| {
                compiled(device, pipeline)
            })
        };
        let pipelines = frame.pipelines.iter().map(compile).collect::<Result<_, _>>()?;
        let mut executor = Self { gpu, frame, resources, pipelines, bind_groups: Vec::new() };
        executor.bind_groups = gpu.guarded("binding resources", |device| {
            executor.frame.bind_groups.iter().map(|group| executor.bind_group(device, group)).collect()
        })?;
        Ok(executor)
    }

    /// Returns the frame that it runs, without contents, which the device holds.
    #[must_use]
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    fn bind_group(&self, device: &wgpu::Device, group: &BindGroup) -> wgpu::BindGroup {
        let views: Vec<Option<wgpu::TextureView>> = group
            .entries
            .iter()
            .map(|(_, bound)| match bound {
                Bound::Texture(texture, dimension) => {
                    let dimension = Some(*dimension);
                    let descriptor = wgpu::TextureViewDescriptor { dimension, ..Default::default() };
                    Some(self.texture(*texture).create_view(&descriptor))
                }
                Bound::Buffer(_) | Bound::Sampler(_) => None,
            })
            .collect();
        let entries: Vec<wgpu::BindGroupEntry<'_>> = group
            .entries
            .iter()
            .zip(&views)
            .map(|((binding, bound), view)| wgpu::BindGroupEntry {
                binding: *binding,
                resource: match (bound, view) {
                    (Bound::Buffer(buffer), _) => self.buffer(*buffer).as_entire_binding(),
                    (Bound::Sampler(sampler), _) => wgpu::BindingResource::Sampler(self.sampler(*sampler)),
                    (Bound::Texture(..), Some(view)) => wgpu::BindingResource::TextureView(view),
                    (Bound::Texture(..), None) => unreachable!("each texture has a view"),
                },
            })
            .collect();
        let layout = &self.pipelines[group.pipeline.0].layout(group.group);
        device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
    }

    fn buffer(&self, Buffer(place): Buffer) -> &wgpu::Buffer {
        let Made::Buffer(buffer) = &self.resources[place] else { unreachable!("resource {place} is a buffer") };
        buffer
    }

    fn texture(&self, Texture(place): Texture) -> &wgpu::Texture {
        let Made::Texture(texture) = &self.resources[place] else { unreachable!("resource {place} is a texture") };
        texture
    }

    fn sampler(&self, Sampler(place): Sampler) -> &wgpu::Sampler {
        let Made::Sampler(sampler) = &self.resources[place] else { unreachable!("resource {place} is a sampler") };
        sampler
    }

    /// Fills the upper left part of a texture, row by row. The texture must allow copies to it.
    pub fn write_texture(&self, texture: Texture, [width, height]: [u32; 2], texels: &[u8]) {
        let texture = self.texture(texture);
        let bytes_per_row = Some(width * texel_bytes(texture.format()));
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row, rows_per_image: Some(height) };
        let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
        self.gpu.queue.write_texture(texture.as_image_copy(), texels, layout, size);
    }

    /// Fills a buffer, which must allow copies to it.
    ///
    /// # Errors
    /// If the contents are longer or shorter than the buffer.
    pub fn write_buffer(&self, buffer: Buffer, contents: &[u8]) -> Result<(), GpuError> {
        let (size, given) = (self.buffer(buffer).size(), contents.len() as u64);
        if size != given {
            let what = format!("writing `{}`", self.frame.name(buffer));
            let reason =
                format!("it holds {size} bytes, but {given} were given; make the frame anew for another number");
            return Err(GpuError::Device { what, reason });
        }
        self.gpu.queue.write_buffer(self.buffer(buffer), 0, contents);
        Ok(())
    }

    /// Returns the words of a whole buffer, which must allow copies from it. Waits for everything
    /// submitted.
    ///
    /// # Errors
    /// If the device is lost.
    pub fn words(&self, buffer: Buffer) -> Result<Vec<u32>, GpuError> {
        self.gpu.words(self.buffer(buffer))
    }

    /// Runs all passes. `read` receives each [`Read`] with its rows, in order and without gaps.
    ///
    /// # Errors
    /// If the device rejects a pass or is lost.
    pub fn run(&self, read: impl FnMut(&Read, &[u8])) -> Result<(), GpuError> {
        self.run_passes(0..self.frame.passes.len(), read)
    }

    /// Runs the passes in a range of indices, like [`Executor::run`].
    ///
    /// # Errors
    /// If the device rejects a pass or is lost.
    pub fn run_passes(&self, passes: Range<usize>, mut read: impl FnMut(&Read, &[u8])) -> Result<(), GpuError> {
        let mut rest = &self.frame.passes[passes];
        while !rest.is_empty() {
            // Up to and including the next reads.
            let is_read = |pass: &Pass| matches!(pass, Pass::Read(_));
            let start = rest.iter().position(is_read).unwrap_or(rest.len());
            // Together, as long as each has a buffer of its own.
            let mut buffers = Vec::new();
            let mut is_another = |pass: &&Pass| {
                let Pass::Read(read) = pass else { return false };
                let is_new = !buffers.contains(&read.buffer);
                buffers.push(read.buffer);
                is_new
            };
            let count = rest[start..].iter().take_while(|pass| is_another(pass)).count();
            let (now, later) = rest.split_at(start + count);
            self.submit(now)?;
            for pass in &now[start..] {
                if let Pass::Read(part) = pass {
                    self.bring_back(part, &mut read)?;
                }
            }
            rest = later;
        }
        Ok(())
    }

    /// Encodes and submits passes without waiting.
    fn submit(&self, passes: &[Pass]) -> Result<(), GpuError> {
        self.gpu.guarded("drawing a frame", |device| {
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            for pass in passes {
                self.encode(&mut encoder, pass);
            }
            self.gpu.queue.submit([encoder.finish()]);
        })
    }

    fn encode(&self, encoder: &mut wgpu::CommandEncoder, pass: &Pass) {
        match pass {
            Pass::Render(pass) => self.encode_render(encoder, pass),
            Pass::Compute(pass) => self.encode_compute(encoder, pass),
            Pass::Clear { buffer, bytes } => encoder.clear_buffer(self.buffer(*buffer), 0, Some(*bytes)),
            Pass::Copy { from, to, bytes } => {
                encoder.copy_buffer_to_buffer(self.buffer(*from), 0, self.buffer(*to), 0, *bytes);
            }
            Pass::Read(Read { texture, size: [width, height], buffer, bytes_per_row, .. }) => {
                let layout = wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(*bytes_per_row),
                    rows_per_image: Some(*height),
                };
                let to = wgpu::TexelCopyBufferInfo { buffer: self.buffer(*buffer), layout };
                let size = wgpu::Extent3d { width: *width, height: *height, depth_or_array_layers: 1 };
                encoder.copy_texture_to_buffer(self.texture(*texture).as_image_copy(), to, size);
            }
        }
    }

    fn encode_render(&self, encoder: &mut wgpu::CommandEncoder, pass: &RenderPass) {
        let layer = |texture: Texture, layer: u32| {
            self.texture(texture).create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2),
                base_array_layer: layer,
                array_layer_count: Some(1),
                ..wgpu::TextureViewDescriptor::default()
            })
        };
        let views: Vec<_> = pass.targets.iter().map(|target| layer(target.texture, target.layer)).collect();
        let attachment = |(target, view): (&Target, _)| {
            let cleared = |[r, g, b, a]: [f64; 4]| wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a });
            let load = target.clear.map_or(wgpu::LoadOp::Load, cleared);
            let ops = wgpu::Operations { load, store: wgpu::StoreOp::Store };
            Some(wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops })
        };
        let depth = pass.depth.map(|depth| (layer(depth.texture, 0), depth));
        let depth_attachment = depth.as_ref().map(|(view, Depth { load, keep, .. })| {
            let load = if *load { wgpu::LoadOp::Load } else { wgpu::LoadOp::Clear(1.0) };
            let store = if *keep { wgpu::StoreOp::Store } else { wgpu::StoreOp::Discard };
            let depth_ops = Some(wgpu::Operations { load, store });
            wgpu::RenderPassDepthStencilAttachment { view, depth_ops, stencil_ops: None }
        });
        let mut encoded = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(&pass.name),
            color_attachments: &pass.targets.iter().zip(&views).map(attachment).collect::<Vec<_>>(),
            depth_stencil_attachment: depth_attachment,
            ..wgpu::RenderPassDescriptor::default()
        });
        if let Some(viewport) = pass.viewport {
            let [left, top, width, height] = viewport.map(|side| side as f32);
            encoded.set_viewport(left, top, width, height, 0.0, 1.0);
        }
        for draw in &pass.draws {
            if let Compiled::Render(pipeline) = &self.pipelines[draw.pipeline.0] {
                encoded.set_pipeline(pipeline);
            }
            for (index, group) in (0..).zip(&draw.groups) {
                encoded.set_bind_group(index, group.map(|group| &self.bind_groups[group.0]), &[]);
            }
            if let Some([left, top, width, height]) = draw.scissor {
                encoded.set_scissor_rect(left, top, width, height);
            }
            encoded.draw(0..draw.vertices, 0..draw.instances);
        }
    }

    fn encode_compute(&self, encoder: &mut wgpu::CommandEncoder, pass: &ComputePass) {
        let label = Some(&*pass.name);
        let mut encoded = encoder
            .begin_compute_pass(&wgpu::ComputePassDescriptor { label, ..wgpu::ComputePassDescriptor::default() });
        for dispatch in (0..pass.repeat).flat_map(|_| &pass.dispatches) {
            if let Compiled::Compute(pipeline) = &self.pipelines[dispatch.pipeline.0] {
                encoded.set_pipeline(pipeline);
            }
            for (index, group) in (0..).zip(&dispatch.groups) {
                encoded.set_bind_group(index, group.map(|group| &self.bind_groups[group.0]), &[]);
            }
            match dispatch.workgroups {
                Workgroups::Count([x, y, z]) => encoded.dispatch_workgroups(x, y, z),
                Workgroups::Indirect(buffer) => encoded.dispatch_workgroups_indirect(self.buffer(buffer), 0),
            }
        }
    }

    /// Waits for the data copied to a buffer, and passes its rows on.
    fn bring_back(&self, part: &Read, read: &mut impl FnMut(&Read, &[u8])) -> Result<(), GpuError> {
        let Read { texture, size: [width, height], buffer, bytes_per_row, .. } = part;
        let used = (width * texel_bytes(self.texture(*texture).format())) as usize;
        self.gpu.read_back(self.buffer(*buffer), u64::from(*bytes_per_row) * u64::from(*height), |bytes| {
            let rows: Vec<u8> =
                bytes.chunks_exact(*bytes_per_row as usize).flat_map(|row| &row[..used]).copied().collect();
            read(part, &rows);
        })
    }
}

/// Creates a resource.
fn made(gpu: &Gpu, resource: &Resource) -> Made {
    let (device, label) = (&gpu.device, Some(&*resource.name));
    match &resource.kind {
        ResourceKind::Buffer { size, usage, contents, .. } => Made::Buffer(match contents {
            Contents::Bytes(contents) => {
                device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label, contents, usage: *usage })
            }
            Contents::Zeros | Contents::LeftOut => device.create_buffer(&wgpu::BufferDescriptor {
                label,
                size: *size,
                usage: *usage,
                mapped_at_creation: false,
            }),
        }),
        ResourceKind::Texture { size, levels, dimension, format, usage, contents } => {
            let [width, height, depth_or_array_layers] = *size;
            let descriptor = wgpu::TextureDescriptor {
                label,
                size: wgpu::Extent3d { width, height, depth_or_array_layers },
                mip_level_count: *levels,
                sample_count: 1,
                dimension: *dimension,
                format: *format,
                usage: *usage,
                view_formats: &[],
            };
            Made::Texture(match contents {
                Contents::Bytes(contents) => {
                    let order = wgpu::util::TextureDataOrder::MipMajor;
                    device.create_texture_with_data(&gpu.queue, &descriptor, order, contents)
                }
                Contents::Zeros | Contents::LeftOut => device.create_texture(&descriptor),
            })
        }
        ResourceKind::Sampler { filter, address: [u, v] } => {
            Made::Sampler(device.create_sampler(&wgpu::SamplerDescriptor {
                label,
                mag_filter: *filter,
                min_filter: *filter,
                mipmap_filter: match filter {
                    wgpu::FilterMode::Linear => wgpu::MipmapFilterMode::Linear,
                    wgpu::FilterMode::Nearest => wgpu::MipmapFilterMode::Nearest,
                },
                address_mode_u: *u,
                address_mode_v: *v,
                ..wgpu::SamplerDescriptor::default()
            }))
        }
    }
}

/// Compiles a pipeline.
fn compiled(device: &wgpu::Device, pipeline: &Pipeline) -> Compiled {
    let label = Some(&*pipeline.name);
    let module = device.create_shader_module(module_descriptor(&pipeline.shader));
    let entry = |place: usize| pipeline.shader.entries().get(place).map(String::as_str);
    let PipelineKind::Render { targets, depth, cull, blend } = &pipeline.kind else {
        return Compiled::Compute(device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label,
            layout: None,
            module: &module,
            entry_point: entry(0),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        }));
    };
    let component = |operation| wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation,
    };
    let blend =
        blend.map(|Blend { color, alpha }| wgpu::BlendState { color: component(color), alpha: component(alpha) });
    let target = |format: &wgpu::TextureFormat| wgpu::ColorTargetState { blend, ..(*format).into() };
    let targets: Vec<Option<wgpu::ColorTargetState>> = targets.iter().map(|format| Some(target(format))).collect();
    Compiled::Render(device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label,
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: entry(0),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState { cull_mode: *cull, ..wgpu::PrimitiveState::default() },
        depth_stencil: depth.map(|format| wgpu::DepthStencilState {
            format,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Less),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: entry(1),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &targets,
        }),
        multiview_mask: None,
        cache: None,
    }))
}

/// Returns the descriptor that creates a shader's module on a device.
fn module_descriptor(shader: &Shader) -> wgpu::ShaderModuleDescriptor<'static> {
    wgpu::ShaderModuleDescriptor { label: None, source: wgpu::ShaderSource::Naga(Cow::Owned(shader.module().clone())) }
}
