//! Compilation of a kernel for a device.

use super::error::DispatchError;
use super::kernel::ENTRY_POINT;
use super::layout::Layout;
use super::module::KernelModule;
use super::signature::Signature;
use super::turns;
use lapidary_gpu::Gpu;
use std::borrow::Cow;

/// The parts of a kernel that are compiled once for a source and a function.
#[derive(Clone, Debug)]
pub(super) struct Compiled {
    pub(super) signature: Signature,
    pub(super) input: Layout,
    pub(super) output: Layout,
    pub(super) pipeline: wgpu::ComputePipeline,
    /// Turn counting, if the function has a loop.
    pub(super) turns: Option<Turns>,
}

/// Turn counting of a kernel's loops.
#[derive(Clone, Debug)]
pub(super) struct Turns {
    /// Most turns of an invocation.
    pub(super) limit: u32,
    /// On lavapipe, the kernel with one row per workgroup, for rows that their neighbours may have
    /// cut short.
    pub(super) alone: Option<wgpu::ComputePipeline>,
}

impl Compiled {
    /// Returns the number of words in a row of arguments.
    pub(super) fn argument_words(&self) -> usize {
        self.input.offsets.len()
    }

    /// Returns the number of words in a row of results.
    pub(super) fn result_words(&self) -> usize {
        self.output.offsets.len()
    }

    /// Returns the most turns of an invocation; `None` if the function has no loop.
    pub(super) fn turn_limit(&self) -> Option<u32> {
        self.turns.as_ref().map(|turns| turns.limit)
    }

    /// Returns whether an invocation that took so many turns was stopped.
    pub(super) fn is_over(&self, turns: u32) -> bool {
        self.turn_limit().is_some_and(|limit| turns > limit)
    }
}

/// Compiles a kernel with values for its overrides: (name, value).
pub(super) fn compile(gpu: &Gpu, kernel: KernelModule, constants: &[(&str, f64)]) -> Result<Compiled, DispatchError> {
    let KernelModule { signature, mut module, input, output } = kernel;
    module.entry_points.retain(|point| point.name == ENTRY_POINT);
    if constants.is_empty() {
        // The driver's compiler need not see code that the function does not reach. With constants,
        // a removed override would be an error.
        naga::compact::compact(&mut module, naga::compact::KeepUnused::No);
    }
    let limit = if gpu.is_lavapipe() { turns::LAVAPIPE_LIMIT } else { turns::LIMIT };
    let counts = turns::count(&mut module, limit);
    let alone = if counts && gpu.is_lavapipe() {
        let mut alone = module.clone();
        alone.entry_points.iter_mut().for_each(turns::one_row_a_workgroup);
        Some(pipeline(gpu, &signature, alone, constants)?)
    } else {
        None
    };
    let pipeline = pipeline(gpu, &signature, module, constants)?;
    Ok(Compiled { signature, input, output, pipeline, turns: counts.then_some(Turns { limit, alone }) })
}

fn pipeline(
    gpu: &Gpu,
    signature: &Signature,
    module: naga::Module,
    constants: &[(&str, f64)],
) -> Result<wgpu::ComputePipeline, DispatchError> {
    Ok(gpu.guarded(&format!("compiling `{}`", signature.function), |device| {
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(&signature.function),
            source: wgpu::ShaderSource::Naga(Cow::Owned(module)),
        });
        device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(&signature.function),
            layout: None,
            module: &module,
            entry_point: Some(ENTRY_POINT),
            compilation_options: wgpu::PipelineCompilationOptions { constants, ..Default::default() },
            cache: None,
        })
    })?)
}
