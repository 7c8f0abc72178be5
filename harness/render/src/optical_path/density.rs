//! The recipe `optical_path_density`: how dense a body is, voxel by voxel.

use super::super::RenderError;
use super::super::device::{self, uniform, view};
use crate::compute::Kernel;
use crate::record::Record;
use crate::voxel_grid::VoxelGrid;
use lapidary_gpu::{Encoder, Gpu};
use lapidary_scene::{Density, DensityGrid};
use lapidary_veins::VeinsPattern;

const RECIPE: &str = "optical_path_density";

/// A body's densities on the device, made anew each frame.
pub(super) struct Densities {
    kernel: Kernel,
    group: Option<wgpu::BindGroup>,
    cells: u32,
    /// An f32 for each voxel.
    pub(super) buffer: wgpu::Buffer,
}

impl Densities {
    /// Nothing where the density is the same everywhere.
    pub(super) fn new(
        gpu: &Gpu,
        grid: VoxelGrid,
        density: &Density,
        matter: &wgpu::Buffer,
    ) -> Result<Option<Self>, RenderError> {
        let constants = [("DENSITY_FROM_TEXTURE", f64::from(u8::from(matches!(density, Density::Grid(_)))))];
        let source = match density {
            Density::Uniform => return Ok(None),
            Density::Veins(pattern) => Source::Veins(*pattern),
            Density::Grid(values) => Source::Texture(values),
        };
        let kernel = Kernel::new(gpu, RECIPE, &lapidary_wgsl::recipe_source(RECIPE), RECIPE, &constants)?;
        let (group, of_voxels) = gpu.guarded("allocating densities", |device| {
            let of_voxels = device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("densities"),
                size: 4 * grid.count() as u64,
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            });
            let place = uniform(device, "grid of densities", &grid.bytes());
            let first =
                [(0, place.as_entire_binding()), (1, matter.as_entire_binding()), (2, of_voxels.as_entire_binding())];
            let group = match source {
                Source::Veins(pattern) => {
                    let pattern = uniform(device, "veins", &pattern_bytes(pattern));
                    kernel.bind(device, 0, &[&first[..], &[(3, pattern.as_entire_binding())]].concat())
                }
                Source::Texture(values) => {
                    let texture = view(&texture(gpu, values));
                    let [least, greatest] = values.bounds();
                    let extent = Record::new("OpticalPathBox").with("least", least).with("greatest", greatest);
                    let extent = uniform(device, "box of densities", &extent.bytes());
                    let own = [(4, wgpu::BindingResource::TextureView(&texture)), (5, extent.as_entire_binding())];
                    kernel.bind(device, 0, &[&first[..], &own].concat())
                }
            };
            (group, of_voxels)
        })?;
        Ok(Some(Self { kernel, group, cells: grid.cells, buffer: of_voxels }))
    }

    /// Records it, once the voxels are known.
    pub(super) fn encode(&self, encoder: &mut Encoder) {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("densities"),
            ..wgpu::ComputePassDescriptor::default()
        });
        pass.set_pipeline(&self.kernel.pipeline);
        pass.set_bind_group(0, self.group.as_ref());
        pass.dispatch_workgroups(1, self.cells, self.cells);
    }
}

enum Source<'a> {
    Veins(VeinsPattern),
    Texture(&'a DensityGrid),
}

/// `VeinsPattern` of the recipe.
fn pattern_bytes(pattern: VeinsPattern) -> Vec<u8> {
    let VeinsPattern { frequency, width, least, greatest, octaves, seed } = pattern;
    let record = Record::new("VeinsPattern").with("frequency", frequency).with("width", width);
    record.with("least", least).with("greatest", greatest).with("octaves", octaves).with("seed", seed).bytes()
}

fn texture(gpu: &Gpu, grid: &DensityGrid) -> wgpu::Texture {
    let format = (wgpu::TextureDimension::D3, wgpu::TextureFormat::R32Float);
    device::texture(gpu, "measured densities", format, grid.size().to_array(), bytemuck::cast_slice(grid.densities()))
}

#[cfg(test)]
mod tests;
