//! The project's own workshop: the suite, new techniques, committed pictures, generated pages, lints.

pub mod defects;
pub mod dist;
mod executables;
pub mod host;
pub mod lint;
pub mod new;
pub mod snapshots;
pub mod test;
