//! Any WGSL function as a compute kernel: reflected on naga's IR, run over rows of words.

mod kernel;
mod layout;
mod nonfinite;
pub mod shape;
pub mod value;

pub use kernel::{ENTRY_POINT, kernel_source};

use crate::gpu::{Gpu, GpuError};
use layout::Layout;
use shape::{Signature, SignatureError};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};
use value::{Arguments, Value};

/// Rows in one dispatch: enough to fill the device, few enough that memory stays bounded (16 MiB at 64 words a row).
pub const ROWS_PER_DISPATCH: usize = 65_536;

/// Why a function could not be made into a kernel, or run.
#[derive(Debug, thiserror::Error)]
pub enum DispatchError {
    /// The source is not valid WGSL; naga's message with line and column.
    #[error("{0}")]
    Source(String),
    /// The function is not there or cannot be dispatched.
    #[error(transparent)]
    Signature(#[from] SignatureError),
    /// The device refused.
    #[error(transparent)]
    Gpu(#[from] GpuError),
}

/// Parses and validates WGSL; an error holds naga's message with `path`, line and column.
pub fn parse(source: &str, path: &str) -> Result<(naga::Module, naga::valid::ModuleInfo), DispatchError> {
    let module = naga::front::wgsl::parse_str(source)
        .map_err(|error| DispatchError::Source(error.emit_to_string_with_path(source, path)))?;
    let info =
        validate(&module).map_err(|error| DispatchError::Source(error.emit_to_string_with_path(source, path)))?;
    Ok((module, info))
}

/// Those of `constants` that `module` declares as overrides. One that it does not is an error to wgpu and naga; a user's recipe
/// may have left one out, and recipes that share settings need not have all.
pub fn declared<'a>(module: &naga::Module, constants: &[(&'a str, f64)]) -> Vec<(&'a str, f64)> {
    let is_declared = |key: &str| module.overrides.iter().any(|(_, o)| o.name.as_deref() == Some(key));
    constants.iter().copied().filter(|(key, _)| is_declared(key)).collect()
}

/// Validates a module for what core WebGPU offers.
pub fn validate(
    module: &naga::Module,
) -> Result<naga::valid::ModuleInfo, Box<naga::WithSpan<naga::valid::ValidationError>>> {
    naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::default())
        .validate(module)
        .map_err(Box::new)
}

/// A function's source with its entry point, as naga IR: what a kernel is compiled from, and what a mutant is made of.
#[derive(Clone, Debug)]
pub struct KernelModule {
    /// The function's signature.
    pub signature: Signature,
    /// The source's functions and the entry point.
    pub module: naga::Module,
    input: Layout,
    output: Layout,
}

impl KernelModule {
    /// Reflects `function` in `source` (`path` is for messages) and appends its entry point.
    pub fn reflect(source: &str, path: &str, function: &str) -> Result<KernelModule, DispatchError> {
        let (module, _) = parse(source, path)?;
        let signature = Signature::reflect(&module, function)?;
        let source = format!("{source}\n{}", kernel_source(&signature));
        let (module, _) = parse(&source, path)?;
        let input = Layout::of_struct(&module, kernel::INPUT);
        let output = Layout::of_struct(&module, kernel::OUTPUT);
        Ok(KernelModule { signature, module, input, output })
    }
}

/// What is compiled once for a source and a function.
#[derive(Clone, Debug)]
struct Compiled {
    signature: Signature,
    input: Layout,
    output: Layout,
    pipeline: wgpu::ComputePipeline,
}

/// The kernels of this process, by source and function: it has one device.
static COMPILED: Mutex<BTreeMap<(String, String), Compiled>> = Mutex::new(BTreeMap::new());

/// A compiled kernel: rows of argument words in, rows of result words out.
#[derive(Debug)]
pub struct Kernel<'gpu> {
    gpu: &'gpu Gpu,
    compiled: Compiled,
    buffers: Option<Buffers>,
}

#[derive(Debug)]
struct Buffers {
    capacity: usize,
    inputs: wgpu::Buffer,
    outputs: wgpu::Buffer,
    readback: wgpu::Buffer,
    staging: Vec<u8>,
}

impl<'gpu> Kernel<'gpu> {
    /// The kernel of `function` in `source` (`path` is for messages), compiled at the first call for both.
    pub fn of_function(
        gpu: &'gpu Gpu,
        source: &str,
        path: &str,
        function: &str,
    ) -> Result<Kernel<'gpu>, DispatchError> {
        let key = (source.to_owned(), function.to_owned());
        let mut known = COMPILED.lock().unwrap_or_else(PoisonError::into_inner);
        let compiled = match known.get(&key) {
            Some(compiled) => compiled.clone(),
            None => {
                let compiled = compile(gpu, KernelModule::reflect(source, path, function)?, &[])?;
                known.insert(key, compiled.clone());
                compiled
            }
        };
        Ok(Kernel { gpu, compiled, buffers: None })
    }

    /// Compiles a kernel that nobody asks for again, such as a mutant.
    pub fn new(gpu: &'gpu Gpu, kernel: KernelModule) -> Result<Kernel<'gpu>, DispatchError> {
        Self::with_constants(gpu, kernel, &[])
    }

    /// Compiles a kernel with values for its overrides: (name, value), a bool as 0 or 1.
    pub fn with_constants(
        gpu: &'gpu Gpu,
        kernel: KernelModule,
        constants: &[(&str, f64)],
    ) -> Result<Kernel<'gpu>, DispatchError> {
        Ok(Kernel { gpu, compiled: compile(gpu, kernel, constants)?, buffers: None })
    }

    /// The function's signature.
    pub fn signature(&self) -> &Signature {
        &self.compiled.signature
    }

    /// Words in a row of arguments.
    pub fn argument_words(&self) -> usize {
        self.compiled.input.offsets.len()
    }

    /// Words in a row of results.
    pub fn result_words(&self) -> usize {
        self.compiled.output.offsets.len()
    }

    /// Calls the function for each row of `arguments`; `results` then holds a row for each, in order.
    ///
    /// # Panics
    /// Where `arguments` is not a whole number of rows.
    pub fn run(&mut self, arguments: &[u32], results: &mut Vec<u32>) -> Result<(), DispatchError> {
        assert_eq!(arguments.len() % self.argument_words(), 0, "whole rows");
        results.clear();
        let mut part = Vec::new();
        for rows in arguments.chunks(ROWS_PER_DISPATCH * self.argument_words()) {
            self.dispatch(rows, &mut part)?;
            results.extend_from_slice(&part);
        }
        Ok(())
    }

    fn dispatch(&mut self, arguments: &[u32], results: &mut Vec<u32>) -> Result<(), DispatchError> {
        let rows = arguments.len() / self.argument_words();
        if self.buffers.as_ref().is_none_or(|buffers| buffers.capacity < rows) {
            self.buffers = Some(self.allocate(rows)?);
        }
        let Some(buffers) = &mut self.buffers else { unreachable!("allocated above") };
        let input_bytes = rows * self.compiled.input.stride;
        let output_bytes = (rows * self.compiled.output.stride) as u64;
        self.compiled.input.scatter(arguments, &mut buffers.staging[..input_bytes]);
        self.gpu.queue.write_buffer(&buffers.inputs, 0, &buffers.staging[..input_bytes]);
        self.gpu.guarded(&format!("running `{}`", self.compiled.signature.function), |device| {
            // Bound to the rows in use, so that arrayLength is their number.
            let bind_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout: &self.compiled.pipeline.get_bind_group_layout(0),
                entries: &[
                    wgpu::BindGroupEntry { binding: 0, resource: sized(&buffers.inputs, input_bytes as u64) },
                    wgpu::BindGroupEntry { binding: 1, resource: sized(&buffers.outputs, output_bytes) },
                ],
            });
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            {
                let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
                pass.set_pipeline(&self.compiled.pipeline);
                pass.set_bind_group(0, &bind_group);
                let workgroups = rows.div_ceil(kernel::WORKGROUP_SIZE as usize);
                pass.dispatch_workgroups(u32::try_from(workgroups).expect("at most 1024 workgroups"), 1, 1);
            }
            encoder.copy_buffer_to_buffer(&buffers.outputs, 0, &buffers.readback, 0, output_bytes);
            self.gpu.queue.submit([encoder.finish()]);
        })?;
        self.gpu
            .read_back(&buffers.readback, output_bytes, |bytes| self.compiled.output.gather(bytes, rows, results))?;
        Ok(())
    }

    fn allocate(&self, rows: usize) -> Result<Buffers, DispatchError> {
        let capacity = rows.next_power_of_two();
        let buffer = |label, bytes: usize, usage| {
            self.gpu.guarded("allocating kernel buffers", |device| {
                device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some(label),
                    size: bytes as u64,
                    usage,
                    mapped_at_creation: false,
                })
            })
        };
        use wgpu::BufferUsages as Usage;
        Ok(Buffers {
            capacity,
            inputs: buffer("inputs", capacity * self.compiled.input.stride, Usage::STORAGE | Usage::COPY_DST)?,
            outputs: buffer("outputs", capacity * self.compiled.output.stride, Usage::STORAGE | Usage::COPY_SRC)?,
            readback: buffer("readback", capacity * self.compiled.output.stride, Usage::COPY_DST | Usage::MAP_READ)?,
            staging: vec![0; capacity * self.compiled.input.stride],
        })
    }
}

fn compile(gpu: &Gpu, kernel: KernelModule, constants: &[(&str, f64)]) -> Result<Compiled, DispatchError> {
    let KernelModule { signature, module, input, output } = kernel;
    let pipeline = gpu.guarded(&format!("compiling `{}`", signature.function), |device| {
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
    })?;
    Ok(Compiled { signature, input, output, pipeline })
}

fn sized(buffer: &wgpu::Buffer, size: u64) -> wgpu::BindingResource<'_> {
    wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer, offset: 0, size: wgpu::BufferSize::new(size) })
}

/// Calls a WGSL function for each of `inputs` and returns its results: a slice in, a vector out, types checked against
/// naga's first.
pub fn call<A: Arguments<u32>, R: Value>(
    gpu: &Gpu,
    source: &str,
    function: &str,
    inputs: &[A],
) -> Result<Vec<R>, DispatchError> {
    let mut kernel = Kernel::of_function(gpu, source, function, function)?;
    kernel.signature().expect(&A::shapes(), &R::shape())?;
    let mut arguments = Vec::with_capacity(inputs.len() * kernel.argument_words());
    inputs.iter().for_each(|input| input.write(&mut arguments));
    let mut results = Vec::new();
    kernel.run(&arguments, &mut results)?;
    let mut words = results.as_slice();
    Ok(inputs.iter().map(|_| R::read(&mut words)).collect())
}
