//! A stone in a frame: its material, its mesh, and the data that its rung's geometry also needs.

use super::mesh_buffers::vertices as mesh_vertices;
use super::pass::Body;
use super::variant::Drawn;
use super::walk::Walked;
use super::{RenderError, Settings, restraint};
use crate::frame::record::Record;
use crate::frame::{Bound, Builder, PipelineId};
use glam::{DMat3, Mat3, Vec3};
use lapidary_gpu::Gpu;
use lapidary_plan::{Effect, Geometry, Rung, Spectrum};
use lapidary_scene::normals::soft_normals;
use lapidary_scene::{Bvh, Convex, Copies, Material, Mesh, Object, Place, convex, spectrum};
use std::borrow::Cow;

/// Adds an object to the frame, with the resources that `pipeline` reads.
pub(super) fn add(
    builder: &mut Builder<'_>,
    pipeline: PipelineId,
    Drawn { object, name, decisions }: &Drawn<'_>,
    rung: Rung,
    settings: &Settings,
) -> Result<Body, RenderError> {
    let copies = object.copies.as_ref().filter(|_| decisions.has(Effect::Instances));
    let mesh = if copies.is_some() { object.shape() } else { &object.mesh };
    let Geometries { indices, own, record, steps } = Geometries::of(&object.name, mesh, rung)?;
    check_steps(builder, rung, steps)?;
    let read = |(group, binding): (u32, u32)| builder.binds(pipeline, group, binding);
    let mut parts: Vec<(u32, u32, &str, &[u8])> = vec![
        (1, 1, "positions", bytemuck::cast_slice(&mesh.positions)),
        (1, 2, "indices", bytemuck::cast_slice(&indices)),
    ];
    parts.extend((0..).zip(&own).map(|(binding, (what, part))| (2, binding, *what, &part[..])));
    parts.retain(|(group, binding, ..)| read((*group, *binding)));
    let vertices = mesh_vertices(object, &indices, parts.iter().map(|(.., contents)| *contents))?;
    let place = own.len() as u32;
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
        let add = |wanted: u32, bound: &mut Vec<(u32, Bound)>, builder: &mut Builder<'_>| {
            for (_, binding, what, contents) in parts.iter().filter(|(group, ..)| *group == wanted) {
                bound.push((*binding, builder.storage(what, contents).into()));
            }
        };
        let mut first = vec![(0, material.into())];
        add(1, &mut first, builder);
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
        add(2, &mut second, builder);
        if let Some((what, record)) = record {
            second.push((place, builder.record(what, record).into()));
        }
        let groups = vec![builder.bind(pipeline, 1, &first), builder.bind(pipeline, 2, &second)];
        Body { name: name.clone(), groups, vertices, instances: copied }
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

/// Data of a mesh that a rung's geometry needs, besides its positions.
struct Geometries<'a> {
    indices: Cow<'a, [u32]>,
    /// The buffers of group 2.
    own: Vec<(&'static str, Cow<'a, [u8]>)>,
    /// A struct that follows them.
    record: Option<(&'static str, Record)>,
    /// Loop iterations to find one hit.
    steps: u64,
}

/// Number of loop iterations, summed over all loops of one invocation, after which lavapipe
/// silently ends loops (Mesa's `LP_MAX_TGSI_LOOP_ITERATIONS`).
const LAVAPIPE_STEPS: u64 = 65_535;

/// Rejects a rung that lavapipe would render incorrectly.
fn check_steps(builder: &Builder<'_>, rung: Rung, steps: u64) -> Result<(), RenderError> {
    let rays = match rung.spectrum() {
        Spectrum::One | Spectrum::Paper | Spectrum::Tracker => 1,
        Spectrum::Split => 2,
        Spectrum::Separate(count) => u64::from(count),
    };
    let steps = rays * (1 + u64::from(rung.hits()) * (1 + steps));
    if builder.gpu().is_some_and(Gpu::is_lavapipe) && steps > LAVAPIPE_STEPS {
        return Err(RenderError::TooManySteps { rung, steps, limit: LAVAPIPE_STEPS });
    }
    Ok(())
}

impl<'a> Geometries<'a> {
    /// Returns the data for a body of this name.
    fn of(name: &str, mesh: &'a Mesh, rung: Rung) -> Result<Self, RenderError> {
        let indices = Cow::Borrowed(&mesh.indices[..]);
        let not_convex = |reason| RenderError::NotConvex { object: name.to_owned(), reason };
        Ok(match rung.geometry() {
            Geometry::Proxy => {
                let normals = match soft_normals(mesh) {
                    Cow::Borrowed(own) => Cow::Borrowed(bytemuck::cast_slice(own)),
                    Cow::Owned(softened) => Cow::Owned(bytemuck::cast_slice(&softened).to_vec()),
                };
                Self { indices, own: vec![("normals", normals)], record: None, steps: 0 }
            }
            Geometry::Convex => {
                let convex = Convex::of_mesh(mesh).ok_or_else(|| not_convex(convex::obstacle(mesh)))?;
                Self { indices, own: facets(&convex), record: None, steps: convex.planes.len() as u64 }
            }
            Geometry::Walk => {
                let Walked { convex, map, centre } = Walked::of_mesh(mesh).map_err(not_convex)?;
                let stone = Record::new("GemStone").with("centre", centre).with("side", map.side);
                let stone = stone.with("lower", map.lower).with("upper", map.upper);
                let mut own = facets(&convex);
                own.push(("facet map", bytemuck::cast_slice(&map.words).to_vec().into()));
                // Few walks take more than four passes, even over the longest lists.
                Self { indices, own, record: Some(("stone", stone)), steps: 4 * map.longest_list() as u64 }
            }
            Geometry::Bvh | Geometry::Triangles => {
                let bvh = Bvh::build(&mesh.positions, &mesh.indices);
                let words = bvh.words();
                let (nodes, corners): (&[u8], &[u8]) =
                    (bytemuck::cast_slice(&words), bytemuck::cast_slice(&bvh.corners));
                let own = vec![("nodes", nodes.to_vec().into()), ("corners", corners.to_vec().into())];
                // The recipe, too, numbers triangles in the order of the leaves.
                let triangles = mesh.triangle_count() as u64;
                // A ray's path through a hierarchy has no useful bound; few take as many as 16
                // iterations for each of its levels.
                let levels = u64::from(triangles.ilog2()) + 1;
                let steps = if rung.geometry() == Geometry::Bvh { 16 * levels } else { triangles };
                Self { indices: Cow::Owned(bvh.indices), own, record: None, steps }
            }
        })
    }
}

/// Returns the buffers of a convex body's facets.
fn facets<'a>(Convex { planes, face_of_triangle }: &Convex) -> Vec<(&'static str, Cow<'a, [u8]>)> {
    let planes: Vec<[f32; 4]> = planes.iter().map(|plane| plane.to_array()).collect();
    let (planes, faces): (&[u8], &[u8]) = (bytemuck::cast_slice(&planes), bytemuck::cast_slice(face_of_triangle));
    vec![("planes", planes.to_vec().into()), ("face of triangle", faces.to_vec().into())]
}

/// Size in bytes of the device buffers that a rung's geometry needs for `object`, besides positions
/// and indices.
pub fn geometry_bytes(object: &Object, rung: Rung) -> Result<u64, RenderError> {
    let Geometries { own, record, .. } = Geometries::of(&object.name, object.shape(), rung)?;
    let record = record.map_or(0, |(_, record)| record.bytes().len());
    Ok(own.iter().map(|(_, part)| part.len() as u64).sum::<u64>() + record as u64)
}

/// `GemMaterial` of the recipe.
pub(crate) struct GemMaterial {
    pub(crate) base_color: Vec3,
    pub(crate) index: f32,
    pub(crate) absorption: Vec3,
    pub(crate) distance_limit: f32,
    pub(crate) channel_indices: Vec3,
    pub(crate) dispersion_strength: f32,
    pub(crate) throughput_limit: f32,
}

impl GemMaterial {
    pub(crate) fn of(material: &Material, rung: Rung, settings: &Settings) -> Self {
        Self {
            base_color: material.base_color,
            index: material.ior,
            absorption: lapidary_absorption::coefficient(material.attenuation_color, material.attenuation_distance),
            // No ray travels as far as this.
            distance_limit: settings.gem.distance_limit.unwrap_or(f32::MAX),
            channel_indices: material.channel_indices(),
            dispersion_strength: settings.gem.dispersion_strength,
            throughput_limit: restraint::throughput_limit(material, rung, settings),
        }
    }

    fn record(&self) -> Record {
        let record = Record::new("GemMaterial").with("base_color", self.base_color).with("index", self.index);
        let record = record.with("absorption", self.absorption).with("distance_limit", self.distance_limit);
        let record = record.with("channel_indices", self.channel_indices);
        let record = record.with("dispersion_strength", self.dispersion_strength);
        record.with("throughput_limit", self.throughput_limit)
    }
}

/// `GemWavelength` of the recipe.
pub(crate) struct GemWavelength {
    pub(crate) weights: Mat3,
    pub(crate) index: f32,
}

impl GemWavelength {
    fn record(&self) -> Record {
        Record::new("GemWavelength").with("weights", self.weights).with("index", self.index)
    }
}

/// Returns the wavelengths for which separate rays are followed.
pub(crate) fn wavelengths(material: &Material, spectrum: Spectrum) -> Vec<GemWavelength> {
    let entry = |weights: DMat3, index: f32| GemWavelength { weights: weights.as_mat3(), index };
    match spectrum {
        // Without separate wavelengths, one entry fills the binding.
        Spectrum::One | Spectrum::Paper | Spectrum::Tracker | Spectrum::Split => {
            vec![entry(DMat3::IDENTITY, material.ior)]
        }
        Spectrum::Separate(3) => {
            let channels = [glam::DVec3::X, glam::DVec3::Y, glam::DVec3::Z].map(DMat3::from_diagonal);
            channels.into_iter().zip(material.channel_indices().to_array()).map(|(w, n)| entry(w, n)).collect()
        }
        Spectrum::Separate(count) => spectrum::weights(count as usize)
            .iter()
            .map(|wavelength| entry(wavelength.weights, material.index_at(wavelength.nanometres) as f32))
            .collect(),
    }
}
