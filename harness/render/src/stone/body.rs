//! A stone in a frame: its material, its mesh and its copies, bound to a pipeline.

use super::geometry::{Geometries, check_steps};
use super::material::GemMaterial;
use super::wavelengths::{GemWavelength, of_bodies, wavelengths};
use crate::error::RenderError;
use crate::frame::record::Record;
use crate::frame::{Bound, Builder, PipelineId};
use crate::light::hierarchy::Hierarchy;
use crate::objects::draws::Body;
use crate::objects::mesh_buffers::vertices as mesh_vertices;
use crate::objects::part::Drawn;
use crate::settings::Settings;
use glam::Vec3;
use lapidary_plan::{Effect, Rung};
use lapidary_scene::{Copies, Material, Object, Place};

/// Adds an object to the frame, with the resources that `pipeline` reads.
pub(crate) fn add(
    builder: &mut Builder<'_>,
    pipeline: PipelineId,
    Drawn { object, name, decisions }: &Drawn<'_>,
    rung: Rung,
    settings: &Settings,
) -> Result<Body, RenderError> {
    let copies = object.copies.as_ref().filter(|_| decisions.has(Effect::Instances));
    let mesh = if copies.is_some() { object.shape() } else { &object.mesh };
    let Geometries { indices, facets, record, steps } = Geometries::of(&object.name, mesh, rung)?;
    check_steps(builder, rung, steps)?;
    let read = |(group, binding): (u32, u32)| builder.binds(pipeline, group, binding);
    let mut parts: Vec<(u32, u32, &str, &[u8])> = vec![
        (1, 1, "positions", bytemuck::cast_slice(&mesh.positions)),
        (1, 2, "indices", bytemuck::cast_slice(&indices)),
    ];
    parts.extend((0..).zip(&facets).map(|(binding, (what, part))| (2, binding, *what, &part[..])));
    parts.retain(|(group, binding, ..)| read((*group, *binding)));
    let vertices = mesh_vertices(object, &indices, parts.iter().map(|(.., contents)| *contents))?;
    let place = facets.len() as u32;
    let record = record.filter(|_| read((2, place)));
    let instances = copies.map(|copies| instances(copies, &object.material));
    let copied = instances.as_ref().map_or(1, |instances| instances.len() as u32);
    // Rays of all copies end by one limit.
    let brightest = Material { base_color: brightest(object), ..object.material.clone() };
    let material = GemMaterial::of(&brightest, rung, settings);
    let material = GemMaterial { base_color: object.material.base_color, ..material };
    let wavelengths = read((1, 3)).then(|| wavelengths(&object.material, rung.spectrum()));
    Ok(builder.of_object(name, |builder| {
        let material = builder.record("material", material.record());
        let add_parts = |wanted: u32, bound: &mut Vec<(u32, Bound)>, builder: &mut Builder<'_>| {
            for (_, binding, what, contents) in parts.iter().filter(|(group, ..)| *group == wanted) {
                bound.push((*binding, builder.storage(what, contents).into()));
            }
        };
        let mut first = vec![(0, material.into())];
        add_parts(1, &mut first, builder);
        if let Some(wavelengths) = wavelengths {
            let wavelengths = wavelengths.iter().map(GemWavelength::record).collect();
            first.push((3, builder.records("wavelengths", wavelengths, wgpu::BufferUsages::STORAGE).into()));
        }
        if let Some(instances) = instances {
            // A host may move the copies from frame to frame.
            let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
            first.push((4, builder.records("instances", instances, usage).into()));
        }
        let mut second = Vec::new();
        add_parts(2, &mut second, builder);
        if let Some((what, record)) = record {
            second.push((place, builder.record(what, record).into()));
        }
        let groups = vec![builder.bind(pipeline, 1, &first), builder.bind(pipeline, 2, &second)];
        Body { name: name.clone(), groups, vertices, instances: copied }
    }))
}

/// Adds a body of the recipe `gem_scene`, whose triangles are in the hierarchy of all, with the resources that `pipeline`
/// reads.
pub(crate) fn add_among(
    builder: &mut Builder<'_>,
    pipeline: PipelineId,
    Drawn { name, .. }: &Drawn<'_>,
    (hierarchy, number): (&Hierarchy, usize),
    rung: Rung,
) -> Result<Body, RenderError> {
    check_steps(builder, rung, hierarchy.steps)?;
    let triangles = hierarchy.triangles(number);
    let vertices = 3 * triangles.len() as u32;
    let (wavelengths, indices) = of_bodies(hierarchy.materials(), rung.spectrum());
    Ok(builder.of_object(name, |builder| {
        let mut bound: Vec<(u32, Bound)> = Vec::new();
        if builder.binds(pipeline, 1, 0) {
            bound.push((0, builder.storage("triangles", bytemuck::cast_slice(triangles)).into()));
        }
        if builder.binds(pipeline, 1, 1) {
            bound.push((1, builder.records("wavelengths", wavelengths, wgpu::BufferUsages::STORAGE).into()));
        }
        if builder.binds(pipeline, 1, 2) {
            bound.push((2, builder.storage("indices of refraction", bytemuck::cast_slice(&indices)).into()));
        }
        let groups = vec![builder.bind(pipeline, 1, &bound)];
        Body { name: name.clone(), groups, vertices, instances: 1 }
    }))
}

/// Returns the brightest base colour of an object's copies, by channel; the material's own if it is
/// shown once.
fn brightest(object: &Object) -> Vec3 {
    object.materials().map(|material| material.base_color).fold(Vec3::ZERO, Vec3::max)
}

/// Returns `GemInstance` of the recipe for each copy.
fn instances(copies: &Copies, material: &Material) -> Vec<Record> {
    let instance = |place: &Place| {
        let Material { base_color, attenuation_color, attenuation_distance, .. } = place.material(material);
        let record = Record::new("GemInstance").with("world_from_stone", place.rows()).with("base_color", base_color);
        record.with("absorption", lapidary_absorption::coefficient(attenuation_color, attenuation_distance))
    };
    copies.places.iter().map(instance).collect()
}
