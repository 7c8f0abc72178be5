//! `cook builtins`.

use crate::builtins;
use lapidary_assay::dispatch::{Kernel, KernelText};
use lapidary_assay::runner::Runner;
use lapidary_browser::Adapter;
use lapidary_cook::check::in_browser::InBrowser;
use lapidary_cook::command::{Context, Failure, Outcome, browser, number, output, progress};
use std::path::PathBuf;

/// Measures the accuracy of a device's built-in functions: those of one float over all floats, the
/// others over samples.
///
/// Takes a quarter of an hour over all floats; --stride 256 takes seconds.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  ./cook builtins --stride 256\n  ./cook builtins --browser --stride 256\n  ./cook builtins --out target/builtins"
)]
pub struct Arguments {
    /// Try every N-th float.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = number::whole(1..=1_u32 << 20))]
    stride: u32,
    /// Measure Chromium's adapter instead: swiftshader (included in Chromium), or own (the adapter
    /// that it chooses by itself).
    #[arg(long, value_name = "ADAPTER", num_args = 0..=1, require_equals = true, default_missing_value = "swiftshader")]
    browser: Option<Adapter>,
    /// Folder for the table (builtins.txt) and builtins.json.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print one JSON document on stdout, and nothing else.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
///
/// # Errors
/// Returns one line for the user: what is wrong, where, and what to do.
pub fn run(context: &Context, arguments: &Arguments) -> Result<Outcome, Failure> {
    if let Some(folder) = &arguments.out {
        // Before the measurement, which takes minutes.
        std::fs::create_dir_all(folder)
            .map_err(|error| Failure(format!("{}: cannot be made: {error}", folder.display())))?;
        lapidary_files::check_writable(&folder.join("builtins.txt"))?;
    }
    let bar = progress::bar(builtins::count() as u64, "measuring");
    let tick = |name: &str| {
        bar.set_message(name.to_owned());
        bar.inc(1);
    };
    let report = match arguments.browser {
        Some(adapter) => {
            let browser = browser::started(adapter)?;
            let start = |source: &str, function: &str| -> Result<Box<dyn Runner>, _> {
                Ok(Box::new(InBrowser::new(browser, KernelText::of_function(source, function, function)?)))
            };
            builtins::measure(browser.adapter(), &start, arguments.stride, &tick)?
        }
        None => {
            let gpu = context.gpu()?;
            let start = |source: &str, function: &str| -> Result<Box<dyn Runner>, _> {
                Ok(Box::new(Kernel::of_function(gpu, source, function, function)?))
            };
            builtins::measure(&gpu.describe(), &start, arguments.stride, &tick)?
        }
    };
    bar.finish_and_clear();
    let (text, json) = (builtins::text(&report), serde_json::to_string_pretty(&report)?);
    if let Some(folder) = &arguments.out {
        lapidary_files::replace(&folder.join("builtins.txt"), text.as_bytes())?;
        lapidary_files::replace(&folder.join("builtins.json"), format!("{json}\n").as_bytes())?;
    }
    output::bytes(if arguments.json { format!("{json}\n") } else { text }.as_bytes())?;
    Ok(Outcome::Passed)
}
