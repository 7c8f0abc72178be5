//! What is made and run on the device, written down while someone listens: for `cook plan`, and for the tests that
//! what a scene does not call for does not exist.
//!
//! Only [`Device`](super::Device) makes things, and only its encoders begin passes, so nothing is left out. Each thread has a capture of its own.

use std::cell::RefCell;
use std::collections::HashMap;
use wgpu::{BindGroup, BindingResource, Buffer, ComputePipeline, RenderPipeline, Sampler, Texture};

/// What a resource is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// A buffer.
    Buffer,
    /// A texture, with all its layers.
    Texture,
    /// A sampler; it has no bytes of its own.
    Sampler,
}

/// A resource that was made.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Resource {
    /// Of an object `object/what`; what all share has no object before it.
    pub name: String,
    /// The object that it was made for; nothing for what all share.
    pub object: String,
    /// What it is.
    pub kind: Kind,
    /// Its contents' bytes, without what the driver adds.
    pub bytes: u64,
}

/// A pipeline that was compiled.
#[derive(Clone, Debug, PartialEq)]
pub struct Pipeline {
    /// Of a graphics pipeline the recipe's name, of a compute pipeline its entry point's; where there are several of one name, with `#2`, `#3` and so on.
    pub name: String,
    /// The recipe.
    pub recipe: String,
    /// Its entry points.
    pub entries: Vec<String>,
    /// The values of its overrides.
    pub overrides: Vec<(String, f64)>,
    /// Group and number of what it reads and writes.
    pub bindings: Vec<(u32, u32)>,
    /// Instructions of its SPIR-V.
    pub instructions: usize,
}

/// Draws or dispatches of one pipeline with the same resources in one pass. What comes again, in a solver's turns or drawn in
/// another tile, is counted where it came first.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Step {
    /// The pass.
    pub pass: String,
    /// The object that it is for, or nothing where it is for all.
    pub object: String,
    /// [`Pipeline::name`].
    pub pipeline: String,
    /// [`Resource::name`]s of what is bound and drawn to.
    pub resources: Vec<String>,
    /// How often.
    pub times: u32,
}

/// All of it, in the order in which it came.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Capture {
    /// Each name once; what was made again under the same name counts with its largest size.
    pub resources: Vec<Resource>,
    /// Each different one once.
    pub pipelines: Vec<Pipeline>,
    /// What was run.
    pub steps: Vec<Step>,
}

impl Capture {
    /// The resource of this name.
    #[must_use]
    pub fn resource(&self, name: &str) -> Option<&Resource> {
        self.resources.iter().find(|resource| resource.name == name)
    }

    /// The bytes of all resources.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.resources.iter().map(|resource| resource.bytes).sum()
    }
}

/// A capture that is going on.
#[derive(Default)]
struct Recorder {
    capture: Capture,
    /// The places of names among the capture's resources.
    places: HashMap<String, usize>,
    /// The places of steps among the capture's.
    steps: HashMap<Step, usize>,
    buffers: HashMap<Buffer, String>,
    textures: HashMap<Texture, String>,
    samplers: HashMap<Sampler, String>,
    render_pipelines: HashMap<RenderPipeline, String>,
    compute_pipelines: HashMap<ComputePipeline, String>,
    groups: HashMap<BindGroup, Vec<String>>,
}

thread_local! {
    static RECORDER: RefCell<Option<Recorder>> = const { RefCell::new(None) };
    static OBJECTS: RefCell<Vec<String>> = const { RefCell::new(Vec::new()) };
}

/// Runs `work` and says what this thread made and ran on the device meanwhile.
pub fn capture<T>(work: impl FnOnce() -> T) -> (T, Capture) {
    let outer = RECORDER.replace(Some(Recorder::default()));
    let result = work();
    let recorder = RECORDER.replace(outer);
    (result, recorder.map(|recorder| recorder.capture).unwrap_or_default())
}

/// While it lives, what this thread makes and runs is the named object's.
pub struct OfObject(());

impl OfObject {
    /// From now on.
    #[must_use]
    pub fn named(name: &str) -> Self {
        OBJECTS.with_borrow_mut(|objects| objects.push(name.to_owned()));
        Self(())
    }
}

impl Drop for OfObject {
    fn drop(&mut self) {
        OBJECTS.with_borrow_mut(Vec::pop);
    }
}

fn object() -> String {
    OBJECTS.with_borrow(|objects| objects.last().cloned().unwrap_or_default())
}

/// Tells the capture that is going on, if any.
fn record(tell: impl FnOnce(&mut Recorder)) {
    RECORDER.with_borrow_mut(|recorder| {
        if let Some(recorder) = recorder {
            tell(recorder);
        }
    });
}

impl Recorder {
    /// Adds a resource and gives its name back.
    fn resource(&mut self, label: Option<&str>, kind: Kind, bytes: u64) -> String {
        let what = label.unwrap_or("unnamed");
        let object = object();
        let name = if object.is_empty() { what.to_owned() } else { format!("{object}/{what}") };
        let resources = &mut self.capture.resources;
        let place = *self.places.entry(name.clone()).or_insert(resources.len());
        match resources.get_mut(place) {
            Some(known) => known.bytes = known.bytes.max(bytes),
            None => resources.push(Resource { name: name.clone(), object, kind, bytes }),
        }
        name
    }

    /// Adds a pipeline and gives its name back.
    fn pipeline(&mut self, mut pipeline: Pipeline) -> String {
        let same = |known: &&Pipeline| {
            let (entries, overrides) = (known.entries == pipeline.entries, known.overrides == pipeline.overrides);
            known.recipe == pipeline.recipe && entries && overrides && known.instructions == pipeline.instructions
        };
        if let Some(known) = self.capture.pipelines.iter().find(same) {
            return known.name.clone();
        }
        let plain = pipeline.name.clone();
        let is_taken = |name: &str| self.capture.pipelines.iter().any(|known| known.name == name);
        let numbered = (2..).map(|number| format!("{plain}#{number}"));
        let mut names = std::iter::once(plain.clone()).chain(numbered);
        pipeline.name = names.find(|name| !is_taken(name)).unwrap_or(plain);
        let name = pipeline.name.clone();
        self.capture.pipelines.push(pipeline);
        name
    }

    fn step(
        &mut self,
        pass: &str,
        pipeline: Option<String>,
        groups: &[Option<BindGroup>],
        targets: &[String],
        is_drawn: bool,
    ) {
        let mut resources: Vec<String> = Vec::new();
        let of = self.capture.pipelines.iter().find(|known| Some(&known.name) == pipeline.as_ref());
        // What an earlier pipeline bound stays where this one has no such group.
        let is_read = |group: u32| of.is_some_and(|of| of.bindings.iter().any(|(known, _)| *known == group));
        let own = (0..).zip(groups).filter(|(index, _)| is_read(*index)).filter_map(|(_, group)| group.as_ref());
        let bound = own.filter_map(|group| self.groups.get(group)).flatten();
        for name in bound.chain(targets) {
            if !resources.contains(name) {
                resources.push(name.clone());
            }
        }
        let pipeline = pipeline.unwrap_or_default();
        let step = Step { pass: pass.to_owned(), object: object(), pipeline, resources, times: 1 };
        let steps = &mut self.capture.steps;
        // A solver takes turns between two; what is drawn is drawn again in another tile.
        let last = self.steps.get(&step).copied().filter(|last| is_drawn || last + 2 >= steps.len());
        if let Some(last) = last {
            steps[last].times += 1;
        } else {
            self.steps.insert(step.clone(), steps.len());
            steps.push(step);
        }
    }
}

pub(super) fn buffer(label: Option<&str>, buffer: &Buffer) {
    record(|recorder| {
        let name = recorder.resource(label, Kind::Buffer, buffer.size());
        recorder.buffers.insert(buffer.clone(), name);
    });
}

pub(super) fn texture(label: Option<&str>, texture: &Texture) {
    record(|recorder| {
        let size = texture.size();
        let texels = u64::from(size.width) * u64::from(size.height) * u64::from(size.depth_or_array_layers);
        // Only formats without blocks of several texels are used; depth is one of 32 bits.
        let texel = u64::from(texture.format().block_copy_size(None).unwrap_or_default());
        let name = recorder.resource(label, Kind::Texture, texels * texel);
        recorder.textures.insert(texture.clone(), name);
    });
}

pub(super) fn sampler(label: Option<&str>, sampler: &Sampler) {
    record(|recorder| {
        let name = recorder.resource(label, Kind::Sampler, 0);
        recorder.samplers.insert(sampler.clone(), name);
    });
}

pub(super) fn bind_group(descriptor: &wgpu::BindGroupDescriptor<'_>, group: &BindGroup) {
    record(|recorder| {
        let name = |resource: &BindingResource<'_>| match resource {
            BindingResource::Buffer(binding) => recorder.buffers.get(binding.buffer).cloned(),
            BindingResource::TextureView(view) => recorder.textures.get(view.texture()).cloned(),
            BindingResource::Sampler(sampler) => recorder.samplers.get(*sampler).cloned(),
            _ => None,
        };
        let names = descriptor.entries.iter().filter_map(|entry| name(&entry.resource)).collect();
        recorder.groups.insert(group.clone(), names);
    });
}

/// Notes a pipeline, whose description is made only where someone listens.
pub fn render_pipeline(pipeline: &RenderPipeline, describe: impl FnOnce() -> Pipeline) {
    record(|recorder| {
        let name = recorder.pipeline(describe());
        recorder.render_pipelines.insert(pipeline.clone(), name);
    });
}

/// The same of a compute pipeline.
pub fn compute_pipeline(pipeline: &ComputePipeline, describe: impl FnOnce() -> Pipeline) {
    record(|recorder| {
        let name = recorder.pipeline(describe());
        recorder.compute_pipelines.insert(pipeline.clone(), name);
    });
}

/// The names of what is drawn to.
pub(super) fn targets<'a>(views: impl Iterator<Item = &'a wgpu::TextureView>) -> Vec<String> {
    let mut names = Vec::new();
    record(|recorder| names.extend(views.filter_map(|view| recorder.textures.get(view.texture()).cloned())));
    names
}

pub(super) fn draw(pass: &str, pipeline: Option<&RenderPipeline>, groups: &[Option<BindGroup>], targets: &[String]) {
    record(|recorder| {
        let name = pipeline.and_then(|pipeline| recorder.render_pipelines.get(pipeline).cloned());
        recorder.step(pass, name, groups, targets, true);
    });
}

pub(super) fn dispatch(pass: &str, pipeline: Option<&ComputePipeline>, groups: &[Option<BindGroup>]) {
    record(|recorder| {
        let name = pipeline.and_then(|pipeline| recorder.compute_pipelines.get(pipeline).cloned());
        recorder.step(pass, name, groups, &[], false);
    });
}
