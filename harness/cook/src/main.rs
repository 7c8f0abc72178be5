//! `cook`, the cookbook's command line.

mod cli;

use std::process::ExitCode;

/// Commands that the launcher `./cook` has besides, from programs that stay in the repository.
const IN_THE_REPOSITORY: [&str; 8] = ["builtins", "cost", "dist", "gallery", "new", "snapshots", "studies", "test"];

fn main() -> ExitCode {
    if let Some(command) = std::env::args().nth(1).filter(|word| IN_THE_REPOSITORY.contains(&word.as_str())) {
        lapidary_cook::command::output::remark(&format!(
            "`{command}` is a command of the cookbook's repository; clone it and run ./cook {command} there"
        ));
        return ExitCode::from(2);
    }
    cli::run()
}
