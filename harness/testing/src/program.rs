//! The real programs as child processes.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Commands of other programs than `cook`; what `take` has, `cook` has too.
const PROGRAMS: [(&str, &[&str]); 3] =
    [("ladders", &["cost", "builtins"]), ("gallery", &["gallery"]), ("xtask", &["test", "new", "dist", "snapshots"])];

/// Returns the program of a command, which stands above the test that runs: a run of the whole suite builds all.
pub fn program(command: Option<&OsStr>) -> PathBuf {
    let holds = |commands: &[&str]| command.is_some_and(|word| commands.iter().any(|command| word == *command));
    let name = PROGRAMS.iter().find(|(_, commands)| holds(commands)).map_or("cook", |(name, _)| name);
    let test = std::env::current_exe().expect("the test's own path");
    test.ancestors().nth(2).expect("the build folder").join(name).with_extension(std::env::consts::EXE_EXTENSION)
}

/// Result of a run of `cook`.
#[derive(Debug)]
pub struct Answer {
    /// Exit code; `None` if a signal ended the process.
    pub code: Option<i32>,
    /// What it printed on stdout.
    pub stdout: String,
    /// What it printed on stderr.
    pub stderr: String,
}

/// Runs `cook` with `folder` as its working directory.
pub fn cook(folder: &Path, arguments: &[impl AsRef<OsStr>]) -> Answer {
    cook_in(folder, arguments, &[])
}

/// Like [`cook`], with changes to the environment.
pub fn cook_in(folder: &Path, arguments: &[impl AsRef<OsStr>], environment: &[(&str, &str)]) -> Answer {
    run(&program(arguments.first().map(AsRef::as_ref)), folder, arguments, environment)
}

/// Runs a program of a suite's own, like [`cook_in`].
pub fn run(program: &Path, folder: &Path, arguments: &[impl AsRef<OsStr>], environment: &[(&str, &str)]) -> Answer {
    // Without XDG_RUNTIME_DIR the Vulkan drivers complain on stderr, which some tests compare in
    // full.
    let runtime = tempfile::tempdir().expect("a temporary folder");
    let output = Command::new(program)
        .args(arguments)
        .current_dir(folder)
        .env("XDG_RUNTIME_DIR", runtime.path())
        .envs(environment.iter().copied())
        .output()
        .unwrap_or_else(|error| panic!("{error}; `cargo test --workspace` builds every program"));
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    Answer { code: output.status.code(), stdout: text(&output.stdout), stderr: text(&output.stderr) }
}

/// Runs `cook` in `folder`, and asserts success and an empty stderr.
pub fn succeeds(folder: &Path, arguments: &[&str]) -> Answer {
    let answer = cook(folder, arguments);
    assert_eq!((answer.code, answer.stderr.as_str()), (Some(0), ""), "{arguments:?}: {}", answer.stdout);
    answer
}

/// Returns a folder that is removed on drop.
pub fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}
