//! Translucent stone: the pass of the recipe `optical_path_shading`, and the stages that compute
//! its costs each frame on the device: voxels, reflective shadow maps, seeds and a solver.

mod seeds;

use super::density::{Densities, Where};
use super::light_maps::{LightMaps, Lit};
use super::lighting::Lighting;
use super::mesh_buffers::{MeshBuffers, ShapeBuffers, Shapes};
use super::pass::{Before, Body, DEPTH_FORMAT, SAMPLE_FORMAT, ScenePass, Variant};
use super::reflective_shadow_map::ReflectiveShadowMaps;
use super::scattering_law::ScatteringLaw;
use super::stage::Stage;
use super::variant::{Drawn, Part};
use super::{RenderError, Settings};
use crate::frame::record::Record;
use crate::frame::{Bound, Buffer, Builder, Dispatch, Executor, Frame, PipelineId, PipelineSource};
use crate::solver::{Solve, Solved, Solver, Status};
use crate::voxel_grid::VoxelGrid;
use crate::voxelization::Voxelizer;
use glam::Vec3;
use lapidary_gpu::GpuError;
use lapidary_plan::{Decisions, Effect, Note};
use lapidary_scene::solver::Paths;
use lapidary_scene::{Bounds, Density, Material, Object};
use seeds::{Seeded, Seeds};
use std::f32::consts::FRAC_1_PI;
use std::ops::Range;

/// The passes of a frame before the bodies are drawn.
pub(super) struct OpticalPaths {
    maps: ReflectiveShadowMaps,
    bodies: Vec<BodyPaths>,
}

/// Buffers and passes of one body.
struct BodyPaths {
    /// Name of its object.
    name: String,
    voxelizer: Voxelizer,
    densities: Option<Densities>,
    solver: Solver,
    positions: Buffer,
    indices: Buffer,
    channels: Vec<Channel>,
    /// Linear radiance that the surface sends back where the cost is 0, for each channel.
    brightest: Vec3,
}

/// Passes of one of a body's channels.
struct Channel {
    seeds: Vec<Dispatch>,
    solved: Solved,
}

/// Compiles `source`, the composed recipe, for the effects of each body, and adds the bodies.
pub(super) fn pass(
    builder: &mut Builder<'_>,
    lighting: &Lighting<'_>,
    part: &Part<'_>,
    paths: Paths,
    source: &str,
) -> Result<ScenePass, RenderError> {
    let LightMaps { mut maps, lit, largest } = LightMaps::of(builder, lighting, part, paths.cells)?;
    let mut pass = ScenePass::default();
    let mut bodies = Vec::new();
    for (constants, objects) in part.variants(|drawn| drawn.decisions.constants()) {
        let pipeline = builder.render_pipeline(&PipelineSource {
            recipe: part.rung.recipe(),
            source,
            entries: ["optical_path_vertex", "optical_path_fragment"],
            constants: &constants,
            formats: &[SAMPLE_FORMAT],
            depth: Some(DEPTH_FORMAT),
        })?;
        let mut shared = lighting.shared(builder, pipeline)?;
        shared.extend([(4, lit.views.into()), (5, lit.maps)]);
        let follows = objects.iter().any(|drawn| drawn.decisions.has(Effect::OpticalPath));
        let seeds = follows.then(|| Seeds::new(builder, &constants)).transpose()?;
        let add = Add { pipeline, seeds, paths, lit: &lit, largest, settings: part.settings };
        let mut drawn_bodies = Vec::new();
        for drawn in objects {
            let (body, of_body) =
                builder.of_object(&drawn.name, |builder| add.body(builder, drawn, (&lighting.shapes, &mut maps)))?;
            drawn_bodies.push(body);
            bodies.extend(of_body);
        }
        pass.variants.push(Variant { pipeline, targets: 1, reads_screen: false, shared, bodies: drawn_bodies });
    }
    pass.before.push(Before::Paths(OpticalPaths { maps, bodies }));
    Ok(pass)
}

/// Inputs for adding a body, besides the body itself.
struct Add<'a> {
    pipeline: PipelineId,
    /// Seeding pipelines of this variant; `None` if it does not follow light through bodies.
    seeds: Option<Seeds>,
    paths: Paths,
    lit: &'a Lit,
    /// Irradiance whose cost is 0, for each channel.
    largest: Vec3,
    settings: &'a Settings,
}

impl Add<'_> {
    /// Returns a body to draw and, if light is followed through it, the passes that find the paths.
    /// Also adds the body to the maps.
    fn body(
        &self,
        builder: &mut Builder<'_>,
        drawn: &Drawn<'_>,
        (shapes, maps): (&Shapes, &mut ReflectiveShadowMaps),
    ) -> Result<(Body, Option<BodyPaths>), RenderError> {
        let Drawn { object: Object { mesh, material, .. }, name, decisions } = drawn;
        let extinction = extinction(material, self.settings);
        let grid = VoxelGrid::about(Bounds::of(mesh.positions.iter().copied()), self.paths.cells);
        let shape = shapes.of(builder, name, drawn.object)?;
        let buffers = MeshBuffers::of(builder, shape, drawn.object)?;
        maps.add(builder, name, &buffers)?;
        let of_body = match &self.seeds {
            Some(seeds) => Some(self.paths(builder, drawn, seeds, grid, extinction, shape)?),
            None => None,
        };
        let record = builder.record("material", record_of(grid, (material, decisions), extinction, self.largest));
        let MeshBuffers { shape: ShapeBuffers { positions, indices, vertices }, normals } = buffers;
        let mut resources: Vec<(u32, Bound)> =
            (0..).zip([record, positions, indices, normals].map(Bound::from)).collect();
        if let Some(of_body) = &of_body {
            resources.extend((4..).zip(of_body.channels.iter().map(|channel| channel.solved.cost.into())));
            resources.extend(of_body.densities.as_ref().map(|densities| (7, densities.buffer.into())));
        }
        let group = builder.bind(self.pipeline, 1, &resources);
        Ok((Body { name: name.clone(), groups: vec![group], vertices, instances: 1 }, of_body))
    }

    /// Returns the buffers and passes that find the light's paths through a body.
    fn paths(
        &self,
        builder: &mut Builder<'_>,
        drawn: &Drawn<'_>,
        seeds: &Seeds,
        grid: VoxelGrid,
        extinction: Vec3,
        ShapeBuffers { positions, indices, .. }: ShapeBuffers,
    ) -> Result<BodyPaths, RenderError> {
        let Drawn { object: Object { mesh, material, .. }, name, decisions } = drawn;
        let voxelizer = Voxelizer::new(builder, grid, mesh, &decisions.constants())?;
        let density = material.medium.as_ref().map_or(&Density::Uniform, |medium| &medium.density);
        let density = if decisions.has(Effect::ExtinctionPerVoxel) { density } else { &Density::Uniform };
        let densities = Densities::new(builder, grid, density, Where::Near(voxelizer.matter))?;
        let solve = Solve { method: self.paths.method, heterogeneous: densities.is_some(), most_passes: None };
        let solver = Solver::new(builder, grid, solve)?;
        let (matter, density) = (voxelizer.matter, densities.as_ref().map(|densities| densities.buffer));
        let mut channel = |number: usize| {
            let kept = Solver::kept(builder);
            let what = ["costs of red", "costs of green", "costs of blue"][number];
            let cost = builder.buffer(what, 4 * grid.count() as u64, wgpu::BufferUsages::STORAGE);
            let (extinction, largest) = (extinction[number], self.largest[number]);
            let seeded = Seeded { grid, matter, density, costs: cost, extinction, largest, channel: number as u32 };
            let seeds = seeds.dispatches(builder, self.lit, &seeded);
            Channel { seeds, solved: Solved { matter, density, cost, extinction, kept } }
        };
        let channels = (0..if decisions.has(Effect::Color) { 3 } else { 1 }).map(&mut channel).collect();
        Ok(BodyPaths {
            name: name.clone(),
            voxelizer,
            densities,
            solver,
            positions,
            indices,
            channels,
            brightest: FRAC_1_PI * material.base_color * self.largest,
        })
    }
}

/// Weight of the extinction of diffused light, √(3 absorption × extinction), relative to the
/// extinction itself; docs/optical_path_shading.md has the fit.
const EFFECTIVE_WEIGHT: f32 = 2.0;

/// Returns the extinction along a path, per unit of length: the settings' scale times the sum of
/// the extinction by scattering and absorption, and a second absorption term for light that is
/// scattered all along its path.
fn extinction(material: &Material, settings: &Settings) -> Vec3 {
    let Some(medium) = &material.medium else {
        return Vec3::ZERO;
    };
    let extinction = medium.transport_extinction();
    let effective = (3.0 * medium.absorption * extinction).map(f32::sqrt);
    settings.optical_path.extinction_scale * (extinction + EFFECTIVE_WEIGHT * effective)
}

/// Fills `OpticalPathBody` of the recipe.
fn record_of(
    grid: VoxelGrid,
    (material, decisions): (&Material, &Decisions),
    extinction: Vec3,
    largest: Vec3,
) -> Record {
    let record = Record::new("OpticalPathBody").within("grid", |record| grid.fill(record));
    let record = record.with("base_color", material.base_color).with("index", material.ior);
    let record = record.with("extinction", extinction).with("alpha", material.roughness * material.roughness);
    let record = record.with("largest", largest);
    record.within("law", |record| ScatteringLaw::of_object(material, decisions).fill(record))
}

impl OpticalPaths {
    /// Encodes the passes that compute all the data that the frame's picture looks up, from the
    /// meshes and lights alone. Returns the range of passes of each stage except [`Stage::Shade`],
    /// which is not part of it.
    pub(super) fn encode(&self, builder: &mut Builder<'_>) -> [Range<usize>; Stage::ALL.len() - 1] {
        Stage::before_shading(builder, &self.maps, &self.bodies, |body| &body.name, BodyPaths::encode)
    }

    /// Returns the notes on the last frame that was run. Waits for it.
    pub(super) fn notes(&self, executor: &Executor<'_>) -> Result<Vec<Note>, GpuError> {
        let mut notes = Vec::new();
        for body in &self.bodies {
            notes.extend(body.voxelizer.note(executor, &body.name)?);
            let mut bound = 0f32;
            for (number, channel) in body.channels.iter().enumerate() {
                // The first brightness covers all three channels if there is only one.
                let brightest = if body.channels.len() == 1 {
                    body.brightest.max_element()
                } else {
                    body.brightest.to_array()[number]
                };
                bound = bound.max(brightest * Status::read(executor, channel.solved.kept)?.luminance_bound());
            }
            if bound > 0.0 {
                notes.push(Note::StoppedEarly { object: body.name.clone(), bound });
            }
        }
        Ok(notes)
    }

    /// Returns how far each body's solver got in its last channel. Waits for the device.
    pub(super) fn statuses(&self, executor: &Executor<'_>) -> Result<Vec<Status>, GpuError> {
        let last = |body: &BodyPaths| Some(Status::read(executor, body.channels.last()?.solved.kept));
        self.bodies.iter().filter_map(last).collect()
    }

    /// Size in bytes of the maps and of each body's voxels, densities, costs and solver.
    pub(super) fn bytes(&self, frame: &Frame) -> u64 {
        let of = |body: &BodyPaths| {
            let costs = frame.bytes_of(body.channels.iter().map(|channel| channel.solved.cost));
            let densities = body.densities.as_ref().map_or(0, |densities| densities.bytes(frame));
            body.voxelizer.bytes(frame) + densities + costs + body.solver.bytes(frame)
        };
        self.maps.bytes(frame) + self.bodies.iter().map(of).sum::<u64>()
    }
}

impl BodyPaths {
    /// Encodes this body's part of a stage.
    fn encode(&self, builder: &mut Builder<'_>, stage: Stage) {
        match stage {
            Stage::Voxels => {
                self.voxelizer.encode(builder, self.positions, self.indices);
                if let Some(densities) = &self.densities {
                    densities.encode(builder);
                }
            }
            Stage::Seeds => self.channels.iter().for_each(|channel| builder.compute("seeds", channel.seeds.clone(), 1)),
            Stage::Solve => self.channels.iter().for_each(|channel| self.solver.encode(builder, &channel.solved)),
            Stage::Maps | Stage::Shade => {}
        }
    }
}
