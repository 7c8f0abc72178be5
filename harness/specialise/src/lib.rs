//! Specialises a shader: only what the chosen override values call for is left, so that what a scene does not ask for
//! is neither compiled nor bound.
//!
//! All of it happens on naga's IR, pass by pass:
//!
//! 1. `keep_entry_points`: the others go.
//! 2. `apply_overrides`: naga gives every `override` its value and evaluates the constant expressions above it.
//! 3. In rounds, until nothing changes:
//!    - `fold`: branches, switches and loops on what is constant, with the local variables between (naga lowers `&&`
//!      and `||` to an `if` and a variable);
//!    - `dead`: stores that nobody reads, calls without effect whose result nobody reads;
//!    - naga's own compaction: functions, globals, types and expressions that nothing reaches;
//!    - `arguments`: those that are the same constant in every call, those that nobody reads.
//! 4. `stages`: what a vertex stage hands on and no fragment stage reads; if there was any, 3. again.
//! 5. `finish`: constants that nothing uses, and naga's validation.
//!
//! What is left does what the whole shader does with these values, to the bit: a sum of floats is never computed here,
//! and calls and stores keep their order. A function whose result is used stays a function, and a function's result is
//! never taken for constant.
//!
//! Two limits. A loop without effect is dropped, which would be seen if it did not end. And an argument that becomes a
//! constant falls under WGSL's rules for constants when the module is written as text: a division by a zero that only
//! now is known is then an error, where the device would have given a value.

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

/// Why a shader could not be specialised.
#[derive(Debug, thiserror::Error)]
pub enum SpecialiseError {
    /// The module has no entry point of that name.
    #[error("no entry point `{name}`; the shader has {found}")]
    NoEntryPoint {
        /// The name that was asked for.
        name: String,
        /// The names that there are.
        found: String,
    },
    /// An override has no value, a value has no override, or a value does not fit.
    #[error("the override values do not fit the shader: {0}")]
    Override(#[source] Box<PipelineConstantError>),
    /// An override is the length of a workgroup array, which naga's IR ties to the override itself.
    #[error("override `{name}` is the length of an array; give the array a constant length")]
    ArrayLength {
        /// The override.
        name: String,
    },
    /// The shader is not valid, before or after.
    #[error("the shader is not valid {when} it was specialised: {error}")]
    Invalid {
        /// "before" points at the shader, "after" at a fault of the specialisation.
        when: &'static str,
        /// naga's word.
        error: Box<WithSpan<naga::valid::ValidationError>>,
    },
}

/// The part of a shader that the named entry points need with these override values: (override's name or `@id`, value),
/// a bool as 0 or 1. An override that is not named keeps its default.
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

/// The module with the named entry points alone. First of all, so that an override of another needs no value.
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

/// The module with constants instead of overrides.
fn apply_overrides(module: &Module, info: &ModuleInfo, constants: &[(&str, f64)]) -> Result<Module, SpecialiseError> {
    let constants = constants.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
    let (module, _) = process_overrides(module, info, None, &constants)
        .map_err(|error| SpecialiseError::Override(Box::new(error)))?;
    Ok(module.into_owned())
}

/// Folds each function, with the types and constants of the module at hand.
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

/// Statements, expressions and variables of all functions: a round that found anything to fold or drop leaves fewer.
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

/// Drops the last of what is unused, and validates.
fn finish(mut module: Module) -> Result<(Module, ModuleInfo), SpecialiseError> {
    dead::forget_unused_constants(&mut module);
    compact(&mut module, KeepUnused::No);
    // naga hands back the overrides that it has replaced; compaction drops all but those that a type still names.
    if let Some((_, left)) = module.overrides.iter().next() {
        let name = left.name.clone().or(left.id.map(|id| format!("@id({id})"))).unwrap_or_default();
        return Err(SpecialiseError::ArrayLength { name });
    }
    let info = validate(&module).map_err(|error| SpecialiseError::Invalid { when: "after", error })?;
    Ok((module, info))
}
