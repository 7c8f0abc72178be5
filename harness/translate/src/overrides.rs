//! Overrides, set to their defaults.

use naga::Module;
use naga::valid::ModuleInfo;

/// Returns the module with its overrides' defaults as constants: naga's writers know no overrides.
pub(crate) fn with_defaults(module: &Module) -> Result<(Module, ModuleInfo), String> {
    let info = lapidary_specialise::validate(module).map_err(|error| error.to_string())?;
    let constants = naga::back::PipelineConstants::default();
    let (module, info) = naga::back::pipeline_constants::process_overrides(module, &info, None, &constants)
        .map_err(|error| error.to_string())?;
    Ok((module.into_owned(), info.into_owned()))
}
