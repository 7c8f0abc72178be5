//! wgpu's device and encoders, as far as they are used here, with every resource, pipeline and pass told to the
//! [`capture`]. What is not listed here cannot be made, and so not be left out of a capture.

use super::capture;
use std::ops::Range;
use wgpu::util::DeviceExt as _;

/// An open device.
#[derive(Debug)]
pub struct Device(pub(super) wgpu::Device);

impl Device {
    /// A buffer.
    pub fn create_buffer(&self, descriptor: &wgpu::BufferDescriptor<'_>) -> wgpu::Buffer {
        let buffer = self.0.create_buffer(descriptor);
        capture::buffer(descriptor.label, &buffer);
        buffer
    }

    /// A buffer with contents.
    pub fn create_buffer_init(&self, descriptor: &wgpu::util::BufferInitDescriptor<'_>) -> wgpu::Buffer {
        let buffer = self.0.create_buffer_init(descriptor);
        capture::buffer(descriptor.label, &buffer);
        buffer
    }

    /// A texture.
    pub fn create_texture(&self, descriptor: &wgpu::TextureDescriptor<'_>) -> wgpu::Texture {
        let texture = self.0.create_texture(descriptor);
        capture::texture(descriptor.label, &texture);
        texture
    }

    /// A texture with contents.
    pub fn create_texture_with_data(
        &self,
        queue: &wgpu::Queue,
        descriptor: &wgpu::TextureDescriptor<'_>,
        order: wgpu::util::TextureDataOrder,
        data: &[u8],
    ) -> wgpu::Texture {
        let texture = self.0.create_texture_with_data(queue, descriptor, order, data);
        capture::texture(descriptor.label, &texture);
        texture
    }

    /// A sampler.
    pub fn create_sampler(&self, descriptor: &wgpu::SamplerDescriptor<'_>) -> wgpu::Sampler {
        let sampler = self.0.create_sampler(descriptor);
        capture::sampler(descriptor.label, &sampler);
        sampler
    }

    /// A bind group.
    pub fn create_bind_group(&self, descriptor: &wgpu::BindGroupDescriptor<'_>) -> wgpu::BindGroup {
        let group = self.0.create_bind_group(descriptor);
        capture::bind_group(descriptor, &group);
        group
    }

    /// A shader module.
    pub fn create_shader_module(&self, descriptor: wgpu::ShaderModuleDescriptor<'_>) -> wgpu::ShaderModule {
        self.0.create_shader_module(descriptor)
    }

    /// A graphics pipeline. Whoever makes it describes it to the capture.
    pub fn create_render_pipeline(&self, descriptor: &wgpu::RenderPipelineDescriptor<'_>) -> wgpu::RenderPipeline {
        self.0.create_render_pipeline(descriptor)
    }

    /// A compute pipeline. Whoever makes it describes it to the capture.
    pub fn create_compute_pipeline(&self, descriptor: &wgpu::ComputePipelineDescriptor<'_>) -> wgpu::ComputePipeline {
        self.0.create_compute_pipeline(descriptor)
    }

    /// An encoder of commands.
    pub fn create_command_encoder(&self, descriptor: &wgpu::CommandEncoderDescriptor<'_>) -> Encoder {
        Encoder(self.0.create_command_encoder(descriptor))
    }

    /// What it allows.
    pub fn limits(&self) -> wgpu::Limits {
        self.0.limits()
    }

    /// Waits for what was submitted.
    pub fn poll(&self, poll_type: wgpu::PollType) -> Result<wgpu::PollStatus, wgpu::PollError> {
        self.0.poll(poll_type)
    }

    /// From now on errors of this kind are kept for whoever pops the scope.
    pub fn push_error_scope(&self, filter: wgpu::ErrorFilter) -> wgpu::ErrorScopeGuard {
        self.0.push_error_scope(filter)
    }
}

/// Commands being recorded.
#[derive(Debug)]
pub struct Encoder(wgpu::CommandEncoder);

impl Encoder {
    /// Begins a pass of draws.
    pub fn begin_render_pass(&mut self, descriptor: &wgpu::RenderPassDescriptor<'_>) -> RenderPass<'_> {
        let colors = descriptor.color_attachments.iter().flatten().map(|attachment| attachment.view);
        let depth = descriptor.depth_stencil_attachment.iter().map(|attachment| attachment.view);
        let targets = capture::targets(colors.chain(depth));
        let name = descriptor.label.unwrap_or_default().to_owned();
        let pass = self.0.begin_render_pass(descriptor);
        RenderPass { pass, name, targets, pipeline: None, groups: Vec::new() }
    }

    /// Begins a pass of dispatches.
    pub fn begin_compute_pass(&mut self, descriptor: &wgpu::ComputePassDescriptor<'_>) -> ComputePass<'_> {
        let name = descriptor.label.unwrap_or_default().to_owned();
        let pass = self.0.begin_compute_pass(descriptor);
        ComputePass { pass, name, pipeline: None, groups: Vec::new() }
    }

    /// Copies a buffer's part.
    pub fn copy_buffer_to_buffer(&mut self, from: &wgpu::Buffer, at: u64, to: &wgpu::Buffer, place: u64, size: u64) {
        self.0.copy_buffer_to_buffer(from, at, to, place, size);
    }

    /// Sets a buffer's part to 0, up to its end where there is no size.
    pub fn clear_buffer(&mut self, buffer: &wgpu::Buffer, offset: u64, size: Option<u64>) {
        self.0.clear_buffer(buffer, offset, size);
    }

    /// Copies a texture's part to a buffer.
    pub fn copy_texture_to_buffer(
        &mut self,
        from: wgpu::TexelCopyTextureInfo<'_>,
        to: wgpu::TexelCopyBufferInfo<'_>,
        size: wgpu::Extent3d,
    ) {
        self.0.copy_texture_to_buffer(from, to, size);
    }

    /// What is to be submitted.
    pub fn finish(self) -> wgpu::CommandBuffer {
        self.0.finish()
    }
}

fn set_group(groups: &mut Vec<Option<wgpu::BindGroup>>, index: u32, group: Option<&wgpu::BindGroup>) {
    let place = index as usize;
    if groups.len() <= place {
        groups.resize(place + 1, None);
    }
    groups[place] = group.cloned();
}

/// Draws being recorded.
#[derive(Debug)]
pub struct RenderPass<'encoder> {
    pass: wgpu::RenderPass<'encoder>,
    name: String,
    targets: Vec<String>,
    pipeline: Option<wgpu::RenderPipeline>,
    groups: Vec<Option<wgpu::BindGroup>>,
}

impl RenderPass<'_> {
    /// What the next draws are drawn with.
    pub fn set_pipeline(&mut self, pipeline: &wgpu::RenderPipeline) {
        self.pass.set_pipeline(pipeline);
        self.pipeline = Some(pipeline.clone());
    }

    /// What they read; nothing where the pipeline has no binding in this group.
    pub fn set_bind_group<'a>(&mut self, index: u32, group: impl Into<Option<&'a wgpu::BindGroup>>) {
        let group = group.into();
        self.pass.set_bind_group(index, group, &[]);
        set_group(&mut self.groups, index, group);
    }

    /// What vertices are read from.
    pub fn set_vertex_buffer(&mut self, slot: u32, slice: wgpu::BufferSlice<'_>) {
        self.pass.set_vertex_buffer(slot, slice);
    }

    /// Where on the target: left, top, width and height, and the range of depths.
    pub fn set_viewport(&mut self, [left, top, width, height]: [f32; 4], depths: Range<f32>) {
        self.pass.set_viewport(left, top, width, height, depths.start, depths.end);
    }

    /// What part of the target may change: left, top, width and height.
    pub fn set_scissor_rect(&mut self, [left, top, width, height]: [u32; 4]) {
        self.pass.set_scissor_rect(left, top, width, height);
    }

    /// Draws.
    pub fn draw(&mut self, vertices: Range<u32>, instances: Range<u32>) {
        self.pass.draw(vertices, instances);
        capture::draw(&self.name, self.pipeline.as_ref(), &self.groups, &self.targets);
    }
}

/// Dispatches being recorded.
#[derive(Debug)]
pub struct ComputePass<'encoder> {
    pass: wgpu::ComputePass<'encoder>,
    name: String,
    pipeline: Option<wgpu::ComputePipeline>,
    groups: Vec<Option<wgpu::BindGroup>>,
}

impl ComputePass<'_> {
    /// What the next dispatches run.
    pub fn set_pipeline(&mut self, pipeline: &wgpu::ComputePipeline) {
        self.pass.set_pipeline(pipeline);
        self.pipeline = Some(pipeline.clone());
    }

    /// What they read and write; nothing where the pipeline has no binding in this group.
    pub fn set_bind_group<'a>(&mut self, index: u32, group: impl Into<Option<&'a wgpu::BindGroup>>) {
        let group = group.into();
        self.pass.set_bind_group(index, group, &[]);
        set_group(&mut self.groups, index, group);
    }

    /// So many workgroups along each axis.
    pub fn dispatch_workgroups(&mut self, x: u32, y: u32, z: u32) {
        self.pass.dispatch_workgroups(x, y, z);
        self.told();
    }

    /// As many as three words of a buffer say.
    pub fn dispatch_workgroups_indirect(&mut self, buffer: &wgpu::Buffer, offset: u64) {
        self.pass.dispatch_workgroups_indirect(buffer, offset);
        self.told();
    }

    fn told(&self) {
        capture::dispatch(&self.name, self.pipeline.as_ref(), &self.groups);
    }
}
