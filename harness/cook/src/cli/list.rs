//! `cook list`.

use super::{Failure, Outcome, output};
use lapidary_plan::ladder::Step;
use lapidary_plan::{Quality, Rung, Technique};
use lapidary_scene::{BUILT_IN, BuiltIn, PRESETS, Preset};
use lapidary_take::list;
use serde::Serialize;

/// Lists modules and functions, signature and stated accuracy of each; or scenes, materials or rungs.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  ./cook list --json\n  ./cook list --materials",
    group = clap::ArgGroup::new("what").args(["scenes", "materials", "rungs", "markdown"])
)]
pub(super) struct Arguments {
    /// The built-in scenes.
    #[arg(long)]
    scenes: bool,
    /// The materials of `--material`.
    #[arg(long)]
    materials: bool,
    /// The rungs of `--rung`, each with its mean error where a ladder is committed.
    #[arg(long)]
    rungs: bool,
    /// Print one JSON document on stdout, and nothing else.
    #[arg(long)]
    json: bool,
    /// Print the modules as the table of docs/modules.md.
    #[arg(long, conflicts_with = "json")]
    markdown: bool,
}

#[derive(Serialize)]
struct Named {
    name: &'static str,
    description: String,
}

/// A rung on the ladder of a technique.
#[derive(Serialize)]
struct RungRow {
    technique: &'static str,
    rung: String,
    /// Qualities that choose it.
    qualities: Vec<&'static str>,
    /// Mean over the ladder's views, and milliseconds of its record's adapter.
    error: Option<f64>,
    error_measure: Option<&'static str>,
    ms: Option<f64>,
}

/// Returns the rungs of each technique's ladder, in its order; those of techniques without one after them.
fn rung_rows() -> Vec<RungRow> {
    let mut rows = Vec::new();
    for technique in Technique::ALL {
        let chosen = |rung: &str| {
            let qualities = Quality::ALL.into_iter().filter(|quality| technique.rung(*quality).to_string() == rung);
            qualities.map(Quality::name).collect::<Vec<_>>()
        };
        let ladder = technique.ladder();
        // By diffusion on request: the ladder is that of light through a body.
        let rungs = |one: &Technique| Some(one.ladder()?.steps.iter().map(|step| &step.rung).collect::<Vec<_>>());
        let mut before = Technique::ALL.iter().take_while(|other| **other != technique);
        if ladder.is_some() && before.any(|other| rungs(other) == rungs(&technique)) {
            continue;
        }
        // A record also holds forms that are no rungs, for comparison.
        let is_rung = |step: &&Step| step.rung.parse::<Rung>().is_ok();
        for step in ladder.iter().flat_map(|ladder| &ladder.steps).filter(is_rung) {
            rows.push(RungRow {
                technique: technique.name(),
                qualities: chosen(&step.rung),
                rung: step.rung.clone(),
                error: Some(step.error),
                error_measure: ladder.map(|ladder| ladder.measure),
                ms: Some(step.ms),
            });
        }
        if ladder.is_none() {
            let rung = technique.rung(Quality::Good).to_string();
            let qualities = chosen(&rung);
            rows.push(RungRow {
                technique: technique.name(),
                rung,
                qualities,
                error: None,
                error_measure: None,
                ms: None,
            });
        }
    }
    rows
}

/// Prints names with what they stand for, a line each.
fn named(rows: Vec<Named>, json: bool) -> Result<Outcome, Failure> {
    if json {
        output::line(&serde_json::to_string_pretty(&rows)?)?;
        return Ok(Outcome::Passed);
    }
    let width = rows.iter().map(|row| row.name.len()).max().unwrap_or_default();
    for Named { name, description } in rows {
        output::line(&format!("{name:width$}  {description}"))?;
    }
    Ok(Outcome::Passed)
}

fn rungs(json: bool) -> Result<Outcome, Failure> {
    let rows = rung_rows();
    if json {
        output::line(&serde_json::to_string_pretty(&rows)?)?;
        return Ok(Outcome::Passed);
    }
    let mut technique = "";
    for row in rows {
        if row.technique != technique {
            let measure =
                row.error_measure.map_or(String::new(), |measure| format!(": {measure}, then ms on lavapipe"));
            output::line(&format!("{}{measure}", row.technique))?;
            technique = row.technique;
        }
        let figures = row.error.zip(row.ms).map_or(String::new(), |(error, ms)| format!("{error:8.4}{ms:9.1}"));
        let chosen = if row.qualities.is_empty() { String::new() } else { format!("  {}", row.qualities.join(", ")) };
        output::line(format!("  {:22}{figures}{chosen}", row.rung).trim_end())?;
    }
    Ok(Outcome::Passed)
}

pub(super) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    if arguments.scenes {
        let row = |scene: BuiltIn| Named { name: scene.name, description: scene.description.to_owned() };
        return named(BUILT_IN.map(row).into(), arguments.json);
    }
    if arguments.materials {
        let row = |preset: Preset| Named { name: preset.name, description: preset.description.to_owned() };
        return named(PRESETS.map(row).into(), arguments.json);
    }
    if arguments.rungs {
        return rungs(arguments.json);
    }
    list::shaders(arguments.json, arguments.markdown)
}
