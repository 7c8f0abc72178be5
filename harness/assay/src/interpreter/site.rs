//! Places in a module.

/// Place of a decision: a function of the module and an expression of it, by their indices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Site {
    /// Index of the function.
    pub function: u32,
    /// Index of the expression in it.
    pub expression: u32,
}
