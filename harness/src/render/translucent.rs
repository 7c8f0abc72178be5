//! The recipe `cdrf_shading`'s pass: what scatters light, under the scene's lights and the environment.

use super::device::{self, PipelineSource, bind_group, buffer, mesh_vertices, uniform};
use super::pass::{Body, DEPTH_FORMAT, SAMPLE_FORMAT, ScenePass, Shared};
use super::{Curvature, Environment, Reflectance, RenderError, Settings, harmonics};
use crate::cdrf::table::{self, Format};
use crate::gpu::Gpu;
use crate::scene::curvatures::vertex_curvatures;
use crate::scene::{Light, Material, Object, Scene};
use glam::{UVec2, Vec3};
use wgpu::util::DeviceExt as _;

/// Compiles `source`, the composed recipe, and uploads the scene.
pub(super) fn pass<'gpu>(
    gpu: &'gpu Gpu,
    scene: &Scene,
    settings: &Settings,
    reflectance: Reflectance,
    source: &str,
) -> Result<ScenePass<'gpu>, RenderError> {
    for Object { name, material, .. } in &scene.objects {
        if material.sigma0.is_none() {
            return Err(RenderError::NoSigma0 {
                object: name.clone(),
                material: material.name.clone(),
                rung: settings.rung,
            });
        }
    }
    let pipeline = device::pipeline(
        gpu,
        &PipelineSource {
            recipe: settings.rung.recipe(),
            source,
            entries: ["cdrf_vertex", "cdrf_fragment"],
            constants: &constants(scene, settings, reflectance),
            formats: &[SAMPLE_FORMAT],
            depth: Some(DEPTH_FORMAT),
        },
    )?;
    let environment = super::environment::texture(gpu, &settings.environment)?;
    let coefficients = if settings.light_from_environment {
        harmonics::project(&settings.environment)
    } else {
        [glam::DVec3::ZERO; harmonics::COUNT]
    };
    let coefficients: Vec<f32> =
        coefficients.iter().flat_map(|coefficient| coefficient.as_vec3().extend(0.0).to_array()).collect();
    let [lights, coefficients] = gpu.guarded("uploading lights", |device| {
        let lights = buffer(device, bytemuck::cast_slice(&lights(scene)), wgpu::BufferUsages::STORAGE);
        [lights, uniform(device, &coefficients)]
    })?;
    let shared = vec![Shared::Texture(environment), Shared::Buffer(lights), Shared::Buffer(coefficients)];
    let bodies: Result<Vec<Body>, RenderError> =
        scene.objects.iter().map(|object| upload(gpu, &pipeline, object, settings, reflectance)).collect();
    Ok(ScenePass { gpu, pipeline, shared, bodies: bodies? })
}

/// The overrides of the recipe for these settings.
fn constants(scene: &Scene, settings: &Settings, reflectance: Reflectance) -> Vec<(&'static str, f64)> {
    let flag = |on: bool| f64::from(u8::from(on));
    let materials = || scene.objects.iter().map(|object| &object.material);
    let scatters = materials().any(|material| material.sigma0.is_some_and(|sigma0| sigma0 != Vec3::ZERO));
    let polished = materials().any(|material| material.roughness == 0.0 && material.ior > 1.0);
    vec![
        ("EFFECT_CDRF", flag(scatters && reflectance != Reflectance::Lambert)),
        ("CDRF_FORM", f64::from(reflectance.form().unwrap_or_default())),
        ("CURVATURE_FORM", f64::from(settings.curvature.form())),
        ("EFFECT_ENVIRONMENT", flag(settings.light_from_environment)),
        ("ENVIRONMENT_AT_VERTICES", flag(settings.environment_at_vertices)),
        ("EFFECT_REFLECTION", flag(settings.reflection && polished)),
        ("EFFECT_ENVIRONMENT_MAP", flag(matches!(settings.environment, Environment::Map(_)))),
    ]
}

/// `Light` of the recipe, 8 floats each; one black light where there is none.
fn lights(scene: &Scene) -> Vec<f32> {
    let entry =
        |place: Vec3, point: f32, power: Vec3| [place.x, place.y, place.z, point, power.x, power.y, power.z, 0.0];
    let mut entries: Vec<[f32; 8]> = scene
        .lights
        .iter()
        .map(|light| match *light {
            Light::Directional { toward, irradiance } => entry(toward, 0.0, irradiance),
            Light::Point { position, intensity } => entry(position, 1.0, intensity),
        })
        .collect();
    if entries.is_empty() {
        entries.push(entry(Vec3::Y, 0.0, Vec3::ZERO));
    }
    entries.concat()
}

/// Sends an object to the device.
fn upload(
    gpu: &Gpu,
    pipeline: &wgpu::RenderPipeline,
    object: &Object,
    settings: &Settings,
    reflectance: Reflectance,
) -> Result<Body, RenderError> {
    let Object { mesh, material, .. } = object;
    let curvatures = if settings.curvature == Curvature::Vertex { vertex_curvatures(mesh) } else { vec![0.0] };
    let parts: [&[u8]; 4] = [
        bytemuck::cast_slice(&mesh.positions),
        bytemuck::cast_slice(&mesh.indices),
        bytemuck::cast_slice(&mesh.normals),
        bytemuck::cast_slice(&curvatures),
    ];
    let vertices = mesh_vertices(gpu, object, &mesh.indices, parts)?;
    let (filtered, texels) = match reflectance {
        Reflectance::Table(side, Format::R32Float) => (empty(gpu)?, baked(gpu, material, side, Format::R32Float)?),
        Reflectance::Table(side, format) => (baked(gpu, material, side, format)?, empty(gpu)?),
        _ => (empty(gpu)?, empty(gpu)?),
    };
    let group = gpu.guarded("uploading a mesh", |device| {
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..wgpu::SamplerDescriptor::default()
        });
        let uniform = uniform(device, &uniform_of(material));
        let buffers = parts.map(|part| buffer(device, part, wgpu::BufferUsages::STORAGE));
        let [positions, indices, normals, curvatures] = buffers.each_ref().map(wgpu::Buffer::as_entire_binding);
        let resources = vec![
            uniform.as_entire_binding(),
            positions,
            indices,
            normals,
            wgpu::BindingResource::TextureView(&filtered),
            wgpu::BindingResource::Sampler(&sampler),
            wgpu::BindingResource::TextureView(&texels),
            curvatures,
        ];
        bind_group(device, pipeline, 1, resources)
    })?;
    Ok(Body { groups: vec![group], vertices })
}

/// `CdrfMaterial` of the recipe.
fn uniform_of(material: &Material) -> [f32; 8] {
    let [r, g, b] = material.base_color.to_array();
    let sigma0 = material.sigma0.unwrap_or_default();
    [r, g, b, material.ior, sigma0.x, sigma0.y, sigma0.z, sigma0.max_element()]
}

/// One black texel, where a recipe binds what its form does not read.
fn empty(gpu: &Gpu) -> Result<wgpu::TextureView, RenderError> {
    texture(gpu, 1, Format::Rgba8, &[Vec3::ZERO])
}

/// The table of a material's channels.
fn baked(gpu: &Gpu, material: &Material, side: u32, format: Format) -> Result<wgpu::TextureView, RenderError> {
    let sigma0 = material.sigma0.unwrap_or_default();
    let tint = match format {
        // Its one channel serves every material.
        Format::R32Float => Vec3::ONE,
        Format::Rgba8 | Format::Rgba16Float => sigma0 / sigma0.max_element().max(f32::MIN_POSITIVE),
    };
    let texels = table::bake(gpu, UVec2::splat(side), tint)?;
    texture(gpu, side, format, &texels)
}

fn texture(gpu: &Gpu, side: u32, format: Format, texels: &[Vec3]) -> Result<wgpu::TextureView, RenderError> {
    let (format, bytes) = format.texture(texels);
    let texture = gpu.guarded("uploading a table", |device| {
        device.create_texture_with_data(
            &gpu.queue,
            &wgpu::TextureDescriptor {
                label: Some("reflectance"),
                size: wgpu::Extent3d { width: side, height: side, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            },
            wgpu::util::TextureDataOrder::LayerMajor,
            &bytes,
        )
    })?;
    Ok(device::view(&texture))
}
