//! Runs any WGSL function as a compute kernel: reflected on naga's IR, run over rows of words.

#[cfg(feature = "gpu")]
mod batch;
#[cfg(feature = "gpu")]
mod compiled;
#[cfg(feature = "gpu")]
mod device;
mod error;
mod kernel;
pub mod layout;
mod module;
#[cfg(feature = "gpu")]
mod nonfinite;
pub mod reach;
pub mod signature;
mod source;
#[cfg(feature = "gpu")]
mod turns;

#[cfg(feature = "gpu")]
pub use device::{Kernel, ROWS_PER_DISPATCH, call};
pub use error::DispatchError;
pub use kernel::{ENTRY_POINT, WORKGROUP_SIZE, kernel_source};
pub use module::{KernelModule, KernelText};
pub use source::{examine, parse};
