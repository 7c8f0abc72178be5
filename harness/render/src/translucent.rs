//! The recipe `cdrf_shading`'s pass: what scatters light, and what is opaque, under the scene's lights and the environment.

use super::device::{self, Pipeline, PipelineSource, mesh_vertices};
use super::diffusion::{Diffusion, MeshBuffers};
use super::lighting::Lighting;
use super::pass::{Before, Body, DEPTH_FORMAT, SAMPLE_FORMAT, ScenePass, Shared, Variant};
use super::reflectance::form;
use super::shadows::Shadows;
use super::variant::{Drawn, Part};
use super::{RenderError, Settings};
use crate::cdrf::table;
use crate::record::Record;
use glam::{UVec2, Vec2, Vec3};
use lapidary_gpu::Gpu;
use lapidary_gpu::capture::OfObject;
use lapidary_plan::{Decisions, Rung, thickness};
use lapidary_scene::curvatures::vertex_curvatures;
use lapidary_scene::solver::{Format, Reflectance};
use lapidary_scene::{Material, Object};

/// What shines on the objects, and what keeps it from them, where anything does.
pub(super) type Light<'a> = (&'a Lighting<'a>, Option<&'a Shadows<'a>>);

/// Compiles `source`, the composed recipe, for the effects of each object, and uploads the objects.
pub(super) fn pass<'gpu>(
    gpu: &'gpu Gpu,
    light: Light<'_>,
    part: &Part<'_>,
    reflectance: Reflectance,
    source: &str,
) -> Result<ScenePass<'gpu>, RenderError> {
    for drawn in &part.objects {
        check(drawn.object, part.rung, reflectance)?;
    }
    let mut pass = ScenePass::empty(gpu);
    for (constants, objects) in part.variants(|drawn| constants(&drawn.decisions, part.settings, reflectance)) {
        let from = PipelineSource {
            recipe: part.rung.recipe(),
            source,
            entries: ["cdrf_vertex", "cdrf_fragment"],
            constants: &constants,
            formats: &[SAMPLE_FORMAT],
            depth: Some(DEPTH_FORMAT),
        };
        let pipeline = device::pipeline(gpu, &from)?;
        let mut bodies = Vec::new();
        for drawn in objects {
            let (body, diffusion) = upload(gpu, &pipeline, drawn, reflectance, (light, &constants))?;
            bodies.push(body);
            pass.before.extend(diffusion.map(Before::Diffusion));
        }
        pass.variants.push(Variant { shared: shared(light, &pipeline)?, pipeline, bodies });
    }
    Ok(pass)
}

/// What the pipeline reads of group 0, beside the view.
pub(super) fn shared((lighting, shadows): Light<'_>, pipeline: &Pipeline) -> Result<Vec<(u32, Shared)>, RenderError> {
    let mut shared = lighting.shared(pipeline)?;
    shared.extend(shadows.into_iter().flat_map(|shadows| shadows.shared(pipeline)));
    Ok(shared)
}

/// Refuses what the rung cannot draw.
fn check(object: &Object, rung: Rung, reflectance: Reflectance) -> Result<(), RenderError> {
    let Object { name, material, mesh } = object;
    if reflectance == Reflectance::Blur && mesh.uvs.len() != mesh.positions.len() {
        return Err(RenderError::NoTextureCoordinates { object: name.clone() });
    }
    let inside = |uv: &Vec2| uv.cmpge(Vec2::ZERO).all() && uv.cmple(Vec2::ONE).all();
    if reflectance == Reflectance::Blur && !mesh.uvs.iter().all(inside) {
        return Err(RenderError::TextureCoordinatesOutside { object: name.clone() });
    }
    if thickness::sigma0(material).is_none() && !reflectance.is_lambert() {
        return Err(RenderError::NoSigma0 { object: name.clone(), material: material.name.clone(), rung });
    }
    Ok(())
}

/// The overrides of the recipe for an object.
pub(crate) fn constants(
    decisions: &Decisions,
    settings: &Settings,
    reflectance: Reflectance,
) -> Vec<(&'static str, f64)> {
    let mut constants = decisions.constants();
    constants.extend([
        ("CDRF_FORM", f64::from(form(reflectance).unwrap_or_default())),
        ("CURVATURE_FORM", f64::from(settings.curvature.form())),
        ("ENVIRONMENT_AT_VERTICES", f64::from(u8::from(settings.environment_at_vertices))),
    ]);
    constants
}

/// Sends an object to the device: what `pipeline` reads of it.
fn upload<'gpu>(
    gpu: &'gpu Gpu,
    pipeline: &Pipeline,
    Drawn { object, name, .. }: &Drawn<'_>,
    reflectance: Reflectance,
    (light, constants): (Light<'_>, &[(&str, f64)]),
) -> Result<(Body, Option<Diffusion<'gpu>>), RenderError> {
    let _of = OfObject::named(name);
    let Object { mesh, material, .. } = object;
    let curvatures = if pipeline.binds(1, 7) { vertex_curvatures(mesh) } else { Vec::new() };
    let parts: [(u32, &str, &[u8]); 5] = [
        (1, "positions", bytemuck::cast_slice(&mesh.positions)),
        (2, "indices", bytemuck::cast_slice(&mesh.indices)),
        (3, "normals", bytemuck::cast_slice(&mesh.normals)),
        (7, "curvatures", bytemuck::cast_slice(&curvatures)),
        (8, "uvs", bytemuck::cast_slice(&mesh.uvs)),
    ];
    // What arrives is drawn with these, whatever shading still reads of them.
    let blurs = pipeline.binds(1, 9);
    let is_read = |binding: u32| pipeline.binds(1, binding) || blurs && [1, 3, 8].contains(&binding);
    let read = || parts.into_iter().filter(|(binding, _, _)| is_read(*binding));
    let vertices = mesh_vertices(gpu, object, &mesh.indices, read().map(|(_, _, contents)| contents))?;
    // What casts shadows is there already.
    let cast = |binding: u32| {
        let mesh = light.1?.mesh(name)?;
        Some((binding, mesh.get(binding.checked_sub(1)? as usize)?.clone()))
    };
    let buffers: Vec<(u32, wgpu::Buffer)> = gpu.guarded("uploading a mesh", |device| {
        let storage =
            |(binding, what, contents): (u32, &str, &[u8])| (binding, device::storage(device, what, contents));
        read()
            .map(|part| cast(part.0).unwrap_or_else(|| storage(part)))
            .chain([(0, device::storage(device, "material", &record_of(material)))])
            .collect()
    })?;
    let mut textures = Vec::new();
    if let Reflectance::Table(side, format) = reflectance {
        let binding = if format == Format::R32Float { 6 } else { 4 };
        if pipeline.binds(1, binding) {
            textures.push((binding, baked(gpu, material, side, format)?));
        }
    }
    let mut diffusion = None;
    let of = |wanted: u32| buffers.iter().find(|(binding, _)| *binding == wanted).map(|(_, buffer)| buffer);
    if let (true, Some(positions), Some(normals), Some(uvs)) = (blurs, of(1), of(3), of(8)) {
        let made = Diffusion::new(gpu, (object, name), (light, constants), &MeshBuffers { positions, normals, uvs })?;
        textures.push((9, made.diffused()));
        diffusion = Some(made);
    }
    let group = gpu.guarded("uploading a material", |device| {
        let sampler = |what: &str, address| {
            device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some(what),
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                address_mode_u: address,
                address_mode_v: address,
                ..wgpu::SamplerDescriptor::default()
            })
        };
        // Charts keep off the texture's edges but where it repeats, and at a sphere's poles, where either is as good.
        let samplers =
            [(5, "table sampler", wgpu::AddressMode::ClampToEdge), (10, "diffused sampler", wgpu::AddressMode::Repeat)];
        let samplers = samplers.into_iter().filter(|(binding, _, _)| pipeline.binds(1, *binding));
        let samplers: Vec<_> = samplers.map(|(binding, what, address)| (binding, sampler(what, address))).collect();
        let mut resources: Vec<(u32, wgpu::BindingResource<'_>)> = Vec::new();
        resources.extend(buffers.iter().map(|(binding, buffer)| (*binding, buffer.as_entire_binding())));
        resources.extend(textures.iter().map(|(binding, view)| (*binding, wgpu::BindingResource::TextureView(view))));
        resources.extend(samplers.iter().map(|(binding, of)| (*binding, wgpu::BindingResource::Sampler(of))));
        pipeline.bind(device, 1, &resources)
    })?;
    Ok((Body { name: name.clone(), groups: vec![group], vertices }, diffusion))
}

/// `CdrfMaterial` of the recipe.
fn record_of(material: &Material) -> Vec<u8> {
    let sigma0 = safe_sigma0(material);
    let record = Record::new("CdrfMaterial").with("base_color", material.base_color).with("index", material.ior);
    let record = record.with("sigma0", sigma0).with("table_sigma0", sigma0.max_element());
    record.with("alpha", material.roughness * material.roughness).bytes()
}

/// The material's widths, made safe.
fn safe_sigma0(material: &Material) -> Vec3 {
    let sigma0 = thickness::sigma0(material).unwrap_or_default();
    Vec3::from_array(sigma0.to_array().map(|sigma0| lapidary_cdrf::sigma(sigma0, 1.0)))
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
    let (format, bytes) = table::texture(format, texels);
    let texture = gpu.guarded("uploading a table", |_| {
        device::texture(gpu, "table", (wgpu::TextureDimension::D2, format), [side, side, 1], &bytes)
    })?;
    Ok(device::view(&texture))
}
