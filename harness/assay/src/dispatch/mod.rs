//! Runs any WGSL function as a compute kernel: reflected on naga's IR, run over rows of words.

mod batch;
mod kernel;
pub mod layout;
mod nonfinite;
pub mod reach;
pub mod signature;
mod turns;

pub use kernel::{ENTRY_POINT, WORKGROUP_SIZE, kernel_source};

use crate::runner::Runner;
use crate::tokens::{items, tokens};
use crate::value::{Arguments, Value};
use batch::Buffers;
use lapidary_gpu::{Gpu, GpuError};
use layout::Layout;
use signature::{Signature, SignatureError};
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Mutex, PoisonError};

/// Rows in one dispatch: enough to fill the device, but few enough to limit memory (16 MiB at 64
/// words per row).
pub const ROWS_PER_DISPATCH: usize = 65_536;

/// Most words in a row of arguments or results.
const MOST_WORDS: usize = 16_384;

/// Reason why a function could not be made into a kernel, or could not run.
#[derive(Debug, thiserror::Error)]
pub enum DispatchError {
    /// The source is not valid WGSL; naga's message with line and column.
    #[error("{0}")]
    Source(String),
    /// The source is valid WGSL, but cannot be made into a kernel.
    #[error("{message}")]
    Fault {
        /// Line, from 1, if known.
        line: Option<u32>,
        /// The fault and its remedy.
        message: String,
    },
    /// The function does not exist or cannot be dispatched.
    #[error(transparent)]
    Signature(#[from] SignatureError),
    /// The device refused the operation.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// A runner other than a wgpu device refused the operation.
    #[error("{0}")]
    Runner(String),
}

/// Parses and validates WGSL; an error holds naga's message with `path`, line and column.
pub fn parse(source: &str, path: &str) -> Result<(naga::Module, naga::valid::ModuleInfo), DispatchError> {
    lapidary_specialise::parse(source, path).map_err(|error| DispatchError::Source(error.0))
}

/// A function's source with its entry point, as text for any WGSL implementation. Each invocation
/// takes one row of arguments; bindings 0 (arguments) and 1 (results) are in group 0.
#[derive(Clone, Debug)]
pub struct KernelText {
    /// The source as given, followed by the kernel.
    pub text: String,
    /// Signature of the function.
    pub signature: Signature,
    /// Layout of a row of arguments.
    pub input: Layout,
    /// Layout of a row of results.
    pub output: Layout,
}

impl KernelText {
    /// Reflects `function` in `source` (`path` appears in messages) and writes its entry point.
    pub fn of_function(source: &str, path: &str, function: &str) -> Result<KernelText, DispatchError> {
        Self::reflect(source, path, function).map(|(kernel, _)| kernel)
    }

    fn reflect(source: &str, path: &str, function: &str) -> Result<(KernelText, naga::Module), DispatchError> {
        let (module, _) = parse(source, path)?;
        let signature = Signature::reflect(&module, function)?;
        let words: usize = signature.arguments.iter().map(|(_, shape)| shape.words()).sum();
        if words.max(signature.result.words()) > MOST_WORDS {
            let message = format!("`{function}` takes or returns over {MOST_WORDS} numbers; make its arrays smaller");
            return Err(DispatchError::Fault { line: None, message });
        }
        let kernel = kernel_source(&signature);
        refuse_clashes(source, &kernel, &signature)?;
        let text = format!("{source}\n{kernel}");
        let (module, _) = parse(&text, path)?;
        let input = Layout::of_struct(&module, kernel::INPUT);
        let output = Layout::of_struct(&module, kernel::OUTPUT);
        Ok((KernelText { text, signature, input, output }, module))
    }
}

/// A function's source with its entry point, as naga IR: the form that is compiled and mutated.
#[derive(Clone, Debug)]
pub struct KernelModule {
    /// Signature of the function.
    pub signature: Signature,
    /// Functions of the source, and the entry point.
    pub module: naga::Module,
    input: Layout,
    output: Layout,
}

impl KernelModule {
    /// Reflects `function` in `source` (`path` appears in messages) and appends its entry point.
    pub fn reflect(source: &str, path: &str, function: &str) -> Result<KernelModule, DispatchError> {
        let (KernelText { signature, input, output, .. }, module) = KernelText::reflect(source, path, function)?;
        Ok(KernelModule { signature, module, input, output })
    }
}

/// Refuses a function from outside the cookbook if it is impure or too large for a compiler.
pub fn examine(source: &str, path: &str, function: &str) -> Result<(), DispatchError> {
    let (module, _) = parse(source, path)?;
    reach::check(&module, function).map_err(|fault| DispatchError::Fault {
        line: fault.span.is_defined().then(|| fault.span.location(source).line_number),
        message: fault.message,
    })
}

/// Refuses a source that declares a name that the kernel's text needs for another purpose, such as
/// the name of a built-in.
fn refuse_clashes(source: &str, kernel: &str, signature: &Signature) -> Result<(), DispatchError> {
    let mut needed: BTreeSet<&str> = tokens(kernel).iter().map(|token| token.text).collect();
    for name in kernel::HARMLESS {
        needed.remove(name);
    }
    needed.remove(signature.function.as_str());
    let meant = signature.structs();
    let code = tokens(source);
    let clash = items(&code).into_iter().find(|item| needed.contains(item.name) && !meant.contains(item.name));
    match clash {
        None => Ok(()),
        Some(item) => Err(DispatchError::Fault {
            line: Some(item.line),
            message: format!(
                "declares `{}`, a name that WGSL or the check's kernel needs for something else; rename it",
                item.name
            ),
        }),
    }
}

/// The parts of a kernel that are compiled once for a source and a function.
#[derive(Clone, Debug)]
struct Compiled {
    signature: Signature,
    input: Layout,
    output: Layout,
    pipeline: wgpu::ComputePipeline,
    /// Turn counting, if the function has a loop.
    turns: Option<Turns>,
}

/// Turn counting of a kernel's loops.
#[derive(Clone, Debug)]
struct Turns {
    /// Most turns of an invocation.
    limit: u32,
    /// On lavapipe, the kernel with one row per workgroup, for rows that their neighbours may have
    /// cut short.
    alone: Option<wgpu::ComputePipeline>,
}

/// The kernels of this process, by device, source and function.
static COMPILED: Mutex<BTreeMap<(u64, String, String), Compiled>> = Mutex::new(BTreeMap::new());

/// A compiled kernel: rows of argument words in, rows of result words out.
#[derive(Debug)]
pub struct Kernel<'gpu> {
    gpu: &'gpu Gpu,
    compiled: Compiled,
    buffers: Option<Buffers>,
    /// Turns of each row of the last run; empty if the function has no loop.
    turns: Vec<u32>,
    is_portable: bool,
}

impl<'gpu> Kernel<'gpu> {
    /// Returns the kernel of `function` in `source` (`path` appears in messages), compiled at the
    /// first call for both.
    pub fn of_function(
        gpu: &'gpu Gpu,
        source: &str,
        path: &str,
        function: &str,
    ) -> Result<Kernel<'gpu>, DispatchError> {
        let key = (gpu.id(), source.to_owned(), function.to_owned());
        let mut known = COMPILED.lock().unwrap_or_else(PoisonError::into_inner);
        let compiled = match known.get(&key) {
            Some(compiled) => compiled.clone(),
            None => {
                let compiled = compile(gpu, KernelModule::reflect(source, path, function)?, &[])?;
                known.insert(key, compiled.clone());
                compiled
            }
        };
        Ok(Kernel { gpu, compiled, buffers: None, turns: Vec::new(), is_portable: false })
    }

    /// Compiles a kernel that is used only once, such as a mutant.
    pub fn new(gpu: &'gpu Gpu, kernel: KernelModule) -> Result<Kernel<'gpu>, DispatchError> {
        Self::with_constants(gpu, kernel, &[])
    }

    /// Compiles a kernel with values for its overrides: (name, value), a bool as 0 or 1.
    pub fn with_constants(
        gpu: &'gpu Gpu,
        kernel: KernelModule,
        constants: &[(&str, f64)],
    ) -> Result<Kernel<'gpu>, DispatchError> {
        Ok(Kernel {
            gpu,
            compiled: compile(gpu, kernel, constants)?,
            buffers: None,
            turns: Vec::new(),
            is_portable: false,
        })
    }

    /// Returns the kernel, held only to the guarantees of every device that conforms to WGSL: see
    /// [`Runner::is_portable`].
    #[must_use]
    pub fn portable(mut self, is_portable: bool) -> Self {
        self.is_portable = is_portable;
        self
    }

    /// Returns the function's signature.
    pub fn signature(&self) -> &Signature {
        &self.compiled.signature
    }

    /// Returns the most turns (iterations) that the function's loops may take together in one call,
    /// or `None` if it has no loop. Beyond that limit the kernel ends them, and the row's result is
    /// not the function's.
    pub fn turn_limit(&self) -> Option<u32> {
        self.compiled.turns.as_ref().map(|turns| turns.limit)
    }

    fn is_over(&self, turns: u32) -> bool {
        self.turn_limit().is_some_and(|limit| turns > limit)
    }
}

impl Runner for Kernel<'_> {
    fn argument_words(&self) -> usize {
        self.compiled.input.offsets.len()
    }

    fn result_words(&self) -> usize {
        self.compiled.output.offsets.len()
    }

    fn run(&mut self, arguments: &[u32], results: &mut Vec<u32>) -> Result<(), DispatchError> {
        assert_eq!(arguments.len() % self.argument_words(), 0, "whole rows");
        results.clear();
        self.turns.clear();
        let (mut part, mut turns) = (Vec::new(), Vec::new());
        for rows in arguments.chunks(ROWS_PER_DISPATCH * self.argument_words()) {
            self.batch(rows, &mut part, &mut turns)?;
            results.extend_from_slice(&part);
            self.turns.extend_from_slice(&turns);
        }
        Ok(())
    }

    fn is_portable(&self) -> bool {
        self.is_portable
    }

    fn loops(&self) -> bool {
        self.compiled.turns.is_some()
    }

    fn stopped(&self, row: usize) -> bool {
        self.turns.get(row).is_some_and(|turns| self.is_over(*turns))
    }

    fn any_stopped(&self) -> bool {
        self.turns.iter().any(|turns| self.is_over(*turns))
    }

    fn why_stopped(&self) -> String {
        let limit = self.turn_limit().unwrap_or_default();
        let (reason, remedy) = if self.gpu.is_lavapipe() {
            (
                format!("; lavapipe itself would end them without a word after {}", turns::LAVAPIPE_ENDS_AT),
                format!("; a GPU (LAPIDARY_ADAPTER; cook: --adapter NAME) follows up to {}", turns::LIMIT),
            )
        } else {
            (String::new(), String::new())
        };
        format!(
            "took over {limit} turns of its loops and was stopped there{reason}: an endless loop, or one too long to be judged here{remedy}"
        )
    }
}

fn compile(gpu: &Gpu, kernel: KernelModule, constants: &[(&str, f64)]) -> Result<Compiled, DispatchError> {
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

/// Calls a WGSL function for each of `inputs` and returns the results, after a check of the Rust
/// types against naga's.
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
