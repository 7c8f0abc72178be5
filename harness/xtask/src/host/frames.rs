//! What frames do with recipes, and whether the formulas of sizes hold there.

use super::error::HostError;
use super::recipe::Description;
use super::sizes::{self, Quantities, Rule};
use lapidary_plan::{Outside, Rung};
use lapidary_render::frame::{Bound, Frame, Pass, PipelineId, PipelineKind, Resource, ResourceKind, Workgroups};
use lapidary_render::plan::Plan;
use lapidary_render::{GemOptions, Settings};
use lapidary_scene::{Object, Scene};
use std::collections::{HashMap, HashSet};

/// A frame whose sizes are looked at.
pub(super) struct Example {
    /// The command that writes it.
    pub(super) command: &'static str,
    scene: &'static str,
    rung: &'static str,
    gem: fn(GemOptions) -> GemOptions,
    /// Whether its passes are listed.
    is_listed: bool,
}

const fn of(command: &'static str, scene: &'static str, rung: &'static str) -> Example {
    Example { command, scene, rung, gem: |gem| gem, is_listed: true }
}

/// A frame for other sizes alone.
const fn other(command: &'static str, scene: &'static str, rung: &'static str) -> Example {
    Example { is_listed: false, ..of(command, scene, rung) }
}

/// Frames that between them run every recipe that frames run, each of those with a grid at several sizes.
pub(super) const EXAMPLES: [Example; 20] = [
    of("brilliant", "brilliant", "by-material"),
    other("brilliant --rung convex-8+tracker", "brilliant", "convex-8+tracker"),
    other("brilliant --rung proxy-1", "brilliant", "proxy-1"),
    other("bunny_stone", "bunny_stone", "by-material"),
    other("pave_ring", "pave_ring", "by-material"),
    Example {
        command: "brilliant --rung convex-8 --deferred",
        scene: "brilliant",
        rung: "convex-8",
        gem: |gem| GemOptions { deferred: true, ..gem },
        is_listed: true,
    },
    Example {
        command: "brilliant --samples 1",
        scene: "brilliant",
        rung: "walk-8+tracker",
        gem: |gem| GemOptions { footprint: true, ..gem },
        is_listed: true,
    },
    Example {
        command: "tray --outside screen",
        scene: "tray",
        rung: "by-material",
        gem: |gem| GemOptions { outside: Some(Outside::Screen), ..gem },
        is_listed: true,
    },
    of("solitaire", "solitaire", "by-material"),
    other("tray --rung scene-16+3", "tray", "scene-16+3"),
    other("skin", "skin", "by-material"),
    of("skin_bunny --rung blur", "skin_bunny", "blur"),
    of("bunny --rung ping-pong-26-32", "bunny", "ping-pong-26-32"),
    other("dragon --rung ping-pong-26-64", "dragon", "ping-pong-26-64"),
    other("bunny --rung tiled-26-32", "bunny", "tiled-26-32"),
    of("dragon --rung godunov-64", "dragon", "godunov-64"),
    other("dragon --rung godunov-128", "dragon", "godunov-128"),
    of("bunny --rung diffusion-64", "bunny", "diffusion-64"),
    other("dragon --rung diffusion-128", "dragon", "diffusion-128"),
    other("vitrine", "vitrine", "by-material"),
];

/// What a pass of a frame does with a recipe.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Use {
    pub(super) recipe: String,
    /// The first frame that does it.
    pub(super) example: &'static str,
    pub(super) pass: String,
    pub(super) entries: Vec<String>,
    /// Vertices or workgroups, as a formula.
    pub(super) count: String,
    /// Formats, depth, culling and blending; empty for a dispatch.
    pub(super) state: String,
}

/// A step of a frame, in order.
pub(super) struct Step {
    pub(super) pass: String,
    pub(super) recipe: String,
    pub(super) entries: String,
    pub(super) count: String,
    pub(super) times: u32,
}

/// A frame's command, and its steps.
pub(super) type Listed = (&'static str, Vec<Step>);

/// Returns what the frames do with the recipes, and the steps of those that are listed.
pub(super) fn all(described: &[Description]) -> Result<(Vec<Use>, Vec<Listed>), HostError> {
    let mut uses: Vec<Use> = Vec::new();
    let mut frames = Vec::new();
    for example in &EXAMPLES {
        let scene = Scene::named(example.scene)?;
        let unfit = |message| HostError::Example { command: example.command, message };
        let rung: Rung = example.rung.parse().map_err(unfit)?;
        let base = Settings::of_size(256, 256);
        let settings = Settings { rung, gem: (example.gem)(base.gem), ..base };
        let plan = Plan::of(&scene, &settings)?;
        let objects = objects(&scene, &plan);
        let is_diffused = |resource: &&Resource| resource.name.ends_with("/conductances");
        let diffused = plan.frame.resources.iter().filter(is_diffused).map(|resource| &*resource.object).collect();
        let reader = Reader { example: example.command, frame: &plan.frame, objects, diffused, described };
        let mut steps: Vec<Step> = Vec::new();
        for pass in &plan.frame.passes {
            reader.pass(pass, &mut uses, &mut steps)?;
        }
        if example.is_listed {
            frames.push((example.command, steps));
        }
    }
    Ok((uses, frames))
}

/// Numbers of each object, by name.
fn objects(scene: &Scene, plan: &Plan) -> HashMap<String, Quantities> {
    let quantities_of = |object: &Object, rung: Rung| {
        let shape = object.shape();
        let n = match rung {
            Rung::OpticalPath(paths) => paths.cells,
            Rung::Diffusion(diffusion) => diffusion.cells,
            _ => 0,
        };
        Quantities {
            vertices: shape.positions.len() as u64,
            triangles: shape.triangle_count() as u64,
            halo: (shape.halo.len() / 3) as u64,
            n: n.into(),
            ..Quantities::default()
        }
    };
    let planned = scene.objects.iter().zip(&plan.objects);
    planned.map(|(object, planned)| (planned.object.clone(), quantities_of(object, planned.decisions.rung))).collect()
}

/// Adds a step that clears or copies, to one of its kind if that came just before.
fn add_data_step(steps: &mut Vec<Step>, pass: &str, what: impl AsRef<str>) {
    match steps.last_mut().filter(|last| last.pass == pass) {
        Some(last) => last.entries = format!("{}, {}", last.entries, what.as_ref()),
        None => steps.push(Step {
            pass: pass.to_owned(),
            recipe: String::new(),
            entries: what.as_ref().to_owned(),
            count: String::new(),
            times: 1,
        }),
    }
}

struct Reader<'a> {
    example: &'static str,
    frame: &'a Frame,
    objects: HashMap<String, Quantities>,
    /// Objects through which light diffuses.
    diffused: HashSet<&'a str>,
    described: &'a [Description],
}

impl Reader<'_> {
    fn pass(&self, pass: &Pass, uses: &mut Vec<Use>, steps: &mut Vec<Step>) -> Result<(), HostError> {
        let mut add = |name: &str, pipeline: PipelineId, count: String, state: String, times: u32| {
            let shader = &self.frame.pipeline(pipeline).shader;
            let step = Use {
                recipe: shader.recipe().to_owned(),
                example: self.example,
                pass: name.to_owned(),
                entries: shader.entries().to_vec(),
                count,
                state,
            };
            let entries = step.entries.join(", ");
            let is_same =
                |last: &&mut Step| last.pass == step.pass && last.entries == entries && last.count == step.count;
            if steps.last_mut().as_ref().is_none_or(|last| !is_same(last)) {
                let (recipe, count) = (step.recipe.clone(), step.count.clone());
                steps.push(Step { pass: step.pass.clone(), recipe, entries, count, times });
            }
            let is_known = |known: &Use| Use { example: step.example, ..known.clone() } == step;
            if !uses.iter().any(is_known) {
                uses.push(step);
            }
        };
        match pass {
            Pass::Render(render) => {
                for draw in &render.draws {
                    let bound = self.bound(draw.pipeline, &draw.groups)?;
                    let count = self.vertices(draw.pipeline, draw.vertices, &bound)?;
                    add(&render.name, draw.pipeline, count, self.state(draw.pipeline), 1);
                }
            }
            Pass::Compute(compute) => {
                for dispatch in &compute.dispatches {
                    let bound = self.bound(dispatch.pipeline, &dispatch.groups)?;
                    let count = self.workgroups(dispatch.pipeline, &dispatch.workgroups, &bound)?;
                    add(&compute.name, dispatch.pipeline, count, String::new(), compute.repeat);
                }
            }
            Pass::Clear { buffer, .. } => add_data_step(steps, "clear", self.own_name(*buffer)),
            Pass::Copy { from, to, .. } => {
                add_data_step(steps, "copy", format!("{} to {}", self.own_name(*from), self.own_name(*to)));
            }
            Pass::Read(_) => {}
        }
        Ok(())
    }

    /// Returns a buffer's name without its object's.
    fn own_name(&self, buffer: lapidary_render::frame::Buffer) -> &str {
        let name = self.frame.name(buffer);
        name.split_once('/').map_or(name, |(_, rest)| rest)
    }

    fn fault(&self, pipeline: PipelineId, what: &str, message: String) -> HostError {
        let recipe = self.frame.pipeline(pipeline).shader.recipe().to_owned();
        HostError::Size { recipe, what: what.to_owned(), frame: self.example, message }
    }

    /// Checks what is bound against the formulas, and returns the numbers that dispatches depend on.
    fn bound(
        &self,
        pipeline: PipelineId,
        groups: &[Option<lapidary_render::frame::BindGroupId>],
    ) -> Result<Quantities, HostError> {
        let recipe = self.frame.pipeline(pipeline).shader.recipe();
        let described = self.described.iter().find(|described| described.name == recipe);
        let mut all = Quantities::default();
        for group in groups.iter().flatten() {
            let group = self.frame.bind_group(*group);
            for (binding, bound) in &group.entries {
                let row = described.and_then(|described| {
                    described.bindings.iter().find(|row| (row.group, row.binding) == (group.group, *binding))
                });
                let Some(row) = row else {
                    let what = format!("group {} binding {binding}", group.group);
                    return Err(self.fault(pipeline, &what, "the recipe declares no such binding".to_owned()));
                };
                let resource = self.frame.resource(*bound);
                let numbers = self.numbers(recipe, &row.name, resource);
                if let Bound::Buffer(_) = bound {
                    self.check(pipeline, row, resource, &numbers)?;
                }
                if let ("maps", ResourceKind::Texture { size, .. }) = (&*row.name, &resource.kind) {
                    (all.texels, all.views) = (size[0].into(), size[2].into());
                }
                if numbers.vertices > 0 {
                    (all.vertices, all.triangles, all.halo) = (numbers.vertices, numbers.triangles, numbers.halo);
                }
                // The grid of what a dispatch lists or fills; a coarser level's own bindings come in group 1.
                if all.n == 0 || numbers.n > 0 && row.name == "tiles" && group.group == 0 {
                    all.n = numbers.n;
                }
            }
        }
        Ok(all)
    }

    /// Returns the numbers that a resource's size depends on.
    fn numbers(&self, recipe: &str, binding: &str, resource: &Resource) -> Quantities {
        let mut numbers = self.objects.get(&resource.object).copied().unwrap_or_default();
        let level = resource.name.rsplit_once("level ").and_then(|(_, level)| level.parse::<u32>().ok());
        numbers.n >>= level.unwrap_or_default();
        if binding.starts_with("coarser_") {
            numbers.n *= 2;
        }
        // Diffusion counts eighths of its cells.
        if recipe == "voxelize" && self.diffused.contains(resource.object.as_str()) {
            numbers.n *= 2;
        }
        numbers
    }

    fn check(
        &self,
        pipeline: PipelineId,
        row: &super::recipe::Row,
        resource: &Resource,
        numbers: &Quantities,
    ) -> Result<(), HostError> {
        let fault = |message: String| self.fault(pipeline, &row.name, message);
        let (found, Some(bytes)) = (resource.bytes(), row.bytes.map(u64::from)) else { return Ok(()) };
        // A buffer may be up to 15 bytes longer.
        let fits = |expected: u64| (expected..expected + 16).contains(&found);
        if !row.is_open {
            return if fits(bytes) { Ok(()) } else { Err(fault(format!("{found} bytes instead of {bytes}"))) };
        }
        match sizes::rule(self.frame.pipeline(pipeline).shader.recipe(), &row.name) {
            Some(Rule::Bytes(_, value)) if fits(value(numbers)) => Ok(()),
            Some(Rule::Bytes(text, value)) => {
                Err(fault(format!("{found} bytes, and {text} is {} for {numbers:?}", value(numbers))))
            }
            Some(Rule::Each(_)) if found % bytes == 0 && found > 0 => Ok(()),
            Some(Rule::Each(_)) => Err(fault(format!("{found} bytes are no elements of {bytes}"))),
            Some(Rule::Texture(_)) | None => Err(fault("its size has no formula".to_owned())),
        }
    }

    fn vertices(&self, pipeline: PipelineId, vertices: u32, bound: &Quantities) -> Result<String, HostError> {
        let vertices = u64::from(vertices);
        if vertices == 3 && bound.triangles != 1 {
            return Ok("3: one triangle over the target".to_owned());
        }
        if vertices == 3 * bound.triangles {
            return Ok("3 × triangles".to_owned());
        }
        if vertices == 3 * (bound.triangles + bound.halo) {
            return Ok("3 × (triangles + halo)".to_owned());
        }
        let message = format!("{vertices} vertices for {bound:?}");
        Err(self.fault(pipeline, "draw", message))
    }

    fn workgroups(
        &self,
        pipeline: PipelineId,
        workgroups: &Workgroups,
        bound: &Quantities,
    ) -> Result<String, HostError> {
        let entry = &self.frame.pipeline(pipeline).shader.entries()[0];
        let Workgroups::Count(found) = workgroups else { return Ok("indirect".to_owned()) };
        let Some((text, value)) = sizes::workgroups(entry) else {
            return Err(self.fault(pipeline, entry, "its workgroups have no formula".to_owned()));
        };
        let expected = value(bound);
        if found.map(u64::from) == expected {
            return Ok(text.to_owned());
        }
        Err(self.fault(pipeline, entry, format!("workgroups {found:?}, and {text} is {expected:?} for {bound:?}")))
    }

    /// Returns formats, depth, culling and blending of a pipeline that draws.
    fn state(&self, pipeline: PipelineId) -> String {
        let PipelineKind::Render { targets, depth, cull, blend } = &self.frame.pipeline(pipeline).kind else {
            return String::new();
        };
        let formats: Vec<String> = targets.iter().map(|format| format!("{format:?}").to_lowercase()).collect();
        let mut parts = vec![format!("to {}", formats.join(" and "))];
        parts.push(depth.map_or_else(
            || "no depth".to_owned(),
            |depth| format!("{}, tested `less` and written", format!("{depth:?}").to_lowercase()),
        ));
        parts.push(match cull {
            Some(wgpu::Face::Back) => "back faces culled".to_owned(),
            Some(wgpu::Face::Front) => "front faces culled".to_owned(),
            None => "no culling".to_owned(),
        });
        if let Some(blend) = blend {
            let word = |operation: wgpu::BlendOperation| format!("{operation:?}").to_lowercase();
            parts.push(format!("blended: colour {}, alpha {}, factors one", word(blend.color), word(blend.alpha)));
        }
        parts.join(", ")
    }
}
