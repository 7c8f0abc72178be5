//! The recipe `optical_path_density`: the density of a body at each voxel.

use super::voxel_grid::VoxelGrid;
use crate::error::RenderError;
use crate::frame::record::Record;
use crate::frame::{Bound, Buffer, Builder, Contents, Dispatch, Frame, Texture, Workgroups};
use lapidary_scene::{Density, DensityGrid};
use lapidary_veins::VeinsPattern;

const RECIPE: &str = "optical_path_density";

/// Where densities are needed.
#[derive(Clone, Copy)]
pub(crate) enum Where {
    /// In and next to the voxels that hold matter, a bit for each.
    Near(Buffer),
    /// In listed tiles, whose count is given as arguments of an indirect dispatch.
    Listed {
        /// The tiles' numbers.
        tiles: Buffer,
        /// Their count.
        workgroups: Buffer,
    },
}

/// A body's densities, recomputed each frame.
pub(crate) struct Densities {
    dispatch: Dispatch,
    /// One f32 per voxel.
    pub(crate) buffer: Buffer,
}

impl Densities {
    /// Returns `None` if the density is the same everywhere.
    pub(crate) fn new(
        builder: &mut Builder<'_>,
        grid: VoxelGrid,
        density: &Density,
        places: Where,
    ) -> Result<Option<Self>, RenderError> {
        let constants = [("DENSITY_FROM_TEXTURE", f64::from(u8::from(matches!(density, Density::Grid(_)))))];
        if matches!(density, Density::Uniform) {
            return Ok(None);
        }
        let (entry, bound, workgroups) = match places {
            Where::Near(matter) => (RECIPE, (1, matter), Workgroups::Count([1, grid.cells, grid.cells])),
            Where::Listed { tiles, workgroups } => {
                ("optical_path_density_listed", (6, tiles), Workgroups::Indirect(workgroups))
            }
        };
        let kernel = builder.compute_pipeline(RECIPE, &lapidary_wgsl::recipe_source(RECIPE), entry, &constants)?;
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
        let buffer = builder.buffer("densities", 4 * grid.count() as u64, usage);
        let place = builder.uniform("grid of densities", grid.fill(Record::new("VoxelizationGrid")));
        let mut resources: Vec<(u32, Bound)> = vec![(0, place.into()), (bound.0, bound.1.into()), (2, buffer.into())];
        match density {
            Density::Uniform => {}
            Density::Veins(pattern) => {
                resources.push((3, builder.uniform("veins", record_of(*pattern)).into()));
            }
            Density::Grid(values) => {
                let texture = Bound::Texture(texture(builder, values), wgpu::TextureViewDimension::D3);
                let [least, greatest] = values.bounds();
                let extent = Record::new("OpticalPathBox").with("least", least).with("greatest", greatest);
                let extent = builder.uniform("box of densities", extent);
                resources.extend([(4, texture), (5, extent.into())]);
            }
        }
        let group = builder.bind(kernel, 0, &resources);
        Ok(Some(Self { dispatch: builder.dispatch(kernel, vec![group], workgroups), buffer }))
    }

    /// Computes the densities, once the voxels are known.
    pub(crate) fn encode(&self, builder: &mut Builder<'_>) {
        builder.compute("densities", vec![self.dispatch.clone()], 1);
    }

    /// Size of the buffer in bytes.
    pub(crate) fn bytes(&self, frame: &Frame) -> u64 {
        frame.resource(self.buffer).bytes()
    }
}

/// Fills `VeinsPattern` of the recipe.
fn record_of(pattern: VeinsPattern) -> Record {
    let VeinsPattern { frequency, width, least, greatest, octaves, seed } = pattern;
    let record = Record::new("VeinsPattern").with("frequency", frequency).with("width", width);
    record.with("least", least).with("greatest", greatest).with("octaves", octaves).with("seed", seed)
}

fn texture(builder: &mut Builder<'_>, grid: &DensityGrid) -> Texture {
    let format = (wgpu::TextureDimension::D3, wgpu::TextureFormat::R32Float);
    let contents = Contents::Bytes(bytemuck::cast_slice(grid.densities()).to_vec());
    builder.texture("measured densities", format, grid.size().to_array(), contents)
}

#[cfg(test)]
mod tests;
