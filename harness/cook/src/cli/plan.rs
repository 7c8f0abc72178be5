//! `cook plan`.

use super::asked::Asked;
use super::{Failure, Outcome, output};
use lapidary_plan::Decision;
use lapidary_plan::quality::Chosen;
use lapidary_render::plan::{Kind, Pipeline, Plan, PlannedObject, Resource, Step};
use serde::Serialize;
use std::collections::BTreeMap;

/// Shows which effects a scene calls for and why, and the resulting passes, pipelines and
/// resources. Needs no GPU.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  ./cook plan vitrine\n  ./cook plan wax --with cdrf\n  ./cook plan ruby --quality best\n  ./cook plan my_stone.glb --without dispersion --json"
)]
pub(super) struct Arguments {
    #[command(flatten)]
    asked: Asked,
    /// Print one JSON document on stdout, and nothing else.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Document<'a> {
    scene: &'a str,
    objects: Vec<ObjectRow<'a>>,
    effects: Vec<EffectRow<'a>>,
    passes: Vec<PassRow<'a>>,
    pipelines: Vec<PipelineRow<'a>>,
    resources: Vec<ResourceRow<'a>>,
    /// The document that `cook frame` writes to `frame.json`.
    frame: lapidary_render::frame::Document,
    notes: Vec<String>,
    lacking: &'a [String],
}

#[derive(Serialize)]
struct ObjectRow<'a> {
    object: &'a str,
    material: &'a str,
    rung: String,
    reason: &'a str,
    /// `None` if the user or the material names the rung.
    quality: Option<&'static str>,
    /// From the committed ladder: mean error over the views, then the worst view and the error
    /// measure.
    error: Option<f64>,
    worst_error: Option<f64>,
    error_measure: Option<&'static str>,
    times_fast: Option<f64>,
}

#[derive(Serialize)]
struct EffectRow<'a> {
    object: &'a str,
    material: &'a str,
    effect: &'static str,
    on: bool,
    reason: &'a str,
}

#[derive(Serialize)]
struct PassRow<'a> {
    name: &'a str,
    pipeline: &'a str,
    object: Option<&'a str>,
    material: Option<&'a str>,
    resources: &'a [String],
    times: u32,
}

#[derive(Serialize)]
struct PipelineRow<'a> {
    name: &'a str,
    recipe: &'a str,
    entries: &'a [String],
    overrides: BTreeMap<&'a str, f64>,
    instructions: usize,
}

#[derive(Serialize)]
struct ResourceRow<'a> {
    name: &'a str,
    object: Option<&'a str>,
    kind: &'static str,
    bytes: u64,
}

impl<'a> Document<'a> {
    fn of(plan: &'a Plan) -> Self {
        let object = |planned: &'a PlannedObject| {
            let chosen = planned.decisions.chosen;
            let measured = chosen.and_then(Chosen::measured);
            ObjectRow {
                object: &planned.object,
                material: &planned.material,
                rung: planned.decisions.rung.to_string(),
                reason: &planned.decisions.reason,
                quality: chosen.map(|chosen| chosen.quality.name()),
                error: measured.map(|measured| measured.error),
                worst_error: measured.map(|measured| measured.worst),
                error_measure: measured.map(|measured| measured.measure),
                times_fast: measured.map(|measured| measured.times_fast),
            }
        };
        let effects = plan.objects.iter().flat_map(|planned| {
            planned.decisions.effects.iter().map(|Decision { effect, on, reason }| EffectRow {
                object: &planned.object,
                material: &planned.material,
                effect: effect.name(),
                on: *on,
                reason,
            })
        });
        let pass = |step: &'a Step| PassRow {
            name: &step.pass,
            pipeline: &step.pipeline,
            object: Some(step.object.as_str()).filter(|object| !object.is_empty()),
            material: plan.material_of(&step.object),
            resources: &step.resources,
            times: step.times,
        };
        let pipeline = |pipeline: &'a Pipeline| PipelineRow {
            name: &pipeline.name,
            recipe: &pipeline.recipe,
            entries: &pipeline.entries,
            overrides: pipeline.overrides.iter().map(|(name, value)| (name.as_str(), *value)).collect(),
            instructions: pipeline.instructions,
        };
        let resource = |Resource { name, object, kind, bytes }: &'a Resource| ResourceRow {
            name,
            object: Some(object.as_str()).filter(|object| !object.is_empty()),
            kind: match kind {
                Kind::Buffer => "buffer",
                Kind::Texture => "texture",
                Kind::Sampler => "sampler",
            },
            bytes: *bytes,
        };
        Self {
            scene: &plan.scene,
            objects: plan.objects.iter().map(object).collect(),
            effects: effects.collect(),
            passes: plan.listing.steps.iter().map(pass).collect(),
            pipelines: plan.listing.pipelines.iter().map(pipeline).collect(),
            resources: plan.listing.resources.iter().map(resource).collect(),
            frame: plan.frame.document(),
            notes: plan.notes.iter().map(ToString::to_string).collect(),
            lacking: &plan.lacking,
        }
    }
}

pub(super) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let opened = arguments.asked.open_with_hints()?;
    let (settings, more) = arguments.asked.settings(&opened)?;
    let mut plan = Plan::of(&opened.scene, &settings)?;
    plan.notes.splice(..0, opened.notes.into_iter().chain(more));
    if arguments.json {
        output::line(&serde_json::to_string_pretty(&Document::of(&plan))?)?;
    } else {
        output::line(plan.to_string().trim_end())?;
    }
    Ok(Outcome::Passed)
}
