//! The commands. Each returns an [`Outcome`] or a [`Failure`]; this file turns those into exit
//! codes: 0 for success, 1 for a check that failed, 2 for bad usage or bad input, with one clear
//! line on stderr.

mod asked;
mod browser;
mod builtins;
mod check;
mod compare;
mod completions;
mod copy;
mod cost;
mod dist;
mod drawn;
mod frame;
mod gallery;
mod list;
mod named;
mod new;
mod number;
mod output;
mod plan;
mod progress;
mod render;
mod scene;
mod snapshots;
mod test;

use clap::error::ErrorKind;
use clap::{Parser, Subcommand};
use lapidary_gpu::{AdapterChoice, Gpu};
use std::process::ExitCode;

/// Whether the checks passed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// All checks passed.
    Passed,
    /// A check ran and failed.
    Failed,
}

/// One clear line: the problem, where it is, and what to do.
#[derive(Debug)]
pub(crate) struct Failure(pub(crate) String);

impl<E: std::error::Error> From<E> for Failure {
    fn from(error: E) -> Self {
        Self(error.to_string())
    }
}

/// A shader cookbook for gems: copy the WGSL, test its formulas, look at the pictures.
#[derive(Parser)]
#[command(name = "cook", version, arg_required_else_help = true, after_help = "Example: ./cook gallery --open")]
struct Arguments {
    /// GPU to use: lavapipe, any, or part of an adapter's name; LAPIDARY_ADAPTER by default.
    #[arg(long, global = true, value_name = "NAME")]
    adapter: Option<AdapterChoice>,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Gallery(gallery::Arguments),
    Test(test::Arguments),
    Check(check::Arguments),
    Builtins(builtins::Arguments),
    List(list::Arguments),
    New(new::Arguments),
    Copy(copy::Arguments),
    Dist(dist::Arguments),
    Cost(cost::Arguments),
    Plan(plan::Arguments),
    Frame(frame::Arguments),
    Render(render::Arguments),
    Scene(scene::Arguments),
    Snapshots(snapshots::Arguments),
    Compare(compare::Arguments),
    Completions(completions::Arguments),
}

/// State shared by all commands.
pub(crate) struct Context {
    adapter: AdapterChoice,
}

impl Context {
    /// Returns the device of the process, opened on first use.
    pub(crate) fn gpu(&self) -> Result<&'static Gpu, Failure> {
        Ok(Gpu::shared(&self.adapter)?)
    }
}

/// Returns clap's message as one line, without the usage, which `--help` prints.
fn one_line(message: &str) -> String {
    let message = message.strip_prefix("error: ").unwrap_or(message);
    let parts = message.lines().map(str::trim).take_while(|line| !line.starts_with("Usage: "));
    let parts = parts.filter(|line| !line.is_empty() && !line.starts_with("For more information"));
    let mut line = String::new();
    for part in parts {
        let part = part.trim_matches(['[', ']']);
        let joint = if line.is_empty() {
            ""
        } else if line.ends_with(':') {
            " "
        } else {
            "; "
        };
        line.push_str(joint);
        line.push_str(part.strip_prefix("tip: ").unwrap_or(part));
    }
    line
}

/// Parses the command line, runs the command and reports errors.
pub(crate) fn run() -> ExitCode {
    let arguments = match Arguments::try_parse_from(number::joined(std::env::args_os())) {
        Ok(arguments) => arguments,
        Err(error) if error.use_stderr() && error.kind() != ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => {
            eprintln!("cook: {}", one_line(&error.to_string()));
            return ExitCode::from(2);
        }
        Err(error) => {
            // Help and version are not errors; clap knows the right stream and exit code.
            let _ = error.print();
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2));
        }
    };
    let context = Context { adapter: arguments.adapter.unwrap_or_else(AdapterChoice::from_environment) };
    let outcome = match arguments.command {
        Command::Gallery(arguments) => gallery::run(&context, &arguments),
        Command::Test(arguments) => test::run(&context, &arguments),
        Command::Check(arguments) => check::run(&context, &arguments),
        Command::Builtins(arguments) => builtins::run(&context, &arguments),
        Command::List(arguments) => list::run(&arguments),
        Command::New(arguments) => new::run(&arguments),
        Command::Copy(arguments) => copy::run(&arguments),
        Command::Dist(arguments) => dist::run(&arguments),
        Command::Cost(arguments) => cost::run(&context, &arguments),
        Command::Plan(arguments) => plan::run(&arguments),
        Command::Frame(arguments) => frame::run(&context, &arguments),
        Command::Render(arguments) => render::run(&context, &arguments),
        Command::Scene(arguments) => scene::run(&arguments),
        Command::Snapshots(arguments) => snapshots::run(&context, &arguments),
        Command::Compare(arguments) => compare::run(&arguments),
        Command::Completions(arguments) => completions::run(&arguments),
    };
    browser::close();
    match outcome {
        Ok(Outcome::Passed) => ExitCode::SUCCESS,
        Ok(Outcome::Failed) => ExitCode::from(1),
        Err(Failure(message)) => {
            eprintln!("cook: {}", message.trim_end());
            ExitCode::from(2)
        }
    }
}
