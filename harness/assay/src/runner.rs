//! What calls a WGSL function for rows of argument words: an adapter, or the interpreter.

use crate::dispatch::DispatchError;

/// Calls one function.
pub trait Runner {
    /// Words in a row of arguments.
    fn argument_words(&self) -> usize;

    /// Words in a row of results.
    fn result_words(&self) -> usize;

    /// Calls the function for each row of `arguments`; `results` then holds a row for each, in order.
    ///
    /// # Errors
    /// Where the device refuses.
    fn run(&mut self, arguments: &[u32], results: &mut Vec<u32>) -> Result<(), DispatchError>;

    /// Whether the device is held to what every device must keep that conforms to WGSL, and to nothing that the reference device keeps besides. Then a result is
    /// held to the oracle alone, a subnormal input may have been read as 0, and what the formula says of two results, or of devices that round to nearest, is not asked.
    fn is_portable(&self) -> bool {
        false
    }

    /// Whether the function has a loop, so that a run may take long.
    fn loops(&self) -> bool;

    /// Whether that row of the last run was stopped before its end: its result says nothing.
    fn stopped(&self, row: usize) -> bool;

    /// Whether any row of the last run was.
    fn any_stopped(&self) -> bool;

    /// What there is to say of a stopped row.
    fn why_stopped(&self) -> String;
}
