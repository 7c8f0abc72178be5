//! `cook check`.

use super::{Context, Failure, Outcome, output};
use lapidary_harness::check::{self, Row, Source};
use lapidary_harness::formula::Formula;
use lapidary_harness::property::{DEFAULT_CASES, Settings};
use std::path::PathBuf;

/// Property tests of formulas: shader, mirror and oracle compared on random inputs, the worst failure shrunk.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  ./cook check refraction\n  ./cook check fresnel::dielectric --cases 1000000\n  ./cook check refraction --wgsl my_engine/refraction.wgsl"
)]
pub(super) struct Arguments {
    /// A module, or one function of it as MODULE::FUNCTION; all where left out.
    #[arg(value_name = "MODULE[::FUNCTION]")]
    filter: Option<String>,
    /// Test this file's functions instead of the cookbook's, to the cookbook's tolerance.
    #[arg(long, value_name = "FILE")]
    wgsl: Option<PathBuf>,
    /// Random inputs a function.
    #[arg(long, default_value_t = DEFAULT_CASES, value_parser = clap::value_parser!(u64).range(1..))]
    cases: u64,
    /// Where the random inputs start; the same seed gives the same inputs.
    #[arg(long, default_value_t = Settings::default().seed)]
    seed: u64,
    /// One JSON document on stdout, and nothing else.
    #[arg(long)]
    json: bool,
}

pub(super) fn run(context: &Context, arguments: &Arguments) -> Result<Outcome, Failure> {
    let copy = match &arguments.wgsl {
        None => None,
        Some(path) => {
            let text = std::fs::read_to_string(path)
                .map_err(|error| Failure(format!("{}: cannot be read: {error}", path.display())))?;
            Some((path.display().to_string(), text))
        }
    };
    let source = copy.as_ref().map_or(Source::Cookbook, |(path, text)| Source::Copy(path, text));
    let formulas = match (&arguments.filter, source) {
        (None, Source::Copy(path, text)) => functions_of(path, text)?,
        (filter, _) => check::select(filter.as_deref())?,
    };
    let gpu = context.gpu()?;
    let settings = Settings { cases: arguments.cases, seed: arguments.seed };
    // All signatures first, so that a wrong one is said before minutes of testing.
    for formula in &formulas {
        check::kernel(gpu, formula, source)?;
    }
    let bar = super::progress::bar(formulas.len() as u64, "checking");
    let mut rows = Vec::new();
    for formula in formulas {
        bar.set_message(formula.function);
        rows.push(check::run(gpu, formula, source, settings)?);
        bar.inc(1);
    }
    bar.finish_and_clear();
    if arguments.json {
        output::line(&serde_json::to_string_pretty(&rows)?.to_string())?;
    } else {
        output::bytes(table(&rows, &gpu.describe()).as_bytes())?;
    }
    Ok(if rows.iter().all(Row::passed) { Outcome::Passed } else { Outcome::Failed })
}

/// The formulas of the functions that a user's file defines, where the user did not say which to test.
fn functions_of(path: &str, text: &str) -> Result<Vec<&'static Formula>, Failure> {
    let defined = |formula: &&Formula| {
        let definition = format!("fn {}(", formula.function);
        text.lines().any(|line| line.split("//").next().unwrap_or_default().contains(&definition))
    };
    let found: Vec<&Formula> = check::select(None)?.into_iter().filter(defined).collect();
    if found.is_empty() {
        let message = format!("{path}: defines no function of the cookbook; keep the names, or see `./cook list`");
        return Err(Failure(message));
    }
    Ok(found)
}

fn table(rows: &[Row], adapter: &str) -> String {
    use std::fmt::Write as _;
    let mut text = String::new();
    let _ = writeln!(
        text,
        "on {adapter}; forward error against the f64 oracle in ulp, and the worst error over the allowed one"
    );
    let _ = writeln!(
        text,
        "{:<44} {:>9} {:>7} {:>9} {:>10} {:>9} {:>9} {:>8} {:>7}",
        "function", "cases", "failed", "nonfinite", "max ulp", "p99", "median", "of bound", "seconds"
    );
    for row in rows {
        let _ = writeln!(
            text,
            "{:<44} {:>9} {:>7} {:>9} {:>10} {:>9} {:>9} {:>8} {:>7.2}",
            row.function,
            row.cases,
            row.failed,
            row.nonfinite,
            short(row.max_ulp),
            short(row.p99_ulp),
            short(row.median_ulp),
            short(row.worst_ratio),
            row.seconds
        );
    }
    for row in rows.iter().filter(|row| !row.passed()) {
        let _ = writeln!(text, "\nFAILED {}", row.function);
        if let Some(reason) = &row.reason {
            let _ = writeln!(text, "  {reason}");
            let _ = writeln!(text, "  worst input:  {}", row.worst_input);
        }
        if let Some(shrunk) = &row.shrunk_input {
            let _ = writeln!(text, "  shrunk input: {shrunk}");
        }
        for case in &row.broken_hard_cases {
            let _ = writeln!(text, "  hard case {case}");
        }
        for edge in &row.missed_edges {
            let _ = writeln!(text, "  the inputs never reached: {edge}; run more --cases");
        }
    }
    let failed = rows.iter().filter(|row| !row.passed()).count();
    let _ = writeln!(
        text,
        "\n{} functions hold, {failed} fail. Where `of bound` is at most 1 all is within the Accuracy line; `backward` there allows more\n\
         ulp where the input's own last place makes them. Naive forms are left out unless named; they are tested where they do well.",
        rows.len() - failed
    );
    text
}

/// Three digits, in whichever notation is shorter.
fn short(value: f64) -> String {
    if value >= f64::MAX {
        return "inf".to_owned();
    }
    if value == 0.0 || (0.01..10_000.0).contains(&value) { format!("{value:.2}") } else { format!("{value:.1e}") }
}
