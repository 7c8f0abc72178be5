//! `cook test --defects`: plants each defect of a list in a copy of the working tree, and expects a test to fail.
//!
//! The list is `harness/xtask/defects.txt`; its head says how an entry is written. The copy has a target folder of its
//! own. In a shared one cargo would take what it has built of the copy's files for built of these, and the other way
//! round: it goes by paths below the workspace and by times, not by contents.

use lapidary_cook::command::{Context, Failure, Outcome, output};
use lapidary_cookbook::repository;
use lapidary_gpu::ADAPTER_VARIABLE;
use lapidary_testing::seed::SEED_VARIABLE;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

/// The list, from the repository's folder.
pub const LIST: &str = "harness/xtask/defects.txt";

/// A defect that a tired person could write, and the tests that must find it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Defect {
    /// Its place in the list, from 1.
    pub number: usize,
    /// Heading that it stands under.
    pub kind: String,
    /// What is wrong, in a few words.
    pub what: String,
    /// File, from the repository's folder.
    pub file: String,
    /// Arguments of `cargo test`, the test's name last.
    pub test: String,
    /// Text that occurs once in the file.
    pub old: String,
    /// Text in its place.
    pub new: String,
}

impl Defect {
    /// Returns the file's text with the defect.
    ///
    /// # Errors
    /// Returns an error if the old text does not occur exactly once.
    pub fn planted(&self, text: &str) -> Result<String, String> {
        match text.matches(&self.old).count() {
            1 => Ok(text.replacen(&self.old, &self.new, 1)),
            count => Err(format!("{}: occurs {count} times, not once: {}", self.file, self.old)),
        }
    }

    fn is_asked_for(&self, filter: Option<&str>) -> bool {
        let all = [&self.kind, &self.what, &self.file, &self.test];
        filter.is_none_or(|asked| all.iter().any(|part| part.contains(asked)) || self.number.to_string() == asked)
    }
}

/// Reads a list.
///
/// # Errors
/// Returns an error that names the line that is none of an entry.
pub fn read(text: &str) -> Result<Vec<Defect>, String> {
    let mut found = Vec::new();
    let mut kind = String::new();
    for (part, first) in paragraphs(text) {
        if let Some(heading) = part[0].strip_prefix('[').and_then(|rest| rest.strip_suffix(']')) {
            kind = heading.to_owned();
            continue;
        }
        let mut defect = Defect { number: found.len() + 1, kind: kind.clone(), ..Defect::default() };
        let (mut old, mut new) = (Vec::new(), Vec::new());
        for (offset, line) in part.iter().enumerate() {
            match line.split_once(' ').unwrap_or((line, "")) {
                _ if offset == 0 => defect.what = (*line).to_owned(),
                ("file", file) => defect.file = file.to_owned(),
                ("test", test) => defect.test = test.to_owned(),
                ("-", text) => old.push(text),
                ("+", text) => new.push(text),
                _ => return Err(format!("{LIST}:{}: neither file, test, - nor +: {line}", first + offset)),
            }
        }
        (defect.old, defect.new) = (old.join("\n"), new.join("\n"));
        if [&defect.file, &defect.test, &defect.old].iter().any(|part| part.is_empty()) || old == new {
            return Err(format!("{LIST}:{first}: lacks a file, a test, a text or a change"));
        }
        found.push(defect);
    }
    Ok(found)
}

/// Returns the stretches of lines between blank ones and comments, each with its first line's number.
fn paragraphs(text: &str) -> Vec<(Vec<&str>, usize)> {
    let mut found: Vec<(Vec<&str>, usize)> = Vec::new();
    let mut is_open = false;
    for (number, line) in (1..).zip(text.lines()) {
        if line.is_empty() || line.starts_with('#') {
            is_open = false;
        } else if is_open && let Some((lines, _)) = found.last_mut() {
            lines.push(line);
        } else {
            found.push((vec![line], number));
            is_open = true;
        }
    }
    found
}

/// What became of a defect.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Fate {
    /// A test failed.
    Caught,
    /// All tests passed, or none ran.
    Missed,
    /// The compiler refused it, which is a fault of the list.
    DoesNotCompile,
    /// The tests do not pass without it either, so that they say nothing.
    FailsWithout,
}

impl Fate {
    const fn name(&self) -> &'static str {
        match self {
            Self::Caught => "caught",
            Self::Missed => "MISSED",
            Self::DoesNotCompile => "does not compile",
            Self::FailsWithout => "fails without the defect",
        }
    }
}

/// Plants the defects whose kind, words, file or test hold `filter`, one after the other.
///
/// # Errors
/// Returns one line for the user: what is wrong, where, and what to do.
pub fn run(context: &Context, filter: Option<&str>, seed: u64) -> Result<Outcome, Failure> {
    let root = repository::required("test")?;
    let list = std::fs::read_to_string(root.join(LIST)).map_err(|error| Failure(format!("{LIST}: {error}")))?;
    let all = read(&list).map_err(Failure)?;
    let chosen: Vec<&Defect> = all.iter().filter(|defect| defect.is_asked_for(filter)).collect();
    if chosen.is_empty() {
        return Err(Failure(format!("no defect of {LIST} holds `{}`", filter.unwrap_or_default())));
    }
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from);
    let tree = Tree { folder: target.join("defects/tree"), target: target.join("defects/target") };
    tree.bring_up_to_date(&root).map_err(Failure)?;
    let tests = Tests { tree: &tree, adapter: context.adapter.to_string(), seed };
    // Without a defect first, all of them: what is planted later would have to be built out of each again.
    let mut passes: BTreeMap<&str, bool> = BTreeMap::new();
    for test in chosen.iter().map(|defect| defect.test.as_str()) {
        if !passes.contains_key(test) {
            eprintln!("without a defect: cargo test {test}");
            passes.insert(test, tests.build(test)? && tests.pass(test)?);
        }
    }
    let mut count: BTreeMap<&str, usize> = BTreeMap::new();
    for defect in chosen {
        let start = Instant::now();
        let fate = if passes[defect.test.as_str()] { tests.fate(defect)? } else { Fate::FailsWithout };
        let Defect { number, file, test, .. } = defect;
        let seconds = start.elapsed().as_secs();
        output::line(&format!("{number:>3} {file:<52} {test:<72} {} {seconds} s", fate.name()))?;
        *count.entry(fate.name()).or_default() += 1;
    }
    let mut total = String::new();
    for (name, count) in &count {
        let _ = write!(total, "{}{count} {name}", if total.is_empty() { "" } else { ", " });
    }
    output::line(&total)?;
    let is_sound = count.keys().all(|name| *name == Fate::Caught.name());
    Ok(if is_sound { Outcome::Passed } else { Outcome::Failed })
}

/// A copy of the working tree.
struct Tree {
    folder: PathBuf,
    target: PathBuf,
}

impl Tree {
    /// Copies what differs of the files that git knows or would take, so that cargo builds no more than that again.
    fn bring_up_to_date(&self, root: &Path) -> Result<(), String> {
        let listed = Command::new("git")
            .arg("-C")
            .arg(root)
            .args(["ls-files", "-z", "--cached", "--others", "--exclude-standard", "--deduplicate"])
            .output()
            .map_err(|error| format!("git cannot be run: {error}; is it on the PATH?"))?;
        if !listed.status.success() {
            return Err("git lists no files: the defects need a checkout".to_owned());
        }
        let listed = String::from_utf8_lossy(&listed.stdout).into_owned();
        let names = listed.split('\0').filter(|name| !name.is_empty() && root.join(name).is_file());
        let wanted: BTreeSet<&Path> = names.map(Path::new).collect();
        for path in files(&self.folder, Path::new("")) {
            if !wanted.contains(path.as_path()) {
                std::fs::remove_file(self.folder.join(&path)).map_err(|error| fault(&path, &error))?;
            }
        }
        for path in wanted {
            let bytes = std::fs::read(root.join(path)).map_err(|error| fault(path, &error))?;
            let to = self.folder.join(path);
            if std::fs::read(&to).is_ok_and(|there| there == bytes) {
                continue;
            }
            std::fs::create_dir_all(to.parent().unwrap_or(&self.folder)).map_err(|error| fault(path, &error))?;
            // A copy keeps whether a file may be run.
            std::fs::copy(root.join(path), &to).map_err(|error| fault(path, &error))?;
        }
        Ok(())
    }
}

fn fault(path: &Path, error: &std::io::Error) -> String {
    format!("{}: {error}", path.display())
}

/// Returns the files below a folder, by their paths from it.
fn files(folder: &Path, below: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder.join(below)).into_iter().flatten().flatten() {
        let path = below.join(entry.file_name());
        if entry.file_type().is_ok_and(|kind| kind.is_dir()) {
            found.extend(files(folder, &path));
        } else {
            found.push(path);
        }
    }
    found
}

/// Cargo in the copy.
struct Tests<'a> {
    tree: &'a Tree,
    adapter: String,
    seed: u64,
}

impl Tests<'_> {
    /// Plants a defect, runs its tests, and takes it out again.
    fn fate(&self, defect: &Defect) -> Result<Fate, Failure> {
        let path = self.tree.folder.join(&defect.file);
        let text = std::fs::read_to_string(&path).map_err(|error| Failure(format!("{}: {error}", defect.file)))?;
        let planted = defect.planted(&text).map_err(Failure)?;
        let write = |text: &str| std::fs::write(&path, text).map_err(|error| fault(&path, &error));
        write(&planted).map_err(Failure)?;
        let fate = self.build(&defect.test).and_then(|builds| {
            Ok(match builds {
                false => Fate::DoesNotCompile,
                true if self.pass(&defect.test)? => Fate::Missed,
                true => Fate::Caught,
            })
        });
        write(&text).map_err(Failure)?;
        fate
    }

    /// Whether the tests compile.
    fn build(&self, test: &str) -> Result<bool, Failure> {
        Ok(self.cargo(&["--no-run", "--quiet"], test)?.0)
    }

    /// Whether the tests pass, at least one of them; they have been built.
    fn pass(&self, test: &str) -> Result<bool, Failure> {
        let (is_success, said) = self.cargo(&["--quiet"], test)?;
        let ran = said.lines().filter_map(|line| line.strip_prefix("test result: ok. ")?.split(' ').next());
        let ran: usize = ran.filter_map(|count| count.parse::<usize>().ok()).sum();
        if is_success && ran == 0 {
            return Err(Failure(format!("cargo test {test}: no test has this name; mend {LIST}")));
        }
        Ok(is_success)
    }

    /// Runs `cargo test`, and returns whether it succeeded, and what it said on stdout.
    fn cargo(&self, options: &[&str], test: &str) -> Result<(bool, String), Failure> {
        let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        command.arg("test").args(options).args(test.split(' ')).current_dir(&self.tree.folder);
        // What is named is run, also if it is marked as long.
        command.args(["--", "--include-ignored"]);
        command.env("CARGO_TARGET_DIR", &self.tree.target).env(ADAPTER_VARIABLE, &self.adapter);
        command.env(repository::VARIABLE, &self.tree.folder);
        command.env(SEED_VARIABLE, self.seed.to_string()).stdin(Stdio::null()).stderr(Stdio::null());
        let output = command.output();
        let output = output.map_err(|error| Failure(format!("cargo cannot be run: {error}; is it on the PATH?")))?;
        Ok((output.status.success(), String::from_utf8_lossy(&output.stdout).into_owned()))
    }
}
