//! A kernel on a device: rows of words in, rows of words out.

use super::batch::Dispatcher;
use super::compiled::{Compiled, compile};
use super::error::DispatchError;
use super::module::KernelModule;
use super::signature::Signature;
use super::turns;
use crate::runner::Runner;
use crate::value::{Arguments, Value};
use lapidary_gpu::Gpu;
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// Rows in one dispatch: enough to fill the device, but few enough to limit memory (16 MiB at 64
/// words per row).
pub const ROWS_PER_DISPATCH: usize = 65_536;

/// The kernels of this process, by device, source and function.
static COMPILED: Mutex<BTreeMap<(u64, String, String), Compiled>> = Mutex::new(BTreeMap::new());

/// A compiled kernel: rows of argument words in, rows of result words out.
#[derive(Debug)]
pub struct Kernel<'gpu> {
    dispatcher: Dispatcher<'gpu>,
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
        Ok(Kernel { dispatcher: Dispatcher::new(gpu, compiled), turns: Vec::new(), is_portable: false })
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
            dispatcher: Dispatcher::new(gpu, compile(gpu, kernel, constants)?),
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
        &self.dispatcher.compiled.signature
    }

    /// Returns the most turns (iterations) that the function's loops may take together in one call,
    /// or `None` if it has no loop. Beyond that limit the kernel ends them, and the row's result is
    /// not the function's.
    pub fn turn_limit(&self) -> Option<u32> {
        self.dispatcher.compiled.turn_limit()
    }
}

impl Runner for Kernel<'_> {
    fn argument_words(&self) -> usize {
        self.dispatcher.compiled.argument_words()
    }

    fn result_words(&self) -> usize {
        self.dispatcher.compiled.result_words()
    }

    fn run(&mut self, arguments: &[u32], results: &mut Vec<u32>) -> Result<(), DispatchError> {
        assert_eq!(arguments.len() % self.argument_words(), 0, "whole rows");
        results.clear();
        self.turns.clear();
        let (mut part, mut turns) = (Vec::new(), Vec::new());
        for rows in arguments.chunks(ROWS_PER_DISPATCH * self.argument_words()) {
            self.dispatcher.batch(rows, &mut part, &mut turns)?;
            results.extend_from_slice(&part);
            self.turns.extend_from_slice(&turns);
        }
        Ok(())
    }

    fn is_portable(&self) -> bool {
        self.is_portable
    }

    fn loops(&self) -> bool {
        self.dispatcher.compiled.turns.is_some()
    }

    fn stopped(&self, row: usize) -> bool {
        self.turns.get(row).is_some_and(|turns| self.dispatcher.compiled.is_over(*turns))
    }

    fn any_stopped(&self) -> bool {
        self.turns.iter().any(|turns| self.dispatcher.compiled.is_over(*turns))
    }

    fn why_stopped(&self) -> String {
        let limit = self.turn_limit().unwrap_or_default();
        let (reason, remedy) = if self.dispatcher.gpu.is_lavapipe() {
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
