//! What the command lines with a device share, beyond what all do: the device, a browser, progress.

pub mod browser;
pub mod progress;

pub use lapidary_command::{Failure, Outcome, named, number, output};

use lapidary_gpu::{AdapterChoice, Gpu};
use std::process::ExitCode;

/// Options that every command takes.
#[derive(Clone, Debug, clap::Args)]
pub struct Common {
    /// GPU to use: lavapipe, any, or part of an adapter's name; LAPIDARY_ADAPTER by default.
    #[arg(long, global = true, value_name = "NAME")]
    pub adapter: Option<AdapterChoice>,
}

/// State shared by all commands.
#[derive(Debug)]
pub struct Context {
    /// The device that was chosen.
    pub adapter: AdapterChoice,
}

impl Context {
    /// Returns the device of the process, opened on first use.
    ///
    /// # Errors
    /// Returns an error if there is no such device.
    pub fn gpu(&self) -> Result<&'static Gpu, Failure> {
        Ok(Gpu::shared(&self.adapter)?)
    }
}

impl Common {
    /// Returns the state of a command.
    #[must_use]
    pub fn context(self) -> Context {
        Context { adapter: self.adapter.unwrap_or_else(AdapterChoice::from_environment) }
    }
}

/// Parses the command line, runs the command, closes the browser and reports errors.
pub fn run<A: clap::Parser>(act: impl FnOnce(A) -> Result<Outcome, Failure>) -> ExitCode {
    lapidary_command::run(|arguments| {
        let outcome = act(arguments);
        browser::close();
        outcome
    })
}
