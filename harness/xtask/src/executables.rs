//! The suite's test programs: cargo builds and lists them, and each is run by itself, so that what has not changed since
//! it passed can be left out, and each test's seconds can be read.

use lapidary_cook::command::Failure;
use serde_json::Value;
use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::io::{BufRead as _, BufReader, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// A test program.
#[derive(Clone, Debug)]
pub(crate) struct Executable {
    /// The package's folder, in which cargo runs the program.
    folder: PathBuf,
    /// Package and target, such as `render suite`.
    pub(crate) name: String,
    path: PathBuf,
}

/// Builds the test programs that these arguments of `cargo test` name, and lists them.
pub(crate) fn built(root: &Path, targets: &[&str]) -> Result<Vec<Executable>, Failure> {
    let mut command = Command::new(cargo());
    command.arg("test").args(targets).args([
        "--no-run",
        "--message-format",
        "json-render-diagnostics",
        "--manifest-path",
    ]);
    command.arg(root.join("Cargo.toml")).stdout(Stdio::piped());
    let failed = |error: std::io::Error| Failure(format!("cargo cannot be run: {error}; is it on the PATH?"));
    let mut child = command.spawn().map_err(failed)?;
    let mut found = Vec::new();
    for line in child.stdout.take().map(BufReader::new).into_iter().flat_map(|lines| lines.lines()) {
        let Ok(message) = serde_json::from_str::<Value>(&line.map_err(failed)?) else { continue };
        found.extend(executable(&message));
    }
    if !child.wait().map_err(failed)?.success() {
        return Err(Failure("the tests do not build; cargo's messages are above".to_owned()));
    }
    // The largest run longest: begun last, they would run alone in the end.
    let size = |program: &Executable| std::fs::metadata(&program.path).map_or(0, |data| data.len());
    found.sort_by_key(|program| (std::cmp::Reverse(size(program)), program.name.clone()));
    Ok(found)
}

fn cargo() -> std::ffi::OsString {
    std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into())
}

/// Returns the test program that a message of cargo's is about.
fn executable(message: &Value) -> Option<Executable> {
    if message["reason"] != "compiler-artifact" || message["profile"]["test"] != true {
        return None;
    }
    let path = PathBuf::from(message["executable"].as_str()?);
    let folder = Path::new(message["manifest_path"].as_str()?).parent()?.to_owned();
    let package = folder.file_name()?.to_string_lossy().into_owned();
    let kind = message["target"]["kind"][0].as_str()?;
    let target = if kind == "test" { message["target"]["name"].as_str()? } else { kind };
    Some(Executable { name: format!("{package} {target}"), folder, path })
}

/// How a run went.
pub(crate) struct Ran {
    pub(crate) passed: bool,
    /// Seconds of each test, by its name.
    pub(crate) seconds: BTreeMap<String, f64>,
    pub(crate) count: Count,
}

/// Numbers of tests.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Count {
    /// Those that ran.
    pub(crate) ran: usize,
    /// Those that have the name asked for, but are marked as long.
    pub(crate) long: usize,
}

impl std::ops::AddAssign for Count {
    fn add_assign(&mut self, other: Self) {
        self.ran += other.ran;
        self.long += other.long;
    }
}

impl Executable {
    /// Runs the tests, and shows what the program prints: line by line if it runs alone, else when it has ended.
    pub(crate) fn run(
        &self,
        arguments: &[&str],
        environment: &[(&str, String)],
        is_alone: bool,
    ) -> Result<Ran, Failure> {
        let mut command = Command::new(&self.path);
        command.current_dir(&self.folder).args(arguments).envs(environment.iter().map(|(name, value)| (name, value)));
        // libtest tells a test's time to those who may use what is unstable.
        command.args(["-Z", "unstable-options", "--report-time"]).env("RUSTC_BOOTSTRAP", "1");
        // Its errors stand between its lines, as they would on a terminal.
        let (reader, writer) = std::io::pipe()?;
        command.env("CARGO", cargo()).stdout(writer.try_clone()?).stderr(writer);
        let failed = |error: std::io::Error| Failure(format!("{}: cannot be run: {error}", self.path.display()));
        let mut child = command.spawn().map_err(failed)?;
        // What it holds of the pipe would keep the reader waiting.
        drop(command);
        let mut said = format!("{}:\n", self.name).into_bytes();
        let (mut seconds, mut count) = (BTreeMap::new(), Count::default());
        for line in BufReader::new(reader).split(b'\n') {
            let line = line.map_err(failed)?;
            let text = String::from_utf8_lossy(&line);
            seconds.extend(timed(&text));
            count += counted(&text).unwrap_or_default();
            said.extend(line);
            said.push(b'\n');
            if is_alone {
                let _ = std::io::stdout().lock().write_all(&said);
                said.clear();
            }
        }
        let passed = child.wait().map_err(failed)?.success();
        let _ = std::io::stdout().lock().write_all(&said);
        Ok(Ran { passed, seconds, count })
    }

    /// Runs a program that has a `main` of its own.
    pub(crate) fn run_plainly(&self, arguments: &[&str], environment: &[(&str, String)]) -> Result<bool, Failure> {
        let mut command = Command::new(&self.path);
        command.current_dir(&self.folder).args(arguments).envs(environment.iter().map(|(name, value)| (name, value)));
        let status = command.env("CARGO", cargo()).status();
        Ok(status.map_err(|error| Failure(format!("{}: cannot be run: {error}", self.path.display())))?.success())
    }

    /// Returns a hash of all that the tests depend on: the program itself, the files and programs of the repository that it
    /// may read or run.
    pub(crate) fn hash(&self, files: &Files) -> u64 {
        let mut hasher = DefaultHasher::new();
        built_when(&self.path).hash(&mut hasher);
        files.below(&self.folder).for_each(|file| file.hash(&mut hasher));
        if let Some(programs) = self.path.ancestors().nth(2) {
            for program in ["cook", "gallery", "ladders", "take", "xtask"] {
                built_when(&programs.join(program)).hash(&mut hasher);
            }
        }
        hasher.finish()
    }
}

/// Returns the hash of a value.
pub(crate) fn hash_of(value: &impl std::hash::Hash) -> u64 {
    let mut hasher = DefaultHasher::new();
    value.hash(&mut hasher);
    hasher.finish()
}

/// Returns what tells a program of cargo's from an earlier one; their contents are gigabytes.
fn built_when(program: &Path) -> Option<(u64, std::time::SystemTime)> {
    let data = std::fs::metadata(program).ok()?;
    Some((data.len(), data.modified().ok()?))
}

/// Packages whose tests read Rust's sources while they run.
const READERS: [&str; 2] = ["assay", "xtask"];

/// The files that tests may read while they run, each with a hash.
pub(crate) struct Files {
    root: PathBuf,
    hashes: Vec<(String, u64)>,
}

impl Files {
    /// Reads the files that git knows; `None` where it knows none, as in an unpacked archive.
    pub(crate) fn of(root: &Path) -> std::io::Result<Option<Self>> {
        let mut git = Command::new("git");
        git.arg("-C").arg(root).args(["ls-files", "--cached", "--others", "--exclude-standard", "-z"]);
        let output = git.output()?;
        if !output.status.success() {
            return Ok(None);
        }
        let text = String::from_utf8(output.stdout).map_err(std::io::Error::other)?;
        let hash = |file: &str| (file.to_owned(), hash_of(&std::fs::read(root.join(file)).unwrap_or_default()));
        let files = text.split('\0').filter(|file| !file.is_empty());
        Ok(Some(Self { root: root.to_owned(), hashes: files.map(hash).collect() }))
    }

    /// Those that the tests of a package may read: a mirror's own read none but those of their folder, and most read no
    /// Rust but what their program holds.
    fn below(&self, folder: &Path) -> impl Iterator<Item = &(String, u64)> {
        let is_mirror = folder.parent().is_some_and(|parent| parent.ends_with("crates"));
        let reads_rust = READERS.iter().any(|reader| folder.ends_with(reader));
        let is_read = move |(file, _): &&(String, u64)| {
            (reads_rust || !file.ends_with(".rs")) && (!is_mirror || self.root.join(file).starts_with(folder))
        };
        self.hashes.iter().filter(is_read)
    }
}

/// Returns the test and the seconds of one of libtest's lines: `test a::b ... ok <1.234s>`.
fn timed(line: &str) -> Option<(String, f64)> {
    let (name, rest) = line.strip_prefix("test ")?.split_once(" ... ")?;
    let seconds = rest.rsplit_once('<')?.1.strip_suffix("s>")?.parse().ok()?;
    Some((name.to_owned(), seconds))
}

/// Returns the numbers of one of libtest's lines: `test result: ok. 3 passed; 0 failed; 1 ignored; …`.
fn counted(line: &str) -> Option<Count> {
    let (_, parts) = line.strip_prefix("test result: ")?.split_once(". ")?;
    let number = |what: &str| {
        parts.split("; ").find_map(|part| part.strip_suffix(what)?.trim().parse::<usize>().ok()).unwrap_or(0)
    };
    Some(Count { ran: number("passed") + number("failed"), long: number("ignored") })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tests_are_counted() {
        let line = "test result: FAILED. 3 passed; 1 failed; 2 ignored; 0 measured; 8 filtered out; finished in 6.36s";
        assert_eq!(counted(line), Some(Count { ran: 4, long: 2 }));
        assert_eq!(counted("test a ... ok <0.1s>"), None);
    }

    #[test]
    fn a_tests_seconds_are_read() {
        assert_eq!(timed("test a::b ... ok <1.250s>"), Some(("a::b".to_owned(), 1.25)));
        assert_eq!(timed("test a ... FAILED <0.5s>"), Some(("a".to_owned(), 0.5)));
        for line in ["running 3 tests", "test a ... ignored", "test result: ok. 3 passed"] {
            assert_eq!(timed(line), None);
        }
    }

    #[test]
    fn a_program_is_known_by_its_package_and_target() {
        let message = serde_json::json!({
            "reason": "compiler-artifact", "profile": { "test": true }, "executable": "/t/debug/deps/suite-1",
            "manifest_path": "/r/harness/render/Cargo.toml", "target": { "name": "suite", "kind": ["test"] },
        });
        assert_eq!(executable(&message).expect("a test").name, "render suite");
        assert!(executable(&serde_json::json!({ "reason": "build-finished" })).is_none());
    }
}
