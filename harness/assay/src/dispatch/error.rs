//! Why a kernel cannot be made or run.

use super::signature::SignatureError;
#[cfg(feature = "gpu")]
use lapidary_gpu::GpuError;

/// Reason why a function could not be made into a kernel, or could not run.
#[derive(Debug, thiserror::Error)]
pub enum DispatchError {
    /// The source is not valid WGSL; naga's message with line and column.
    #[error("{0}")]
    Source(String),
    /// The source is valid WGSL, but cannot be made into a kernel.
    #[error("{message}")]
    Fault {
        /// Line, from 1, if known.
        line: Option<u32>,
        /// The fault and its remedy.
        message: String,
    },
    /// The function does not exist or cannot be dispatched.
    #[error(transparent)]
    Signature(#[from] SignatureError),
    /// The device refused the operation.
    #[cfg(feature = "gpu")]
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// A runner other than a wgpu device refused the operation.
    #[error("{0}")]
    Runner(String),
}
