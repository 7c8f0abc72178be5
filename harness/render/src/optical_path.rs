//! Translucent stone: the recipe `optical_path_shading`'s pass, and what fills its costs each frame: voxels, reflective shadow maps,
//! seeds and a solver, all of them on the device.

mod density;
mod seeds;
mod stage;

use super::device::{self, Pipeline, PipelineSource, mesh_vertices, storage};
use super::light_views;
use super::lighting::Lighting;
use super::pass::{Before, Body, DEPTH_FORMAT, SAMPLE_FORMAT, ScenePass, Shared, Variant};
use super::reflective_shadow_map::{self, ReflectiveShadowMaps};
use super::variant::{Drawn, Part};
use super::{RenderError, Settings};
use crate::record::Record;
use crate::solver::{Solver, Status};
use crate::voxel_grid::VoxelGrid;
use crate::voxelization::{MOST_TRIANGLES, Voxelizer};
use density::Densities;
use glam::Vec3;
use lapidary_gpu::capture::OfObject;
use lapidary_gpu::{Encoder, Gpu};
use lapidary_plan::{Effect, Note, Rung};
use lapidary_scene::solver::Paths;
use lapidary_scene::{Bounds, Density, Light, Material, Object};
use seeds::{Lit, Seeded, Seeds};
pub use stage::Stage;
use std::f32::consts::FRAC_1_PI;

/// Texels of a map along a side for each voxel of a grid that all bodies fill: the sphere about a body is up to 1.7 grids wide.
const TEXELS_PER_VOXEL: u32 = 4;
/// For smaller bodies there are more, so that none of their voxels is left out, but no more than this along a side.
const MOST_TEXELS: u32 = 2048;

/// The passes of a frame before the bodies are drawn.
pub(super) struct OpticalPaths<'gpu> {
    gpu: &'gpu Gpu,
    maps: ReflectiveShadowMaps<'gpu>,
    /// Of each variant.
    seeds: Vec<Seeds>,
    bodies: Vec<BodyPaths<'gpu>>,
}

/// Of one body.
struct BodyPaths<'gpu> {
    /// Of its object.
    name: String,
    grid: VoxelGrid,
    voxelizer: Voxelizer<'gpu>,
    densities: Option<Densities>,
    solver: Solver<'gpu>,
    positions: wgpu::Buffer,
    indices: wgpu::Buffer,
    channels: Vec<Channel>,
    /// Which of the seeds' variants.
    variant: usize,
    /// What the surface sends back where the cost is 0, for each channel: linear radiance.
    brightest: Vec3,
}

/// Of one of a body's channels.
struct Channel {
    extinction: f32,
    costs: wgpu::Buffer,
    groups: seeds::Groups,
    /// How far its last solve came.
    status: wgpu::Buffer,
}

/// Compiles `source`, the composed recipe, for the effects of each body, and uploads the bodies.
pub(super) fn pass<'gpu>(
    gpu: &'gpu Gpu,
    lighting: &Lighting<'_>,
    part: &Part<'_>,
    paths: Paths,
    source: &str,
) -> Result<ScenePass<'gpu>, RenderError> {
    for drawn in &part.objects {
        check(drawn.object, part.rung)?;
    }
    let bounds = part.bounds();
    // A sun without light stands in where there is no light.
    let dark = [Light::Directional { toward: Vec3::Y, irradiance: Vec3::ZERO }];
    let lights = if part.lights.is_empty() { &dark[..] } else { part.lights };
    let views = light_views::views(lights, bounds);
    let largest = light_views::largest_irradiance(lights, bounds);
    // Where there is no light, a texel is enough to say so.
    let side = if part.lights.is_empty() { 1 } else { map_side(part, paths.cells) };
    let side = side.min(gpu.device.limits().max_texture_dimension_2d);
    let mut maps = ReflectiveShadowMaps::new(gpu, &views, side, &format!("of {}", part.rung))?;
    let views = reflective_shadow_map::view_buffer(gpu, &views)?;
    let lit = Lit { views, maps: maps.view(), lights: lighting.lights()?.clone() };
    let mut pass = ScenePass::empty(gpu);
    let (mut seeds, mut bodies) = (Vec::new(), Vec::new());
    for (constants, objects) in part.variants(|drawn| drawn.decisions.constants()) {
        let from = PipelineSource {
            recipe: part.rung.recipe(),
            source,
            entries: ["optical_path_vertex", "optical_path_fragment"],
            constants: &constants,
            formats: &[SAMPLE_FORMAT],
            depth: Some(DEPTH_FORMAT),
        };
        let pipeline = device::pipeline(gpu, &from)?;
        let mut shared = lighting.shared(&pipeline)?;
        shared.extend([(4, Shared::Buffer(lit.views.clone())), (5, Shared::Texture(lit.maps.clone()))]);
        let follows = objects.iter().any(|drawn| drawn.decisions.has(Effect::OpticalPath));
        let variant = seeds.len();
        if follows {
            seeds.push(Seeds::new(gpu, &constants)?);
        }
        let seeds = seeds.get(variant);
        let upload =
            Upload { gpu, pipeline: &pipeline, seeds, variant, paths, lit: &lit, largest, settings: part.settings };
        let mut drawn_bodies = Vec::new();
        for drawn in objects {
            let (body, of_body) = upload.body(drawn, &mut maps)?;
            drawn_bodies.push(body);
            bodies.extend(of_body);
        }
        pass.variants.push(Variant { pipeline, shared, bodies: drawn_bodies });
    }
    pass.before.push(Before::Paths(OpticalPaths { gpu, maps, seeds, bodies }));
    Ok(pass)
}

/// Refuses a body through which no light can be followed.
fn check(object: &Object, rung: Rung) -> Result<(), RenderError> {
    let Object { name, material, mesh } = object;
    if material.medium.is_none() {
        return Err(RenderError::NoMedium { object: name.clone(), material: material.name.clone(), rung });
    }
    if mesh.triangle_count() > MOST_TRIANGLES as usize {
        let [bytes, limit] = [mesh.triangle_count() as u64, MOST_TRIANGLES.into()].map(|count| 12 * count);
        return Err(RenderError::TooLarge { what: format!("mesh `{name}`"), bytes, limit });
    }
    Ok(())
}

/// Texels along the sides of the lights' maps, which show all bodies: so many that the smallest one's voxels are seen.
fn map_side(part: &Part<'_>, cells: u32) -> u32 {
    let widest = 2.0 / 3f32.sqrt() * part.bounds().radius();
    let extent = |drawn: &Drawn<'_>| {
        let bounds = Bounds::of(drawn.object.mesh.positions.iter().copied());
        (bounds.max - bounds.min).max_element()
    };
    let extents = part.objects.iter().map(extent);
    let least = extents.filter(|extent| *extent > 0.0).fold(widest, f32::min);
    let side = TEXELS_PER_VOXEL * cells;
    if least < widest { (side as f32 * (widest / least)).min(MOST_TEXELS.max(side) as f32) as u32 } else { side }
}

/// What sending a body to the device takes beside the body.
struct Upload<'a, 'gpu> {
    gpu: &'gpu Gpu,
    pipeline: &'a Pipeline,
    /// Of this variant, where it follows light through bodies.
    seeds: Option<&'a Seeds>,
    variant: usize,
    paths: Paths,
    lit: &'a Lit,
    /// The irradiance whose cost is 0, for each channel.
    largest: Vec3,
    settings: &'a Settings,
}

impl<'gpu> Upload<'_, 'gpu> {
    /// A body to be drawn, and what finds the light's ways through it, where any are followed. The maps are to show it too.
    fn body(
        &self,
        drawn: &Drawn<'_>,
        maps: &mut ReflectiveShadowMaps<'gpu>,
    ) -> Result<(Body, Option<BodyPaths<'gpu>>), RenderError> {
        let gpu = self.gpu;
        let Drawn { object: Object { mesh, material, .. }, name, .. } = drawn;
        let _of = OfObject::named(name);
        let extinction = extinction(material, self.settings);
        let grid = VoxelGrid::about(Bounds::of(mesh.positions.iter().copied()), self.paths.cells);
        let parts: [(&str, &[u8]); 3] = [
            ("positions", bytemuck::cast_slice(&mesh.positions)),
            ("indices", bytemuck::cast_slice(&mesh.indices)),
            ("normals", bytemuck::cast_slice(&mesh.normals)),
        ];
        let vertices = mesh_vertices(gpu, drawn.object, &mesh.indices, parts.map(|(_, contents)| contents))?;
        let [positions, indices, normals] =
            gpu.guarded("uploading a mesh", |device| parts.map(|(what, part)| storage(device, what, part)))?;
        maps.add(name, [&positions, &indices, &normals], vertices)?;
        let of_body = match self.seeds {
            Some(seeds) => Some(self.paths(drawn, seeds, grid, extinction, [&positions, &indices])?),
            None => None,
        };
        let group = gpu.guarded("uploading a material", |device| {
            let record = body_bytes(grid, material, extinction, self.largest);
            let record = storage(device, "material", &record);
            let mut buffers = vec![(0, &record), (1, &positions), (2, &indices), (3, &normals)];
            if let Some(of_body) = &of_body {
                buffers.extend((4..).zip(of_body.channels.iter().map(|channel| &channel.costs)));
                buffers.extend(of_body.densities.as_ref().map(|densities| (7, &densities.buffer)));
            }
            let resources: Vec<_> =
                buffers.into_iter().map(|(binding, buffer)| (binding, buffer.as_entire_binding())).collect();
            self.pipeline.bind(device, 1, &resources)
        })?;
        Ok((Body { name: name.clone(), groups: vec![group], vertices }, of_body))
    }

    /// What finds the light's ways through a body.
    fn paths(
        &self,
        drawn: &Drawn<'_>,
        seeds: &Seeds,
        grid: VoxelGrid,
        extinction: Vec3,
        [positions, indices]: [&wgpu::Buffer; 2],
    ) -> Result<BodyPaths<'gpu>, RenderError> {
        let gpu = self.gpu;
        let Drawn { object: Object { mesh, material, .. }, name, decisions } = drawn;
        let voxelizer = Voxelizer::new(gpu, grid, mesh, &decisions.constants())?;
        let density = material.medium.as_ref().map_or(&Density::Uniform, |medium| &medium.density);
        let density = if decisions.has(Effect::ExtinctionPerVoxel) { density } else { &Density::Uniform };
        let densities = Densities::new(gpu, grid, density, &voxelizer.matter)?;
        let solver = Solver::new(gpu, grid, self.paths.method, densities.is_some(), None)?;
        let of_voxels = (&voxelizer.matter, densities.as_ref().map(|densities| &densities.buffer));
        let channels = (0..if decisions.has(Effect::Color) { 3 } else { 1 })
            .map(|channel| self.channel(channel, extinction[channel], grid, of_voxels, (seeds, &solver)))
            .collect::<Result<Vec<_>, _>>()?;
        Ok(BodyPaths {
            name: name.clone(),
            grid,
            voxelizer,
            densities,
            solver,
            positions: positions.clone(),
            indices: indices.clone(),
            channels,
            variant: self.variant,
            brightest: FRAC_1_PI * material.base_color * self.largest,
        })
    }

    fn channel(
        &self,
        number: usize,
        extinction: f32,
        grid: VoxelGrid,
        (matter, density): (&wgpu::Buffer, Option<&wgpu::Buffer>),
        (seeds, solver): (&Seeds, &Solver<'_>),
    ) -> Result<Channel, RenderError> {
        let status = solver.kept_status()?;
        Ok(self.gpu.guarded("allocating costs", |device| {
            let costs = device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(["costs of red", "costs of green", "costs of blue"][number]),
                size: 4 * grid.count() as u64,
                usage: wgpu::BufferUsages::STORAGE,
                mapped_at_creation: false,
            });
            let largest = self.largest[number];
            let seeded = Seeded { grid, matter, density, costs: &costs, extinction, largest, channel: number as u32 };
            let groups = seeds.bind(device, self.lit, &seeded);
            Channel { extinction, costs, groups, status }
        })?)
    }
}

/// Beside the extinction itself, how often that of diffused light, √(3 absorption × extinction), counts: docs/optical_path_shading.md has the fit.
const EFFECTIVE_WEIGHT: f32 = 2.0;

/// What a body takes from light on its way, per unit of length: the settings' scale times what scattering and absorption take, and absorption
/// once more as it acts on light that is scattered all along.
fn extinction(material: &Material, settings: &Settings) -> Vec3 {
    let Some(medium) = &material.medium else {
        return Vec3::ZERO;
    };
    let extinction = medium.transport_extinction();
    let effective = (3.0 * medium.absorption * extinction).map(f32::sqrt);
    settings.extinction_scale * (extinction + EFFECTIVE_WEIGHT * effective)
}

/// `OpticalPathBody` of the recipe.
fn body_bytes(grid: VoxelGrid, material: &Material, extinction: Vec3, largest: Vec3) -> Vec<u8> {
    let record = Record::new("OpticalPathBody").within("grid", |record| grid.fill(record));
    let record = record.with("base_color", material.base_color).with("index", material.ior);
    let record = record.with("extinction", extinction).with("alpha", material.roughness * material.roughness);
    record.with("largest", largest).bytes()
}

impl OpticalPaths<'_> {
    /// Everything that the frame's picture looks up, from the meshes and lights alone.
    pub(super) fn encode(&self, encoder: &mut Encoder) -> Result<(), RenderError> {
        Stage::ALL.into_iter().try_for_each(|stage| self.encode_stage(encoder, stage))
    }

    /// One stage of it, after those before. Nothing of [`Stage::Shade`], which is no part of it.
    pub(super) fn encode_stage(&self, encoder: &mut Encoder, stage: Stage) -> Result<(), RenderError> {
        match stage {
            Stage::Voxels => self.bodies.iter().try_for_each(|body| self.encode_voxels(encoder, body)),
            Stage::Maps => Ok(self.gpu.guarded("drawing reflective shadow maps", |_| self.maps.encode(encoder))?),
            Stage::Seeds => {
                let channels = self.bodies.iter().flat_map(|body| body.channels.iter().map(move |of| (body, of)));
                channels.into_iter().try_for_each(|(body, channel)| self.encode_seeds(encoder, body, channel))
            }
            Stage::Solve => {
                for body in &self.bodies {
                    let _of = OfObject::named(&body.name);
                    let density = body.densities.as_ref().map(|densities| &densities.buffer);
                    for Channel { costs, extinction, status, .. } in &body.channels {
                        body.solver.encode(encoder, &body.voxelizer.matter, density, costs, *extinction)?;
                        body.solver.keep_status(encoder, status);
                    }
                }
                Ok(())
            }
            Stage::Shade => Ok(()),
        }
    }

    fn encode_voxels(&self, encoder: &mut Encoder, body: &BodyPaths<'_>) -> Result<(), RenderError> {
        let _of = OfObject::named(&body.name);
        body.voxelizer.encode(encoder, &body.positions, &body.indices)?;
        if let Some(densities) = &body.densities {
            self.gpu.guarded("finding densities", |_| densities.encode(encoder))?;
        }
        Ok(())
    }

    fn encode_seeds(&self, encoder: &mut Encoder, body: &BodyPaths<'_>, channel: &Channel) -> Result<(), RenderError> {
        let _of = OfObject::named(&body.name);
        Ok(self.gpu.guarded("seeding costs", |_| {
            self.seeds[body.variant].encode(encoder, &channel.groups, body.grid.cells, self.maps.size());
        })?)
    }

    /// What is to be said about the last submitted frame. Waits for it.
    pub(super) fn notes(&self) -> Result<Vec<Note>, RenderError> {
        let mut notes = Vec::new();
        for body in &self.bodies {
            let odd_columns = body.voxelizer.status()?.odd_columns;
            if odd_columns > 0 {
                let columns = body.grid.cells * body.grid.cells;
                notes.push(Note::Open { object: body.name.clone(), odd_columns, columns });
            }
            let mut bound = 0f32;
            for (number, channel) in body.channels.iter().enumerate() {
                // The first serves all three where there is no other.
                let brightest = if body.channels.len() == 1 {
                    body.brightest.max_element()
                } else {
                    body.brightest.to_array()[number]
                };
                bound = bound.max(brightest * body.solver.status_of(&channel.status)?.luminance_bound());
            }
            if bound > 0.0 {
                notes.push(Note::StoppedEarly { object: body.name.clone(), bound });
            }
        }
        Ok(notes)
    }

    /// How many draw calls it takes.
    pub(super) fn draw_calls(&self) -> usize {
        self.maps.draw_calls()
    }

    /// How far each body's solver came in its last channel. Waits for the device.
    pub(super) fn statuses(&self) -> Result<Vec<Status>, RenderError> {
        let last = |body: &BodyPaths<'_>| body.channels.last().map(|channel| body.solver.status_of(&channel.status));
        Ok(self.bodies.iter().filter_map(last).collect::<Result<_, _>>()?)
    }

    /// Bytes of the maps, and of each body's voxels, densities, costs and solver.
    pub(super) fn bytes(&self) -> u64 {
        let of = |body: &BodyPaths<'_>| {
            let costs: u64 = body.channels.iter().map(|channel| channel.costs.size()).sum();
            let densities = body.densities.as_ref().map_or(0, |densities| densities.buffer.size());
            body.voxelizer.bytes() + densities + costs + body.solver.bytes()
        };
        self.maps.bytes() + self.bodies.iter().map(of).sum::<u64>()
    }
}
