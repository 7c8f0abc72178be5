//! Parses WGSL into naga's IR and validates it for core WebGPU; errors name the file.

use naga::valid::{Capabilities, ModuleInfo, ValidationError, ValidationFlags, Validator};
use naga::{Module, WithSpan};

/// Maximum size in bytes of a naga message, including its source excerpt, that is passed on
/// unchanged.
const MOST_MESSAGE: usize = 4_096;

/// A source that is not valid WGSL: naga's message, with path, line and column.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct SourceError(pub String);

/// Parses and validates WGSL; `path` is used in messages.
pub fn parse(source: &str, path: &str) -> Result<(Module, ModuleInfo), SourceError> {
    let module = naga::front::wgsl::parse_str(source).map_err(|error| {
        let place = error.location(source).map(|place| (place.line_number, place.line_position));
        SourceError(short(error.emit_to_string_with_path(source, path), place, error.message(), path))
    })?;
    let info = validate(&module).map_err(|error| {
        let place = error.location(source).map(|place| (place.line_number, place.line_position));
        SourceError(short(error.emit_to_string_with_path(source, path), place, &error.to_string(), path))
    })?;
    Ok((module, info))
}

/// Validates a module against the features of core WebGPU.
pub fn validate(module: &Module) -> Result<ModuleInfo, Box<WithSpan<ValidationError>>> {
    Validator::new(ValidationFlags::all(), Capabilities::default()).validate(module).map_err(Box::new)
}

/// Returns those of `constants` that `module` declares as overrides. An undeclared one is an error
/// in wgpu and naga; but a user's recipe may have left one out, and recipes that share settings
/// need not have all.
pub fn declared<'a>(module: &Module, constants: &[(&'a str, f64)]) -> Vec<(&'a str, f64)> {
    let is_declared = |key: &str| module.overrides.iter().any(|(_, o)| o.name.as_deref() == Some(key));
    constants.iter().copied().filter(|(key, _)| is_declared(key)).collect()
}

/// Returns the whole message, or a single line if the source excerpt would fill the screen.
fn short(whole: String, place: Option<(u32, u32)>, message: &str, path: &str) -> String {
    if whole.len() <= MOST_MESSAGE {
        return whole;
    }
    let (line, column) = place.unwrap_or_default();
    let first: String = message.lines().next().unwrap_or_default().chars().take(400).collect();
    format!("{path}:{line}:{column}: {first}")
}
