//! A frame summarised by name, for people and for tests that nothing exists that a scene does not
//! need.

use crate::frame::{Bound, Draw, Frame, Pass, PipelineId, ResourceKind};
use std::collections::HashMap;

/// Kind of a resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// A buffer.
    Buffer,
    /// A texture, with all its layers.
    Texture,
    /// A sampler; it has no bytes of its own.
    Sampler,
}

/// The resources of one name.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Resource {
    /// Name: `object/what` for an object's resource, `what` alone for a shared one.
    pub name: String,
    /// The object that it is made for; empty if all objects share it.
    pub object: String,
    /// Kind of the resource.
    pub kind: Kind,
    /// Size of the largest one in bytes, driver overhead excluded.
    pub bytes: u64,
}

/// A pipeline.
#[derive(Clone, Debug, PartialEq)]
pub struct Pipeline {
    /// See [`crate::frame::Pipeline::name`].
    pub name: String,
    /// Name of the recipe.
    pub recipe: String,
    /// Entry points.
    pub entries: Vec<String>,
    /// Names and values of the overrides.
    pub overrides: Vec<(String, f64)>,
    /// Group and binding numbers of the resources that it reads and writes.
    pub bindings: Vec<(u32, u32)>,
    /// Number of SPIR-V instructions.
    pub instructions: usize,
}

/// Draws or dispatches of one pipeline with the same resources in one pass. Repetitions, in a
/// solver's iterations or in another tile, are counted at the first occurrence.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Step {
    /// Name of the pass.
    pub pass: String,
    /// The object that it is for; empty if it is for all objects.
    pub object: String,
    /// The [`Pipeline::name`].
    pub pipeline: String,
    /// The [`Resource::name`]s of the bound resources and the targets.
    pub resources: Vec<String>,
    /// Number of repetitions.
    pub times: u32,
}

/// The whole listing, in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Listing {
    /// The resources, each name once.
    pub resources: Vec<Resource>,
    /// The pipelines, each different one once.
    pub pipelines: Vec<Pipeline>,
    /// The draws and dispatches.
    pub steps: Vec<Step>,
}

impl Listing {
    /// Summarises a frame.
    #[must_use]
    pub fn of(frame: &Frame) -> Self {
        let pipelines = frame.pipelines.iter().map(|pipeline| Pipeline {
            name: pipeline.name.clone(),
            recipe: pipeline.shader.recipe().to_owned(),
            entries: pipeline.shader.entries().to_vec(),
            overrides: pipeline.shader.overrides().to_vec(),
            bindings: pipeline.shader.bindings().collect(),
            instructions: pipeline.shader.instructions(),
        });
        Self { resources: resources(frame), pipelines: pipelines.collect(), steps: steps(frame) }
    }

    /// Returns the resource with this name.
    #[must_use]
    pub fn resource(&self, name: &str) -> Option<&Resource> {
        self.resources.iter().find(|resource| resource.name == name)
    }

    /// Returns the size of all resources in bytes.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.resources.iter().map(|resource| resource.bytes).sum()
    }
}

fn resources(frame: &Frame) -> Vec<Resource> {
    let mut places: HashMap<&str, usize> = HashMap::new();
    let mut resources: Vec<Resource> = Vec::new();
    for resource in &frame.resources {
        let place = *places.entry(&resource.name).or_insert(resources.len());
        match resources.get_mut(place) {
            Some(known) => known.bytes = known.bytes.max(resource.bytes()),
            None => resources.push(Resource {
                name: resource.name.clone(),
                object: resource.object.clone(),
                kind: match resource.kind {
                    ResourceKind::Buffer { .. } => Kind::Buffer,
                    ResourceKind::Texture { .. } => Kind::Texture,
                    ResourceKind::Sampler { .. } => Kind::Sampler,
                },
                bytes: resource.bytes(),
            }),
        }
    }
    resources
}

fn steps(frame: &Frame) -> Vec<Step> {
    let mut steps: Vec<Step> = Vec::new();
    let mut places: HashMap<Step, usize> = HashMap::new();
    let mut add = |step: Step, times: u32, is_drawn: bool| {
        // A solver alternates between two steps; a draw is repeated in another tile.
        let known = places.get(&step).copied().filter(|known| is_drawn || known + 2 >= steps.len());
        if let Some(known) = known {
            steps[known].times += times;
        } else {
            places.insert(step.clone(), steps.len());
            steps.push(Step { times, ..step });
        }
    };
    let step = |pass: &str, object: &str, pipeline: PipelineId, resources: Vec<String>| Step {
        pass: pass.to_owned(),
        object: object.to_owned(),
        pipeline: frame.pipeline(pipeline).name.clone(),
        resources,
        times: 0,
    };
    let bound = |groups: &[Option<crate::frame::BindGroupId>]| {
        let entries = groups.iter().flatten().flat_map(|group| &frame.bind_group(*group).entries);
        entries.map(|(_, bound)| *bound).collect::<Vec<Bound>>()
    };
    let names = |bound: Vec<Bound>| {
        let mut names: Vec<String> = Vec::new();
        for name in bound.into_iter().map(|bound| &frame.resource(bound).name) {
            if !names.contains(name) {
                names.push(name.clone());
            }
        }
        names
    };
    for pass in &frame.passes {
        match pass {
            Pass::Render(pass) => {
                let colors = pass.targets.iter().map(|target| target.texture);
                let targets = colors.chain(pass.depth.map(|depth| depth.texture)).map(Bound::from);
                for Draw { object, pipeline, groups, .. } in &pass.draws {
                    let resources = names(bound(groups).into_iter().chain(targets.clone()).collect());
                    add(step(&pass.name, object, *pipeline, resources), 1, true);
                }
            }
            Pass::Compute(pass) => {
                for dispatch in &pass.dispatches {
                    let resources = names(bound(&dispatch.groups));
                    add(step(&pass.name, &dispatch.object, dispatch.pipeline, resources), pass.repeat, false);
                }
            }
            Pass::Clear { .. } | Pass::Copy { .. } | Pass::Read(_) => {}
        }
    }
    steps
}
