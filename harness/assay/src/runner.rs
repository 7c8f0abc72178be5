//! Runners that call a WGSL function for rows of argument words: an adapter, or the interpreter.

use crate::dispatch::DispatchError;

/// Calls one function.
pub trait Runner {
    /// Returns the number of words in a row of arguments.
    fn argument_words(&self) -> usize;

    /// Returns the number of words in a row of results.
    fn result_words(&self) -> usize;

    /// Calls the function for each row of `arguments`; `results` then holds one row for each, in
    /// order.
    ///
    /// # Errors
    /// Returns an error if the device refuses.
    fn run(&mut self, arguments: &[u32], results: &mut Vec<u32>) -> Result<(), DispatchError>;

    /// Returns whether the device is held only to WGSL's requirements on every conforming device,
    /// and not to further properties of the reference device. A result is then held to the oracle
    /// alone, a subnormal input may have been read as 0, and the formula's properties of pairs of
    /// results, or of devices that round to nearest, are not tested.
    fn is_portable(&self) -> bool {
        false
    }

    /// Returns whether the function has a loop, so that a run may take long.
    fn loops(&self) -> bool;

    /// Returns whether this row of the last run was stopped before its end, so that its result
    /// means nothing.
    fn stopped(&self, row: usize) -> bool;

    /// Returns whether any row of the last run was stopped.
    fn any_stopped(&self) -> bool;

    /// Returns the message for a stopped row.
    fn why_stopped(&self) -> String;
}
