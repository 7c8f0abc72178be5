//! `cook completions`.

use super::{Failure, Outcome, output};

/// Prints a script with which a shell completes commands and options, and values where an option has few.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  cook completions bash > ~/.local/share/bash-completion/completions/cook\n  cook completions fish > ~/.config/fish/completions/cook.fish"
)]
pub(super) struct Arguments {
    /// The shell.
    #[arg(value_enum)]
    shell: clap_complete::Shell,
}

pub(super) fn run(arguments: &Arguments, mut program: clap::Command) -> Result<Outcome, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut program, "cook", &mut script);
    output::bytes(&script)?;
    Ok(Outcome::Passed)
}
