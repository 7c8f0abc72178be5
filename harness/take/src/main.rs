//! `cook copy` and the shaders of `cook list`, for one who builds nothing else.

use clap::{Parser, Subcommand};
use lapidary_take::{copy, list};
use std::process::ExitCode;

/// A shader cookbook for gems: copy the WGSL, test its formulas, look at the pictures.
#[derive(Parser)]
#[command(name = "cook", bin_name = "cook", version, arg_required_else_help = true)]
struct Arguments {
    /// GPU to use: lavapipe, any, or part of an adapter's name; LAPIDARY_ADAPTER by default.
    #[arg(long, global = true, value_name = "NAME")]
    adapter: Option<String>,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Copy(copy::Arguments),
    /// Lists modules and functions, signature and stated accuracy of each.
    List {
        /// Print one JSON document on stdout, and nothing else.
        #[arg(long)]
        json: bool,
        /// Print the modules as the table of docs/modules.md.
        #[arg(long, conflicts_with = "json")]
        markdown: bool,
    },
}

fn main() -> ExitCode {
    lapidary_command::run(|Arguments { command, .. }| match command {
        Command::Copy(arguments) => copy::run(&arguments),
        Command::List { json, markdown } => list::shaders(json, markdown),
    })
}
