//! The recipe `optical_path_seed`: clears the costs, then sets those of the voxels around each lit
//! texel of the lights' maps.

use crate::frame::record::Record;
use crate::frame::shader::ShaderError;
use crate::frame::{Buffer, Builder, Dispatch, PipelineId, Workgroups};
use crate::volume::light_maps::Lit;
use crate::volume::voxel_grid::VoxelGrid;

const RECIPE: &str = "optical_path_seed";
/// Invocations of a workgroup along each side of a map.
const GROUP: u32 = 8;

/// The recipe's two pipelines, one per entry point.
#[derive(Clone, Copy)]
pub(super) struct Seeds {
    clear: PipelineId,
    seed: PipelineId,
}

/// The body and channel to seed.
#[derive(Clone, Copy)]
pub(super) struct Seeded {
    pub(super) grid: VoxelGrid,
    pub(super) matter: Buffer,
    /// Density of each voxel; `None` if it is uniform.
    pub(super) density: Option<Buffer>,
    pub(super) costs: Buffer,
    /// Extinction per unit of length where the density is 1.
    pub(super) extinction: f32,
    /// Irradiance whose cost is 0.
    pub(super) largest: f32,
    /// Colour channel: 0 red, 1 green, 2 blue.
    pub(super) channel: u32,
}

impl Seeds {
    pub(super) fn new(builder: &mut Builder<'_>, constants: &[(&str, f64)]) -> Result<Self, ShaderError> {
        let source = lapidary_wgsl::recipe_source(RECIPE);
        let mut kernel = |entry: &str| builder.compute_pipeline(RECIPE, &source, entry, constants);
        Ok(Self { clear: kernel("optical_path_clear")?, seed: kernel("optical_path_seed_texel")? })
    }

    /// Returns the dispatches that clear the costs, then seed them.
    pub(super) fn dispatches(&self, builder: &mut Builder<'_>, lit: &Lit, seeded: &Seeded) -> Vec<Dispatch> {
        let what = ["seeding of red", "seeding of green", "seeding of blue"][seeded.channel as usize];
        let uniform = builder.uniform(what, seeded.record());
        let of_lights = [(0, uniform.into()), (2, lit.lights.into()), (4, lit.views.into()), (5, lit.maps)];
        let mut of_body = vec![(0, seeded.costs.into()), (1, seeded.matter.into())];
        of_body.extend(seeded.density.map(|density| (2, density.into())));
        let ([width, height, layers], cells) = (lit.size, seeded.grid.cells);
        let sizes = [[1, cells, cells], [width.div_ceil(GROUP), height.div_ceil(GROUP), layers]];
        let dispatch = |(kernel, size)| {
            let groups = vec![builder.bind(kernel, 0, &of_lights), builder.bind(kernel, 1, &of_body)];
            builder.dispatch(kernel, groups, Workgroups::Count(size))
        };
        [self.clear, self.seed].into_iter().zip(sizes).map(dispatch).collect()
    }
}

impl Seeded {
    /// Fills `OpticalPathSeeding` of the recipe.
    fn record(&self) -> Record {
        let Self { grid, extinction, largest, channel, .. } = *self;
        let record = Record::new("OpticalPathSeeding").within("grid", |record| grid.fill(record));
        // Shares are relative to the largest irradiance, which must not be 0.
        let largest = largest.max(f32::MIN_POSITIVE);
        record.with("extinction", extinction).with("largest", largest).with("channel", channel)
    }
}

#[cfg(test)]
mod tests;
