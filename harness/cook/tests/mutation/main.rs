//! Changes every operator, comparison and constant of every module's functions, one at a time. The
//! property tests of the module must notice each change.
//!
//! Mutants run in child processes (this same program, as a worker), two at a time. A mutant that
//! gives no answer in time is judged once more, in a fresh worker and for longer. If it still
//! gives none, it has timed out, which does not count as caught: it fails. A mutant that no input
//! can tell from the original is listed, with the reason, in `equivalent.txt`; at most 5 % may be.
//!
//! A run judges the mutants that a change touches: all mutants of each module that has changed
//! since the record (`docs/measurements/lavapipe/mutation.json`, which holds a hash of everything
//! that a score depends on), and all mutants of all modules if the engine or the device has
//! changed. It reports the mutants that it does not judge. A run that names a module or function
//! judges all of its mutants. `LAPIDARY_MUTANTS=all` judges all mutants, `record` judges all and
//! writes the record, `sample` judges one in ten by the suite's seed, and `listed` judges the
//! listed ones.

mod record;

use lapidary_assay::formula::Formula;
use lapidary_assay::mutate::{self, Judge, Mutant, Mutants};
use lapidary_assay::slack::Reassociation;
use lapidary_cook::check::{self, On};
use lapidary_cook::formulas;
use lapidary_cookbook as cookbook;
use lapidary_gpu::{AdapterChoice, Gpu};
use lapidary_testing::seed::SuiteSeed;
use record::Record;
use std::collections::{BTreeMap, BTreeSet};
use std::io::{BufRead as _, BufReader, Write as _};
use std::process::{Child, ChildStdin, Command, ExitCode, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Mutex, OnceLock};
use std::time::{Duration, Instant};

/// Time limits for an answer: the first time, with a margin for a machine under load, and the
/// second time.
const LIMITS: [Duration; 2] = [Duration::from_secs(20), Duration::from_secs(120)];
/// Environment variable that selects the judged mutants.
const MUTANTS_VARIABLE: &str = "LAPIDARY_MUTANTS";
/// Beginning of a reason that holds for this device alone.
const ANOTHER_DEVICE: &str = "Another device tells";
/// One mutant in this many is in a sample.
const SAMPLE: u64 = 10;
/// Time limit for the start of a worker and its device. It does not count against a mutant.
const START_LIMIT: Duration = Duration::from_secs(120);
/// Number of worker processes.
const WORKERS: usize = 2;
/// Largest share of mutants that may be listed as equivalent.
const MOST_EQUIVALENT: f64 = 0.05;
/// Argument that makes this program a worker.
const WORKER: &str = "--worker";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if arguments.first().is_some_and(|argument| argument == WORKER) {
        worker();
        return ExitCode::SUCCESS;
    }
    if arguments.iter().any(|argument| argument == "--list") {
        println!("mutation: test");
        return ExitCode::SUCCESS;
    }
    // As in libtest, a name is a filter, here for a module or function.
    let filter = arguments.iter().find(|argument| !argument.starts_with('-')).cloned().unwrap_or_default();
    let filter = if filter == "mutation" { "" } else { &filter };
    let seed = SuiteSeed::of_environment().unwrap_or_else(|error| panic!("{error}"));
    let asked = std::env::var(MUTANTS_VARIABLE).ok();
    let choice = match asked.as_deref() {
        Some("all" | "record") => Choice::Same(Share::All),
        Some("listed") => Choice::Same(Share::Listed),
        Some("sample") => Choice::Same(Share::Sample(seed.value)),
        None if filter.is_empty() => Choice::Touched,
        None => Choice::Same(Share::All),
        Some(other) => panic!("{MUTANTS_VARIABLE}={other}: expected all, record, listed or sample"),
    };
    println!("seed {}, {}", seed.value, seed.origin);
    coordinate(filter, choice, asked.as_deref() == Some("record"))
}

/// Selection of the judged mutants.
#[derive(Clone, Copy)]
enum Choice {
    /// The same share of every module's mutants.
    Same(Share),
    /// All mutants of everything that has changed since the record.
    Touched,
}

/// Share of a module's mutants that is judged.
#[derive(Clone, Copy)]
enum Share {
    All,
    /// The mutants that are listed as equivalent.
    Listed,
    /// One in ten, chosen by this seed.
    Sample(u64),
    /// No mutants: this many are as recorded.
    Recorded(usize),
}

impl Choice {
    fn of_module(self, module: &str, now: &Record, then: &Record) -> Share {
        match self {
            Self::Same(share) => share,
            Self::Touched if !now.is_of_the_engine_of(then) || !now.agrees(then, module) => Share::All,
            Self::Touched => Share::Recorded(then.modules.get(module).map_or(0, |module| module.mutants)),
        }
    }
}

impl Share {
    fn holds(self, name: &str) -> bool {
        match self {
            Self::All => true,
            Self::Listed => equivalent_mutants().contains_key(name),
            Self::Sample(seed) => in_sample(seed, name),
            Self::Recorded(_) => false,
        }
    }
}

/// Returns whether a mutant is in the sample of a seed.
fn in_sample(seed: u64, name: &str) -> bool {
    // FNV-1a: the same on every machine and in every version of Rust.
    let hash = name.bytes().fold(0xcbf2_9ce4_8422_2325 ^ seed, |hash: u64, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    });
    // The low bits of the product depend on the low bits of the bytes alone.
    (hash ^ (hash >> 32)).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 32 < (1 << 32) / SAMPLE
}

/// Number of the unchanged function, in place of a mutant's. It must survive.
const UNCHANGED: usize = usize::MAX;
/// A worker's message once it has its device.
const READY: &str = "ready";

/// Returns a function's mutants. They are the same in the coordinator and the workers.
fn mutants_of(formula: &Formula) -> Mutants {
    let module = cookbook::module(formula.module).expect("a formula's module exists");
    mutate::of_function(module.whole, module.name, formula.function).expect("the cookbook's WGSL is valid")
}

fn coordinate(filter: &str, choice: Choice, is_recorded: bool) -> ExitCode {
    let start = Instant::now();
    let gpu = Gpu::shared(&AdapterChoice::from_environment()).unwrap_or_else(|error| panic!("{error}"));
    let modules: Vec<&str> = cookbook::modules().iter().map(|module| module.name).collect();
    let listed = listed_by_module(&modules);
    let mut now = Record::of_sources(gpu, &modules, &listed);
    let then = Record::committed();
    let shares: BTreeMap<&str, Share> =
        modules.iter().map(|module| (*module, choice.of_module(module, &now, &then))).collect();
    let mut jobs: Vec<(usize, usize, String)> = Vec::new();
    let mut constants = Vec::new();
    let mut invalid = 0;
    for (index, formula) in formulas::all().iter().enumerate() {
        let mutants = mutants_of(formula);
        invalid += mutants.invalid;
        for (position, mutant) in mutants.valid.iter().enumerate() {
            let name = mutant.to_string();
            // A const appears again with every function that uses it. All of them judge it at its
            // first appearance.
            let constant = mutant.owner != formula.function;
            if (constant && constants.contains(&name)) || !format!("{}::{name}", formula.module).contains(filter) {
                continue;
            }
            if constant {
                constants.push(name.clone());
            }
            if let Some(module) = now.modules.get_mut(formula.module) {
                module.mutants += 1;
                module.listed += usize::from(equivalent_mutants().contains_key(&name));
            }
            if shares[formula.module].holds(&name) {
                jobs.push((index, position, name));
            }
        }
    }
    let total = jobs.len();
    let judged: BTreeSet<String> = jobs.iter().map(|(.., name)| name.clone()).collect();
    for (module, share) in shares.iter().filter(|_| matches!(choice, Choice::Touched)) {
        match share {
            Share::Recorded(mutants) => {
                println!("{module}: none: {mutants} as recorded, nothing that they depend on has changed");
            }
            _ => println!("{module}: all"),
        }
    }
    if total == 0 && !filter.is_empty() {
        // The filter is for other tests.
        println!("\ntest result: ok. 0 passed; 0 failed; 0 ignored; 0 measured; 1 filtered out\n");
        return ExitCode::SUCCESS;
    }
    // The unchanged functions go first: if one is caught, the harness is at fault and no score
    // means anything.
    let concerned: BTreeSet<usize> = jobs.iter().map(|(formula, ..)| *formula).collect();
    let controls = concerned.iter().map(|index| (*index, UNCHANGED, formulas::all()[*index].function.to_owned()));
    let mut jobs: Vec<(usize, usize, String)> = controls.chain(jobs).collect();
    jobs.reverse();
    let queue = Mutex::new(jobs);
    let survived = Mutex::new(Vec::new());
    let timed_out = Mutex::new(Vec::new());
    let broken = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..WORKERS {
            scope.spawn(|| {
                let mut worker = None;
                loop {
                    let job = queue.lock().expect("no thread panics").pop();
                    let Some((formula, position, name)) = job else { break };
                    match judge(&mut worker, formula, position) {
                        Verdict::Survived if position == UNCHANGED => {}
                        _ if position == UNCHANGED => broken.lock().expect("no thread panics").push(name),
                        Verdict::Caught => {}
                        Verdict::Survived => survived.lock().expect("no thread panics").push(name),
                        Verdict::TimedOut => timed_out.lock().expect("no thread panics").push(name),
                    }
                }
            });
        }
    });
    let survived = survived.into_inner().expect("no thread panics");
    let timed_out = timed_out.into_inner().expect("no thread panics");
    let broken = broken.into_inner().expect("no thread panics");
    for name in &broken {
        println!("BROKEN: the unchanged `{name}` does not pass its own tests in a worker");
    }
    println!("{invalid} changes make no valid program and are no mutants");
    if let Choice::Same(Share::Sample(seed)) = choice {
        println!("a sample of one in {SAMPLE} by seed {seed}; all of them with {MUTANTS_VARIABLE}=all");
    }
    let whole = filter.is_empty() && matches!(choice, Choice::Same(Share::All));
    let passed = report(whole, &judged, total, &survived, &timed_out, start.elapsed()) && broken.is_empty();
    if passed && whole && is_recorded {
        now.write();
    }
    println!(
        "\ntest result: {}. {} passed; {} failed; 0 ignored; 0 measured; 0 filtered out\n",
        if passed { "ok" } else { "FAILED" },
        u8::from(passed),
        u8::from(!passed)
    );
    if passed { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn report(
    whole: bool,
    judged: &BTreeSet<String>,
    total: usize,
    survived: &[String],
    timed_out: &[String],
    took: Duration,
) -> bool {
    let listed = equivalent_mutants();
    let (equivalent, missed): (Vec<&String>, Vec<&String>) =
        survived.iter().partition(|name| listed.contains_key(*name));
    // A listed mutant that is not judged here may well survive. A listed name that is no longer a
    // mutant is found by a whole run.
    let stale: Vec<&String> =
        listed.keys().filter(|name| (whole || judged.contains(*name)) && !survived.contains(name)).collect();
    for name in timed_out {
        println!("TIMED OUT, neither caught nor survived: {name}");
    }
    for name in &missed {
        println!("SURVIVED: {name}");
    }
    for name in &stale {
        println!("STALE: listed as equivalent, but caught or gone: {name}");
    }
    let caught = total - survived.len() - timed_out.len();
    let elsewhere = equivalent.iter().filter(|name| listed[**name].starts_with(ANOTHER_DEVICE)).count();
    let share = equivalent.len() as f64 / total.max(1) as f64;
    println!(
        "mutation score: {caught} of {total} mutants caught ({:.1} %), {} equivalent and listed ({:.1} %, of all at most 5 %; {elsewhere} of them only on this device), {} survived, {} timed out, {:.0} s",
        100.0 * caught as f64 / total.max(1) as f64,
        equivalent.len(),
        100.0 * share,
        missed.len(),
        timed_out.len(),
        took.as_secs_f64()
    );
    missed.is_empty() && stale.is_empty() && timed_out.is_empty() && (!whole || share <= MOST_EQUIVALENT)
}

/// Returns the lines of each module's listed mutants, with their reasons.
fn listed_by_module<'a>(modules: &[&'a str]) -> BTreeMap<&'a str, String> {
    let mut texts: BTreeMap<&str, String> = BTreeMap::new();
    for (name, reason) in equivalent_mutants() {
        // A function's name begins with its module's name, a const's name with the same in
        // capitals. If two modules fit, the longer name counts.
        let lower = name.to_lowercase();
        let fits = modules.iter().filter(|module| lower.starts_with(&format!("{module}_")));
        let module = fits.max_by_key(|module| module.len()).unwrap_or_else(|| panic!("`{name}` is of no module"));
        texts.entry(module).or_default().push_str(&format!("{name}\n{reason}\n"));
    }
    texts
}

/// Returns the name and reason of each listed mutant.
fn equivalent_mutants() -> &'static BTreeMap<String, String> {
    static LISTED: OnceLock<BTreeMap<String, String>> = OnceLock::new();
    LISTED.get_or_init(|| parsed(include_str!("equivalent.txt")))
}

fn parsed(text: &str) -> BTreeMap<String, String> {
    let mut listed = BTreeMap::new();
    let mut reason = String::new();
    let mut continues = false;
    for line in text.lines().map(str::trim) {
        let comment = line.strip_prefix('#');
        let first = !continues;
        continues = comment.is_some();
        if line.is_empty() {
            continue;
        }
        match comment {
            // A reason stands above its mutants, on one line or several.
            Some(comment) if !first => reason = format!("{reason} {}", comment.trim()),
            Some(comment) => comment.trim().clone_into(&mut reason),
            None => {
                assert!(!reason.is_empty(), "equivalent.txt: `{line}` has no reason");
                listed.insert(line.to_owned(), reason.clone());
            }
        }
    }
    listed
}

enum Verdict {
    Caught,
    Survived,
    TimedOut,
}

/// Worker process and the lines that it answers.
struct Worker {
    child: Child,
    stdin: ChildStdin,
    answers: Receiver<String>,
}

impl Worker {
    fn spawn() -> Worker {
        let program = std::env::current_exe().expect("this program has a path");
        let mut child = Command::new(program)
            .arg(WORKER)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("a worker starts");
        let stdin = child.stdin.take().expect("piped");
        let stdout = BufReader::new(child.stdout.take().expect("piped"));
        let (sender, answers) = channel();
        std::thread::spawn(move || {
            for line in stdout.lines().map_while(Result::ok) {
                if sender.send(line).is_err() {
                    break;
                }
            }
        });
        // Without a device every mutant would seem caught.
        let ready = answers.recv_timeout(START_LIMIT);
        assert_eq!(ready.as_deref(), Ok(READY), "a worker does not start: no adapter?");
        Worker { child, stdin, answers }
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        // It may have ended by itself; either way it is gone.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn judge(worker: &mut Option<Worker>, formula: usize, position: usize) -> Verdict {
    // A worker may die because of an earlier mutant's effect on the driver. Only a death at
    // the second try counts as caught.
    for limit in LIMITS {
        let active = worker.get_or_insert_with(Worker::spawn);
        let asked = writeln!(active.stdin, "{formula} {position}").and_then(|()| active.stdin.flush());
        let answer = match asked {
            Ok(()) => active.answers.recv_timeout(limit),
            Err(_) => Err(RecvTimeoutError::Disconnected),
        };
        match answer.as_deref() {
            Ok("survived") => return Verdict::Survived,
            Ok(_) => return Verdict::Caught,
            Err(RecvTimeoutError::Timeout) => {
                *worker = None;
                if limit == LIMITS[1] {
                    return Verdict::TimedOut;
                }
            }
            Err(RecvTimeoutError::Disconnected) => *worker = None,
        }
    }
    Verdict::Caught
}

fn worker() {
    let gpu = Gpu::shared(&AdapterChoice::from_environment()).expect("an adapter");
    println!("{READY}");
    let mut kept: BTreeMap<&'static str, Judge<'static>> = BTreeMap::new();
    let mut listed: BTreeMap<usize, Vec<Mutant>> = BTreeMap::new();
    for line in std::io::stdin().lines().map_while(Result::ok) {
        let mut numbers = line.split(' ').map(|number| number.parse::<usize>().expect("the coordinator's numbers"));
        let (index, position) = (numbers.next().expect("two numbers"), numbers.next().expect("two numbers"));
        let formula = &formulas::all()[index];
        if position == UNCHANGED {
            let kept = kept.entry(formula.function).or_insert_with(|| judge_of(gpu, formula));
            println!("{}", if kept.rejects_unchanged() { "caught" } else { "survived" });
            continue;
        }
        let mutant = &listed.entry(index).or_insert_with(|| mutants_of(formula).valid)[position];
        // The function's own tests first, then those of the module's other functions, which notice
        // the mutant if they call it.
        let mut judges: Vec<&'static Formula> =
            formulas::all().iter().filter(|other| other.module == formula.module).collect();
        judges.sort_by_key(|other| other.function != formula.function);
        let caught = judges
            .into_iter()
            .any(|judge| kept.entry(judge.function).or_insert_with(|| judge_of(gpu, judge)).catches(mutant));
        println!("{}", if caught { "caught" } else { "survived" });
    }
}

/// Returns the tests of a formula, kept for all mutants that they judge.
fn judge_of(gpu: &'static Gpu, formula: &'static Formula) -> Judge<'static> {
    let module = cookbook::module(formula.module).expect("a formula's module exists");
    let judge = Judge::new(gpu, formula, (module.whole, module.name), check::tolerance(gpu, formula), &[]);
    let judge = judge.expect("the cookbook's WGSL is valid");
    if formula.benign.is_some() {
        judge
    } else {
        judge.and_anywhere(check::tolerance(On::Slack(Reassociation::Written), formula))
    }
}
