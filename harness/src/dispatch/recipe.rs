//! A recipe's compute entry point, run once over buffers of its own.

use super::{DispatchError, declared, parse};
use crate::cookbook;
use crate::gpu::Gpu;
use std::borrow::Cow;

/// What stands at a binding; numbered from 0 in its group.
#[derive(Clone, Copy, Debug)]
pub enum Binding<'a> {
    /// A uniform buffer with contents.
    Uniform(&'a [u8]),
    /// A storage buffer that is read.
    Storage(&'a [u8]),
    /// The storage buffer that is written and read back, with its size in bytes.
    Result(u64),
}

/// What to run, and on what.
#[derive(Clone, Copy, Debug)]
pub struct RecipeRun<'a> {
    /// The recipe's name.
    pub recipe: &'a str,
    /// Its compute entry point.
    pub entry: &'a str,
    /// Values of overrides; those that it does not declare are left out.
    pub constants: &'a [(&'a str, f64)],
    /// By group.
    pub bindings: &'a [&'a [Binding<'a>]],
    /// Along each axis.
    pub workgroups: [u32; 3],
}

/// Runs a recipe and hands the bytes of its [`Binding::Result`] to `read`.
///
/// # Errors
/// A recipe that is not valid, or that the device refuses.
///
/// # Panics
/// Where no binding is a result.
pub fn run_recipe<T>(gpu: &Gpu, run: &RecipeRun<'_>, read: impl FnOnce(&[u8]) -> T) -> Result<T, DispatchError> {
    let (module, _) = parse(&cookbook::recipe_source(run.recipe), &format!("recipe {}", run.recipe))?;
    let constants = declared(&module, run.constants);
    let (readback, bytes) = gpu.guarded(&format!("running recipe `{}`", run.recipe), |device| {
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(run.recipe),
            source: wgpu::ShaderSource::Naga(Cow::Owned(module)),
        });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(run.recipe),
            layout: None,
            module: &module,
            entry_point: Some(run.entry),
            compilation_options: wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() },
            cache: None,
        });
        let filled = |contents: &[u8], usage| {
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: None, contents, usage })
        };
        let empty = |size, usage| {
            device.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false })
        };
        use wgpu::BufferUsages as Usage;
        let mut result = None;
        let groups: Vec<wgpu::BindGroup> = (0..)
            .zip(run.bindings)
            .map(|(group, bindings)| {
                let mut buffer = |binding: &Binding<'_>| match *binding {
                    Binding::Uniform(contents) => filled(contents, Usage::UNIFORM),
                    Binding::Storage(contents) => filled(contents, Usage::STORAGE),
                    Binding::Result(size) => {
                        result.insert((empty(size, Usage::STORAGE | Usage::COPY_SRC), size)).0.clone()
                    }
                };
                let buffers: Vec<wgpu::Buffer> = bindings.iter().map(&mut buffer).collect();
                let entries: Vec<wgpu::BindGroupEntry<'_>> = (0..)
                    .zip(&buffers)
                    .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
                    .collect();
                let layout = &pipeline.get_bind_group_layout(group);
                device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
            })
            .collect();
        let (result, bytes) = result.expect("a binding for the result");
        let readback = empty(bytes, Usage::COPY_DST | Usage::MAP_READ);
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(&pipeline);
            for (index, group) in (0..).zip(&groups) {
                pass.set_bind_group(index, group);
            }
            let [x, y, z] = run.workgroups;
            pass.dispatch_workgroups(x, y, z);
        }
        encoder.copy_buffer_to_buffer(&result, 0, &readback, 0, bytes);
        gpu.queue.submit([encoder.finish()]);
        (readback, bytes)
    })?;
    Ok(gpu.read_back(&readback, bytes, read)?)
}
