//! What was measured once and decided: `./cook studies`, and the studies that `./cook cost` runs.

use clap::{Parser, Subcommand};
use lapidary_cook::command::{Common, run};
use lapidary_studies::command;
use std::process::ExitCode;

/// What was measured once and decided.
#[derive(Parser)]
#[command(name = "cook", version, arg_required_else_help = true, after_help = "Example: ./cook studies sphere")]
struct Arguments {
    #[command(flatten)]
    common: Common,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    #[command(alias = "cost")]
    Studies(command::Arguments),
}

fn main() -> ExitCode {
    run(|Arguments { common, command: Command::Studies(arguments) }| command::run(&common.context(), &arguments))
}
