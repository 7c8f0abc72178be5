//! A frame's document for another host, `frame.json`. docs/frame.md defines each field.

use super::handles::{BindGroupId, Bound, Buffer, Sampler, Texture};
use super::pass::{ComputePass, Depth, Pass, Read, RenderPass, Target, Workgroups};
use super::pipeline::{BindGroup, Blend, Pipeline, PipelineKind};
use super::resource::{Contents, Resource, ResourceKind};
use super::shader::Shader;
use super::whole::Frame;
use serde::Serialize;
use std::collections::BTreeMap;

/// Version of the format; readers of other versions should refuse it.
const VERSION: u32 = 4;

/// `frame.json`. Refers to resources, pipelines and bind groups by index.
#[derive(Serialize)]
pub struct Document {
    version: u32,
    pictures: Vec<PictureRow>,
    resources: Vec<ResourceRow>,
    pipelines: Vec<PipelineRow>,
    bind_groups: Vec<BindGroupRow>,
    passes: Vec<PassRow>,
}

#[derive(Serialize)]
struct PictureRow {
    name: &'static str,
    format: String,
    size: [u32; 2],
}

#[derive(Serialize)]
struct ResourceRow {
    name: String,
    #[serde(flatten)]
    kind: ResourceFields,
    usage: Vec<&'static str>,
    contents: Option<String>,
}

#[derive(Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
enum ResourceFields {
    Buffer { bytes: u64, layout: Option<LayoutRow> },
    Texture { dimension: &'static str, format: String, size: [u32; 3], levels: u32 },
    Sampler { filter: &'static str, address: [&'static str; 2] },
}

#[derive(Serialize)]
struct LayoutRow {
    name: &'static str,
    bytes: usize,
    fields: Vec<FieldRow>,
}

#[derive(Serialize)]
struct FieldRow {
    name: &'static str,
    r#type: &'static str,
    offset: usize,
}

#[derive(Serialize)]
struct PipelineRow {
    name: String,
    recipe: String,
    wgsl: String,
    entries: Vec<String>,
    overrides: BTreeMap<String, f64>,
    #[serde(flatten)]
    kind: PipelineFields,
}

#[derive(Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
enum PipelineFields {
    Render { targets: Vec<String>, depth: Option<String>, cull: &'static str, blend: Option<BlendFields> },
    Compute,
}

#[derive(Serialize)]
struct BlendFields {
    color: &'static str,
    alpha: &'static str,
}

#[derive(Serialize)]
struct BindGroupRow {
    pipeline: usize,
    group: u32,
    entries: Vec<EntryRow>,
}

#[derive(Serialize)]
struct EntryRow {
    binding: u32,
    resource: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    dimension: Option<&'static str>,
}

#[derive(Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
enum PassRow {
    Render {
        name: String,
        targets: Vec<TargetRow>,
        depth: Option<DepthRow>,
        viewport: Option<[u32; 4]>,
        draws: Vec<DrawRow>,
    },
    Compute {
        name: String,
        repeat: u32,
        dispatches: Vec<DispatchRow>,
    },
    Clear {
        buffer: usize,
        bytes: u64,
    },
    Copy {
        from: usize,
        to: usize,
        bytes: u64,
    },
    Read {
        picture: &'static str,
        at: [u32; 2],
        size: [u32; 2],
        texture: usize,
        buffer: usize,
        bytes_per_row: u32,
    },
}

#[derive(Serialize)]
struct TargetRow {
    texture: usize,
    layer: u32,
    clear: Option<[f64; 4]>,
}

#[derive(Serialize)]
struct DepthRow {
    texture: usize,
    load: bool,
    keep: bool,
}

#[derive(Serialize)]
struct DrawRow {
    object: String,
    pipeline: usize,
    groups: Vec<Option<usize>>,
    vertices: u32,
    instances: u32,
    scissor: Option<[u32; 4]>,
}

#[derive(Serialize)]
struct DispatchRow {
    object: String,
    pipeline: usize,
    groups: Vec<Option<usize>>,
    #[serde(flatten)]
    workgroups: WorkgroupsRow,
}

#[derive(Serialize)]
#[serde(rename_all = "snake_case")]
enum WorkgroupsRow {
    Workgroups([u32; 3]),
    Indirect(usize),
}

/// Returns a format's name in WebGPU, such as `rgba32float`; for formats without blocks.
fn format_name(format: wgpu::TextureFormat) -> String {
    format!("{format:?}").to_lowercase()
}

/// Returns the name of a file: the index, which makes it unique, and the name, restricted to
/// characters that file systems accept.
fn file_name(folder: &str, place: usize, name: &str, extension: &str) -> String {
    let plain = |letter: char| if letter.is_ascii_alphanumeric() || letter == '_' { letter } else { '-' };
    let name: String = name.chars().map(plain).take(40).collect();
    format!("{folder}/{place:03}-{name}.{extension}")
}

pub(super) fn shader_file(place: usize, pipeline: &Pipeline) -> String {
    file_name("pipelines", place, &pipeline.name, "wgsl")
}

pub(super) fn contents_file(place: usize, resource: &Resource) -> String {
    file_name("resources", place, &resource.name, "bin")
}

fn resource_row((place, resource): (usize, &Resource)) -> ResourceRow {
    let (kind, usage, contents) = match &resource.kind {
        ResourceKind::Buffer { size, usage, contents, layout } => {
            let field = |field: &'static lapidary_specialise::layout::Field| FieldRow {
                name: &field.name,
                r#type: &field.ty,
                offset: field.offsets.first().copied().unwrap_or_default(),
            };
            let layout = layout.map(|(name, layout)| LayoutRow {
                name,
                bytes: layout.size,
                fields: layout.fields.iter().map(field).collect(),
            });
            (
                ResourceFields::Buffer { bytes: *size, layout },
                usage.iter_names().map(|(name, _)| name).collect(),
                contents,
            )
        }
        ResourceKind::Texture { size, levels, dimension, format, usage, contents } => {
            let dimension = match dimension {
                wgpu::TextureDimension::D1 => "1d",
                wgpu::TextureDimension::D2 => "2d",
                wgpu::TextureDimension::D3 => "3d",
            };
            let kind =
                ResourceFields::Texture { dimension, format: format_name(*format), size: *size, levels: *levels };
            (kind, usage.iter_names().map(|(name, _)| name).collect(), contents)
        }
        ResourceKind::Sampler { filter, address } => {
            let filter = match filter {
                wgpu::FilterMode::Nearest => "nearest",
                wgpu::FilterMode::Linear => "linear",
            };
            let address = address.map(|address| match address {
                wgpu::AddressMode::Repeat => "repeat",
                wgpu::AddressMode::MirrorRepeat => "mirror-repeat",
                // WebGPU has no border mode.
                wgpu::AddressMode::ClampToEdge | wgpu::AddressMode::ClampToBorder => "clamp-to-edge",
            });
            (ResourceFields::Sampler { filter, address }, Vec::new(), &Contents::Zeros)
        }
    };
    let contents = (*contents != Contents::Zeros).then(|| contents_file(place, resource));
    ResourceRow { name: resource.name.clone(), kind, usage, contents }
}

fn pipeline_row((place, pipeline): (usize, &Pipeline)) -> PipelineRow {
    let shader: &Shader = &pipeline.shader;
    let kind = match &pipeline.kind {
        PipelineKind::Render { targets, depth, cull, blend } => PipelineFields::Render {
            targets: targets.iter().copied().map(format_name).collect(),
            depth: depth.map(format_name),
            cull: match cull {
                None => "none",
                Some(wgpu::Face::Front) => "front",
                Some(wgpu::Face::Back) => "back",
            },
            blend: blend.map(|Blend { color, alpha }| BlendFields { color: operation(color), alpha: operation(alpha) }),
        },
        PipelineKind::Compute => PipelineFields::Compute,
    };
    PipelineRow {
        name: pipeline.name.clone(),
        recipe: shader.recipe().to_owned(),
        wgsl: shader_file(place, pipeline),
        entries: shader.entries().to_vec(),
        overrides: shader.overrides().iter().cloned().collect(),
        kind,
    }
}

fn operation(operation: wgpu::BlendOperation) -> &'static str {
    match operation {
        wgpu::BlendOperation::Add => "add",
        wgpu::BlendOperation::Subtract => "subtract",
        wgpu::BlendOperation::ReverseSubtract => "reverse-subtract",
        wgpu::BlendOperation::Min => "min",
        wgpu::BlendOperation::Max => "max",
    }
}

fn bind_group_row(group: &BindGroup) -> BindGroupRow {
    let entry = |(binding, bound): &(u32, Bound)| {
        let (resource, dimension) = match *bound {
            Bound::Buffer(Buffer(place)) | Bound::Sampler(Sampler(place)) => (place, None),
            Bound::Texture(Texture(place), dimension) => (place, Some(dimension)),
        };
        let dimension = dimension.map(|dimension| match dimension {
            wgpu::TextureViewDimension::D1 => "1d",
            wgpu::TextureViewDimension::D2 => "2d",
            wgpu::TextureViewDimension::D2Array => "2d-array",
            wgpu::TextureViewDimension::Cube => "cube",
            wgpu::TextureViewDimension::CubeArray => "cube-array",
            wgpu::TextureViewDimension::D3 => "3d",
        });
        EntryRow { binding: *binding, resource, dimension }
    };
    BindGroupRow { pipeline: group.pipeline.0, group: group.group, entries: group.entries.iter().map(entry).collect() }
}

fn pass_row(pass: &Pass) -> PassRow {
    let groups = |groups: &[Option<BindGroupId>]| groups.iter().map(|group| group.map(|group| group.0)).collect();
    match pass {
        Pass::Render(RenderPass { name, targets, depth, viewport, draws }) => PassRow::Render {
            name: name.clone(),
            targets: targets
                .iter()
                .map(|&Target { texture, layer, clear }| TargetRow { texture: texture.0, layer, clear })
                .collect(),
            depth: depth.map(|Depth { texture, load, keep }| DepthRow { texture: texture.0, load, keep }),
            viewport: *viewport,
            draws: draws
                .iter()
                .map(|draw| DrawRow {
                    object: draw.object.clone(),
                    pipeline: draw.pipeline.0,
                    groups: groups(&draw.groups),
                    vertices: draw.vertices,
                    instances: draw.instances,
                    scissor: draw.scissor,
                })
                .collect(),
        },
        Pass::Compute(ComputePass { name, dispatches, repeat }) => PassRow::Compute {
            name: name.clone(),
            repeat: *repeat,
            dispatches: dispatches
                .iter()
                .map(|dispatch| DispatchRow {
                    object: dispatch.object.clone(),
                    pipeline: dispatch.pipeline.0,
                    groups: groups(&dispatch.groups),
                    workgroups: match dispatch.workgroups {
                        Workgroups::Count(count) => WorkgroupsRow::Workgroups(count),
                        Workgroups::Indirect(buffer) => WorkgroupsRow::Indirect(buffer.0),
                    },
                })
                .collect(),
        },
        &Pass::Clear { buffer, bytes } => PassRow::Clear { buffer: buffer.0, bytes },
        &Pass::Copy { from, to, bytes } => PassRow::Copy { from: from.0, to: to.0, bytes },
        &Pass::Read(Read { picture, texture, size, at: position, buffer, bytes_per_row }) => {
            PassRow::Read { picture, at: position, size, texture: texture.0, buffer: buffer.0, bytes_per_row }
        }
    }
}

impl Frame {
    /// Returns the pictures that are read back, by name.
    fn pictures(&self) -> Vec<PictureRow> {
        let mut pictures: Vec<PictureRow> = Vec::new();
        for pass in &self.passes {
            let Pass::Read(read) = pass else { continue };
            let ResourceKind::Texture { format, .. } = self.resource(read.texture).kind else { continue };
            let end = [0, 1].map(|axis| read.at[axis] + read.size[axis]);
            match pictures.iter_mut().find(|picture| picture.name == read.picture) {
                Some(picture) => picture.size = [0, 1].map(|axis| picture.size[axis].max(end[axis])),
                None => {
                    pictures.push(PictureRow { name: read.picture, format: format_name(format), size: end });
                }
            }
        }
        pictures
    }

    /// Returns the contents of `frame.json`.
    #[must_use]
    pub fn document(&self) -> Document {
        Document {
            version: VERSION,
            pictures: self.pictures(),
            resources: self.resources.iter().enumerate().map(resource_row).collect(),
            pipelines: self.pipelines.iter().enumerate().map(pipeline_row).collect(),
            bind_groups: self.bind_groups.iter().map(bind_group_row).collect(),
            passes: self.passes.iter().map(pass_row).collect(),
        }
    }
}
