//! WGSL sources: parsed, and examined.

use super::error::DispatchError;
use super::reach;
use super::signature::Signature;

/// Parses and validates WGSL; an error holds naga's message with `path`, line and column.
pub fn parse(source: &str, path: &str) -> Result<(naga::Module, naga::valid::ModuleInfo), DispatchError> {
    lapidary_specialise::parse(source, path).map_err(|error| DispatchError::Source(error.0))
}

/// Refuses a function from outside the cookbook if it is impure or too large for a compiler.
pub fn examine(source: &str, path: &str, function: &str) -> Result<(), DispatchError> {
    let (module, _) = parse(source, path)?;
    reach::check(&module, function).map_err(|fault| DispatchError::Fault {
        line: fault.span.is_defined().then(|| fault.span.location(source).line_number),
        message: fault.message,
    })
}

impl Signature {
    /// Reads the signature of `function` in WGSL source; `path` appears in messages.
    pub fn of_source(source: &str, path: &str, function: &str) -> Result<Signature, DispatchError> {
        let (module, _) = parse(source, path)?;
        Ok(Signature::reflect(&module, function)?)
    }
}
