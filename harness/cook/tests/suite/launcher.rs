//! The launcher `./cook`, with stand-ins for the toolchain and the binary: the tests cover its use
//! of them.

use lapidary_testing::program::folder;
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// A clone with the real launcher, and scripts in place of the built binary and of cargo.
struct Clone {
    folder: tempfile::TempDir,
}

fn script(path: &Path, lines: &str) {
    std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
    std::fs::write(path, format!("#!/usr/bin/env bash\n{lines}\n")).expect("written");
    std::fs::set_permissions(path, std::fs::Permissions::from_mode(0o755)).expect("set");
}

impl Clone {
    fn new(cargo: &str, binary: &str) -> Self {
        let clone = Self { folder: folder() };
        for part in ["crates", "harness", "wgsl", "temporary"] {
            std::fs::create_dir(clone.at(part)).expect("made");
        }
        for file in ["Cargo.toml", "Cargo.lock", "harness/lib.rs"] {
            std::fs::write(clone.at(file), "").expect("written");
        }
        std::fs::copy(concat!(env!("CARGO_MANIFEST_DIR"), "/../../cook"), clone.at("cook")).expect("copied");
        script(&clone.at("tools/cargo"), cargo);
        script(&clone.at("target/debug/cook"), binary);
        clone
    }

    fn at(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Returns the launcher, in an environment without HOME and without a runtime folder.
    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(self.at("cook"));
        let tools = format!("{}:/usr/local/bin:/usr/bin:/bin", self.at("tools").display());
        command.args(arguments).current_dir(self.folder.path()).env("PATH", tools).env("TMPDIR", self.at("temporary"));
        for name in
            ["HOME", "XDG_RUNTIME_DIR", "XDG_DATA_HOME", "CARGO_TARGET_DIR", "LAPIDARY_CHROMIUM", "LAPIDARY_GLSLANG"]
        {
            command.env_remove(name);
        }
        command
    }

    fn run(&self, arguments: &[&str]) -> (Option<i32>, String, String) {
        self.answer(&mut self.command(arguments))
    }

    fn answer(&self, command: &mut Command) -> (Option<i32>, String, String) {
        let Output { status, stdout, stderr } = command.output().expect("it starts");
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        (status.code(), text(&stdout), text(&stderr))
    }
}

#[test]
fn the_program_takes_the_launchers_place() {
    let clone = Clone::new("exit 0", "echo $$");
    let child = clone.command(&["list"]).stdout(Stdio::piped()).spawn().expect("it starts");
    let id = child.id();
    let output = child.wait_with_output().expect("it ends");
    // A signal to the launcher reaches the program, and no process is left running.
    assert_eq!(String::from_utf8_lossy(&output.stdout).trim(), id.to_string());
}

#[test]
fn arguments_and_the_exit_code_are_the_programs_and_nothing_is_left_behind() {
    let clone = Clone::new("exit 0", "printf '%s|' \"$@\" \"$XDG_RUNTIME_DIR\"; exit 7");
    let (code, stdout, stderr) = clone.run(&["render", "two words", "*"]);
    let temporary = clone.at("temporary");
    assert_eq!((code, stderr.as_str()), (Some(7), ""), "HOME is not needed");
    assert_eq!(stdout, format!("render|two words|*|{}|", temporary.display()));
    assert_eq!(std::fs::read_dir(temporary).expect("a folder").count(), 0);
}

/// A study that shares its ladder's report shows the tables of both; the ladder alone measures.
#[test]
fn what_was_measured_once_is_run_by_the_studies() {
    let clone = Clone::new("echo \"$*, $CARGO_TARGET_DIR\" >>built", "echo cook");
    std::fs::create_dir(clone.at("studies")).expect("made");
    for program in ["ladders", "studies"] {
        script(&clone.at(&format!("target/debug/{program}")), &format!("echo {program}"));
    }
    for (arguments, program) in [
        ("cost sphere --walks 9", "studies"),
        ("--adapter any cost --adapter any restraint", "studies"),
        ("cost dynamic", "studies"),
        ("cost outside", "studies"),
        ("cost gem --rounds 1 --profile", "studies"),
        ("cost gem --from gem.json --fill page.md", "studies"),
        ("cost cdrf --from=cdrf.json", "studies"),
        ("studies gem", "studies"),
        ("cost gem --rungs proxy-1", "ladders"),
        ("cost cdrf --profile", "ladders"),
        ("cost optical_path --from optical_path.json", "ladders"),
        ("cost", "ladders"),
        ("list sphere", "cook"),
    ] {
        let words: Vec<&str> = arguments.split_whitespace().collect();
        let (code, stdout, stderr) = clone.run(&words);
        assert_eq!((code, stdout.trim()), (Some(0), program), "{arguments}: {stderr}");
    }
    // They are built by their own manifest, in the folder of the other builds.
    let built = std::fs::read_to_string(clone.at("built")).expect("cargo ran");
    let is_study = |line: &&str| line.contains("studies/Cargo.toml");
    let target = format!(", {}", clone.at("target").display());
    assert_eq!(built.lines().filter(is_study).count(), 8, "{built}");
    assert!(
        built.lines().filter(is_study).all(|line| line.contains("lapidary-studies") && line.ends_with(&target)),
        "{built}"
    );
}

/// One who copies builds the small program alone; where cook is built already, that serves.
#[test]
fn shaders_are_taken_by_the_smallest_program() {
    let clone = Clone::new("exit 0", "echo cook");
    let program = |words: &str| clone.run(&words.split_whitespace().collect::<Vec<_>>()).1.trim().to_owned();
    assert_eq!(program("copy fresnel"), "cook");
    script(&clone.at("target/debug/take"), "echo take");
    for (words, expected) in [
        ("copy fresnel --to hlsl", "take"),
        ("--adapter any copy --help", "take"),
        ("list", "take"),
        ("list --json", "take"),
        ("list --materials", "cook"),
        ("list --json --rungs", "cook"),
        ("list --rung", "cook"),
        ("help copy", "take"),
        ("help render", "cook"),
        ("list --help", "cook"),
        ("plan ruby", "cook"),
    ] {
        assert_eq!(program(words), expected, "{words}");
    }
    std::fs::remove_file(clone.at("target/debug/cook")).expect("removed");
    assert_eq!(program("copy fresnel"), "take");
}

#[test]
fn what_is_built_runs_where_nothing_can_be_built() {
    let cargo =
        "echo 'error: failed to open: target/debug/.cargo-lock: Read-only file system (os error 30)' >&2; exit 101";
    let clone = Clone::new(cargo, "echo ran");
    let (code, stdout, stderr) = clone.run(&["list"]);
    assert_eq!((code, stdout.as_str()), (Some(0), "ran\n"), "{stderr}");
    assert!(
        stderr.starts_with("cook: cargo cannot build here (error: failed to open") && stderr.contains("up to date"),
        "{stderr}"
    );
    assert_eq!(stderr.lines().count(), 1, "{stderr}");
    // A binary built from other sources does not run.
    let later = std::time::SystemTime::now() + std::time::Duration::from_secs(10);
    std::fs::File::open(clone.at("harness/lib.rs")).and_then(|file| file.set_modified(later)).expect("set");
    let (code, stdout, stderr) = clone.run(&["list"]);
    assert_eq!((code, stdout.as_str()), (Some(2), ""), "{stderr}");
    assert!(stderr.contains("Read-only file system"), "{stderr}");
}

#[test]
fn what_is_built_runs_without_a_toolchain() {
    let clone = Clone::new("exit 0", "echo ran");
    std::fs::remove_file(clone.at("tools/cargo")).expect("removed");
    // There is no toolchain in the user's own folder either.
    let (code, stdout, stderr) = clone.answer(clone.command(&["list"]).env("HOME", clone.at("temporary")));
    assert_eq!((code, stdout.as_str(), stderr.as_str()), (Some(0), "ran\n", ""));
}

#[test]
fn a_first_build_is_announced_and_its_failure_is_bad_input() {
    let clone = Clone::new("echo 'error: no' >&2; exit 101", "");
    std::fs::remove_file(clone.at("target/debug/cook")).expect("removed");
    let (code, stdout, stderr) = clone.run(&["list"]);
    assert_eq!((code, stdout.as_str()), (Some(2), ""), "{stderr}");
    assert!(stderr.contains("cook: building") && stderr.contains("error: no"), "{stderr}");
}

/// The launcher's help, which needs no build, has the commands of every program, and no others.
#[test]
fn the_help_lists_the_commands_of_every_program() {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
    let help = Command::new("bash").arg("cook").current_dir(root).output().expect("bash runs").stdout;
    let help = String::from_utf8(help).expect("UTF-8");
    let listed = |text: &str| -> Vec<String> {
        let words = text.lines().filter_map(|line| line.strip_prefix("  ")?.split(' ').next());
        let mut words: Vec<String> = words
            .filter(|word| word.starts_with(|first: char| first.is_ascii_lowercase()))
            .map(str::to_owned)
            .collect();
        words.sort();
        words
    };
    let programs = std::env::current_exe().expect("the test's own path");
    let programs = programs.ancestors().nth(2).expect("the build folder");
    let clone = Clone::new("exit 0", "echo cook");
    std::fs::create_dir(clone.at("studies")).expect("made");
    for program in ["take", "ladders", "gallery", "xtask"] {
        script(&clone.at(&format!("target/debug/{program}")), &format!("echo {program}"));
    }
    let mut all = Vec::new();
    for program in ["cook", "ladders", "gallery", "xtask"] {
        let output = Command::new(programs.join(program)).arg("--help").output();
        let output = output.unwrap_or_else(|error| panic!("{program}: {error}; `cargo test --workspace` builds it"));
        let commands = listed(&String::from_utf8(output.stdout).expect("UTF-8"));
        // The launcher runs each by the program that has it, or by the smallest.
        for command in commands.iter().filter(|command| *command != "help") {
            let smallest = if ["copy", "list"].contains(&command.as_str()) { "take" } else { program };
            let mut words = vec![command.as_str()];
            // No device is looked for.
            if command != "list" {
                words.splice(..0, ["--adapter", "any"]);
            }
            assert_eq!(clone.run(&words).1.trim(), smallest, "{command}");
        }
        all.extend(commands);
    }
    all.retain(|word| word != "help");
    // Outside of the workspace, built when they are asked for.
    all.push("studies".to_owned());
    all.sort();
    assert_eq!(listed(&help), all, "{help}");
}
