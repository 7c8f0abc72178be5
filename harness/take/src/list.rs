//! Lists of shaders.

use lapidary_assay::dispatch;
use lapidary_assay::dispatch::signature::Signature;
use lapidary_command::{Failure, Outcome, output};
use lapidary_cookbook as cookbook;
use serde::Serialize;

#[derive(Serialize)]
struct Row {
    module: &'static str,
    function: String,
    signature: String,
    accuracy: String,
    summary: String,
}

/// Lists modules and functions, with the signature and the stated accuracy of each: as text, as JSON, or as the table of
/// docs/modules.md.
///
/// # Errors
/// Returns an error if stdout cannot be written.
pub fn shaders(json: bool, markdown: bool) -> Result<Outcome, Failure> {
    if markdown {
        output::line("| module | what it computes |\n|---|---|")?;
        for module in cookbook::modules() {
            let purpose = module.header.purpose.trim_end_matches('.');
            output::line(&format!("| [{0}]({0}.md) | {purpose} |", module.name))?;
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
    if json {
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
