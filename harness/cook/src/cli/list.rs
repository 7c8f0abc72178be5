//! `cook list`.

use super::{Failure, Outcome, output};
use lapidary_assay::dispatch;
use lapidary_assay::dispatch::signature::Signature;
use lapidary_cook::cookbook;
use serde::Serialize;

/// Lists modules and functions: signature and stated accuracy of each.
#[derive(clap::Args)]
#[command(after_help = "Example: ./cook list --json")]
pub(super) struct Arguments {
    /// Print one JSON document on stdout, and nothing else.
    #[arg(long)]
    json: bool,
    /// Print the modules as the table of the README.
    #[arg(long, conflicts_with = "json")]
    markdown: bool,
}

#[derive(Serialize)]
struct Row {
    module: &'static str,
    function: String,
    signature: String,
    accuracy: String,
    summary: String,
}

pub(super) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    if arguments.markdown {
        output::line("| module | what it computes |\n|---|---|")?;
        for module in cookbook::modules() {
            let purpose = module.header.purpose.trim_end_matches('.');
            output::line(&format!("| [{0}](docs/{0}.md) | {purpose} |", module.name))?;
        }
        return Ok(Outcome::Passed);
    }
    let mut rows = Vec::new();
    for module in cookbook::modules() {
        let (ir, _) = dispatch::parse(module.whole, module.name)?;
        for function in &module.functions {
            rows.push(Row {
                module: module.name,
                signature: Signature::reflect(&ir, &function.name)?.to_string(),
                function: function.name.clone(),
                accuracy: function.accuracy.to_string(),
                summary: function.summary.clone(),
            });
        }
    }
    if arguments.json {
        output::line(&serde_json::to_string_pretty(&rows)?.to_string())?;
        return Ok(Outcome::Passed);
    }
    for module in cookbook::modules() {
        output::line(&format!("{}: {}", module.name, module.header.purpose))?;
        for row in rows.iter().filter(|row| row.module == module.name) {
            output::line(&format!("  {}\n      {}", row.signature, row.accuracy))?;
        }
    }
    for recipe in lapidary_wgsl::RECIPES {
        output::line(&format!("recipe {}: requires {}", recipe.name, recipe.requires().join(", ")))?;
    }
    Ok(Outcome::Passed)
}
