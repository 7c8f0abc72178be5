//! Why a browser gave no answer.

/// The reasons why a browser gave no answer.
#[derive(Debug, thiserror::Error)]
pub enum BrowserError {
    /// The browser cannot be started, or the connection fails.
    #[error("{0}")]
    Connection(String),
    /// The browser's WebGPU refused the job.
    #[error("{0}")]
    Refused(String),
}
