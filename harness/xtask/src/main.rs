//! The project's own workshop: `./cook test`, `new`, `dist` and `snapshots`.

use clap::{Parser, Subcommand};
use lapidary_cook::command::{self, Common};
use lapidary_xtask::{dist, new, snapshots, test};
use std::process::ExitCode;

/// The project's own workshop: `./cook test`, `new`, `dist` and `snapshots`.
#[derive(Parser)]
#[command(
    name = "cook",
    bin_name = "cook",
    version,
    arg_required_else_help = true,
    after_help = "Example: ./cook test"
)]
struct Arguments {
    #[command(flatten)]
    common: Common,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Test(test::Arguments),
    New(new::Arguments),
    Dist(dist::command::Arguments),
    Snapshots(snapshots::Arguments),
}

fn main() -> ExitCode {
    command::run(|Arguments { common, command }| {
        let context = common.context();
        match command {
            Command::Test(arguments) => test::run(&context, &arguments),
            Command::New(arguments) => new::run(&arguments),
            Command::Dist(arguments) => dist::command::run(&arguments),
            Command::Snapshots(arguments) => snapshots::run(&context, &arguments),
        }
    })
}
