//! Output of commands: results on stdout, remarks on stderr. A failed write of a result is an error, unless the reader has
//! closed the pipe.

use super::failure::Failure;
use std::io::Write as _;

/// Writes a line.
pub fn line(text: &str) -> Result<(), Failure> {
    bytes(text.as_bytes())?;
    bytes(b"\n")
}

/// Writes bytes as they are.
pub fn bytes(bytes: &[u8]) -> Result<(), Failure> {
    let mut stdout = std::io::stdout().lock();
    match stdout.write_all(bytes).and_then(|()| stdout.flush()) {
        Ok(()) => Ok(()),
        // `cook list | head` is not an error.
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(()),
        Err(error) => Err(Failure(format!("stdout: cannot be written: {error}"))),
    }
}

/// Writes a remark or a failure as a line on stderr. If that cannot be written, nobody can be told.
pub fn remark(text: &str) {
    let _ = writeln!(std::io::stderr(), "cook: {text}");
}
