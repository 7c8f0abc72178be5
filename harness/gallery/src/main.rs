//! The site: `./cook gallery`.

use clap::{Parser, Subcommand};
use lapidary_cook::command::{Common, run};
use lapidary_gallery::command;
use std::process::ExitCode;

/// The site: `./cook gallery`.
#[derive(Parser)]
#[command(
    name = "cook",
    bin_name = "cook",
    version,
    arg_required_else_help = true,
    after_help = "Example: ./cook gallery --open"
)]
struct Arguments {
    #[command(flatten)]
    common: Common,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Gallery(command::Arguments),
}

fn main() -> ExitCode {
    run(|Arguments { common, command }| {
        let context = common.context();
        match command {
            Command::Gallery(arguments) => command::run(&context, &arguments),
        }
    })
}
