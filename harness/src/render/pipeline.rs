//! The device's side of a render: pipelines, buffers and textures, and the two passes of a tile.

use super::camera::clip_from_world;
use super::{Environment, Picture, RenderError, Rung, SAMPLES, Settings, TILE, Tile};
use crate::cookbook;
use crate::dispatch::{self, DispatchError};
use crate::gpu::Gpu;
use crate::scene::{Bounds, Camera, Object, Scene};
use std::borrow::Cow;
use wgpu::util::DeviceExt as _;

/// Samples are kept in f32: radiance spans more than f16 holds exactly, and references are compared in linear light.
const SAMPLE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;
const ENCODED_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// One object's bind group and how many vertices to draw.
pub(super) struct Stone {
    bind_group: wgpu::BindGroup,
    vertices: u32,
}

/// Everything of a picture that its tiles share.
pub(super) struct Pipelines<'gpu> {
    gpu: &'gpu Gpu,
    gem: wgpu::RenderPipeline,
    display: wgpu::RenderPipeline,
    environment: wgpu::TextureView,
    targets: Targets,
}

/// Textures of one tile's size.
struct Targets {
    samples: wgpu::TextureView,
    depth: wgpu::TextureView,
    linear: wgpu::Texture,
    encoded: wgpu::Texture,
}

impl<'gpu> Pipelines<'gpu> {
    /// Compiles `source`, the composed gem recipe, and the display recipe for these settings.
    pub(super) fn new(gpu: &'gpu Gpu, source: &str, settings: &Settings) -> Result<Self, RenderError> {
        let flag = |on: bool| if on { 1.0 } else { 0.0 };
        let constants = [
            ("EFFECT_PROXY_GEOMETRY", flag(settings.rung == Rung::ProxyOne)),
            ("EFFECT_ENVIRONMENT_MAP", flag(matches!(settings.environment, Environment::Map(_)))),
            ("CENTRE_PAPER", flag(settings.paper_centre)),
        ];
        let gem = pipeline(gpu, "gem", source, &constants, &[SAMPLE_FORMAT], true)?;
        let display_source = cookbook::recipe_source("display");
        let constants = [("SAMPLES", f64::from(SAMPLES))];
        let display = pipeline(gpu, "display", &display_source, &constants, &[SAMPLE_FORMAT, ENCODED_FORMAT], false)?;
        let environment = environment_texture(gpu, &settings.environment)?;
        let targets = gpu.guarded("allocating a tile", Targets::new)?;
        Ok(Self { gpu, gem, display, environment, targets })
    }

    /// Sends the meshes to the device.
    pub(super) fn upload(&self, scene: &Scene) -> Result<Vec<Stone>, RenderError> {
        scene.objects.iter().map(|object| self.upload_object(object)).collect()
    }

    fn upload_object(&self, object: &Object) -> Result<Stone, RenderError> {
        let mesh = &object.mesh;
        let limits = self.gpu.device.limits();
        let limit = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
        let parts: [&[u8]; 3] = [
            bytemuck::cast_slice(&mesh.positions),
            bytemuck::cast_slice(&mesh.normals),
            bytemuck::cast_slice(&mesh.indices),
        ];
        if let Some(bytes) = parts.iter().map(|part| part.len() as u64).find(|bytes| *bytes > limit) {
            return Err(RenderError::TooLarge { what: format!("mesh `{}`", object.name), bytes, limit });
        }
        let vertices = u32::try_from(mesh.indices.len()).map_err(|_| RenderError::TooLarge {
            what: format!("mesh `{}`", object.name),
            bytes: parts[2].len() as u64,
            limit,
        })?;
        let color = object.material.base_color;
        let material: [f32; 4] = [color.x, color.y, color.z, object.material.ior];
        self.gpu
            .guarded("uploading a mesh", |device| {
                let storage = wgpu::BufferUsages::STORAGE;
                let buffer = |contents: &[u8], usage| {
                    device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: None, contents, usage })
                };
                let buffers = [
                    buffer(bytemuck::cast_slice(&material), wgpu::BufferUsages::UNIFORM),
                    buffer(parts[0], storage),
                    buffer(parts[1], storage),
                    buffer(parts[2], storage),
                ];
                let entries: Vec<wgpu::BindGroupEntry<'_>> = (0..)
                    .zip(&buffers)
                    .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
                    .collect();
                let bind_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
                    label: Some(&object.name),
                    layout: &self.gem.get_bind_group_layout(1),
                    entries: &entries,
                });
                Stone { bind_group, vertices }
            })
            .map_err(RenderError::from)
    }

    /// Renders one tile into the picture.
    pub(super) fn tile(
        &self,
        camera: &Camera,
        bounds: &Bounds,
        stones: &[Stone],
        settings: &Settings,
        tile: Tile,
        picture: &mut Picture,
    ) -> Result<(), RenderError> {
        let mut view = [0f32; 20];
        view[..16]
            .copy_from_slice(&clip_from_world(camera, bounds, settings.width, settings.height, tile).to_cols_array());
        view[16..19].copy_from_slice(&camera.eye.to_array());
        let frame: [f32; 6] =
            [tile.left as f32, tile.top as f32, settings.width as f32, settings.height as f32, settings.exposure, 0.0];
        let readback = self.gpu.guarded("rendering a tile", |device| {
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            let view = self.uniform_and_texture(&self.gem, bytemuck::cast_slice(&view), &self.environment);
            self.draw_stones(&mut encoder, tile, &view, stones);
            let frame = self.uniform_and_texture(&self.display, bytemuck::cast_slice(&frame), &self.targets.samples);
            self.draw_display(&mut encoder, tile, &frame);
            let linear = self.copy_out(&mut encoder, &self.targets.linear, 16, tile);
            let encoded = self.copy_out(&mut encoder, &self.targets.encoded, 4, tile);
            self.gpu.queue.submit([encoder.finish()]);
            [linear, encoded]
        })?;
        let width = picture.width as usize;
        let [linear, encoded] = readback;
        linear.read(self.gpu, tile, |row, bytes| {
            let start = (tile.top as usize + row) * width + tile.left as usize;
            for (pixel, bytes) in picture.linear[start..].iter_mut().zip(bytes.chunks_exact(16)) {
                *pixel = bytemuck::pod_read_unaligned(bytes);
            }
        })?;
        encoded.read(self.gpu, tile, |row, bytes| {
            let start = (tile.top as usize + row) * width + tile.left as usize;
            for (pixel, bytes) in picture.encoded[start..].iter_mut().zip(bytes.chunks_exact(4)) {
                *pixel = bytemuck::pod_read_unaligned(bytes);
            }
        })?;
        Ok(())
    }

    fn uniform_and_texture(
        &self,
        pipeline: &wgpu::RenderPipeline,
        uniform: &[u8],
        texture: &wgpu::TextureView,
    ) -> wgpu::BindGroup {
        let device = &self.gpu.device;
        // Uniform structs are padded to 16 bytes.
        let mut contents = uniform.to_vec();
        contents.resize(uniform.len().next_multiple_of(16), 0);
        let buffer = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: None,
            contents: &contents,
            usage: wgpu::BufferUsages::UNIFORM,
        });
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(texture) },
            ],
        })
    }

    fn draw_stones(&self, encoder: &mut wgpu::CommandEncoder, tile: Tile, view: &wgpu::BindGroup, stones: &[Stone]) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("gem"),
            color_attachments: &[Some(cleared(&self.targets.samples))],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.targets.depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store: wgpu::StoreOp::Discard }),
                stencil_ops: None,
            }),
            ..wgpu::RenderPassDescriptor::default()
        });
        pass.set_viewport(0.0, 0.0, (tile.width * SAMPLES) as f32, (tile.height * SAMPLES) as f32, 0.0, 1.0);
        pass.set_pipeline(&self.gem);
        pass.set_bind_group(0, view, &[]);
        for stone in stones {
            pass.set_bind_group(1, &stone.bind_group, &[]);
            pass.draw(0..stone.vertices, 0..1);
        }
    }

    fn draw_display(&self, encoder: &mut wgpu::CommandEncoder, tile: Tile, frame: &wgpu::BindGroup) {
        let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let (linear, encoded) = (view(&self.targets.linear), view(&self.targets.encoded));
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("display"),
            color_attachments: &[Some(cleared(&linear)), Some(cleared(&encoded))],
            ..wgpu::RenderPassDescriptor::default()
        });
        pass.set_viewport(0.0, 0.0, tile.width as f32, tile.height as f32, 0.0, 1.0);
        pass.set_pipeline(&self.display);
        pass.set_bind_group(0, frame, &[]);
        pass.draw(0..3, 0..1);
    }

    /// Copies the tile's part of `texture` to a new buffer that can be mapped.
    fn copy_out(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        texture: &wgpu::Texture,
        pixel_bytes: u32,
        tile: Tile,
    ) -> Readback {
        let row_bytes = (tile.width * pixel_bytes).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = self.gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("tile"),
            size: u64::from(row_bytes) * u64::from(tile.height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        encoder.copy_texture_to_buffer(
            texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(row_bytes),
                    rows_per_image: Some(tile.height),
                },
            },
            wgpu::Extent3d { width: tile.width, height: tile.height, depth_or_array_layers: 1 },
        );
        Readback { buffer, row_bytes: row_bytes as usize, used_bytes: (tile.width * pixel_bytes) as usize }
    }
}

/// A tile's rows on their way back.
struct Readback {
    buffer: wgpu::Buffer,
    row_bytes: usize,
    used_bytes: usize,
}

impl Readback {
    fn read(&self, gpu: &Gpu, tile: Tile, mut row: impl FnMut(usize, &[u8])) -> Result<(), RenderError> {
        let size = self.row_bytes as u64 * u64::from(tile.height);
        gpu.read_back(&self.buffer, size, |bytes| {
            for (index, bytes) in bytes.chunks_exact(self.row_bytes).enumerate() {
                row(index, &bytes[..self.used_bytes]);
            }
        })?;
        Ok(())
    }
}

impl Targets {
    fn new(device: &wgpu::Device) -> Targets {
        let texture = |side: u32, format, usage| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d { width: side, height: side, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | usage,
                view_formats: &[],
            })
        };
        let view = |texture: wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        use wgpu::TextureUsages as Usage;
        Targets {
            samples: view(texture(TILE * SAMPLES, SAMPLE_FORMAT, Usage::TEXTURE_BINDING)),
            depth: view(texture(TILE * SAMPLES, DEPTH_FORMAT, Usage::empty())),
            linear: texture(TILE, SAMPLE_FORMAT, Usage::COPY_SRC),
            encoded: texture(TILE, ENCODED_FORMAT, Usage::COPY_SRC),
        }
    }
}

fn cleared(view: &wgpu::TextureView) -> wgpu::RenderPassColorAttachment<'_> {
    wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT), store: wgpu::StoreOp::Store },
    }
}

/// A pipeline from the entry points `<name>_vertex` and `<name>_fragment` of `source`.
fn pipeline(
    gpu: &Gpu,
    name: &str,
    source: &str,
    constants: &[(&str, f64)],
    formats: &[wgpu::TextureFormat],
    depth: bool,
) -> Result<wgpu::RenderPipeline, RenderError> {
    let (module, _) = dispatch::parse(source, &format!("recipe {name}"))?;
    // A constant that the text does not declare is an error to wgpu; a user's recipe may have left one out.
    let declared = |key: &str| module.overrides.iter().any(|(_, o)| o.name.as_deref() == Some(key));
    let constants: Vec<(&str, f64)> = constants.iter().copied().filter(|(key, _)| declared(key)).collect();
    for suffix in ["vertex", "fragment"] {
        let entry = format!("{name}_{suffix}");
        if !module.entry_points.iter().any(|point| point.name == entry) {
            return Err(DispatchError::Source(format!("recipe {name}: no entry point `{entry}`")).into());
        }
    }
    let pipeline = gpu.guarded(&format!("compiling recipe `{name}`"), |device| {
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(name),
            source: wgpu::ShaderSource::Naga(Cow::Owned(module)),
        });
        let targets: Vec<Option<wgpu::ColorTargetState>> =
            formats.iter().map(|format| Some((*format).into())).collect();
        let compilation_options = || wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() };
        let primitive = wgpu::PrimitiveState {
            // A closed stone shows its front; the display's one triangle has no back to speak of.
            cull_mode: depth.then_some(wgpu::Face::Back),
            ..wgpu::PrimitiveState::default()
        };
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(name),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some(&format!("{name}_vertex")),
                compilation_options: compilation_options(),
                buffers: &[],
            },
            primitive,
            depth_stencil: depth.then(|| wgpu::DepthStencilState {
                format: DEPTH_FORMAT,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Less),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some(&format!("{name}_fragment")),
                compilation_options: compilation_options(),
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    })?;
    Ok(pipeline)
}

/// The environment map as a texture; one black texel where the studio stands in.
fn environment_texture(gpu: &Gpu, environment: &Environment) -> Result<wgpu::TextureView, RenderError> {
    let black = [[0f32; 4]];
    let (width, height, pixels): (u32, u32, &[[f32; 4]]) = match environment {
        Environment::Studio => (1, 1, &black),
        Environment::Map(map) => (map.width, map.height, &map.pixels),
    };
    let limit = gpu.device.limits().max_texture_dimension_2d;
    if width.max(height) > limit {
        let bytes = std::mem::size_of_val(pixels) as u64;
        let what = format!("an environment map of {width}x{height} (at most {limit} a side)");
        return Err(RenderError::TooLarge { what, bytes, limit: u64::from(limit) * u64::from(limit) * 16 });
    }
    let texture = gpu.guarded("uploading the environment", |device| {
        device.create_texture_with_data(
            &gpu.queue,
            &wgpu::TextureDescriptor {
                label: Some("environment"),
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: wgpu::TextureFormat::Rgba32Float,
                usage: wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            },
            wgpu::util::TextureDataOrder::LayerMajor,
            bytemuck::cast_slice(pixels),
        )
    })?;
    Ok(texture.create_view(&wgpu::TextureViewDescriptor::default()))
}
