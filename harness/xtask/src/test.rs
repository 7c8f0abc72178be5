//! `cook test`.

use crate::defects;
use crate::executables::{self, Count};
use lapidary_cook::command::{Context, Failure, Outcome};
use lapidary_cookbook::{Module, modules, repository};
use lapidary_gpu::ADAPTER_VARIABLE;
use lapidary_testing::WHOLE_VARIABLE;
use lapidary_testing::seed::{SEED_VARIABLE, SuiteSeed};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Runs the whole test suite or a part of it, in the same build that `cook` itself runs from.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  ./cook test\n  ./cook test --quick\n  ./cook test hard_cases\n  ./cook test parity --quick --show\n  ./cook test --defects wgsl/fresnel"
)]
pub struct Arguments {
    /// Run only the tests whose names contain this text; those marked as long if there are no others.
    filter: Option<String>,
    /// Skip the mutation tests and the slowest of the others: takes about two minutes.
    #[arg(long)]
    quick: bool,
    /// Test everything: no samples, every picture as displayed beyond its linear radiance, every rung, and the
    /// tests that are marked as long.
    #[arg(long, conflicts_with = "quick")]
    whole: bool,
    /// Judge every mutant, not only those of modules that changed since the record.
    #[arg(long, conflicts_with = "quick")]
    all_mutants: bool,
    /// Update what is generated: signatures, the tables in docs/modules.md, choosing.md and drivers.md,
    /// the list of pictures, docs/check.md, the recipes' pages, the shaders of the WebGPU example. With
    /// --all-mutants: only judge the mutants, and record the score.
    #[arg(long, conflicts_with_all = ["filter", "quick"])]
    refresh: bool,
    /// Run also what has not changed since it passed.
    #[arg(long)]
    again: bool,
    /// Write a table of each test's seconds; runs also what has not changed.
    #[arg(long, value_name = "FILE", conflicts_with = "refresh")]
    times: Option<PathBuf>,
    /// Plant the defects of harness/xtask/defects.txt one by one, in a copy of the working tree, and
    /// expect a test to fail of each; FILTER chooses by their words, files, tests or numbers.
    #[arg(long, conflicts_with_all = ["quick", "whole", "all_mutants", "refresh", "show"])]
    defects: bool,
    /// Also show what the tests measure.
    #[arg(long)]
    show: bool,
}

/// Cargo's names of the test programs. All name the workspace: a package by itself would be built with other features.
const TARGETS: [&str; 9] = ["--workspace", "--lib", "--bins", "--test", "suite", "--test", "wgsl", "--test", "fuzz"];
/// Those that can write what is generated.
const REFRESHED: [&str; 4] = ["--workspace", "--bins", "--test", "suite"];
/// The mutation tests, which run last: they take long, and a test that fails says more.
const MUTATION: [&str; 3] = ["--workspace", "--test", "mutation"];

/// Tests that a quick run skips: those whose names contain one of these.
const SLOW: [&str; 39] = [
    "allowance::",
    "antialiasing::",
    "atlas::",
    "cdrf_shading::",
    "chromium::",
    "cost::",
    "curvature::meshes",
    "deferred::",
    "dispatch::random",
    "effects_off::",
    "footprint::",
    "formulas::every",
    "furnace::",
    "gallery_live::",
    "gallery_pages::",
    "gallery_rows::",
    "gem::",
    "languages::",
    "optical_path::",
    "optical_path_shading::",
    "parity::",
    "plan::an_effect",
    "plan::every_subset",
    "plan::what_is_drawn",
    "random_walk::",
    "reference::",
    "restraint::",
    "rewrites::",
    "seams::",
    "shadows::",
    "slack::",
    "snapshots::",
    "specialise::",
    "texture_diffusion::",
    "user_file::every",
    "user_file::odd",
    "vitrine::",
    "voxelization::",
    "walked_references::",
];

/// Variables that make tests write instead of compare.
const REFRESHING: [(&str, &str); 3] =
    [("LAPIDARY_REFRESH_PAGES", "1"), ("INSTA_UPDATE", "always"), ("INSTA_FORCE_PASS", "1")];
/// Tests that can write.
const GENERATED: [&str; 5] =
    ["engines::the_shaders", "host::the_pages", "structure::the_projects", "text::", "user_file::the_page_shows"];

/// Runs the command.
///
/// # Errors
/// Returns one line for the user: what is wrong, where, and what to do.
pub fn run(context: &Context, arguments: &Arguments) -> Result<Outcome, Failure> {
    let root = repository::required("test")?;
    // Reports a missing device at once, before minutes of building.
    context.gpu()?;
    let seed = SuiteSeed::of_environment().map_err(Failure)?;
    eprintln!("seed {}, {}; again with {SEED_VARIABLE}={}", seed.value, seed.origin, seed.value);
    if arguments.defects {
        return defects::run(context, arguments.filter.as_deref(), seed.value);
    }
    // Tests that are named explicitly are always run.
    let is_short = arguments.quick && arguments.filter.is_none();
    if is_short {
        eprintln!("left out: mutants, and the tests named {}", SLOW.join(", "));
    }
    let filter: Vec<&str> = arguments.filter.iter().map(String::as_str).collect();
    let mut environment =
        vec![(ADAPTER_VARIABLE, context.adapter.to_string()), (SEED_VARIABLE, seed.value.to_string())];
    if arguments.whole {
        environment.push((WHOLE_VARIABLE, "1".to_owned()));
    }
    let mut outcome = Outcome::Passed;
    if !(arguments.refresh && arguments.all_mutants) {
        let mut options = filter.clone();
        if arguments.refresh {
            environment.extend(REFRESHING.map(|(name, value)| (name, value.to_owned())));
            options.extend(GENERATED);
        }
        if is_short {
            options.extend(SLOW.iter().flat_map(|name| ["--skip", name]));
        }
        if arguments.whole {
            // What CI's weekly run has a stage for stays out.
            options.extend(["--include-ignored", "--skip", "loader_survives"]);
        }
        if arguments.show {
            options.push("--nocapture");
        }
        let targets: &[&str] = if arguments.refresh { &REFRESHED } else { &TARGETS };
        let (mut passed, count) = suite(&root, arguments, targets, &options, &environment)?;
        match (arguments.filter.as_deref(), count) {
            (Some(name), Count { ran: 0, long: 0 }) if !has_mutants(name) => {
                return Err(Failure(format!("no test, module or function has `{name}` in its name")));
            }
            (Some(name), Count { ran: 0, long: 1.. }) => {
                eprintln!("all tests with `{name}` in their names are marked as long: they are run");
                options.push("--ignored");
                (passed, _) = suite(&root, arguments, targets, &options, &environment)?;
            }
            (Some(name), Count { long: long @ 1.., .. }) => {
                eprintln!("{long} more with `{name}` in their names are marked as long: --whole runs them too");
            }
            _ => {}
        }
        if !passed {
            outcome = Outcome::Failed;
        }
    }
    if !is_short && (arguments.all_mutants || !arguments.refresh) && outcome == Outcome::Passed {
        if arguments.all_mutants {
            let asked = if arguments.refresh { "record" } else { "all" };
            environment.push(("LAPIDARY_MUTANTS", asked.to_owned()));
        }
        for mutation in executables::built(&root, &MUTATION)? {
            if !mutation.run_plainly(&filter, &environment)? {
                outcome = Outcome::Failed;
            }
        }
    }
    Ok(outcome)
}

/// Whether the mutation tests take a name: that of a module or function, or their own.
fn has_mutants(name: &str) -> bool {
    let has =
        |module: &Module| module.functions.iter().any(|it| format!("{}::{}", module.name, it.name).contains(name));
    name == "mutation" || modules().iter().any(has)
}

/// Number of test programs that run at a time: many tests wait for a browser, a device or another program.
const AT_A_TIME: usize = 2;

/// Runs the test programs, and says in the end which failed and which were left out. What passes is remembered with a hash
/// of all that it depends on, and is left out until that changes. Returns whether all passed, and how many ran.
fn suite(
    root: &Path,
    arguments: &Arguments,
    targets: &[&str],
    options: &[&str],
    environment: &[(&'static str, String)],
) -> Result<(bool, Count), Failure> {
    let remembered = root.join("target/lapidary/passed");
    // The commit's seed changes with each commit, and with it alone nothing is run again; one that was asked for counts.
    let set: Vec<_> = environment.iter().filter(|(name, _)| *name != SEED_VARIABLE).collect();
    let given: Vec<_> = std::env::vars().filter(|(name, _)| name.starts_with("LAPIDARY_")).collect();
    // A part of the suite that passed leaves what is known of the whole.
    let asked = executables::hash_of(&(options, set, given));
    // A refresh writes files that other tests read; a few tests are watched, and are run as often as they are asked for.
    let is_watched = arguments.refresh || arguments.show || arguments.filter.is_some();
    let may_skip = !arguments.again && !is_watched && arguments.times.is_none();
    let (mut waiting, mut unchanged) = (Vec::new(), Vec::new());
    let built = executables::built(root, targets)?;
    let files = executables::Files::of(root)?;
    for executable in built {
        let file = remembered.join(format!("{}-{asked:016x}", executable.name.replace(' ', "_")));
        // Without git nothing tells a changed file.
        let hash = files.as_ref().map(|files| executable.hash(files).to_string());
        if may_skip && hash.is_some() && std::fs::read_to_string(&file).ok() == hash {
            unchanged.push(executable.name);
        } else {
            waiting.push((executable, file, hash));
        }
    }
    let workers = if is_watched { 1 } else { AT_A_TIME };
    let (waiting, done) = (Mutex::new(waiting.into_iter()), Mutex::new(Vec::new()));
    let work = || -> Result<(), Failure> {
        loop {
            let next = waiting.lock().unwrap_or_else(PoisonError::into_inner).next();
            let Some((executable, file, hash)) = next else { return Ok(()) };
            eprintln!("{} ...", executable.name);
            let ran = executable.run(options, environment, workers == 1)?;
            if let (true, Some(hash)) = (ran.passed, hash) {
                std::fs::create_dir_all(&remembered)?;
                std::fs::write(file, hash)?;
            }
            done.lock().unwrap_or_else(PoisonError::into_inner).push((executable.name, ran));
        }
    };
    std::thread::scope(|scope| {
        let workers: Vec<_> = (0..workers).map(|_| scope.spawn(work)).collect();
        workers
            .into_iter()
            .try_for_each(|worker| worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
    })?;
    let done = done.into_inner().unwrap_or_else(PoisonError::into_inner);
    if let Some(file) = &arguments.times {
        let seconds = done
            .iter()
            .flat_map(|(name, ran)| ran.seconds.iter().map(|(test, seconds)| (*seconds, name.clone(), test.clone())));
        lapidary_files::replace(file, table(seconds.collect()).as_bytes())?;
    }
    if !unchanged.is_empty() {
        eprintln!("unchanged since they passed, and not run again: {} (--again runs them)", unchanged.join(", "));
    }
    let failed: Vec<&str> = done.iter().filter(|(_, ran)| !ran.passed).map(|(name, _)| name.as_str()).collect();
    if !failed.is_empty() {
        eprintln!("failed: {}", failed.join(", "));
    }
    let mut count = Count::default();
    done.iter().for_each(|(_, ran)| count += ran.count);
    Ok((failed.is_empty(), count))
}

/// Returns the seconds of each test as a table, the longest first; those below a tenth of a second are added up.
fn table(mut seconds: Vec<(f64, String, String)>) -> String {
    seconds.sort_by(|one, other| other.0.total_cmp(&one.0));
    let total: f64 = seconds.iter().map(|(seconds, ..)| seconds).sum();
    let mut text = format!(
        "Seconds of each test, as ./cook test --times wrote them: {} tests, {total:.0} s added up, {AT_A_TIME} programs at a time on {} threads each.\n\n",
        seconds.len(),
        std::thread::available_parallelism().map_or(1, usize::from)
    );
    let (long, short): (Vec<_>, Vec<_>) = seconds.into_iter().partition(|(seconds, ..)| *seconds >= 0.1);
    for (seconds, executable, test) in &long {
        text.push_str(&format!("{seconds:>8.1}  {executable:<18} {test}\n"));
    }
    let rest: f64 = short.iter().map(|(seconds, ..)| seconds).sum();
    text.push_str(&format!("{rest:>8.1}  {} others\n", short.len()));
    text
}

#[cfg(test)]
mod tests {
    use super::SLOW;
    use std::path::{Path, PathBuf};

    /// Collects every Rust file below a folder.
    fn files(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            let path = entry.path();
            if path.is_dir() {
                files(&path, found);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                found.push(path);
            }
        }
    }

    /// An entry that matches no test would skip nothing, and go unnoticed.
    #[test]
    fn what_a_quick_run_leaves_out_is_there() {
        let mut found = Vec::new();
        files(&Path::new(env!("CARGO_MANIFEST_DIR")).join(".."), &mut found);
        for word in SLOW {
            let (module, start) = word.split_once("::").expect("a module");
            let is_it = |path: &&PathBuf| {
                let names =
                    path.iter().rev().take(2).map(|name| name.to_string_lossy().trim_end_matches(".rs").to_owned());
                names.into_iter().any(|name| name == module)
            };
            let holds = |path: &PathBuf| {
                let text = std::fs::read_to_string(path).unwrap_or_default();
                text.contains("#[test]") && text.contains(&format!("fn {start}"))
            };
            assert!(found.iter().filter(is_it).any(holds), "no test's name holds `{word}`");
        }
    }
}
