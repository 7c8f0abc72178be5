//! Runs a recipe's compute entry point once, with its own buffers.

use super::build::Builder;
use super::execute::Executor;
use super::pass::Workgroups;
use super::shader::ShaderError;
use lapidary_gpu::Gpu;
use wgpu::BufferUsages as Usage;

/// Resource at a binding; bindings are numbered from 0 in each group.
#[derive(Clone, Copy, Debug)]
pub enum Binding<'a> {
    /// A uniform buffer with these contents.
    Uniform(&'a [u8]),
    /// A read-only storage buffer with these contents.
    Storage(&'a [u8]),
    /// The storage buffer that is written and read back, with its size in bytes.
    Result(u64),
}

/// A recipe to run, and its inputs.
#[derive(Clone, Copy, Debug)]
pub struct RecipeRun<'a> {
    /// Name of the recipe.
    pub recipe: &'a str,
    /// Compute entry point of the recipe.
    pub entry: &'a str,
    /// Values of overrides; names that the recipe does not declare are ignored.
    pub constants: &'a [(&'a str, f64)],
    /// Bindings of each group.
    pub bindings: &'a [&'a [Binding<'a>]],
    /// Number of workgroups along each axis.
    pub workgroups: [u32; 3],
}

/// Runs a recipe and returns the words of its [`Binding::Result`].
///
/// # Errors
/// If the recipe is not valid, or the device rejects it.
///
/// # Panics
/// If no binding is a result.
pub fn run_recipe(gpu: &Gpu, run: &RecipeRun<'_>) -> Result<Vec<u32>, ShaderError> {
    let mut builder = Builder::new(Some(gpu));
    let source = lapidary_wgsl::recipe_source(run.recipe);
    let pipeline = builder.compute_pipeline(run.recipe, &source, run.entry, run.constants)?;
    let mut result = None;
    let mut groups = Vec::new();
    for (group, bindings) in (0..).zip(run.bindings) {
        let mut buffer = |binding: &Binding<'_>| match *binding {
            Binding::Uniform(contents) => builder.filled("uniform", contents.to_vec(), Usage::UNIFORM),
            Binding::Storage(contents) => builder.storage("input", contents),
            Binding::Result(size) => *result.insert(builder.buffer("result", size, Usage::STORAGE | Usage::COPY_SRC)),
        };
        let buffers: Vec<_> = (0..).zip(bindings.iter().map(&mut buffer)).collect();
        let resources: Vec<_> = buffers.into_iter().map(|(binding, buffer)| (binding, buffer.into())).collect();
        groups.push(builder.bind(pipeline, group, &resources));
    }
    let dispatch = builder.dispatch(pipeline, groups, Workgroups::Count(run.workgroups));
    builder.compute(run.recipe, vec![dispatch], 1);
    let executor = Executor::new(gpu, builder.finish())?;
    executor.run(|_, _| {})?;
    Ok(executor.words(result.expect("a binding for the result"))?)
}
