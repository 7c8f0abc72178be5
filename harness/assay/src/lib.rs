//! Property tests of WGSL functions on a GPU: any function is reflected and run as a compute kernel, compared with a function in Rust over random,
//! hard and shrunk inputs, under a tolerance in ulp, absolute, relative or backward error.
//!
//! Without the feature `gpu`, what needs no device is left: random inputs, shapes and values, tolerances.

pub mod accuracy_line;
#[cfg(feature = "gpu")]
pub mod dispatch;
pub mod draws;
#[cfg(feature = "gpu")]
mod environment;
#[cfg(feature = "gpu")]
pub mod examination;
pub mod extremum;
#[cfg(feature = "gpu")]
pub mod failure;
pub mod formula;
pub mod golden_section;
#[cfg(feature = "gpu")]
pub mod interpreter;
#[cfg(feature = "gpu")]
mod kernel;
pub mod literal;
#[cfg(feature = "trials")]
pub mod module;
#[cfg(feature = "gpu")]
pub mod mutate;
pub mod outside;
#[cfg(feature = "gpu")]
pub mod property;
pub mod shape;
#[cfg(feature = "gpu")]
pub mod tokens;
pub mod tolerance;
pub mod value;
#[cfg(feature = "gpu")]
mod wgsl;

#[cfg(feature = "gpu")]
pub use environment::{SEED_VARIABLE, WITHOUT_ADAPTER_VARIABLE};
#[cfg(feature = "gpu")]
pub use kernel::{Buffer, Buffers, KernelMirror, KernelSource, KernelTest, Type, kernel};
#[cfg(feature = "gpu")]
pub use wgsl::{Failure, Mirrored, Outcome, Source, Test, wgsl};
