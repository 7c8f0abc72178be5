//! Specialises a shader: keeps only the code that the chosen override values need, so that nothing
//! a scene does not ask for is compiled or bound.
//!
//! Everything happens on naga's IR, pass by pass:
//!
//! 1. `keep_entry_points`: drops the other entry points.
//! 2. `apply_overrides`: naga gives every `override` its value and evaluates the constant
//!    expressions above it.
//! 3. In rounds, until nothing changes:
//!    - `fold`: folds branches, switches and loops on constants, with the local variables between
//!      them (naga lowers `&&` and `||` to an `if` and a variable);
//!    - `dead`: drops stores that are never read, and calls without effect whose result is never
//!      read;
//!    - naga's own compaction: drops unreachable functions, globals, types and expressions;
//!    - `arguments`: replaces arguments that are the same constant in every call, drops those that
//!      are never read.
//! 4. `stages`: drops vertex outputs that no fragment stage reads; if there were any, step 3 is
//!    repeated.
//! 5. `finish`: drops unused constants and runs naga's validation.
//!
//! The result is identical, to the bit, to that of the whole shader with these values: sums of
//! floats are never computed here, and calls and stores keep their order. A function whose result
//! is used stays a function, and its result is never treated as constant.
//!
//! There are two limits. A loop without effect is dropped, which would be visible if it did not
//! end. And an argument that becomes a constant falls under WGSL's rules for constants when the
//! module is written as text: a division by a zero that becomes known only then is an error,
//! although the device would have returned a value.

mod arguments;
mod dead;
mod fold;
pub mod layout;
mod operands;
pub mod spirv_counts;
mod stages;
mod text;
mod value;

#[cfg(test)]
mod tests;

pub use operands::for_each_statement;
pub use text::{SourceError, declared, parse, validate};

use naga::back::pipeline_constants::{PipelineConstantError, process_overrides};
use naga::compact::{KeepUnused, compact};
use naga::valid::ModuleInfo;
use naga::{Module, WithSpan};

/// The reasons why a shader could not be specialised.
#[derive(Debug, thiserror::Error)]
pub enum SpecialiseError {
    /// The module has no entry point of that name.
    #[error("no entry point `{name}`; the shader has {found}")]
    NoEntryPoint {
        /// The requested name.
        name: String,
        /// The names that exist.
        found: String,
    },
    /// An override has no value, a value has no override, or a value does not fit.
    #[error("the override values do not fit the shader: {0}")]
    Override(#[source] Box<PipelineConstantError>),
    /// An override is the length of a workgroup array, which naga's IR ties to the override itself.
    #[error("override `{name}` is the length of an array; give the array a constant length")]
    ArrayLength {
        /// Name of the override.
        name: String,
    },
    /// The shader is not valid, before or after specialisation.
    #[error("the shader is not valid {when} it was specialised: {error}")]
    Invalid {
        /// "before" means that the shader is at fault, "after" that the specialisation is.
        when: &'static str,
        /// The error reported by naga.
        error: Box<WithSpan<naga::valid::ValidationError>>,
    },
}

/// Returns the part of a shader that the named entry points need with the given override values,
/// and its validation info.
///
/// `constants` are pairs of an override's name or `@id` and its value, with a bool as 0 or 1. An
/// override that is not named keeps its default.
pub fn specialise(
    ir: Module,
    constants: &[(&str, f64)],
    entry_points: &[&str],
) -> Result<(Module, ModuleInfo), SpecialiseError> {
    let info = validate(&ir).map_err(|error| SpecialiseError::Invalid { when: "before", error })?;
    let ir = keep_entry_points(ir, entry_points)?;
    let mut module = apply_overrides(&ir, &info, constants)?;
    loop {
        fold_in_rounds(&mut module);
        let dropped = stages::drop_unread_members(&mut module);
        if !dropped.map_err(|error| SpecialiseError::Invalid { when: "after", error })? {
            break;
        }
    }
    finish(module)
}

/// Folds and drops until nothing changes.
fn fold_in_rounds(module: &mut Module) {
    loop {
        let before = size(module);
        fold_functions(module);
        dead::drop_dead_statements(module);
        compact(module, KeepUnused::No);
        dead::drop_unused_locals(module);
        let dropped = arguments::drop_unread_arguments(module);
        let propagated = arguments::propagate_constant_arguments(module);
        if !dropped && !propagated && size(module) == before {
            break;
        }
    }
}

/// Returns the module with only the named entry points. This comes first, so that overrides of
/// other entry points need no value.
fn keep_entry_points(mut module: Module, names: &[&str]) -> Result<Module, SpecialiseError> {
    for name in names {
        if !module.entry_points.iter().any(|entry| entry.name == *name) {
            let found: Vec<String> = module.entry_points.iter().map(|entry| format!("`{}`", entry.name)).collect();
            let found = if found.is_empty() { "none".to_owned() } else { found.join(", ") };
            return Err(SpecialiseError::NoEntryPoint { name: (*name).to_owned(), found });
        }
    }
    module.entry_points.retain(|entry| names.contains(&entry.name.as_str()));
    Ok(module)
}

/// Returns the module with constants instead of overrides.
fn apply_overrides(module: &Module, info: &ModuleInfo, constants: &[(&str, f64)]) -> Result<Module, SpecialiseError> {
    let constants = constants.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
    let (module, _) = process_overrides(module, info, None, &constants)
        .map_err(|error| SpecialiseError::Override(Box::new(error)))?;
    Ok(module.into_owned())
}

/// Folds each function, with the module's types and constants available.
fn fold_functions(module: &mut Module) {
    let mut functions = std::mem::take(&mut module.functions);
    for (_, function) in functions.iter_mut() {
        fold::fold_function(module, function);
    }
    module.functions = functions;
    let mut entry_points = std::mem::take(&mut module.entry_points);
    for entry in &mut entry_points {
        fold::fold_function(module, &mut entry.function);
    }
    module.entry_points = entry_points;
}

/// Returns the number of statements, expressions and variables in all functions. It falls in every
/// round that folds or drops anything.
fn size(module: &Module) -> usize {
    let functions = module.functions.iter().map(|(_, function)| function);
    functions
        .chain(module.entry_points.iter().map(|entry| &entry.function))
        .map(|function| {
            let mut statements = 0;
            operands::for_each_statement(&function.body, &mut |_| statements += 1);
            statements + function.expressions.len() + function.local_variables.len()
        })
        .sum()
}

/// Drops everything still unused, and validates.
fn finish(mut module: Module) -> Result<(Module, ModuleInfo), SpecialiseError> {
    dead::forget_unused_constants(&mut module);
    compact(&mut module, KeepUnused::No);
    // naga returns the overrides that it has replaced; compaction drops all but those that a type
    // still refers to.
    if let Some((_, left)) = module.overrides.iter().next() {
        let name = left.name.clone().or(left.id.map(|id| format!("@id({id})"))).unwrap_or_default();
        return Err(SpecialiseError::ArrayLength { name });
    }
    let info = validate(&module).map_err(|error| SpecialiseError::Invalid { when: "after", error })?;
    Ok((module, info))
}
