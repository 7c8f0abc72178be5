//! What accuracy costs in time: `./cook cost` and `./cook builtins`.

use clap::{Parser, Subcommand};
use lapidary_cook::command::{Common, run};
use lapidary_ladders::{builtins, command};
use std::process::ExitCode;

/// What accuracy costs in time: `./cook cost` and `./cook builtins`.
#[derive(Parser)]
#[command(
    name = "cook",
    bin_name = "cook",
    version,
    arg_required_else_help = true,
    after_help = "Example: ./cook cost gem"
)]
struct Arguments {
    #[command(flatten)]
    common: Common,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Cost(command::Arguments),
    Builtins(builtins::command::Arguments),
}

fn main() -> ExitCode {
    run(|Arguments { common, command }| {
        let context = common.context();
        match command {
            Command::Cost(arguments) => command::run(&context, &arguments),
            Command::Builtins(arguments) => builtins::command::run(&context, &arguments),
        }
    })
}
