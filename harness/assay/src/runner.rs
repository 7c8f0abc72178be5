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

    /// Whether each row runs on a device of its own, as odd as WGSL allows. Then a result is held to the oracle alone, and what the formula says of two
    /// results is not asked: it holds there as far as the bounds of both say.
    fn is_slack(&self) -> bool {
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
