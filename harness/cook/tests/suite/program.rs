//! The real binary as a child process.

use std::ffi::OsStr;
use std::path::Path;
use std::process::Command;

/// Result of a run of `cook`.
#[derive(Debug)]
pub(crate) struct Answer {
    /// Exit code; `None` if a signal ended the process.
    pub(crate) code: Option<i32>,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

/// Runs `cook` with `folder` as its working directory.
pub(crate) fn cook(folder: &Path, arguments: &[impl AsRef<OsStr>]) -> Answer {
    cook_in(folder, arguments, &[])
}

/// Like [`cook`], with changes to the environment.
pub(crate) fn cook_in(folder: &Path, arguments: &[impl AsRef<OsStr>], environment: &[(&str, &str)]) -> Answer {
    // Without XDG_RUNTIME_DIR the Vulkan drivers complain on stderr, which some tests compare in
    // full.
    let runtime = tempfile::tempdir().expect("a temporary folder");
    let output = Command::new(env!("CARGO_BIN_EXE_cook"))
        .args(arguments)
        .current_dir(folder)
        .env("XDG_RUNTIME_DIR", runtime.path())
        .envs(environment.iter().copied())
        .output()
        .expect("the binary starts");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    Answer { code: output.status.code(), stdout: text(&output.stdout), stderr: text(&output.stderr) }
}

/// Runs `cook` in `folder`, and asserts success and an empty stderr.
pub(crate) fn succeeds(folder: &Path, arguments: &[&str]) -> Answer {
    let answer = cook(folder, arguments);
    assert_eq!((answer.code, answer.stderr.as_str()), (Some(0), ""), "{arguments:?}: {}", answer.stdout);
    answer
}

/// Returns a folder that is removed on drop.
pub(crate) fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}
