//! All bodies of a scene in one hierarchy of triangles, as the recipe `gem_scene` reads them.

use super::environment::{LEAST_DIFFERENCE, largest_radiance};
use super::paint::{self, Paint};
use crate::error::RenderError;
use crate::frame::record::Record;
use crate::frame::{Bound, Buffer, Builder, PipelineId};
use crate::material::scattering_law::ScatteringLaw;
use crate::settings::Settings;
use glam::{UVec4, Vec2, Vec3, Vec4};
use lapidary_plan::{Effect, Outside, thickness};
use lapidary_scene::curvatures::vertex_curvatures;
use lapidary_scene::{Bvh, Environment, Material, Mesh, Object, Scene, harmonics, precedence};
use std::cell::OnceCell;
use std::cmp::Reverse;

/// Bindings in group 0, from the nodes on.
const FIRST: u32 = 11;
/// Stands for no body.
const NONE: u32 = u32::MAX;

/// A body: an object, or one of its copies.
struct Body {
    /// Index of the object in the scene.
    object: usize,
    material: Material,
    /// Range of the body's triangles among all.
    triangles: std::ops::Range<usize>,
}

/// The hierarchy in a frame.
pub(crate) struct Hierarchy {
    nodes: Buffer,
    corners: Buffer,
    /// Normals at the corners, and their buffer once a pipeline reads it.
    normals: (Vec<Vec4>, OnceCell<Buffer>),
    bodies: Buffer,
    start: Buffer,
    /// Images and colours of vertices, and their textures once a pipeline reads them.
    paint: (Paint, OnceCell<[(u32, Bound); 2]>),
    /// The bodies' materials, by number.
    materials: Vec<Material>,
    /// Numbers of each object's triangles, in the order of the leaves.
    triangles: Vec<Vec<u32>>,
    /// Number of turns of the loop over nodes for one ray; few take more.
    pub(crate) steps: u64,
}

impl Hierarchy {
    /// Adds the bodies of a scene to the frame.
    ///
    /// # Errors
    /// If they are beyond the limits that every device offers.
    pub(crate) fn new(builder: &mut Builder<'_>, scene: &Scene, settings: &Settings) -> Result<Self, RenderError> {
        let alone = settings.without.has(Effect::Around) || settings.gem.outside == Some(Outside::Environment);
        let Bodies { mut bodies, positions, normals, uvs, colors, indices } = Bodies::of(scene, alone);
        // Where bodies share space, the one of the lower number is there.
        let places = precedence(&scene.objects);
        bodies.sort_by_key(|body| (!body.material.is_clear(), Reverse((places[body.object], body.triangles.start))));
        let mut of_triangle = vec![0_u32; indices.len() / 3];
        for (number, body) in (0..).zip(&bodies) {
            of_triangle[body.triangles.clone()].fill(number);
        }
        let within = around(scene.camera.eye, &bodies, |body| {
            let corners = indices[3 * body.triangles.start..3 * body.triangles.end].iter();
            let positions: Vec<Vec3> = corners.map(|index| positions[*index as usize]).collect();
            Mesh { indices: (0..positions.len() as u32).collect(), positions, ..Mesh::default() }
        });
        let bvh = Bvh::build(&positions, &indices);
        let mut corners = bvh.corners.clone();
        let mut triangles = vec![Vec::new(); scene.objects.len()];
        for ((number, corners), original) in (0..).zip(corners.chunks_exact_mut(3)).zip(&bvh.order) {
            let body = of_triangle[*original as usize];
            corners.iter_mut().for_each(|corner| corner.w = body as f32);
            triangles[bodies[body as usize].object].push(number);
        }
        let normals: Vec<Vec4> = bvh.indices.iter().map(|index| normals[*index as usize]).collect();
        let mut paint = Paint::new(settings.footprint_of(&scene.camera));
        if !uvs.is_empty() || !colors.is_empty() {
            let images = |body: &Body| {
                let has_places = !scene.objects[body.object].mesh.uvs.is_empty();
                if has_places { paint.body(&body.material, settings.without) } else { Ok(0) }
            };
            let of_bodies = bodies.iter().map(images).collect::<Result<Vec<u32>, RenderError>>()?;
            for (corner, index) in corners.iter().zip(&bvh.indices) {
                let vertex = *index as usize;
                let uv = uvs.get(vertex).copied().unwrap_or_default();
                let color = colors.get(vertex).copied().unwrap_or(Vec3::ONE);
                paint.corner(of_bodies[corner.w as usize], uv, color);
            }
        }
        RenderError::unless_bound(size_of_val(&corners[..]) as u64, || "the scene's triangles".to_owned())?;
        let start = Record::new("SceneStart")
            .with("within", within)
            .with("around", mean_radiance(&settings.environment))
            .with("throughput_limit", throughput_limit(settings));
        let records: Vec<Record> =
            bodies.iter().map(|body| record(&body.material, &scene.objects[body.object].mesh.colors)).collect();
        let words = bvh.words();
        let [nodes, corners, of_bodies, start] = builder.of_object("", |builder| {
            let nodes = builder.storage("nodes", bytemuck::cast_slice(&words));
            let corners = builder.storage("corners", bytemuck::cast_slice(&corners));
            let bodies = builder.records("scene's bodies", records, wgpu::BufferUsages::STORAGE);
            [nodes, corners, bodies, builder.uniform("start", start)]
        });
        let normals = (normals, OnceCell::new());
        let levels = u64::from((bvh.order.len().max(1)).ilog2()) + 1;
        let materials = bodies.into_iter().map(|body| body.material).collect();
        let paint = (paint, OnceCell::new());
        Ok(Self { nodes, corners, normals, bodies: of_bodies, start, paint, materials, triangles, steps: 16 * levels })
    }

    /// Returns the resources that `pipeline` reads.
    ///
    /// # Errors
    /// If they are beyond the limits that every device offers.
    pub(crate) fn shared(
        &self,
        builder: &mut Builder<'_>,
        pipeline: PipelineId,
    ) -> Result<Vec<(u32, Bound)>, RenderError> {
        let (contents, made) = &self.normals;
        let mut buffers = vec![(FIRST, self.nodes), (FIRST + 1, self.corners)];
        if builder.binds(pipeline, 0, FIRST + 2) {
            let add =
                || builder.of_object("", |builder| builder.storage("corner normals", bytemuck::cast_slice(contents)));
            buffers.push((FIRST + 2, *made.get_or_init(add)));
        }
        buffers.extend([(FIRST + 3, self.bodies), (FIRST + 4, self.start)]);
        buffers.retain(|(binding, _)| builder.binds(pipeline, 0, *binding));
        let mut shared: Vec<(u32, Bound)> =
            buffers.into_iter().map(|(binding, buffer)| (binding, buffer.into())).collect();
        if paint::BINDINGS.iter().any(|binding| builder.binds(pipeline, 0, *binding)) {
            let (paint, made) = &self.paint;
            let textures = match made.get() {
                Some(known) => *known,
                None => *made.get_or_init({
                    let new = paint.bound(builder)?;
                    move || new
                }),
            };
            shared.extend(textures.into_iter().filter(|(binding, _)| builder.binds(pipeline, 0, *binding)));
        }
        Ok(shared)
    }

    /// Whether `pipeline` reads any of them.
    pub(crate) fn is_read(builder: &Builder<'_>, pipeline: PipelineId) -> bool {
        builder.binds(pipeline, 0, FIRST)
    }

    /// Returns the numbers of an object's triangles.
    pub(crate) fn triangles(&self, object: usize) -> &[u32] {
        &self.triangles[object]
    }

    /// Returns the bodies' materials, by number.
    pub(crate) fn materials(&self) -> &[Material] {
        &self.materials
    }
}

/// The bodies of a scene and the vertices of all.
#[derive(Default)]
struct Bodies {
    bodies: Vec<Body>,
    positions: Vec<Vec3>,
    /// One for each position; 0 where the surface is flat. In w the mean curvature of a body in which light scatters.
    normals: Vec<Vec4>,
    /// One for each position, or none at all if no body has images.
    uvs: Vec<Vec2>,
    /// One for each position, or none at all if no mesh has colours.
    colors: Vec<Vec3>,
    indices: Vec<u32>,
}

impl Bodies {
    /// Takes the clear bodies `alone`, or all.
    fn of(scene: &Scene, alone: bool) -> Self {
        let mut all = Self::default();
        let is_met = |object: &Object| !alone || object.material.is_clear();
        for (number, object) in scene.objects.iter().enumerate().filter(|(_, object)| is_met(object)) {
            let first = all.indices.len() / 3;
            let offset = all.positions.len() as u32;
            let is_flat = object.material.is_clear() && !lapidary_plan::is_smooth(object);
            all.positions.extend(&object.mesh.positions);
            let normals = object.mesh.normals.iter().copied().filter(|_| !is_flat);
            let curvatures = if object.material.scatters() { vertex_curvatures(&object.mesh) } else { Vec::new() };
            let normals = normals.chain(std::iter::repeat(Vec3::ZERO));
            let corners = normals.zip(curvatures.into_iter().chain(std::iter::repeat(0.0)));
            let corners = corners.map(|(normal, curvature)| normal.extend(curvature));
            all.normals.extend(corners.take(object.mesh.positions.len()));
            if object.material.textures().next().is_some() && !object.mesh.uvs.is_empty() {
                all.uvs.resize(offset as usize, Vec2::ZERO);
                all.uvs.extend(&object.mesh.uvs);
            }
            if !object.mesh.colors.is_empty() {
                all.colors.resize(offset as usize, Vec3::ONE);
                all.colors.extend(&object.mesh.colors);
            }
            all.indices.extend(object.mesh.indices.iter().map(|index| offset + index));
            all.add(number, object, first);
        }
        all
    }

    /// Adds an object whose triangles start at `first`, or its copies.
    fn add(&mut self, number: usize, object: &Object, first: usize) {
        let copies = object.copies.as_ref().map_or(1, |copies| copies.places.len());
        let each = object.mesh.triangle_count() / copies.max(1);
        for (copy, material) in object.materials().enumerate() {
            let start = first + copy * each;
            self.bodies.push(Body { object: number, material, triangles: start..start + each });
        }
    }
}

/// Returns `SceneBody` of the recipe.
fn record(material: &Material, colors: &[Vec3]) -> Record {
    let kind = match material {
        _ if !material.is_clear() => 2_u32,
        _ if material.is_thin_wall() => 1,
        _ => 0,
    };
    // What scatters is matte here.
    let clear = if material.is_clear() { material.clear_share() } else { 1.0 - material.covered_share() };
    let absorption = lapidary_absorption::coefficient(material.attenuation_color, material.attenuation_distance);
    let color = if material.is_clear() { material.base_color } else { thickness::color(material, colors) };
    let record = Record::new("SceneBody").with("base_color", color).with("index", material.ior);
    let record = record.with("absorption", absorption).with("kind", kind);
    let metallic = if material.is_metal() { material.metallic } else { 0.0 };
    let alpha = if metallic > 0.0 { material.roughness * material.roughness } else { material.facet_slope() };
    let record = record.with("alpha", alpha).with("clear", clear).with("metallic", metallic);
    let (mut free_path, mut law) = (Vec3::ZERO, ScatteringLaw::default());
    if material.scatters() {
        // Light that is neither scattered nor absorbed has no mean free path, and does not drift.
        let finite = |length: f32| if length.is_finite() { length } else { 0.0 };
        free_path = thickness::free_path(material).unwrap_or_default().map(finite);
        law = ScatteringLaw::matched(material);
    }
    record.with("free_path", free_path).within("law", |record| law.fill(record))
}

/// Returns the bodies around the eye, as the recipe's rays know them: the first four.
fn around(eye: Vec3, bodies: &[Body], mesh: impl Fn(&Body) -> Mesh) -> UVec4 {
    let is_around = |body: &Body| body.material.has_clear_inside() && mesh(body).encloses(eye);
    let mut within = [NONE; 4];
    let found = (0..).zip(bodies).filter(|(_, body)| is_around(body)).map(|(number, _): (u32, _)| 2 * number);
    within.iter_mut().zip(found).for_each(|(place, number)| *place = number);
    within.into()
}

/// Returns the mean radiance of an environment over all directions.
fn mean_radiance(environment: &Environment) -> Vec3 {
    // The constant harmonic.
    (0.5 / std::f64::consts::PI.sqrt() * harmonics::project(environment)[0]).as_vec3()
}

/// Returns the share of light below which a ray ends: less than half a step of an 8-bit display.
fn throughput_limit(settings: &Settings) -> f32 {
    let shown = f64::from(settings.exposure) * f64::from(largest_radiance(&settings.environment).max(1.0));
    (LEAST_DIFFERENCE / shown).min(f64::from(f32::MAX)) as f32
}
