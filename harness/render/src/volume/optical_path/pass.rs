//! Adds the bodies of the recipe `optical_path_shading`, each with the passes that find its paths.

use super::bodies::{BodyPaths, Channel, OpticalPaths};
use super::seeds::{Seeded, Seeds};
use crate::error::RenderError;
use crate::frame::record::Record;
use crate::frame::{Bound, Builder, PipelineId, PipelineSource};
use crate::light::lighting::Lighting;
use crate::material::scattering_law::ScatteringLaw;
use crate::objects::draws::{Body, Variant};
use crate::objects::mesh_buffers::{MeshBuffers, ShapeBuffers, Shapes};
use crate::objects::part::{Drawn, Part};
use crate::picture::formats::{DEPTH_FORMAT, SAMPLE_FORMAT};
use crate::settings::Settings;
use crate::shadow::reflective_shadow_map::ReflectiveShadowMaps;
use crate::volume::density::{Densities, Where};
use crate::volume::light_maps::{LightMaps, Lit};
use crate::volume::solver::{Solve, Solved, Solver};
use crate::volume::voxel_grid::VoxelGrid;
use crate::volume::voxelization::Voxelizer;
use glam::Vec3;
use lapidary_plan::{Decisions, Effect, thickness};
use lapidary_scene::solver::Paths;
use lapidary_scene::{Bounds, Density, Material, Object};
use std::f32::consts::FRAC_1_PI;

/// Compiles `source`, the composed recipe, for the effects of each body, and adds the bodies.
pub(crate) fn pass(
    builder: &mut Builder<'_>,
    lighting: &Lighting<'_>,
    part: &Part<'_>,
    paths: Paths,
    source: &str,
) -> Result<(Vec<Variant>, OpticalPaths), RenderError> {
    let LightMaps { mut maps, lit, largest } = LightMaps::of(builder, lighting, part, paths.cells)?;
    let mut variants = Vec::new();
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
        variants.push(Variant { pipeline, targets: 1, reads_screen: false, shared, bodies: drawn_bodies });
    }
    Ok((variants, OpticalPaths { maps, bodies }))
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
        let color = thickness::color(material, &mesh.colors);
        let record =
            builder.record("material", record_of(grid, (material, color, decisions), extinction, self.largest));
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
    (material, color, decisions): (&Material, Vec3, &Decisions),
    extinction: Vec3,
    largest: Vec3,
) -> Record {
    let record = Record::new("OpticalPathBody").within("grid", |record| grid.fill(record));
    let record = record.with("base_color", color).with("index", material.ior);
    let record = record.with("extinction", extinction).with("alpha", material.roughness * material.roughness);
    let record = record.with("largest", largest);
    record.within("law", |record| ScatteringLaw::of_object(material, decisions).fill(record))
}
