//! The stone on a device: the recipe `gem_walk` into a float texture, then a display pass of our own.

use crate::stone::{Material, Stone};
use encase::internal::WriteInto;
use encase::{ShaderType, StorageBuffer};
use glam::camera::rh::proj::directx::perspective_infinite;
use glam::{Mat4, Vec3};
use std::error::Error;
use wgpu::util::DeviceExt as _;

/// Samples along each side of a pixel. A stone's glints are small and bright: 16 a pixel show them.
const SAMPLES: u32 = 4;
/// Internal hits that are followed: rung walk-8+tracker, the recommended one.
const BOUNCES: u32 = 8;
/// Radiance is linear and not bounded by 1.
const RADIANCE: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;
/// The shader encodes sRGB itself, so the target must not do so again.
const ENCODED: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Bytes of a pixel of `ENCODED`.
const PIXEL: u32 = 4;

/// `GemView` of the recipe. encase lays fields out as WGSL does, so that these structs need no padding.
#[derive(ShaderType)]
struct GemView {
    clip_from_world: Mat4,
    eye: Vec3,
}

/// `GemMaterial` of the recipe.
#[derive(ShaderType)]
struct GemMaterial {
    base_color: Vec3,
    index: f32,
    absorption: Vec3,
    distance_limit: f32,
    channel_indices: Vec3,
    dispersion_strength: f32,
    throughput_limit: f32,
}

/// `GemStone` of the recipe.
#[derive(ShaderType)]
struct GemStone {
    centre: Vec3,
    side: u32,
    lower: Vec3,
    upper: Vec3,
}

impl GemMaterial {
    fn of(material: &Material) -> Self {
        let &Material { base_color, index, channel_indices, absorption } = material;
        // The limits are read by LIMIT_DISTANCE and LIMIT_THROUGHPUT, the strength by the paper's tracker
        // (DISPERSION_FORM 0): all off.
        let (distance_limit, throughput_limit, dispersion_strength) = (f32::MAX, 0.0, 1.0);
        Self { base_color, index, absorption, distance_limit, channel_indices, dispersion_strength, throughput_limit }
    }
}

/// A device, and how to make things on it.
struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
}

impl Gpu {
    async fn open() -> Result<Self, Box<dyn Error>> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
        let adapter = match std::env::var("WGPU_ADAPTER_NAME") {
            Err(_) => instance.request_adapter(&wgpu::RequestAdapterOptions::default()).await?,
            Ok(name) => {
                let mut adapters = instance.enumerate_adapters(wgpu::Backends::all()).await.into_iter();
                let named =
                    |adapter: &wgpu::Adapter| adapter.get_info().name.to_lowercase().contains(&name.to_lowercase());
                adapters
                    .find(named)
                    .ok_or_else(|| format!("no adapter has `{name}` in its name (WGPU_ADAPTER_NAME)"))?
            }
        };
        println!("adapter: {}", adapter.get_info().name);
        // WebGPU's default limits, and no features: the recipe needs nothing else.
        let (device, queue) = adapter.request_device(&wgpu::DeviceDescriptor::default()).await?;
        Ok(Self { device, queue })
    }

    /// A buffer that holds `value` as WGSL lays it out.
    fn buffer<T: ShaderType + WriteInto>(&self, label: &str, usage: wgpu::BufferUsages, value: &T) -> wgpu::Buffer {
        let mut bytes = StorageBuffer::new(Vec::new());
        bytes.write(value).expect("memory grows as needed");
        let contents = &bytes.into_inner();
        self.device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some(label), contents, usage })
    }

    fn texture(
        &self,
        label: &str,
        format: wgpu::TextureFormat,
        size: u32,
        usage: wgpu::TextureUsages,
    ) -> wgpu::Texture {
        self.device.create_texture(&wgpu::TextureDescriptor {
            label: Some(label),
            size: wgpu::Extent3d { width: size, height: size, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        })
    }

    /// A pipeline without vertex buffers, of the entry points `NAME_vertex` and `NAME_fragment`, with
    /// overrides set and the layout that wgpu derives from the shader.
    fn pipeline(
        &self,
        name: &str,
        wgsl: String,
        constants: &[(&str, f64)],
        (target, depth): (wgpu::TextureFormat, Option<wgpu::TextureFormat>),
    ) -> wgpu::RenderPipeline {
        let source = wgpu::ShaderSource::Wgsl(wgsl.into());
        let module = self.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some(name), source });
        let options = || wgpu::PipelineCompilationOptions { constants, ..Default::default() };
        self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(name),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some(&format!("{name}_vertex")),
                compilation_options: options(),
                buffers: &[],
            },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some(&format!("{name}_fragment")),
                compilation_options: options(),
                targets: &[Some(target.into())],
            }),
            // A ray that enters by a back face would start outside the stone.
            primitive: wgpu::PrimitiveState { cull_mode: depth.map(|_| wgpu::Face::Back), ..Default::default() },
            depth_stencil: depth.map(|format| wgpu::DepthStencilState {
                format,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Less),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: Default::default(),
            multiview_mask: None,
            cache: None,
        })
    }

    fn bind<const N: usize>(
        &self,
        pipeline: &wgpu::RenderPipeline,
        group: u32,
        entries: [(u32, wgpu::BindingResource<'_>); N],
    ) -> wgpu::BindGroup {
        let entries = entries.map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource });
        let layout = &pipeline.get_bind_group_layout(group);
        self.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
    }

    /// Waits for a buffer that is being written, and returns what it holds.
    fn read(&self, buffer: &wgpu::Buffer) -> Result<Vec<u8>, Box<dyn Error>> {
        buffer.map_async(wgpu::MapMode::Read, .., |_| {});
        self.device.poll(wgpu::PollType::wait_indefinitely())?;
        Ok(buffer.get_mapped_range(..)?.to_vec())
    }
}

/// Returns the picture of a stone, `size` pixels along each side: sRGB, row by row from the top.
pub async fn draw(stone: &Stone, size: u32) -> Result<Vec<u8>, Box<dyn Error>> {
    let gpu = Gpu::open().await?;
    let camera = &stone.camera;
    let projection = perspective_infinite(camera.vertical_fov, 1.0, camera.near);
    let view = GemView {
        clip_from_world: projection * camera.world_from_camera.inverse(),
        eye: camera.world_from_camera.w_axis.truncate(),
    };
    let map = &stone.map;
    let place = GemStone { centre: stone.centre, side: map.side, lower: map.lower, upper: map.upper };
    let corners: Vec<f32> = stone.positions.iter().flat_map(|position| position.to_array()).collect();

    // Effects are off unless they are asked for, except for EFFECT_CONVEX_TRACE, the inside.
    let material = &stone.material;
    let on = |effect: bool| f64::from(u8::from(effect));
    let overrides = [
        ("BOUNCES", f64::from(BOUNCES)),
        ("EFFECT_ABSORPTION", on(material.absorption != Vec3::ZERO)),
        ("EFFECT_DISPERSION", on(material.channel_indices != Vec3::splat(material.index))),
    ];
    let recipe = lapidary_wgsl::recipe("gem_walk").ok_or("lapidary-wgsl has no recipe gem_walk")?;
    let gem = gpu.pipeline("gem", recipe.compose(), &overrides, (RADIANCE, Some(DEPTH)));

    let storage = wgpu::BufferUsages::STORAGE;
    let view = gpu.buffer("view", wgpu::BufferUsages::UNIFORM, &view);
    let material = gpu.buffer("material", storage, &GemMaterial::of(material));
    let positions = gpu.buffer("positions", storage, &corners);
    let indices = gpu.buffer("indices", storage, &stone.indices);
    let planes = gpu.buffer("planes", storage, &stone.planes);
    let face_of_triangle = gpu.buffer("face of triangle", storage, &stone.face_of_triangle);
    let facet_map = gpu.buffer("facet map", storage, &map.words);
    let place = gpu.buffer("stone", storage, &place);
    // A pipeline needs something at every binding that the shader declares and uses, even under an
    // override that is off. 256 zeros are enough for each.
    let zeros = gpu.buffer("nothing", storage | wgpu::BufferUsages::UNIFORM, &[0u32; 64]);
    let sampled = wgpu::TextureUsages::TEXTURE_BINDING;
    let black = gpu.texture("nothing", RADIANCE, 1, sampled).create_view(&Default::default());
    let far = gpu.texture("nothing", DEPTH, 1, sampled).create_view(&Default::default());
    let black = wgpu::BindingResource::TextureView(&black);
    let groups = [
        gpu.bind(
            &gem,
            0,
            [
                (0, view.as_entire_binding()),
                (1, black.clone()),                            // environment_map
                (6, zeros.as_entire_binding()),                // screen
                (7, black),                                    // screen_radiance
                (8, wgpu::BindingResource::TextureView(&far)), // screen_depth
                (9, zeros.as_entire_binding()),                // bodies
            ],
        ),
        gpu.bind(
            &gem,
            1,
            [
                (0, material.as_entire_binding()),
                (1, positions.as_entire_binding()),
                (2, indices.as_entire_binding()),
                (3, zeros.as_entire_binding()), // wavelengths
                (4, zeros.as_entire_binding()), // instances
            ],
        ),
        gpu.bind(
            &gem,
            2,
            [
                (0, planes.as_entire_binding()),
                (1, face_of_triangle.as_entire_binding()),
                (2, facet_map.as_entire_binding()),
                (3, place.as_entire_binding()),
            ],
        ),
    ];

    // A shader of our own behind a module of the cookbook.
    let wgsl = lapidary_wgsl::compose(&["srgb"], include_str!("display.wgsl"));
    let display = gpu.pipeline("display", wgsl, &[("SAMPLES", f64::from(SAMPLES))], (ENCODED, None));
    let drawn = wgpu::TextureUsages::RENDER_ATTACHMENT;
    let samples = gpu.texture("samples", RADIANCE, size * SAMPLES, drawn | sampled).create_view(&Default::default());
    let depth = gpu.texture("depth", DEPTH, size * SAMPLES, drawn).create_view(&Default::default());
    let picture = gpu.texture("picture", ENCODED, size, drawn | wgpu::TextureUsages::COPY_SRC);
    let shown = picture.create_view(&Default::default());
    let sources = gpu.bind(&display, 0, [(0, wgpu::BindingResource::TextureView(&samples))]);

    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(cleared(&samples))],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store: wgpu::StoreOp::Discard }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(&gem);
        for (group, number) in groups.iter().zip(0..) {
            pass.set_bind_group(number, group, &[]);
        }
        // Not indexed: the recipe reads the indices itself, since each vertex needs its own triangle.
        pass.draw(0..stone.indices.len() as u32, 0..1);
    }
    {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(cleared(&shown))],
            ..Default::default()
        });
        pass.set_pipeline(&display);
        pass.set_bind_group(0, &sources, &[]);
        pass.draw(0..3, 0..1);
    }
    let read = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("picture to read"),
        size: u64::from(size * size * PIXEL),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(size * PIXEL), rows_per_image: None };
    let target = wgpu::TexelCopyBufferInfo { buffer: &read, layout };
    encoder.copy_texture_to_buffer(picture.as_image_copy(), target, picture.size());
    gpu.queue.submit([encoder.finish()]);
    gpu.read(&read)
}

fn cleared(view: &wgpu::TextureView) -> wgpu::RenderPassColorAttachment<'_> {
    // Alpha 0: the display pass puts its backdrop there.
    let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT), store: wgpu::StoreOp::Store };
    wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops }
}
