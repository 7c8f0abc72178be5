//! The recipe `cdrf_shading`'s pass: what scatters light, under the scene's lights and the environment.

use super::device::{self, PipelineSource, bind_group, buffer, mesh_vertices, uniform};
use super::diffusion::{Diffusion, MeshBuffers};
use super::lighting::{self, Lighting};
use super::pass::{Before, Body, DEPTH_FORMAT, SAMPLE_FORMAT, ScenePass};
use super::{Curvature, Reflectance, RenderError, Settings};
use crate::cdrf::table::{self, Format};
use crate::gpu::Gpu;
use crate::scene::curvatures::vertex_curvatures;
use crate::scene::{Material, Object, Scene};
use glam::{UVec2, Vec2, Vec3};

/// Compiles `source`, the composed recipe, and uploads the scene.
pub(super) fn pass<'gpu>(
    gpu: &'gpu Gpu,
    scene: &Scene,
    settings: &Settings,
    reflectance: Reflectance,
    source: &str,
) -> Result<ScenePass<'gpu>, RenderError> {
    for Object { name, material, mesh } in &scene.objects {
        if reflectance == Reflectance::Blur && mesh.uvs.len() != mesh.positions.len() {
            return Err(RenderError::NoTextureCoordinates { object: name.clone() });
        }
        let inside = |uv: &Vec2| uv.cmpge(Vec2::ZERO).all() && uv.cmple(Vec2::ONE).all();
        if reflectance == Reflectance::Blur && !mesh.uvs.iter().all(inside) {
            return Err(RenderError::TextureCoordinatesOutside { object: name.clone() });
        }
        if material.sigma0.is_none() && reflectance != Reflectance::Lambert {
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
    let lighting = Lighting::upload(gpu, scene, settings)?;
    let irradiance = lighting::constants(scene, settings);
    let (mut bodies, mut before) = (Vec::new(), Vec::new());
    for object in &scene.objects {
        let (body, diffusion) = upload(gpu, &pipeline, object, settings, reflectance, (&lighting, &irradiance))?;
        bodies.push(body);
        before.extend(diffusion.map(Before::Diffusion));
    }
    Ok(ScenePass { gpu, pipeline, shared: lighting.shared(), bodies, before })
}

/// The overrides of the recipe for these settings.
pub(crate) fn constants(scene: &Scene, settings: &Settings, reflectance: Reflectance) -> Vec<(&'static str, f64)> {
    let flag = |on: bool| f64::from(u8::from(on));
    let materials = || scene.objects.iter().map(|object| &object.material);
    let scatters = materials().any(|material| material.sigma0.is_some_and(|sigma0| sigma0 != Vec3::ZERO));
    let mut constants = vec![
        ("EFFECT_CDRF", flag(scatters && reflectance.form().is_some())),
        ("EFFECT_TEXTURE_DIFFUSION", flag(reflectance == Reflectance::Blur)),
        ("CDRF_FORM", f64::from(reflectance.form().unwrap_or_default())),
        ("CURVATURE_FORM", f64::from(settings.curvature.form())),
        ("ENVIRONMENT_AT_VERTICES", flag(settings.environment_at_vertices)),
    ];
    constants.extend(lighting::constants(scene, settings));
    constants
}

/// Sends an object to the device.
fn upload<'gpu>(
    gpu: &'gpu Gpu,
    pipeline: &wgpu::RenderPipeline,
    object: &Object,
    settings: &Settings,
    reflectance: Reflectance,
    lighting: (&Lighting, &[(&str, f64)]),
) -> Result<(Body, Option<Diffusion<'gpu>>), RenderError> {
    let Object { mesh, material, .. } = object;
    let curvatures = if settings.curvature == Curvature::Vertex { vertex_curvatures(mesh) } else { vec![0.0] };
    let unread = [0.0f32; 2];
    let uvs: &[u8] = match reflectance {
        Reflectance::Blur => bytemuck::cast_slice(&mesh.uvs),
        _ => bytemuck::cast_slice(&unread),
    };
    let parts: [&[u8]; 5] = [
        bytemuck::cast_slice(&mesh.positions),
        bytemuck::cast_slice(&mesh.indices),
        bytemuck::cast_slice(&mesh.normals),
        bytemuck::cast_slice(&curvatures),
        uvs,
    ];
    let vertices = mesh_vertices(gpu, object, &mesh.indices, parts)?;
    let (filtered, texels) = match reflectance {
        Reflectance::Table(side, Format::R32Float) => (empty(gpu)?, baked(gpu, material, side, Format::R32Float)?),
        Reflectance::Table(side, format) => (baked(gpu, material, side, format)?, empty(gpu)?),
        _ => (empty(gpu)?, empty(gpu)?),
    };
    let [positions, indices, normals, curvatures, uvs] =
        gpu.guarded("uploading a mesh", |device| parts.map(|part| buffer(device, part, wgpu::BufferUsages::STORAGE)))?;
    let diffusion = match reflectance {
        Reflectance::Blur => {
            let mesh = MeshBuffers { positions: &positions, normals: &normals, uvs: &uvs };
            Some(Diffusion::new(gpu, object, lighting, &mesh)?)
        }
        _ => None,
    };
    let diffused = diffusion.as_ref().map_or_else(|| empty(gpu), |diffusion| Ok(diffusion.diffused()))?;
    let group = gpu.guarded("uploading a material", |device| {
        let sampler = |address| {
            device.create_sampler(&wgpu::SamplerDescriptor {
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                address_mode_u: address,
                address_mode_v: address,
                ..wgpu::SamplerDescriptor::default()
            })
        };
        let clamping = sampler(wgpu::AddressMode::ClampToEdge);
        // Charts keep off the texture's edges but where it repeats, and at a sphere's poles, where either is as good.
        let repeating = sampler(wgpu::AddressMode::Repeat);
        let uniform = uniform(device, &uniform_of(material));
        let resources = vec![
            uniform.as_entire_binding(),
            positions.as_entire_binding(),
            indices.as_entire_binding(),
            normals.as_entire_binding(),
            wgpu::BindingResource::TextureView(&filtered),
            wgpu::BindingResource::Sampler(&clamping),
            wgpu::BindingResource::TextureView(&texels),
            curvatures.as_entire_binding(),
            uvs.as_entire_binding(),
            wgpu::BindingResource::TextureView(&diffused),
            wgpu::BindingResource::Sampler(&repeating),
        ];
        bind_group(device, pipeline, 1, resources)
    })?;
    Ok((Body { groups: vec![group], vertices }, diffusion))
}

/// `CdrfMaterial` of the recipe.
fn uniform_of(material: &Material) -> [f32; 12] {
    let [r, g, b] = material.base_color.to_array();
    let sigma0 = safe_sigma0(material);
    let alpha = material.roughness * material.roughness;
    [r, g, b, material.ior, sigma0.x, sigma0.y, sigma0.z, sigma0.max_element(), alpha, 0.0, 0.0, 0.0]
}

/// The material's widths, made safe.
fn safe_sigma0(material: &Material) -> Vec3 {
    let sigma0 = material.sigma0.unwrap_or_default();
    Vec3::from_array(sigma0.to_array().map(|sigma0| lapidary_cdrf::sigma(sigma0, 1.0)))
}

/// One black texel, where a recipe binds what its form does not read.
fn empty(gpu: &Gpu) -> Result<wgpu::TextureView, RenderError> {
    texture(gpu, 1, Format::Rgba8, &[Vec3::ZERO])
}

/// The table of a material's channels.
fn baked(gpu: &Gpu, material: &Material, side: u32, format: Format) -> Result<wgpu::TextureView, RenderError> {
    let sigma0 = safe_sigma0(material);
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
    let texture = gpu.guarded("uploading a table", |_| {
        device::texture(gpu, (wgpu::TextureDimension::D2, format), [side, side, 1], &bytes)
    })?;
    Ok(device::view(&texture))
}
