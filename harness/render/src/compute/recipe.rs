//! A recipe's compute entry point, run once over buffers of its own.

use super::Kernel;
use crate::shader::ShaderError;
use lapidary_gpu::Gpu;

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
pub fn run_recipe<T>(gpu: &Gpu, run: &RecipeRun<'_>, read: impl FnOnce(&[u8]) -> T) -> Result<T, ShaderError> {
    let kernel = Kernel::new(gpu, run.recipe, &lapidary_wgsl::recipe_source(run.recipe), run.entry, run.constants)?;
    let (readback, bytes) = gpu.guarded(&format!("running recipe `{}`", run.recipe), |device| {
        let label = |what: &str| format!("{} of {}", what, run.recipe);
        let filled = |what: &str, contents: &[u8], usage| {
            let label = Some(&*label(what));
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label, contents, usage })
        };
        let empty = |what: &str, size, usage| {
            let label = Some(&*label(what));
            device.create_buffer(&wgpu::BufferDescriptor { label, size, usage, mapped_at_creation: false })
        };
        use wgpu::BufferUsages as Usage;
        let mut result = None;
        let groups: Vec<Option<wgpu::BindGroup>> = (0..)
            .zip(run.bindings)
            .map(|(group, bindings)| {
                let mut buffer = |binding: &Binding<'_>| match *binding {
                    Binding::Uniform(contents) => filled("uniform", contents, Usage::UNIFORM),
                    Binding::Storage(contents) => filled("input", contents, Usage::STORAGE),
                    Binding::Result(size) => {
                        let buffer = empty("result", size, Usage::STORAGE | Usage::COPY_SRC);
                        result.insert((buffer, size)).0.clone()
                    }
                };
                let buffers: Vec<wgpu::Buffer> = bindings.iter().map(&mut buffer).collect();
                let resources: Vec<_> =
                    (0..).zip(&buffers).map(|(binding, buffer)| (binding, buffer.as_entire_binding())).collect();
                kernel.bind(device, group, &resources)
            })
            .collect();
        let (result, bytes) = result.expect("a binding for the result");
        let readback = empty("result to read", bytes, Usage::COPY_DST | Usage::MAP_READ);
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some(run.recipe),
                ..wgpu::ComputePassDescriptor::default()
            });
            pass.set_pipeline(&kernel.pipeline);
            for (index, group) in (0..).zip(&groups) {
                pass.set_bind_group(index, group.as_ref());
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
