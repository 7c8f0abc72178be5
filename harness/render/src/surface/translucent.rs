//! The pass of the recipe `cdrf_shading`: scattering and opaque materials under the scene's lights
//! and the environment.

use super::blur::Blur;
use super::cdrf::table;
use super::lit::{Light, shared};
use super::reflectance::{form, spread};
use crate::error::RenderError;
use crate::frame::record::Record;
use crate::frame::{Bound, Buffer, Builder, Contents, PipelineId, PipelineSource, Texture};
use crate::material::scattering_law::ScatteringLaw;
use crate::material::textures;
use crate::objects::draws::{Body, Variant};
use crate::objects::mesh_buffers::vertices as mesh_vertices;
use crate::objects::part::{Drawn, Part};
use crate::picture::formats::{DEPTH_FORMAT, SAMPLE_FORMAT};
use crate::settings::Settings;
use glam::{UVec2, Vec2, Vec3};
use lapidary_plan::{Decisions, Rung, thickness};
use lapidary_scene::curvatures::vertex_curvatures;
use lapidary_scene::solver::{Format, Reflectance};
use lapidary_scene::{Coverage, Lobe, Material, Object, Scene};

/// Compiles `source`, the composed recipe, for the effects of each object, and adds the objects.
pub(crate) fn pass(
    builder: &mut Builder<'_>,
    light: Light<'_>,
    part: &Part<'_>,
    reflectance: Reflectance,
    source: &str,
) -> Result<(Vec<Variant>, Vec<Blur>), RenderError> {
    for drawn in &part.objects {
        check(drawn.object, part.rung, reflectance)?;
    }
    let (mut variants, mut blurs) = (Vec::new(), Vec::new());
    for (constants, objects) in part.variants(|drawn| constants(&drawn.decisions, part.settings, reflectance)) {
        let pipeline = builder.render_pipeline(&PipelineSource {
            recipe: part.rung.recipe(),
            source,
            entries: ["cdrf_vertex", "cdrf_fragment"],
            constants: &constants,
            formats: &[SAMPLE_FORMAT],
            depth: Some(DEPTH_FORMAT),
        })?;
        let mut bodies = Vec::new();
        for drawn in objects {
            let added = builder
                .of_object(&drawn.name, |builder| add(builder, pipeline, drawn, reflectance, (light, &constants)));
            let (body, blur) = added?;
            bodies.push(body);
            blurs.extend(blur);
        }
        let shared = shared(builder, light, pipeline)?;
        variants.push(Variant { shared, targets: 1, reads_screen: false, pipeline, bodies });
    }
    Ok((variants, blurs))
}

/// Rejects objects that the rung cannot draw.
fn check(object: &Object, rung: Rung, reflectance: Reflectance) -> Result<(), RenderError> {
    let Object { name, material, mesh, .. } = object;
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

/// Returns the overrides of the recipe for an object.
fn constants(decisions: &Decisions, settings: &Settings, reflectance: Reflectance) -> Vec<(&'static str, f64)> {
    let mut constants = decisions.constants();
    constants.extend([
        ("CDRF_FORM", f64::from(form(reflectance).unwrap_or_default())),
        ("SPREAD_FORM", f64::from(spread(reflectance))),
        ("CURVATURE_FORM", f64::from(settings.diffuse.curvature.form())),
        ("SHADOW_FORM", f64::from(settings.diffuse.shadows.form())),
        ("ENVIRONMENT_AT_VERTICES", f64::from(u8::from(settings.diffuse.environment_at_vertices))),
    ]);
    constants
}

/// Returns the overrides of the recipe `cdrf_shading` for a scene's first object.
pub fn translucent_constants(scene: &Scene, settings: &Settings, reflectance: Reflectance) -> Vec<(&'static str, f64)> {
    let decisions = scene.objects.first().map(|object| Decisions::of(object, scene, &settings.request()));
    decisions.map_or_else(Vec::new, |decisions| constants(&decisions, settings, reflectance))
}

/// Adds an object to the frame, with the resources that `pipeline` reads.
fn add(
    builder: &mut Builder<'_>,
    pipeline: PipelineId,
    Drawn { object, name, decisions }: &Drawn<'_>,
    reflectance: Reflectance,
    (light, constants): (Light<'_>, &[(&str, f64)]),
) -> Result<(Body, Option<Blur>), RenderError> {
    let Object { mesh, material, .. } = object;
    let curvatures = if builder.binds(pipeline, 1, 7) { vertex_curvatures(mesh) } else { Vec::new() };
    let parts: [(u32, &str, &[u8]); 6] = [
        (1, "positions", bytemuck::cast_slice(&mesh.positions)),
        (2, "indices", bytemuck::cast_slice(&mesh.indices)),
        (3, "normals", bytemuck::cast_slice(&mesh.normals)),
        (7, "curvatures", bytemuck::cast_slice(&curvatures)),
        (8, "uvs", bytemuck::cast_slice(&mesh.uvs)),
        (15, "colors", bytemuck::cast_slice(&mesh.colors)),
    ];
    // The irradiance is drawn with these, whether or not shading still reads them.
    let blurs = builder.binds(pipeline, 1, 9);
    let is_read = |binding: u32| builder.binds(pipeline, 1, binding) || blurs && [1, 3, 8].contains(&binding);
    let read: Vec<_> = parts.into_iter().filter(|(binding, _, _)| is_read(*binding)).collect();
    let vertices = mesh_vertices(object, &mesh.indices, read.iter().map(|(_, _, contents)| *contents))?;
    // Light that does not enter keeps its own, even if the matter is black.
    let color = thickness::color(material, &mesh.colors).max(Vec3::splat(1e-6));
    let record = builder.record("material", record_of((material, color), decisions, light.0.number_of(object) as u32));
    let shape = light.0.shapes.of(builder, name, object)?;
    let buffers: Vec<(u32, Buffer)> = read
        .into_iter()
        .map(|(binding, what, contents)| {
            let buffer = match binding {
                1 => shape.positions,
                2 => shape.indices,
                _ => builder.storage(what, contents),
            };
            (binding, buffer)
        })
        .collect();
    let mut resources: Vec<(u32, Bound)> =
        buffers.iter().map(|(binding, buffer)| (*binding, (*buffer).into())).collect();
    resources.push((0, record.into()));
    let reach = thickness::sigma0(material).filter(|_| !reflectance.is_lambert()).unwrap_or_default();
    resources.extend(textures::bound(builder, pipeline, material, (mesh, reach)));
    if let Reflectance::Table(side, format) = reflectance {
        let binding = if format == Format::R32Float { 6 } else { 4 };
        if builder.binds(pipeline, 1, binding) {
            resources.push((binding, baked(builder, material, side, format)?.into()));
        }
    }
    let mut blur = None;
    let buffer_at = |wanted: u32| buffers.iter().find(|(binding, _)| *binding == wanted).map(|(_, buffer)| *buffer);
    if let (true, Some(positions), Some(normals), Some(uvs)) = (blurs, buffer_at(1), buffer_at(3), buffer_at(8)) {
        let made = Blur::new(builder, (object, name), (light, constants), [positions, normals, uvs])?;
        resources.push((9, made.diffused().into()));
        blur = Some(made);
    }
    // Charts stay clear of the texture's edges, except where it repeats and at a sphere's poles,
    // where either address mode will do.
    let samplers =
        [(5, "table sampler", wgpu::AddressMode::ClampToEdge), (10, "diffused sampler", wgpu::AddressMode::Repeat)];
    for (binding, what, address) in samplers {
        if builder.binds(pipeline, 1, binding) {
            resources.push((binding, builder.sampler(what, [address; 2]).into()));
        }
    }
    let group = builder.bind(pipeline, 1, &resources);
    Ok((Body { name: name.clone(), groups: vec![group], vertices, instances: 1 }, blur))
}

/// Fills `CdrfMaterial` of the recipe.
fn record_of((material, color): (&Material, Vec3), decisions: &Decisions, number: u32) -> Record {
    let sigma0 = safe_sigma0(material);
    let record = Record::new("CdrfMaterial").with("base_color", color).with("index", material.ior);
    let record = record.with("sigma0", sigma0).with("table_sigma0", sigma0.max_element());
    let record = record.with("alpha", material.roughness * material.roughness);
    let record = record.with("free_path", safe(thickness::free_path(material)));
    let record = record.with("milne", lapidary_diffusion::milne(ScatteringLaw::index_of(material, decisions)));
    let record = record.within("law", |record| ScatteringLaw::of_object(material, decisions).fill(record));
    let lobe = material.second_lobe.unwrap_or(Lobe { roughness: 0.0, weight: 0.0 });
    let record = record.with("second_alpha", lobe.roughness * lobe.roughness).with("second_weight", lobe.weight);
    let record =
        record.within("base_color_place", |record| textures::place(record, material.base_color_texture.as_ref()));
    let record = record.within("normal_place", |record| textures::place(record, material.normal_texture.as_ref()));
    let record =
        record.within("thickness_place", |record| textures::place(record, material.thickness_texture.as_ref()));
    let record = record.with("transmission", material.share_that_enters());
    let record = record
        .within("transmission_place", |record| textures::place(record, material.diffuse_transmission_texture.as_ref()));
    let Coverage { share, cutoff } = material.coverage.unwrap_or(Coverage { share: 1.0, cutoff: None });
    record
        .with("coverage", share)
        .with("cutoff", cutoff.unwrap_or(-1.0))
        .with("body", number)
        .with("rest", material.base_color / color)
        .with("metallic", material.metallic)
        .within("roughness_place", |record| textures::place(record, material.metallic_roughness_texture.as_ref()))
}

/// Returns the material's widths, made safe.
fn safe_sigma0(material: &Material) -> Vec3 {
    safe(thickness::sigma0(material))
}

/// Returns lengths that no product with a curvature makes infinite or a NaN; 0 for none.
fn safe(lengths: Option<Vec3>) -> Vec3 {
    lengths.unwrap_or_default().map(|length| lapidary_cdrf::sigma(length, 1.0))
}

/// Bakes the table of a material's channels.
fn baked(builder: &mut Builder<'_>, material: &Material, side: u32, format: Format) -> Result<Texture, RenderError> {
    let sigma0 = safe_sigma0(material);
    let tint = match format {
        // The one channel serves every material.
        Format::R32Float => Vec3::ONE,
        Format::Rgba8 | Format::Rgba16Float => sigma0 / sigma0.max_element().max(f32::MIN_POSITIVE),
    };
    let contents = match builder.gpu() {
        Some(gpu) => Contents::Bytes(table::texels(format, &table::bake(gpu, UVec2::splat(side), tint)?)),
        None => Contents::LeftOut,
    };
    Ok(builder.texture("table", (wgpu::TextureDimension::D2, table::format(format)), [side, side, 1], contents))
}
