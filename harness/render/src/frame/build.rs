//! Builds a frame: techniques add resources, pipelines and passes as they need them.

use super::handles::{BindGroupId, Bound, Buffer, PipelineId, Sampler, Texture};
use super::pass::{ComputePass, Dispatch, Draw, Pass, Read, RenderPass, Target, Workgroups};
use super::pipeline::{BindGroup, Blend, Pipeline, PipelineKind};
use super::record::Record;
use super::resource::{Contents, Resource, ResourceKind, texel_bytes};
use super::shader::{Shader, ShaderError};
use super::whole::Frame;
use lapidary_gpu::Gpu;
use lapidary_scene::{Encoding, Texels};
use std::collections::HashMap;
use std::sync::Arc;

/// Source of a graphics pipeline.
#[derive(Clone, Copy, Debug)]
pub struct PipelineSource<'a> {
    /// Name of the recipe, for messages.
    pub recipe: &'a str,
    /// Composed text of the recipe.
    pub source: &'a str,
    /// Vertex and fragment entry points.
    pub entries: [&'a str; 2],
    /// Values of overrides, bools as 0 or 1; names that the text does not declare are left out.
    pub constants: &'a [(&'a str, f64)],
    /// Formats of the colour targets.
    pub formats: &'a [wgpu::TextureFormat],
    /// Format of the depth buffer, for solids; `None` if there is none.
    pub depth: Option<wgpu::TextureFormat>,
}

/// A frame under construction.
#[derive(Debug, Default)]
pub struct Builder<'gpu> {
    frame: Frame,
    /// Composed text of each pipeline.
    sources: Vec<String>,
    object: String,
    gpu: Option<&'gpu Gpu>,
    /// Textures of images, by where their texels stand in memory and what these are taken for. The texels are kept, so that
    /// no others come to stand there.
    images: HashMap<(usize, Encoding), (Arc<Texels>, Texture)>,
}

/// A texture whose parts are read back to the host.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Readback {
    picture: &'static str,
    texture: Texture,
    buffer: Buffer,
}

impl<'gpu> Builder<'gpu> {
    /// Creates an empty frame.
    ///
    /// `gpu` computes the contents that need a device, which are tables of the curvature-dependent
    /// reflectance. Without it they are left out, for frames that are inspected and not run.
    #[must_use]
    pub fn new(gpu: Option<&'gpu Gpu>) -> Self {
        Self { gpu, ..Self::default() }
    }

    /// Returns the device that the frame is made for; `None` if there is none.
    pub(crate) fn gpu(&self) -> Option<&'gpu Gpu> {
        self.gpu
    }

    /// Returns whether the frame is made for lavapipe.
    pub(crate) fn is_for_lavapipe(&self) -> bool {
        self.gpu.is_some_and(Gpu::is_lavapipe)
    }

    /// Returns the limits that every device meets; no device is asked for more.
    #[must_use]
    pub fn limits(&self) -> wgpu::Limits {
        wgpu::Limits::default()
    }

    /// Returns the frame so far.
    #[must_use]
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// Returns the finished frame.
    #[must_use]
    pub fn finish(self) -> Frame {
        self.frame
    }

    /// Runs `make`; everything that it adds belongs to the object `name`, or to all objects if
    /// `name` is empty.
    pub fn of_object<T>(&mut self, name: &str, make: impl FnOnce(&mut Self) -> T) -> T {
        let outer = std::mem::replace(&mut self.object, name.to_owned());
        let made = make(self);
        self.object = outer;
        made
    }

    fn resource(&mut self, what: &str, kind: ResourceKind) -> usize {
        let object = self.object.clone();
        let name = if object.is_empty() { what.to_owned() } else { format!("{object}/{what}") };
        self.frame.resources.push(Resource { name, object, kind });
        self.frame.resources.len() - 1
    }

    /// Adds a buffer of `size` bytes, all zero.
    pub fn buffer(&mut self, what: &str, size: u64, usage: wgpu::BufferUsages) -> Buffer {
        Buffer(self.resource(what, ResourceKind::Buffer { size, usage, contents: Contents::Zeros, layout: None }))
    }

    /// Adds a buffer with contents.
    pub fn filled(&mut self, what: &str, contents: Vec<u8>, usage: wgpu::BufferUsages) -> Buffer {
        let size = contents.len() as u64;
        Buffer(
            self.resource(
                what,
                ResourceKind::Buffer { size, usage, contents: Contents::Bytes(contents), layout: None },
            ),
        )
    }

    /// Adds a storage buffer with contents.
    pub fn storage(&mut self, what: &str, contents: &[u8]) -> Buffer {
        self.filled(what, contents.to_vec(), wgpu::BufferUsages::STORAGE)
    }

    /// Adds a uniform buffer that holds one struct.
    pub(crate) fn uniform(&mut self, what: &str, record: Record) -> Buffer {
        // A host may move the camera, and change whatever else uniforms hold.
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        self.records(what, vec![record], usage)
    }

    /// Adds a storage buffer that holds one struct.
    pub(crate) fn record(&mut self, what: &str, record: Record) -> Buffer {
        self.records(what, vec![record], wgpu::BufferUsages::STORAGE)
    }

    /// Adds a buffer of structs of one type; there must be at least one.
    pub(crate) fn records(&mut self, what: &str, records: Vec<Record>, usage: wgpu::BufferUsages) -> Buffer {
        let layout = records.first().map(Record::layout);
        let contents: Vec<u8> = records.into_iter().flat_map(Record::bytes).collect();
        let kind =
            ResourceKind::Buffer { size: contents.len() as u64, usage, contents: Contents::Bytes(contents), layout };
        Buffer(self.resource(what, kind))
    }

    /// Adds a texture to be sampled or loaded. `size` is width, height, and depth or number of
    /// layers.
    pub fn texture(
        &mut self,
        what: &str,
        (dimension, format): (wgpu::TextureDimension, wgpu::TextureFormat),
        size: [u32; 3],
        contents: Contents,
    ) -> Texture {
        // A host copies its contents there.
        let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
        Texture(self.resource(what, ResourceKind::Texture { size, levels: 1, dimension, format, usage, contents }))
    }

    /// Adds a texture of two dimensions with all its mip levels. `size` is width, height, and number of layers.
    pub(crate) fn mipped(
        &mut self,
        what: &str,
        format: wgpu::TextureFormat,
        size: [u32; 3],
        (levels, contents): (u32, impl Into<Contents>),
    ) -> Texture {
        let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
        let (dimension, contents) = (wgpu::TextureDimension::D2, contents.into());
        Texture(self.resource(what, ResourceKind::Texture { size, levels, dimension, format, usage, contents }))
    }

    /// Returns the texture of an image as colours or data of this encoding; the first use adds it, and it then belongs to all objects.
    pub(crate) fn image(
        &mut self,
        (texels, encoding): (&Arc<Texels>, Encoding),
        make: impl FnOnce(&mut Self) -> Texture,
    ) -> Texture {
        let key = (Arc::as_ptr(texels).addr(), encoding);
        if let Some((_, known)) = self.images.get(&key) {
            return *known;
        }
        let made = self.of_object("", make);
        self.images.insert(key, (Arc::clone(texels), made));
        made
    }

    /// Adds a texture that can be drawn to, with `usage` in addition. `size` is width, height, and
    /// number of layers.
    pub fn target(
        &mut self,
        what: &str,
        size: [u32; 3],
        format: wgpu::TextureFormat,
        usage: wgpu::TextureUsages,
    ) -> Texture {
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | usage;
        let dimension = wgpu::TextureDimension::D2;
        Texture(self.resource(
            what,
            ResourceKind::Texture { size, levels: 1, dimension, format, usage, contents: Contents::Zeros },
        ))
    }

    /// Adds a linear sampler.
    pub fn sampler(&mut self, what: &str, address: [wgpu::AddressMode; 2]) -> Sampler {
        Sampler(self.resource(what, ResourceKind::Sampler { filter: wgpu::FilterMode::Linear, address }))
    }

    /// Adds a graphics pipeline. It culls back faces if it has a depth buffer: a closed body shows
    /// its front, and a full-screen triangle has no back to cull.
    ///
    /// # Errors
    /// If the text is not valid.
    pub fn render_pipeline(&mut self, from: &PipelineSource<'_>) -> Result<PipelineId, ShaderError> {
        self.render_pipeline_with(from, from.depth.map(|_| wgpu::Face::Back), None)
    }

    /// Adds a graphics pipeline that culls these faces and blends, if at all.
    ///
    /// # Errors
    /// If the text is not valid.
    pub fn render_pipeline_with(
        &mut self,
        from: &PipelineSource<'_>,
        cull: Option<wgpu::Face>,
        blend: Option<Blend>,
    ) -> Result<PipelineId, ShaderError> {
        let shader = Shader::new(from.recipe, from.source, &from.entries, from.constants)?;
        let kind = PipelineKind::Render { targets: from.formats.to_vec(), depth: from.depth, cull, blend };
        Ok(self.pipeline(from.recipe, from.source, shader, kind))
    }

    /// Adds a compute pipeline for `entry` of `source`, the composed text of `recipe`.
    ///
    /// `constants` are the values of overrides, bools as 0 or 1; names that the text does not
    /// declare are left out.
    ///
    /// # Errors
    /// If the text is not valid.
    pub fn compute_pipeline(
        &mut self,
        recipe: &str,
        source: &str,
        entry: &str,
        constants: &[(&str, f64)],
    ) -> Result<PipelineId, ShaderError> {
        let shader = Shader::new(recipe, source, &[entry], constants)?;
        Ok(self.pipeline(entry, source, shader, PipelineKind::Compute))
    }

    /// Returns the existing pipeline if an identical one was added before.
    fn pipeline(&mut self, name: &str, source: &str, shader: Shader, kind: PipelineKind) -> PipelineId {
        let pipelines = &mut self.frame.pipelines;
        let is_same = |known: &Pipeline| known.kind == kind && known.shader.is_specialised_as(&shader);
        let mut known = pipelines.iter().zip(&self.sources);
        if let Some(place) = known.position(|(known, text)| text == source && is_same(known)) {
            return PipelineId(place);
        }
        let is_taken = |name: &str| pipelines.iter().any(|known| known.name == name);
        let numbered = (2..).map(|number| format!("{name}#{number}"));
        let mut names = std::iter::once(name.to_owned()).chain(numbered);
        let name = names.find(|name| !is_taken(name)).unwrap_or_default();
        pipelines.push(Pipeline { name, shader, kind });
        self.sources.push(source.to_owned());
        PipelineId(pipelines.len() - 1)
    }

    /// Returns whether a pipeline reads or writes this binding.
    #[must_use]
    pub fn binds(&self, pipeline: PipelineId, group: u32, binding: u32) -> bool {
        self.frame.pipeline(pipeline).shader.binds(group, binding)
    }

    /// Adds a bind group of those `resources`, by binding number, that the pipeline reads or
    /// writes. Returns `None` if the pipeline has no bindings in this group.
    pub fn bind(&mut self, pipeline: PipelineId, group: u32, resources: &[(u32, Bound)]) -> Option<BindGroupId> {
        let used = resources.iter().filter(|(binding, _)| self.binds(pipeline, group, *binding));
        let entries: Vec<(u32, Bound)> = used.copied().collect();
        if entries.is_empty() {
            return None;
        }
        let bind_groups = &mut self.frame.bind_groups;
        bind_groups.push(BindGroup { pipeline, group, entries });
        Some(BindGroupId(bind_groups.len() - 1))
    }

    /// Returns a draw for the current object.
    #[must_use]
    pub fn draw(&self, pipeline: PipelineId, groups: Vec<Option<BindGroupId>>, vertices: u32) -> Draw {
        Draw { object: self.object.clone(), pipeline, groups, vertices, instances: 1, scissor: None }
    }

    /// Returns a dispatch for the current object.
    #[must_use]
    pub fn dispatch(&self, pipeline: PipelineId, groups: Vec<Option<BindGroupId>>, workgroups: Workgroups) -> Dispatch {
        Dispatch { object: self.object.clone(), pipeline, groups, workgroups }
    }

    /// Appends a pass.
    pub fn pass(&mut self, pass: Pass) {
        self.frame.passes.push(pass);
    }

    /// Adds a pass of draws to these textures, from nothing, without a depth buffer.
    pub fn draw_to(&mut self, name: &str, targets: &[Texture], viewport: Option<[u32; 4]>, draws: Vec<Draw>) {
        let targets = targets.iter().copied().map(Target::from).collect();
        self.pass(Pass::Render(RenderPass { name: name.to_owned(), targets, depth: None, viewport, draws }));
    }

    /// Appends a pass of dispatches.
    pub fn compute(&mut self, name: &str, dispatches: Vec<Dispatch>, repeat: u32) {
        self.pass(Pass::Compute(ComputePass { name: name.to_owned(), dispatches, repeat }));
    }

    /// Appends a pass that sets a buffer to 0.
    pub fn clear(&mut self, buffer: Buffer) {
        let bytes = self.frame.resource(buffer).bytes();
        self.pass(Pass::Clear { buffer, bytes });
    }

    /// Prepares reading `texture` back to the host as the named picture, in parts of at most this
    /// size.
    pub(crate) fn readback(&mut self, picture: &'static str, texture: Texture, [width, height]: [u32; 2]) -> Readback {
        let size = u64::from(self.bytes_per_row(texture, width)) * u64::from(height);
        let usage = wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ;
        Readback { picture, texture, buffer: self.buffer(&format!("{picture} to read"), size, usage) }
    }

    /// Appends a pass that reads the upper left part of a texture back, to this position in its
    /// picture.
    pub(crate) fn read(&mut self, readback: Readback, size: [u32; 2], position: [u32; 2]) {
        let Readback { picture, texture, buffer } = readback;
        let bytes_per_row = self.bytes_per_row(texture, size[0]);
        self.pass(Pass::Read(Read { picture, texture, size, at: position, buffer, bytes_per_row }));
    }

    /// Appends a pass that reads a whole texture back, as the named picture.
    pub fn read_whole(&mut self, picture: &'static str, texture: Texture) {
        if let ResourceKind::Texture { size: [width, height, _], .. } = self.frame.resource(texture).kind {
            let readback = self.readback(picture, texture, [width, height]);
            self.read(readback, [width, height], [0, 0]);
        }
    }

    fn bytes_per_row(&self, texture: Texture, width: u32) -> u32 {
        let ResourceKind::Texture { format, .. } = self.frame.resource(texture).kind else { return 0 };
        (width * texel_bytes(format)).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT)
    }
}
