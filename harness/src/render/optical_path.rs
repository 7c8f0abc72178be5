//! Translucent stone: the recipe `optical_path_shading`'s pass, and what fills its costs each frame: voxels, reflective shadow maps,
//! seeds and a solver, all of them on the device.

mod density;
mod seeds;
mod stage;

use super::device::{self, PipelineSource, bind_group, buffer, mesh_vertices};
use super::light_views::{self, LightView};
use super::lighting::{self, Lighting};
use super::pass::{Before, Body, DEPTH_FORMAT, SAMPLE_FORMAT, ScenePass, Shared};
use super::reflective_shadow_map::{self, ReflectiveShadowMaps};
use super::{Note, RenderError, Settings};
use crate::gpu::Gpu;
use crate::optical_path::{Method, Solver, Status};
use crate::scene::{Bounds, Density, Light, Material, Medium, Object, Scene};
use crate::voxel_grid::VoxelGrid;
use crate::voxelization::{MOST_TRIANGLES, Voxelizer};
use density::Densities;
use glam::Vec3;
use seeds::{Lit, Seeded, Seeds};
pub use stage::Stage;
use std::f32::consts::FRAC_1_PI;

/// Texels of a map along a side for each voxel of a grid that all bodies fill: the sphere about a body is up to 1.7 grids wide.
const TEXELS_PER_VOXEL: u32 = 4;
/// For smaller bodies there are more, so that none of their voxels is left out, but no more than this along a side.
const MOST_TEXELS: u32 = 2048;

/// How light's ways through bodies are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Paths {
    /// Voxels along each edge of a body's grid, as [`VoxelGrid::cells`] has them.
    pub cells: u32,
    /// The solver.
    pub method: Method,
}

/// The passes of a frame before the bodies are drawn.
pub(super) struct OpticalPaths<'gpu> {
    gpu: &'gpu Gpu,
    maps: ReflectiveShadowMaps<'gpu>,
    seeds: Seeds,
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

/// Compiles `source`, the composed recipe, and uploads the scene.
pub(super) fn pass<'gpu>(
    gpu: &'gpu Gpu,
    scene: &Scene,
    settings: &Settings,
    paths: Paths,
    source: &str,
) -> Result<ScenePass<'gpu>, RenderError> {
    let extinctions = extinctions(scene, settings)?;
    let bounds = scene.bounds();
    // A sun without light stands in where there is no light.
    let dark = [Light::Directional { toward: Vec3::Y, irradiance: Vec3::ZERO }];
    let lights = if scene.lights.is_empty() { &dark[..] } else { &scene.lights };
    let views = light_views::views(lights, bounds);
    let largest = light_views::largest_irradiance(lights, bounds);
    let color = is_colored(&extinctions, lights);
    let constants = constants(scene, settings, color);
    let pipeline = device::pipeline(
        gpu,
        &PipelineSource {
            recipe: settings.rung.recipe(),
            source,
            entries: ["optical_path_vertex", "optical_path_fragment"],
            constants: &constants,
            formats: &[SAMPLE_FORMAT],
            depth: Some(DEPTH_FORMAT),
        },
    )?;
    let lighting = Lighting::upload(gpu, scene, settings)?;
    let side = map_side(scene, paths.cells).min(gpu.device.limits().max_texture_dimension_2d);
    let mut maps = ReflectiveShadowMaps::new(gpu, &views, side)?;
    let views =
        gpu.guarded("uploading views", |device| buffer(device, &view_bytes(&views), wgpu::BufferUsages::STORAGE))?;
    let seeds = Seeds::new(gpu, &constants)?;
    let lit = Lit { views, maps: maps.view(), lights: lighting.lights.clone() };
    let upload =
        Upload { gpu, pipeline: &pipeline, seeds: &seeds, paths, lit: &lit, largest, color, dense: is_dense(scene) };
    let (mut bodies, mut of_bodies) = (Vec::new(), Vec::new());
    // An object without triangles has nothing to draw, and no buffer is empty.
    let objects = scene.objects.iter().zip(&extinctions).filter(|(object, _)| !object.mesh.indices.is_empty());
    for (object, extinction) in objects {
        let (body, of_body) = upload.body(object, *extinction, &mut maps)?;
        bodies.push(body);
        of_bodies.push(of_body);
    }
    let mut bound = lighting.shared();
    bound.extend([Shared::Buffer(lit.views), Shared::Texture(lit.maps)]);
    let before = vec![Before::Paths(OpticalPaths { gpu, maps, seeds, bodies: of_bodies })];
    Ok(ScenePass { gpu, pipeline, shared: bound, bodies, before })
}

/// Texels along the sides of the lights' maps, which show all bodies: so many that the smallest one's voxels are seen.
fn map_side(scene: &Scene, cells: u32) -> u32 {
    let widest = 2.0 / 3f32.sqrt() * scene.bounds().radius();
    let extent = |object: &Object| {
        let bounds = Bounds::of(object.mesh.positions.iter().copied());
        (bounds.max - bounds.min).max_element()
    };
    let extents = scene.objects.iter().filter(|object| !object.mesh.indices.is_empty()).map(extent);
    let least = extents.filter(|extent| *extent > 0.0).fold(widest, f32::min);
    let side = TEXELS_PER_VOXEL * cells;
    if least < widest { (side as f32 * (widest / least)).min(MOST_TEXELS.max(side) as f32) as u32 } else { side }
}

/// What sending a body to the device takes beside the body.
struct Upload<'a, 'gpu> {
    gpu: &'gpu Gpu,
    pipeline: &'a wgpu::RenderPipeline,
    seeds: &'a Seeds,
    paths: Paths,
    lit: &'a Lit,
    /// The irradiance whose cost is 0, for each channel.
    largest: Vec3,
    /// Each channel has costs of its own.
    color: bool,
    /// Some body's density differs from place to place.
    dense: bool,
}

impl<'gpu> Upload<'_, 'gpu> {
    /// A body to be drawn, and what finds the light's ways through it. The maps are to show it too.
    fn body(
        &self,
        object: &Object,
        extinction: Vec3,
        maps: &mut ReflectiveShadowMaps<'gpu>,
    ) -> Result<(Body, BodyPaths<'gpu>), RenderError> {
        let gpu = self.gpu;
        let Object { mesh, material, name } = object;
        let grid = VoxelGrid::about(Bounds::of(mesh.positions.iter().copied()), self.paths.cells);
        let parts: [&[u8]; 3] = [
            bytemuck::cast_slice(&mesh.positions),
            bytemuck::cast_slice(&mesh.indices),
            bytemuck::cast_slice(&mesh.normals),
        ];
        let vertices = mesh_vertices(gpu, object, &mesh.indices, parts)?;
        let [positions, indices, normals] = gpu.guarded("uploading a mesh", |device| {
            parts.map(|part| buffer(device, part, wgpu::BufferUsages::STORAGE))
        })?;
        maps.add([&positions, &indices, &normals], vertices)?;
        if mesh.triangle_count() > MOST_TRIANGLES as usize {
            let [bytes, limit] = [mesh.triangle_count() as u64, MOST_TRIANGLES.into()].map(|count| 12 * count);
            return Err(RenderError::TooLarge { what: format!("mesh `{name}`"), bytes, limit });
        }
        let voxelizer = Voxelizer::new(gpu, grid, mesh.triangle_count() as u32, &[])?;
        let density = material.medium.as_ref().map_or(&Density::Uniform, |medium| &medium.density);
        let densities = Densities::new(gpu, grid, density, &voxelizer.matter)?;
        let solver = Solver::new(gpu, grid, self.paths.method, densities.is_some(), None)?;
        let same = gpu.guarded("allocating densities", |device| {
            // Beside bodies whose density differs, one whose does not has it too; in a scene of the latter nobody reads it.
            let count = if self.dense && densities.is_none() { grid.count() } else { 1 };
            buffer(device, bytemuck::cast_slice(&vec![1f32; count]), wgpu::BufferUsages::STORAGE)
        })?;
        let density = densities.as_ref().map_or(&same, |densities| &densities.buffer);
        let channels = (0..if self.color { 3 } else { 1 })
            .map(|channel| self.channel(channel, extinction[channel], grid, [&voxelizer.matter, density], &solver))
            .collect::<Result<Vec<_>, _>>()?;
        let group = gpu.guarded("uploading a material", |device| {
            let uniform = body_bytes(grid, material, extinction, self.largest);
            let uniform = buffer(device, &uniform, wgpu::BufferUsages::UNIFORM);
            let costs = |channel: usize| &channels.get(channel).unwrap_or(&channels[0]).costs;
            let buffers = [&uniform, &positions, &indices, &normals, costs(0), costs(1), costs(2), density];
            bind_group(device, self.pipeline, 1, buffers.map(wgpu::Buffer::as_entire_binding).into())
        })?;
        let brightest = FRAC_1_PI * material.base_color * self.largest;
        let name = name.clone();
        let of_body = BodyPaths { name, grid, voxelizer, densities, solver, positions, indices, channels, brightest };
        Ok((Body { groups: vec![group], vertices }, of_body))
    }

    fn channel(
        &self,
        number: usize,
        extinction: f32,
        grid: VoxelGrid,
        [matter, density]: [&wgpu::Buffer; 2],
        solver: &Solver<'_>,
    ) -> Result<Channel, RenderError> {
        let status = solver.kept_status()?;
        Ok(self.gpu.guarded("allocating costs", |device| {
            let costs = device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("costs"),
                size: 4 * grid.count() as u64,
                usage: wgpu::BufferUsages::STORAGE,
                mapped_at_creation: false,
            });
            let largest = self.largest[number];
            let seeded = Seeded { grid, matter, density, costs: &costs, extinction, largest, channel: number as u32 };
            let groups = self.seeds.bind(device, self.lit, &seeded);
            Channel { extinction, costs, groups, status }
        })?)
    }
}

/// The overrides of the recipes for these settings.
pub(crate) fn constants(scene: &Scene, settings: &Settings, color: bool) -> Vec<(&'static str, f64)> {
    let mut constants = vec![
        ("EFFECT_OPTICAL_PATH", 1.0),
        ("EFFECT_COLOR", f64::from(u8::from(color))),
        ("EFFECT_EXTINCTION_PER_VOXEL", f64::from(u8::from(is_dense(scene)))),
    ];
    constants.extend(lighting::constants(scene, settings));
    constants
}

/// Beside the extinction itself, how often that of diffused light, √(3 absorption × extinction), counts: docs/optical_path_shading.md has the fit.
const EFFECTIVE_WEIGHT: f32 = 2.0;

/// What each object takes from light on its way, per unit of length: the settings' scale times what scattering and absorption take, and absorption
/// once more as it acts on light that is scattered all along.
fn extinctions(scene: &Scene, settings: &Settings) -> Result<Vec<Vec3>, RenderError> {
    let of = |object: &Object| {
        let Some(Medium { scattering, absorption, anisotropy, .. }) = &object.material.medium else {
            return Err(RenderError::NoMedium {
                object: object.name.clone(),
                material: object.material.name.clone(),
                rung: settings.rung,
            });
        };
        // Light that is scattered forwards goes on: similarity theory.
        let extinction = *scattering * (1.0 - anisotropy) + *absorption;
        let effective = (3.0 * *absorption * extinction).map(f32::sqrt);
        Ok(settings.extinction_scale * (extinction + EFFECTIVE_WEIGHT * effective))
    };
    scene.objects.iter().map(of).collect()
}

/// Whether any body's density differs from place to place.
fn is_dense(scene: &Scene) -> bool {
    let media = scene.objects.iter().filter_map(|object| object.material.medium.as_ref());
    media.into_iter().any(|medium| medium.density != Density::Uniform)
}

/// Whether red, green and blue differ in any body's extinction or any light.
fn is_colored(extinctions: &[Vec3], lights: &[Light]) -> bool {
    let grey = |color: Vec3| color.x == color.y && color.y == color.z;
    !(extinctions.iter().copied().all(grey) && lights.iter().map(Light::power).all(grey))
}

/// `OpticalPathBody` of the recipe.
fn body_bytes(grid: VoxelGrid, material: &Material, extinction: Vec3, largest: Vec3) -> Vec<u8> {
    let tail = [
        material.base_color.extend(material.ior),
        extinction.extend(material.roughness * material.roughness),
        largest.extend(0.0),
    ];
    let tail = tail.map(|row| row.to_array()).concat();
    bytemuck::cast_slice(&[&grid.words()[..], &tail].concat()).to_vec()
}

/// `array<LightView>` of the part `light_views`.
fn view_bytes(views: &[LightView]) -> Vec<u8> {
    let entry = |from: &LightView| {
        [reflective_shadow_map::bytes(from.view), [from.light, 0, 0, 0].map(u32::to_ne_bytes).concat()].concat()
    };
    views.iter().flat_map(entry).collect()
}

impl OpticalPaths<'_> {
    /// Everything that the frame's picture looks up, from the meshes and lights alone.
    pub(super) fn encode(&self, encoder: &mut wgpu::CommandEncoder) -> Result<(), RenderError> {
        Stage::ALL.into_iter().try_for_each(|stage| self.encode_stage(encoder, stage))
    }

    /// One stage of it, after those before. Nothing of [`Stage::Shade`], which is no part of it.
    pub(super) fn encode_stage(&self, encoder: &mut wgpu::CommandEncoder, stage: Stage) -> Result<(), RenderError> {
        match stage {
            Stage::Voxels => self.bodies.iter().try_for_each(|body| self.encode_voxels(encoder, body)),
            Stage::Maps => Ok(self.gpu.guarded("drawing reflective shadow maps", |_| self.maps.encode(encoder))?),
            Stage::Seeds => {
                let channels = self.bodies.iter().flat_map(|body| body.channels.iter().map(move |of| (body, of)));
                channels.into_iter().try_for_each(|(body, channel)| self.encode_seeds(encoder, body, channel))
            }
            Stage::Solve => {
                for body in &self.bodies {
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

    fn encode_voxels(&self, encoder: &mut wgpu::CommandEncoder, body: &BodyPaths<'_>) -> Result<(), RenderError> {
        body.voxelizer.encode(encoder, &body.positions, &body.indices)?;
        if let Some(densities) = &body.densities {
            self.gpu.guarded("finding densities", |_| densities.encode(encoder))?;
        }
        Ok(())
    }

    fn encode_seeds(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        body: &BodyPaths<'_>,
        channel: &Channel,
    ) -> Result<(), RenderError> {
        Ok(self.gpu.guarded("seeding costs", |_| {
            self.seeds.encode(encoder, &channel.groups, body.grid.cells, self.maps.size());
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
