//! The commands of `cook`, a file for each.

mod asked;
mod check;
mod compare;
mod completions;
mod corpus;
mod drawn;
mod environment;
mod frame;
mod list;
mod opened;
mod opening;
mod plan;
mod render;
mod scene;

use clap::{CommandFactory as _, Parser, Subcommand};
use lapidary_cook::command::{self, Common, Context, Failure, Outcome, browser, named, number, output, progress};
use lapidary_take::copy;
use std::process::ExitCode;

/// A shader cookbook for gems: copy the WGSL, test its formulas, look at the pictures.
#[derive(Parser)]
#[command(
    name = "cook",
    bin_name = "cook",
    version,
    arg_required_else_help = true,
    after_help = "Example: cook render brilliant"
)]
struct Arguments {
    #[command(flatten)]
    common: Common,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Check(check::Arguments),
    List(list::Arguments),
    Copy(copy::Arguments),
    Plan(plan::Arguments),
    Frame(frame::Arguments),
    Render(render::Arguments),
    Scene(scene::Arguments),
    Compare(compare::Arguments),
    Corpus(corpus::Arguments),
    Completions(completions::Arguments),
}

/// Runs the command line.
pub(crate) fn run() -> ExitCode {
    command::run(|Arguments { common, command }| {
        let context = common.context();
        match command {
            Command::Check(arguments) => check::run(&context, &arguments),
            Command::List(arguments) => list::run(&arguments),
            Command::Copy(arguments) => copy::run(&arguments),
            Command::Plan(arguments) => plan::run(&arguments),
            Command::Frame(arguments) => frame::run(&context, &arguments),
            Command::Render(arguments) => render::run(&context, &arguments),
            Command::Scene(arguments) => scene::run(&arguments),
            Command::Compare(arguments) => compare::run(&arguments),
            Command::Corpus(arguments) => corpus::run(&context, &arguments),
            Command::Completions(arguments) => completions::run(&arguments, Arguments::command()),
        }
    })
}
