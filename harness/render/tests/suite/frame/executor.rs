//! Another host: runs the files of `cook frame`, knows nothing else, and uses no project code.

use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;
use wgpu::util::{BufferInitDescriptor, DeviceExt as _};
use wgpu::*;

/// A picture: its width, height and texels, row by row.
pub type Picture = (u32, u32, Vec<u8>);

enum Resource {
    Buffer(Buffer),
    Texture(Texture),
    Sampler(Sampler),
}

enum Pipeline {
    Render(RenderPipeline),
    Compute(ComputePipeline),
}

struct Host<'a> {
    device: &'a Device,
    queue: &'a Queue,
    resources: Vec<Resource>,
    pipelines: Vec<Pipeline>,
    groups: Vec<BindGroup>,
}

/// Runs the frame in a folder, and returns its pictures by name.
pub fn run(device: &Device, queue: &Queue, folder: &Path) -> BTreeMap<String, Picture> {
    let text = std::fs::read_to_string(folder.join("frame.json")).expect("frame.json");
    let frame: Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(frame["version"], 4);
    let mut host = Host { device, queue, resources: Vec::new(), pipelines: Vec::new(), groups: Vec::new() };
    host.resources = list(&frame["resources"]).iter().map(|row| host.resource(row, folder)).collect();
    host.pipelines = list(&frame["pipelines"]).iter().map(|row| host.pipeline(row, folder)).collect();
    host.groups = list(&frame["bind_groups"]).iter().map(|row| host.group(row)).collect();
    let mut pictures: BTreeMap<String, Picture> = BTreeMap::new();
    for row in list(&frame["pictures"]) {
        let [width, height] = numbers(&row["size"]);
        let bytes = width * height * texel_bytes(format(&row["format"]));
        pictures.insert(string(&row["name"]).to_owned(), (width, height, vec![0; bytes as usize]));
    }
    list(&frame["passes"]).iter().for_each(|pass| host.pass(pass, &mut pictures));
    pictures
}

fn list(value: &Value) -> &[Value] {
    value.as_array().expect("a list")
}

fn string(value: &Value) -> &str {
    value.as_str().expect("a string")
}

fn number(value: &Value) -> u32 {
    value.as_u64().expect("a number") as u32
}

fn at<'a, T>(all: &'a [T], place: &Value) -> &'a T {
    &all[number(place) as usize]
}

fn numbers<const N: usize>(value: &Value) -> [u32; N] {
    std::array::from_fn(|place| number(&value[place]))
}

/// Returns the value that a name stands for.
fn named<T: Copy>(value: &Value, known: &[(&str, T)]) -> T {
    let name = string(value);
    known.iter().find(|(known, _)| *known == name).unwrap_or_else(|| panic!("{name}")).1
}

fn format(value: &Value) -> TextureFormat {
    use TextureFormat::{Depth32Float, R32Float, Rg32Float, Rgba8Unorm, Rgba16Float, Rgba32Float};
    let known = [("depth32float", Depth32Float), ("r32float", R32Float), ("rg32float", Rg32Float)];
    let of_four = [("rgba8unorm", Rgba8Unorm), ("rgba16float", Rgba16Float), ("rgba32float", Rgba32Float)];
    named(value, &[known, of_four].concat())
}

fn texel_bytes(format: TextureFormat) -> u32 {
    format.block_copy_size(None).expect("no blocks")
}

impl Host<'_> {
    fn resource(&self, row: &Value, folder: &Path) -> Resource {
        let contents = row["contents"].as_str().map(|file| std::fs::read(folder.join(file)).expect("contents"));
        match string(&row["kind"]) {
            "buffer" => {
                let flag = |name: &Value| BufferUsages::from_name(string(name)).expect("a usage");
                let usage = list(&row["usage"]).iter().map(flag).collect();
                let contents = &contents.unwrap_or_else(|| vec![0; number(&row["bytes"]) as usize]);
                Resource::Buffer(self.device.create_buffer_init(&BufferInitDescriptor { label: None, contents, usage }))
            }
            "texture" => {
                let [width, height, depth_or_array_layers] = numbers(&row["size"]);
                let flag = |name: &Value| TextureUsages::from_name(string(name)).expect("a usage");
                let descriptor = TextureDescriptor {
                    label: None,
                    size: Extent3d { width, height, depth_or_array_layers },
                    mip_level_count: number(&row["levels"]),
                    sample_count: 1,
                    dimension: named(&row["dimension"], &[("2d", TextureDimension::D2), ("3d", TextureDimension::D3)]),
                    format: format(&row["format"]),
                    usage: list(&row["usage"]).iter().map(flag).collect(),
                    view_formats: &[],
                };
                let texture = self.device.create_texture(&descriptor);
                let mut rest = contents.as_deref().unwrap_or_default();
                for mip_level in (0..descriptor.mip_level_count).take_while(|_| !rest.is_empty()) {
                    let size = Extent3d {
                        width: (width >> mip_level).max(1),
                        height: (height >> mip_level).max(1),
                        ..descriptor.size
                    };
                    let bytes_per_row = size.width * texel_bytes(descriptor.format);
                    let (level, others) =
                        rest.split_at((bytes_per_row * size.height * size.depth_or_array_layers) as usize);
                    let layout = TexelCopyBufferLayout {
                        offset: 0,
                        bytes_per_row: Some(bytes_per_row),
                        rows_per_image: Some(size.height),
                    };
                    self.queue.write_texture(
                        TexelCopyTextureInfo { mip_level, ..texture.as_image_copy() },
                        level,
                        layout,
                        size,
                    );
                    rest = others;
                }
                Resource::Texture(texture)
            }
            "sampler" => {
                let modes = [("repeat", AddressMode::Repeat), ("clamp-to-edge", AddressMode::ClampToEdge)];
                let filter = named(&row["filter"], &[("linear", FilterMode::Linear), ("nearest", FilterMode::Nearest)]);
                Resource::Sampler(self.device.create_sampler(&SamplerDescriptor {
                    mag_filter: filter,
                    min_filter: filter,
                    mipmap_filter: named(
                        &row["filter"],
                        &[("linear", MipmapFilterMode::Linear), ("nearest", MipmapFilterMode::Nearest)],
                    ),
                    address_mode_u: named(&row["address"][0], &modes),
                    address_mode_v: named(&row["address"][1], &modes),
                    ..Default::default()
                }))
            }
            other => panic!("resource {other}"),
        }
    }

    fn pipeline(&self, row: &Value, folder: &Path) -> Pipeline {
        let text = std::fs::read_to_string(folder.join(string(&row["wgsl"]))).expect("WGSL");
        let source = ShaderSource::Wgsl(text.into());
        let module = self.device.create_shader_module(ShaderModuleDescriptor { label: None, source });
        let (module, options) = (&module, PipelineCompilationOptions::default());
        let entry_point = |place: usize| Some(string(&row["entries"][place]));
        if row["kind"] == "compute" {
            let (label, layout, entry_point, compilation_options, cache) = (None, None, entry_point(0), options, None);
            let kernel = ComputePipelineDescriptor { label, layout, module, entry_point, compilation_options, cache };
            return Pipeline::Compute(self.device.create_compute_pipeline(&kernel));
        }
        let component = |channel: &str| BlendComponent {
            src_factor: BlendFactor::One,
            dst_factor: BlendFactor::One,
            operation: named(&row["blend"][channel], &[("add", BlendOperation::Add), ("min", BlendOperation::Min)]),
        };
        let blends = row["blend"].is_object();
        let blend = blends.then(|| BlendState { color: component("color"), alpha: component("alpha") });
        let target = |value| Some(ColorTargetState { blend, ..format(value).into() });
        let targets: Vec<_> = list(&row["targets"]).iter().map(target).collect();
        let depth_stencil = row["depth"].as_str().map(|_| DepthStencilState {
            format: format(&row["depth"]),
            depth_write_enabled: Some(true),
            depth_compare: Some(CompareFunction::Less),
            stencil: Default::default(),
            bias: Default::default(),
        });
        let faces = [("none", None), ("front", Some(Face::Front)), ("back", Some(Face::Back))];
        let (first, second, same) = (entry_point(0), entry_point(1), options.clone());
        let vertex = VertexState { module, entry_point: first, compilation_options: same, buffers: &[] };
        let targets = &targets;
        let fragment = FragmentState { module, entry_point: second, compilation_options: options, targets };
        Pipeline::Render(self.device.create_render_pipeline(&RenderPipelineDescriptor {
            label: None,
            layout: None,
            vertex,
            primitive: PrimitiveState { cull_mode: named(&row["cull"], &faces), ..Default::default() },
            depth_stencil,
            multisample: Default::default(),
            fragment: Some(fragment),
            multiview_mask: None,
            cache: None,
        }))
    }

    fn group(&self, row: &Value) -> BindGroup {
        use TextureViewDimension::{D2, D2Array, D3};
        let view = |entry: &Value| {
            let Resource::Texture(texture) = at(&self.resources, &entry["resource"]) else { return None };
            let dimension = Some(named(&entry["dimension"], &[("2d", D2), ("2d-array", D2Array), ("3d", D3)]));
            Some(texture.create_view(&TextureViewDescriptor { dimension, ..Default::default() }))
        };
        let views: Vec<_> = list(&row["entries"]).iter().map(view).collect();
        let mut entries = Vec::new();
        for (entry, view) in list(&row["entries"]).iter().zip(&views) {
            let resource = match at(&self.resources, &entry["resource"]) {
                Resource::Buffer(buffer) => buffer.as_entire_binding(),
                Resource::Texture(_) => BindingResource::TextureView(view.as_ref().expect("a view")),
                Resource::Sampler(sampler) => BindingResource::Sampler(sampler),
            };
            entries.push(BindGroupEntry { binding: number(&entry["binding"]), resource });
        }
        let layout = &match at(&self.pipelines, &row["pipeline"]) {
            Pipeline::Render(pipeline) => pipeline.get_bind_group_layout(number(&row["group"])),
            Pipeline::Compute(pipeline) => pipeline.get_bind_group_layout(number(&row["group"])),
        };
        self.device.create_bind_group(&BindGroupDescriptor { label: None, layout, entries: &entries })
    }

    fn buffer(&self, place: &Value) -> &Buffer {
        let Resource::Buffer(buffer) = at(&self.resources, place) else { panic!("no buffer") };
        buffer
    }

    fn texture(&self, place: &Value) -> &Texture {
        let Resource::Texture(texture) = at(&self.resources, place) else { panic!("no texture") };
        texture
    }

    fn bound<'a>(&'a self, row: &'a Value) -> impl Iterator<Item = (u32, Option<&'a BindGroup>)> {
        (0..).zip(list(&row["groups"]).iter().map(|group| (!group.is_null()).then(|| at(&self.groups, group))))
    }

    fn pass(&self, row: &Value, pictures: &mut BTreeMap<String, Picture>) {
        let mut encoder = self.device.create_command_encoder(&CommandEncoderDescriptor::default());
        match string(&row["kind"]) {
            "render" => self.render(&mut encoder, row),
            "compute" => {
                let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor::default());
                for dispatch in (0..number(&row["repeat"])).flat_map(|_| list(&row["dispatches"])) {
                    let Pipeline::Compute(pipeline) = at(&self.pipelines, &dispatch["pipeline"]) else { panic!() };
                    pass.set_pipeline(pipeline);
                    self.bound(dispatch).for_each(|(place, group)| pass.set_bind_group(place, group, &[]));
                    if dispatch["indirect"].is_null() {
                        let [x, y, z] = numbers(&dispatch["workgroups"]);
                        pass.dispatch_workgroups(x, y, z);
                    } else {
                        pass.dispatch_workgroups_indirect(self.buffer(&dispatch["indirect"]), 0);
                    }
                }
            }
            "clear" => encoder.clear_buffer(self.buffer(&row["buffer"]), 0, row["bytes"].as_u64()),
            "copy" => {
                let (from, to) = (self.buffer(&row["from"]), self.buffer(&row["to"]));
                encoder.copy_buffer_to_buffer(from, 0, to, 0, row["bytes"].as_u64());
            }
            "read" => return self.read(encoder, row, pictures),
            other => panic!("pass {other}"),
        }
        self.queue.submit([encoder.finish()]);
    }

    fn render(&self, encoder: &mut CommandEncoder, row: &Value) {
        let layer = |texture: &Value, layer: u32| {
            let (dimension, array_layer_count) = (Some(TextureViewDimension::D2), Some(1));
            let layers = TextureViewDescriptor { dimension, array_layer_count, ..Default::default() };
            self.texture(texture).create_view(&TextureViewDescriptor { base_array_layer: layer, ..layers })
        };
        let targets = list(&row["targets"]);
        let views: Vec<_> = targets.iter().map(|target| layer(&target["texture"], number(&target["layer"]))).collect();
        let attachment = |(target, view): (&Value, _)| {
            let clear = target["clear"]
                .as_array()
                .map(|color| [0, 1, 2, 3].map(|channel| color[channel].as_f64().expect("a number")));
            let load = clear.map_or(LoadOp::Load, |[r, g, b, a]| LoadOp::Clear(Color { r, g, b, a }));
            let ops = Operations { load, store: StoreOp::Store };
            Some(RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops })
        };
        let depth = (!row["depth"].is_null()).then(|| layer(&row["depth"]["texture"], 0));
        let load = if row["depth"]["load"] == true { LoadOp::Load } else { LoadOp::Clear(1.0) };
        let depth_ops = Some(Operations { load, store: StoreOp::Store });
        let depth_of = |view| RenderPassDepthStencilAttachment { view, depth_ops, stencil_ops: None };
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            color_attachments: &targets.iter().zip(&views).map(attachment).collect::<Vec<_>>(),
            depth_stencil_attachment: depth.as_ref().map(depth_of),
            ..RenderPassDescriptor::default()
        });
        if !row["viewport"].is_null() {
            let [left, top, width, height] = numbers(&row["viewport"]).map(|side| side as f32);
            pass.set_viewport(left, top, width, height, 0.0, 1.0);
        }
        for draw in list(&row["draws"]) {
            let Pipeline::Render(pipeline) = at(&self.pipelines, &draw["pipeline"]) else { panic!() };
            pass.set_pipeline(pipeline);
            self.bound(draw).for_each(|(place, group)| pass.set_bind_group(place, group, &[]));
            if !draw["scissor"].is_null() {
                let [left, top, width, height] = numbers(&draw["scissor"]);
                pass.set_scissor_rect(left, top, width, height);
            }
            pass.draw(0..number(&draw["vertices"]), 0..number(&draw["instances"]));
        }
    }

    fn read(&self, mut encoder: CommandEncoder, row: &Value, pictures: &mut BTreeMap<String, Picture>) {
        let (texture, buffer) = (self.texture(&row["texture"]), self.buffer(&row["buffer"]));
        let ([width, height], [left, top]) = (numbers(&row["size"]), numbers(&row["at"]));
        let bytes_per_row = number(&row["bytes_per_row"]);
        let layout = TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(bytes_per_row), rows_per_image: None };
        let size = Extent3d { width, height, depth_or_array_layers: 1 };
        encoder.copy_texture_to_buffer(texture.as_image_copy(), TexelCopyBufferInfo { buffer, layout }, size);
        self.queue.submit([encoder.finish()]);
        buffer.slice(..).map_async(MapMode::Read, |mapped| mapped.expect("mapped"));
        self.device.poll(PollType::wait_indefinitely()).expect("the device");
        let picture = pictures.get_mut(string(&row["picture"])).expect("a picture");
        let texel = texel_bytes(texture.format());
        let mapped = buffer.get_mapped_range(..).expect("mapped");
        for (line, texels) in (top..top + height).zip(mapped.chunks_exact(bytes_per_row as usize)) {
            let start = ((line * picture.0 + left) * texel) as usize;
            let count = (width * texel) as usize;
            picture.2[start..start + count].copy_from_slice(&texels[..count]);
        }
        drop(mapped);
        buffer.unmap();
    }
}
