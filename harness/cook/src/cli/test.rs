//! `cook test`.

use super::{Context, Failure, Outcome};
use lapidary_cook::seed::{SEED_VARIABLE, SuiteSeed};
use lapidary_gpu::ADAPTER_VARIABLE;
use std::path::Path;
use std::process::Command;

/// The whole test suite, or a part: the same build that `cook` itself runs from.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  ./cook test\n  ./cook test --quick\n  ./cook test hard_cases\n  ./cook test parity --quick --show"
)]
pub(super) struct Arguments {
    /// Run the tests whose names hold this.
    filter: Option<String>,
    /// Leave out the mutation tests, which take minutes.
    #[arg(long)]
    quick: bool,
    /// Judge every mutant, not the sample of one in ten that the seed chooses.
    #[arg(long, conflicts_with = "quick")]
    all_mutants: bool,
    /// Show what the tests measure, too.
    #[arg(long)]
    show: bool,
}

pub(super) fn run(context: &Context, arguments: &Arguments) -> Result<Outcome, Failure> {
    // Says at once what is missing, before minutes of building.
    context.gpu()?;
    let seed = SuiteSeed::of_environment().map_err(Failure)?;
    eprintln!("seed {}, {}; again with {SEED_VARIABLE}={}", seed.value, seed.origin, seed.value);
    // The mutation tests last and apart: cargo stops at the first target that fails.
    let parts: [&[&str]; 2] = [
        &["--workspace", "--lib", "--bins", "--test", "suite", "--test", "wgsl", "--test", "fuzz"],
        &["--package", "lapidary-cook", "--test", "mutation"],
    ];
    let parts = if arguments.quick { &parts[..1] } else { &parts[..] };
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut outcome = Outcome::Passed;
    for part in parts {
        let mut command = Command::new(&cargo);
        command.arg("test").args(*part).arg("--manifest-path");
        command.arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../Cargo.toml"));
        command.env(ADAPTER_VARIABLE, context.adapter.to_string());
        // The same for all parts, whatever changes in the tree meanwhile.
        command.env(SEED_VARIABLE, seed.value.to_string());
        if arguments.all_mutants {
            command.env("LAPIDARY_MUTANTS", "all");
        }
        command.arg("--").args(&arguments.filter);
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
