//! Curvature in use: from dpdx and dpdy, on meshes with smooth normals, drawn by the device. The
//! expected values are closed forms.

use glam::camera::rh;
use glam::{DVec3, Vec3};
use lapidary_cookbook as cookbook;
use lapidary_gpu::Gpu;
use wgpu::util::DeviceExt as _;

/// Side of the picture in pixels.
const SIZE: u32 = 256;
/// Quads of the mesh, around and along.
const AROUND: u32 = 512;

/// Draws position and curvatures. Scaling and interpolation leave the normals at any length.
const SHADER: &str = "
struct View {
    clip_from_world: mat4x4f,
    eye: vec4f,
    axes: vec4f,
}

@group(0) @binding(0) var<uniform> view: View;

struct Surface {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
}

struct Answer {
    @location(0) curvature: vec4f,
    @location(1) position: vec4f,
}

@vertex
fn vertex(@location(0) position: vec3f, @location(1) normal: vec3f) -> Surface {
    let world = view.axes.xyz * position;
    return Surface(view.clip_from_world * vec4f(world, 1.0f), world - view.eye.xyz, normal / view.axes.xyz);
}

@fragment
fn fragment(surface: Surface) -> Answer {
    let p_x = dpdx(surface.position);
    let p_y = dpdy(surface.position);
    let normal = normalize(surface.normal);
    let n_x = dpdx(normal);
    let n_y = dpdy(normal);
    let projected_x = curvature_normal_derivative(surface.normal, dpdx(surface.normal));
    let projected_y = curvature_normal_derivative(surface.normal, dpdy(surface.normal));
    let curvature = vec4f(
        curvature_mean(p_x, p_y, n_x, n_y),
        curvature_mean(p_x, p_y, projected_x, projected_y),
        curvature_gaussian(p_x, p_y, n_x, n_y),
        curvature_naive(p_x, p_y, n_x, n_y),
    );
    return Answer(curvature, vec4f(surface.position, -dot(normal, normalize(surface.position))));
}
";

/// A test surface: a mesh, its scale, and its curvatures in closed form.
struct Shape {
    name: &'static str,
    /// Position and normal at two angles.
    at: fn(f64, f64) -> (DVec3, DVec3),
    axes: Vec3,
    /// Mean and Gaussian curvature at a point.
    known: fn(DVec3) -> (f64, f64),
}

const TORUS: (f64, f64) = (0.7, 0.3);
const AXES: DVec3 = DVec3::new(1.0, 0.5, 0.75);

fn ball(around: f64, along: f64) -> (DVec3, DVec3) {
    let polar = 0.5 * along;
    let point = DVec3::new(polar.sin() * around.cos(), polar.sin() * around.sin(), polar.cos());
    (point, point)
}

fn torus(around: f64, along: f64) -> (DVec3, DVec3) {
    let outward = DVec3::new(around.cos(), around.sin(), 0.0);
    let normal = along.cos() * outward + along.sin() * DVec3::Z;
    (TORUS.0 * outward + TORUS.1 * normal, normal)
}

const SHAPES: [Shape; 3] = [
    Shape { name: "sphere", at: ball, axes: Vec3::ONE, known: |_| (1.0, 1.0) },
    Shape {
        name: "torus",
        at: torus,
        axes: Vec3::ONE,
        known: |p| {
            let outer = 1.0 - TORUS.0 / p.x.hypot(p.y);
            (0.5 * (1.0 + outer) / TORUS.1, outer / (TORUS.1 * TORUS.1))
        },
    },
    // A sphere under a non-uniform scale.
    Shape {
        name: "ellipsoid",
        at: ball,
        axes: Vec3::new(1.0, 0.5, 0.75),
        known: |p| {
            let volume = AXES.x * AXES.y * AXES.z;
            let height = (p / (AXES * AXES)).length_squared();
            let mean = (AXES.length_squared() - p.length_squared()) / (2.0 * volume * volume * height.powf(1.5));
            (mean, 1.0 / (volume * height).powi(2))
        },
    },
];

/// Returns triangles as position and normal at each corner.
fn mesh(surface: fn(f64, f64) -> (DVec3, DVec3)) -> Vec<[f32; 6]> {
    let corner = |i: u32, j: u32| {
        let turn = std::f64::consts::TAU / f64::from(AROUND);
        let (position, normal) = surface(turn * f64::from(i), turn * f64::from(j));
        let (p, n) = (position.as_vec3(), normal.as_vec3());
        [p.x, p.y, p.z, n.x, n.y, n.z]
    };
    let quads = (0..AROUND).flat_map(|i| (0..AROUND).map(move |j| (i, j)));
    quads
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
            [a, b, c, a, c, d]
        })
        .collect()
}

/// A pixel of the surface.
struct Pixel {
    position: DVec3,
    /// Cosine of the angle between the normal and the line of sight.
    cosine: f64,
    /// Mean curvature from differences of unit normals, and from projected normal derivatives.
    mean: [f64; 2],
    gaussian: f64,
    naive: f64,
}

/// Draws a mesh from `eye`, looking at the origin.
fn draw(gpu: &Gpu, mesh: &[[f32; 6]], axes: Vec3, eye: Vec3) -> Vec<Pixel> {
    let module = cookbook::module("curvature").expect("the module");
    let clip_from_view = rh::proj::directx::perspective(0.6, 1.0, 1.0, 10.0);
    let clip_from_world = clip_from_view * rh::view::look_at_mat4(eye, Vec3::ZERO, Vec3::new(0.3, 1.0, 0.2));
    let mut view: Vec<f32> = clip_from_world.to_cols_array().to_vec();
    view.extend([eye.x, eye.y, eye.z, 0.0, axes.x, axes.y, axes.z, 0.0]);
    let bytes_of = |numbers: &[f32]| numbers.iter().flat_map(|number| number.to_le_bytes()).collect::<Vec<u8>>();
    let row = SIZE * 16;
    let (queue, format) = (&gpu.queue, wgpu::TextureFormat::Rgba32Float);
    let buffers = gpu
        .guarded("drawing curvatures", |device| {
            let buffer = |contents: &[u8], usage| {
                device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: None, contents, usage })
            };
            let vertices = buffer(&bytes_of(mesh.as_flattened()), wgpu::BufferUsages::VERTEX);
            let view = buffer(&bytes_of(&view), wgpu::BufferUsages::UNIFORM);
            let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some("curvature"),
                source: wgpu::ShaderSource::Wgsl(format!("{}{SHADER}", module.whole).into()),
            });
            let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some("curvature"),
                layout: None,
                vertex: wgpu::VertexState {
                    module: &shader,
                    entry_point: Some("vertex"),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    buffers: &[Some(wgpu::VertexBufferLayout {
                        array_stride: 24,
                        step_mode: wgpu::VertexStepMode::Vertex,
                        attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3],
                    })],
                },
                primitive: wgpu::PrimitiveState::default(),
                depth_stencil: Some(wgpu::DepthStencilState {
                    format: wgpu::TextureFormat::Depth32Float,
                    depth_write_enabled: Some(true),
                    depth_compare: Some(wgpu::CompareFunction::Less),
                    stencil: wgpu::StencilState::default(),
                    bias: wgpu::DepthBiasState::default(),
                }),
                multisample: wgpu::MultisampleState::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &shader,
                    entry_point: Some("fragment"),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    targets: &[Some(format.into()), Some(format.into())],
                }),
                multiview_mask: None,
                cache: None,
            });
            let texture = |format, usage| {
                device.create_texture(&wgpu::TextureDescriptor {
                    label: None,
                    size: wgpu::Extent3d { width: SIZE, height: SIZE, depth_or_array_layers: 1 },
                    mip_level_count: 1,
                    sample_count: 1,
                    dimension: wgpu::TextureDimension::D2,
                    format,
                    usage: usage | wgpu::TextureUsages::RENDER_ATTACHMENT,
                    view_formats: &[],
                })
            };
            let targets = [(); 2].map(|()| texture(format, wgpu::TextureUsages::COPY_SRC));
            let views = targets.each_ref().map(|target| target.create_view(&wgpu::TextureViewDescriptor::default()));
            let depth = texture(wgpu::TextureFormat::Depth32Float, wgpu::TextureUsages::empty())
                .create_view(&wgpu::TextureViewDescriptor::default());
            let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout: &pipeline.get_bind_group_layout(0),
                entries: &[wgpu::BindGroupEntry { binding: 0, resource: view.as_entire_binding() }],
            });
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            {
                let operations = wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                };
                let attachments = views.each_ref().map(|view| {
                    Some(wgpu::RenderPassColorAttachment {
                        view,
                        depth_slice: None,
                        resolve_target: None,
                        ops: operations,
                    })
                });
                let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                    label: None,
                    color_attachments: &attachments,
                    depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                        view: &depth,
                        depth_ops: Some(wgpu::Operations {
                            load: wgpu::LoadOp::Clear(1.0),
                            store: wgpu::StoreOp::Discard,
                        }),
                        stencil_ops: None,
                    }),
                    ..wgpu::RenderPassDescriptor::default()
                });
                pass.set_pipeline(&pipeline);
                pass.set_bind_group(0, &group, &[]);
                pass.set_vertex_buffer(0, vertices.slice(..));
                pass.draw(0..mesh.len() as u32, 0..1);
            }
            let buffers = [(); 2].map(|()| {
                device.create_buffer(&wgpu::BufferDescriptor {
                    label: None,
                    size: u64::from(row * SIZE),
                    usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
                    mapped_at_creation: false,
                })
            });
            for (target, buffer) in targets.iter().zip(&buffers) {
                encoder.copy_texture_to_buffer(
                    target.as_image_copy(),
                    wgpu::TexelCopyBufferInfo {
                        buffer,
                        layout: wgpu::TexelCopyBufferLayout {
                            offset: 0,
                            bytes_per_row: Some(row),
                            rows_per_image: None,
                        },
                    },
                    target.size(),
                );
            }
            queue.submit([encoder.finish()]);
            buffers
        })
        .expect("drawn");
    let [curvature, position] = buffers.map(|buffer| {
        let read = |bytes: &[u8]| {
            let numbers = bytes.chunks_exact(4).map(|word| f32::from_le_bytes(word.try_into().expect("four bytes")));
            numbers.map(f64::from).collect::<Vec<f64>>()
        };
        gpu.read_back(&buffer, u64::from(row * SIZE), read).expect("read back")
    });
    assert!(curvature.iter().all(|number| number.is_finite()), "silhouettes and all");
    let pixels = curvature.chunks_exact(4).zip(position.chunks_exact(4)).filter(|(_, place)| place[3] != 0.0);
    pixels
        .map(|(found, place)| Pixel {
            position: DVec3::new(place[0], place[1], place[2]) + eye.as_dvec3(),
            cosine: place[3],
            mean: [found[0], found[1]],
            gaussian: found[2],
            naive: found[3],
        })
        .collect()
}

/// Returns the value that `share` of the values do not exceed.
fn quantile(values: &mut [f64], share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    values[((values.len() - 1) as f64 * share) as usize]
}

#[test]
fn meshes_have_the_curvature_of_their_surfaces_from_every_side() {
    for shape in SHAPES {
        let mesh = mesh(shape.at);
        for eye in [Vec3::new(0.0, 0.0, 4.0), Vec3::new(3.0, 1.0, 2.0), Vec3::new(-1.0, 3.5, 0.5)] {
            let pixels = draw(lapidary_testing::gpu(), &mesh, shape.axes, eye);
            assert!(pixels.len() > 4000, "{}: {} pixels", shape.name, pixels.len());
            let mut errors = [const { Vec::new() }; 4];
            for pixel in pixels.iter().filter(|pixel| pixel.cosine > 0.25) {
                let (mean, gaussian) = (shape.known)(pixel.position);
                let largest = mean.abs() + (mean * mean - gaussian).max(0.0).sqrt();
                errors[0].push((pixel.mean[0] - mean).abs() / largest);
                errors[1].push((pixel.mean[1] - mean).abs() / largest);
                errors[2].push((pixel.gaussian - gaussian).abs() / (largest * largest));
                errors[3].push((pixel.naive - mean.abs()).abs() / largest);
            }
            let summary = errors.each_mut().map(|errors| [0.5, 0.99, 1.0].map(|share| quantile(errors, share)));
            println!("{} from {eye}: median, 99 %, worst of {}: {summary:.4?}", shape.name, errors[0].len());
            let [differenced, projected, gaussian, usual] = summary;
            // A pixel is 0.01 wide, and up to 0.04 long at this cosine. The bounds are the
            // first-order change of a curvature of up to 1/0.3 over that length.
            assert!(differenced[0] <= 0.005 && differenced[2] <= 0.04, "{} {differenced:?}", shape.name);
            assert!(gaussian[0] <= 0.005 && gaussian[2] <= 0.06, "{} {gaussian:?}", shape.name);
            assert!(projected[0] <= 0.001 && projected[2] <= 0.006, "{} {projected:?}", shape.name);
            assert_eq!(usual[1] > 0.2, shape.name != "sphere", "{} {usual:?}", shape.name);
            // Silhouettes: still at most a few times the largest curvature of the surface.
            let most = pixels.iter().map(|pixel| pixel.mean[0].abs().max(pixel.mean[1].abs())).fold(0.0, f64::max);
            println!("    at most {most:.2}");
            assert!(most < 10.0, "{} {most}", shape.name);
        }
    }
}
