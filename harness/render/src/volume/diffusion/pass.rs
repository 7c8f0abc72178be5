//! Adds the bodies of the recipe `diffusion_shading`, each with the passes that compute its fluence.

use super::bodies::{BodyDiffusion, Diffusions};
use super::cells::{self, Cells};
use super::levels::Levels;
use super::matter::Matter;
use super::source::{self, Source};
use super::tiles::Tiles;
use crate::error::RenderError;
use crate::frame::record::Record;
use crate::frame::{Bound, Buffer, Builder, PipelineId, PipelineSource};
use crate::light::lighting::Lighting;
use crate::objects::draws::{Body, Variant};
use crate::objects::mesh_buffers::{MeshBuffers, ShapeBuffers, Shapes};
use crate::objects::part::{Drawn, Part};
use crate::picture::formats::{DEPTH_FORMAT, SAMPLE_FORMAT};
use crate::shadow::light_views;
use crate::shadow::reflective_shadow_map::ReflectiveShadowMaps;
use crate::volume::density::Densities;
use crate::volume::light_maps::{LightMaps, Lit};
use crate::volume::voxel_grid::VoxelGrid;
use glam::Vec3;
use lapidary_plan::{Effect, casting, enclosed};
use lapidary_scene::{Bounds, Density, Light, Material, Object, solver};

/// Compiles `source`, the composed recipe, for the effects of each body, and adds the bodies.
pub(crate) fn pass(
    builder: &mut Builder<'_>,
    lighting: &Lighting<'_>,
    part: &Part<'_>,
    diffusion: solver::Diffusion,
    source: &str,
) -> Result<(Vec<Variant>, Diffusions), RenderError> {
    let cells = diffusion.cells;
    let LightMaps { mut maps, lit, .. } = LightMaps::of(builder, lighting, part, cells)?;
    let around = lighting.largest_around();
    let harmonics = lighting.has_environment().then(|| lighting.harmonics(builder));
    let mut variants = Vec::new();
    let mut bodies = Vec::new();
    for (constants, objects) in part.variants(constants_of) {
        let pipeline = builder.render_pipeline(&PipelineSource {
            recipe: part.rung.recipe(),
            source,
            entries: ["diffusion_vertex", "diffusion_fragment"],
            constants: &constants,
            formats: &[SAMPLE_FORMAT],
            depth: Some(DEPTH_FORMAT),
        })?;
        let mut shared = lighting.shared(builder, pipeline)?;
        shared.extend([(4, lit.views.into()), (5, lit.maps)]);
        let add = Add { pipeline, constants: &constants, diffusion, lit: &lit, around, harmonics, part };
        let mut drawn_bodies = Vec::new();
        for drawn in objects {
            let (body, of_body) =
                builder.of_object(&drawn.name, |builder| add.body(builder, drawn, (&lighting.shapes, &mut maps)))?;
            drawn_bodies.push(body);
            bodies.extend(of_body);
        }
        variants.push(Variant { pipeline, targets: 1, reads_screen: false, shared, bodies: drawn_bodies });
    }
    Ok((variants, Diffusions { maps, bodies }))
}

/// The recipe follows ways from voxel to voxel where densities differ by more than this factor. Optical depths of pieces
/// between two points are off by it at most.
const VARIED: f32 = 8.0;

/// Returns the overrides of the recipe for an object.
fn constants_of(drawn: &Drawn<'_>) -> Vec<(&'static str, f64)> {
    let density = drawn.object.material.medium.as_ref().map_or(&Density::Uniform, |medium| &medium.density);
    let is_varied = drawn.decisions.has(Effect::ExtinctionPerVoxel) && density.most() > VARIED * density.least();
    let mut constants = drawn.decisions.constants();
    constants.push(("DIFFUSION_VARIED", f64::from(u8::from(is_varied))));
    constants
}

/// Inputs for adding a body, besides the body itself.
struct Add<'a> {
    pipeline: PipelineId,
    /// Values of the recipes' overrides for this variant.
    constants: &'a [(&'a str, f64)],
    diffusion: solver::Diffusion,
    lit: &'a Lit,
    /// The largest irradiance from all around.
    around: Vec3,
    /// The environment's harmonics; `None` if it is left out.
    harmonics: Option<Buffer>,
    part: &'a Part<'a>,
}

/// What a body gets from the lights.
struct Received {
    /// Irradiance that counts as 1, for each channel.
    largest: Vec3,
    /// For each light 1 if it is a lamp inside the body, else 0; `None` if none is.
    enclosed: Option<Buffer>,
}

impl Add<'_> {
    /// Returns a body to draw and, if light diffuses through it, the passes before. Also adds the body
    /// to the maps.
    fn body(
        &self,
        builder: &mut Builder<'_>,
        drawn: &Drawn<'_>,
        (shapes, maps): (&Shapes, &mut ReflectiveShadowMaps),
    ) -> Result<(Body, Option<BodyDiffusion>), RenderError> {
        let Drawn { object: Object { mesh, material, .. }, name, decisions } = drawn;
        let grid = VoxelGrid::about(Bounds::of(mesh.positions.iter().copied()), self.diffusion.cells);
        let index = if decisions.has(Effect::Dielectric) { material.ior } else { 1.0 };
        let matter = Matter::of(material, grid, index);
        let shape = shapes.of(builder, name, drawn.object)?;
        let buffers = MeshBuffers::of(builder, shape, drawn.object)?;
        maps.add(builder, name, &buffers)?;
        let received = self.received(builder, drawn, grid);
        let of_body = if decisions.has(Effect::Diffusion) {
            Some(self.diffusion(builder, drawn, (grid, matter), &shape, &received)?)
        } else {
            None
        };
        let record = builder.record("material", record_of(grid, material, matter, received.largest));
        let MeshBuffers { shape: ShapeBuffers { positions, indices, vertices }, normals } = buffers;
        let mut resources: Vec<(u32, Bound)> =
            (0..).zip([record, positions, indices, normals].map(Bound::from)).collect();
        if let Some(of_body) = &of_body {
            resources.push((4, of_body.levels.packed.into()));
            resources.extend(of_body.densities.as_ref().map(|densities| (5, densities.buffer.into())));
            resources.extend(received.enclosed.map(|enclosed| (6, enclosed.into())));
        }
        let group = builder.bind(self.pipeline, 1, &resources);
        Ok((Body { name: name.clone(), groups: vec![group], vertices, instances: 1 }, of_body))
    }

    /// Returns what a body gets from the lights.
    fn received(&self, builder: &mut Builder<'_>, drawn: &Drawn<'_>, grid: VoxelGrid) -> Received {
        let Drawn { object, decisions, .. } = drawn;
        let inside = if decisions.has(Effect::LampInside) {
            enclosed::lamps(object, self.part.lights)
        } else {
            vec![false; self.part.lights.len()]
        };
        let (within, outside): (Vec<_>, Vec<_>) =
            self.part.lights.iter().zip(&inside).partition(|(_, inside)| **inside);
        let outside: Vec<Light> = outside.into_iter().map(|(light, _)| *light).collect();
        let of_maps = light_views::largest_irradiance(&outside, casting::bounds(object));
        // All of them may stand in one voxel.
        let of_lamps: Vec3 = within.into_iter().map(|(lamp, _)| source::of_lamp(lamp, grid)).sum();
        let largest = of_maps.max(self.around).max(of_lamps);
        let words: Vec<u32> = inside.into_iter().map(u32::from).collect();
        let enclosed =
            decisions.has(Effect::LampInside).then(|| builder.storage("lamps inside", bytemuck::cast_slice(&words)));
        Received { largest, enclosed }
    }

    /// Returns the buffers and passes of light that diffuses through a body.
    fn diffusion(
        &self,
        builder: &mut Builder<'_>,
        drawn: &Drawn<'_>,
        (grid, matter): (VoxelGrid, Matter),
        mesh: &ShapeBuffers,
        received: &Received,
    ) -> Result<BodyDiffusion, RenderError> {
        let Drawn { object: Object { mesh: shape, material, .. }, name, decisions } = drawn;
        let density = material.medium.as_ref().map_or(&Density::Uniform, |medium| &medium.density);
        let density = if decisions.has(Effect::ExtinctionPerVoxel) { density } else { &Density::Uniform };
        let tiles = Tiles::new(builder, grid.cells, 0);
        let densities = Densities::new(builder, grid, density, tiles.places())?;
        let of_voxel = densities.as_ref().map(|densities| densities.buffer);
        let of_body = cells::Body { matter, material, largest: received.largest, harmonics: self.harmonics };
        let cells = Cells::new(builder, grid, (shape, mesh), self.constants, of_body, (tiles, of_voxel))?;
        let limited = self.diffusion.limited.then_some(matter.extinction);
        let levels = Levels::new(builder, grid, &cells, limited, self.part.settings.diffusion)?;
        let source = Source::new(
            builder,
            grid,
            (self.lit, received.largest),
            matter,
            &source::Buffers {
                nodes: cells.nodes,
                fine: cells.voxelizer.matter,
                density: of_voxel,
                right: levels.right(),
                entering: cells.entering,
                enclosed: received.enclosed.map(|flags| (flags, self.part.lights.len() as u32)),
                tiles,
            },
            self.constants,
        )?;
        Ok(BodyDiffusion { name: name.clone(), cells, densities, source, levels })
    }
}

/// Fills `DiffusionBody` of the recipe.
fn record_of(grid: VoxelGrid, material: &Material, matter: Matter, largest: Vec3) -> Record {
    let record = Record::new("DiffusionBody").within("grid", |record| grid.fill(record));
    let record = record.with("extinction", matter.extinction).with("index", material.ior);
    let record = record.with("gamma", matter.gamma).with("alpha", material.roughness * material.roughness);
    let record = record.with("largest", largest).with("milne", lapidary_diffusion::milne(matter.index));
    let record = record.with("h_normal", matter.gamma.map(|gamma| lapidary_half_space::h(1.0, gamma)));
    let edge = lapidary_half_space::edge(matter.index);
    record.with("edge", edge).with("gain", matter.gamma.map(|gamma| lapidary_half_space::gain(gamma, edge)))
}
