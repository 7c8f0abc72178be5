//! What every command line of the cookbook shares: outcomes, failures of one line, values of options, output.
//!
//! A command returns an [`Outcome`] or a [`Failure`]; [`run`] turns those into exit codes: 0 for success, 1 for a check
//! that failed, 2 for bad usage or bad input, with one clear line on stderr.

mod failure;
pub mod named;
pub mod number;
pub mod output;

pub use failure::{Failure, Outcome};

use clap::Parser;
use clap::error::ErrorKind;
use std::process::ExitCode;

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
pub fn run<A: Parser>(act: impl FnOnce(A) -> Result<Outcome, Failure>) -> ExitCode {
    let arguments = match A::try_parse_from(number::joined(std::env::args_os())) {
        Ok(arguments) => arguments,
        Err(error) if error.use_stderr() && error.kind() != ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => {
            output::remark(&one_line(&error.to_string()));
            return ExitCode::from(2);
        }
        Err(error) => {
            // Help and version are not errors; clap knows the right stream and exit code.
            let _ = error.print();
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2));
        }
    };
    match act(arguments) {
        Ok(Outcome::Passed) => ExitCode::SUCCESS,
        Ok(Outcome::Failed) => ExitCode::from(1),
        Err(Failure(message)) => {
            output::remark(message.trim_end());
            ExitCode::from(2)
        }
    }
}
