//! Why a function was not run to its end.

/// Reason why the interpreter cannot run a function, or stopped it before its end.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Stopped(pub(super) String);
