//! `cook test`.

use crate::defects;
use lapidary_cook::command::{Context, Failure, Outcome};
use lapidary_cookbook::repository;
use lapidary_gpu::ADAPTER_VARIABLE;
use lapidary_testing::seed::{SEED_VARIABLE, SuiteSeed};
use std::process::Command;

/// Runs the whole test suite or a part of it, in the same build that `cook` itself runs from.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  ./cook test\n  ./cook test --quick\n  ./cook test hard_cases\n  ./cook test parity --quick --show\n  ./cook test --defects wgsl/fresnel"
)]
pub struct Arguments {
    /// Run only the tests whose names contain this text.
    filter: Option<String>,
    /// Skip the mutation tests and the slowest of the others: takes about a minute.
    #[arg(long)]
    quick: bool,
    /// Test everything instead of samples: every picture as displayed, beyond its linear radiance,
    /// and every rung.
    #[arg(long, conflicts_with = "quick")]
    whole: bool,
    /// Judge every mutant, not only those of modules that changed since the record.
    #[arg(long, conflicts_with = "quick")]
    all_mutants: bool,
    /// Update the files generated from the modules: releases and version lines, signatures,
    /// README's table, docs/check.md. With --all-mutants: only judge the mutants, and record the
    /// score.
    #[arg(long, conflicts_with_all = ["filter", "quick"])]
    refresh: bool,
    /// Plant the defects of harness/xtask/defects.txt one by one, in a copy of the working tree, and
    /// expect a test to fail of each; FILTER chooses by their words, files, tests or numbers.
    #[arg(long, conflicts_with_all = ["quick", "whole", "all_mutants", "refresh", "show"])]
    defects: bool,
    /// Also show what the tests measure.
    #[arg(long)]
    show: bool,
}

/// Tests that a quick run skips: those whose names contain one of these.
const SLOW: [&str; 40] = [
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
    "releases::an_old",
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
const REFRESHING: [(&str, &str); 4] = [
    ("LAPIDARY_REFRESH_RELEASE", "1"),
    ("LAPIDARY_REFRESH_PAGES", "1"),
    ("INSTA_UPDATE", "always"),
    ("INSTA_FORCE_PASS", "1"),
];
/// Tests that can write.
const GENERATED: [&str; 5] =
    ["engines::the_shaders", "host::the_pages", "releases::", "text::", "user_file::the_page_shows"];

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
    // Mutation tests run last and separately, because cargo stops at the first target that fails.
    let parts: [&[&str]; 2] = [
        &["--workspace", "--lib", "--bins", "--test", "suite", "--test", "wgsl", "--test", "fuzz"],
        &["--package", "lapidary-cook", "--test", "mutation"],
    ];
    let refreshing: [&[&str]; 1] = [&["--package", "lapidary-cook", "--test", "suite"]];
    let parts = match arguments {
        Arguments { refresh: true, all_mutants: true, .. } => &parts[1..],
        Arguments { refresh: true, .. } => &refreshing[..],
        Arguments { quick: true, .. } => &parts[..1],
        _ => &parts[..],
    };
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut outcome = Outcome::Passed;
    for part in parts {
        let mut command = Command::new(&cargo);
        command.arg("test").args(*part).arg("--manifest-path");
        command.arg(root.join("Cargo.toml"));
        command.env(ADAPTER_VARIABLE, context.adapter.to_string());
        // The same seed for all parts, even if the tree changes meanwhile.
        command.env(SEED_VARIABLE, seed.value.to_string());
        if arguments.whole {
            command.env("LAPIDARY_WHOLE", "1");
        }
        if arguments.all_mutants {
            command.env("LAPIDARY_MUTANTS", if arguments.refresh { "record" } else { "all" });
        }
        command.arg("--").args(&arguments.filter);
        if arguments.refresh && !arguments.all_mutants {
            command.envs(REFRESHING).args(GENERATED);
        }
        if is_short {
            command.args(SLOW.iter().flat_map(|name| ["--skip", name]));
        }
        if arguments.show {
            command.arg("--nocapture");
        }
        let status = command.status();
        let status = status.map_err(|error| Failure(format!("cargo cannot be run: {error}; is it on the PATH?")))?;
        if !status.success() {
            outcome = Outcome::Failed;
        }
    }
    Ok(outcome)
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
