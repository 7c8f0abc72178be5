//! `cook test`.

use super::{Context, Failure, Outcome};
use std::path::Path;
use std::process::Command;

/// The whole test suite, or a part: the same build that `cook` itself runs from.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  ./cook test\n  ./cook test --quick\n  ./cook test hard_cases")]
pub(super) struct Arguments {
    /// Run the tests whose names hold this.
    filter: Option<String>,
    /// Leave out the mutation tests, which take minutes.
    #[arg(long)]
    quick: bool,
}

pub(super) fn run(context: &Context, arguments: &Arguments) -> Result<Outcome, Failure> {
    // Says at once what is missing, before minutes of building.
    context.gpu()?;
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.arg("test").arg("--workspace").arg("--manifest-path");
    command.arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("../Cargo.toml"));
    if arguments.quick {
        command.args(["--lib", "--bins", "--test", "suite"]);
    }
    if let Some(filter) = &arguments.filter {
        command.arg("--").arg(filter);
    }
    let status =
        command.status().map_err(|error| Failure(format!("cargo cannot be run: {error}; is it on the PATH?")))?;
    Ok(if status.success() { Outcome::Passed } else { Outcome::Failed })
}
