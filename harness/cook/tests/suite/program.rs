//! The real binary as a child process.

use std::ffi::OsStr;
use std::path::Path;
use std::process::Command;

/// What a run of `cook` answered.
#[derive(Debug)]
pub(crate) struct Answer {
    /// The exit code; none where a signal ended it.
    pub(crate) code: Option<i32>,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

/// Runs `cook` with `folder` as its working directory.
pub(crate) fn cook(folder: &Path, arguments: &[impl AsRef<OsStr>]) -> Answer {
    cook_in(folder, arguments, &[])
}

/// The same, with changes to its environment.
pub(crate) fn cook_in(folder: &Path, arguments: &[impl AsRef<OsStr>], environment: &[(&str, &str)]) -> Answer {
    // Without it the Vulkan drivers complain on stderr, which some tests read to the last line.
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

/// Runs `cook` in `folder` and asserts that it succeeds without a word on stderr.
pub(crate) fn succeeds(folder: &Path, arguments: &[&str]) -> Answer {
    let answer = cook(folder, arguments);
    assert_eq!((answer.code, answer.stderr.as_str()), (Some(0), ""), "{arguments:?}: {}", answer.stdout);
    answer
}

/// A folder that goes when it is dropped.
pub(crate) fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}
