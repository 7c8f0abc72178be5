//! The recipe `optical_path_seed`: costs are cleared, and those of the voxels about each lit texel of the lights' maps set.

use crate::compute::Kernel;
use crate::device::uniform;
use crate::record::Record;
use crate::shader::ShaderError;
use crate::voxel_grid::VoxelGrid;
use lapidary_gpu::{Device, Encoder, Gpu};

const RECIPE: &str = "optical_path_seed";
/// Invocations of a workgroup along each side of a map.
const GROUP: u32 = 8;

/// Its two entry points.
pub(super) struct Seeds {
    clear: Kernel,
    seed: Kernel,
}

/// What is looked up of the lights.
pub(super) struct Lit {
    pub(super) lights: wgpu::Buffer,
    pub(super) views: wgpu::Buffer,
    pub(super) maps: wgpu::TextureView,
}

/// What is seeded.
pub(super) struct Seeded<'a> {
    pub(super) grid: VoxelGrid,
    pub(super) matter: &'a wgpu::Buffer,
    /// Where it differs from voxel to voxel.
    pub(super) density: Option<&'a wgpu::Buffer>,
    pub(super) costs: &'a wgpu::Buffer,
    /// Per unit of length where the density is 1.
    pub(super) extinction: f32,
    /// The irradiance whose cost is 0.
    pub(super) largest: f32,
    /// 0 red, 1 green, 2 blue.
    pub(super) channel: u32,
}

/// Bind groups, each of clearing and of seeding.
pub(super) type Groups = [[Option<wgpu::BindGroup>; 2]; 2];

impl Seeds {
    pub(super) fn new(gpu: &Gpu, constants: &[(&str, f64)]) -> Result<Self, ShaderError> {
        let source = lapidary_wgsl::recipe_source(RECIPE);
        let kernel = |entry: &str| Kernel::new(gpu, RECIPE, &source, entry, constants);
        Ok(Self { clear: kernel("optical_path_clear")?, seed: kernel("optical_path_seed_texel")? })
    }

    pub(super) fn bind(&self, device: &Device, lit: &Lit, seeded: &Seeded<'_>) -> Groups {
        let what = ["seeding of red", "seeding of green", "seeding of blue"][seeded.channel as usize];
        let uniform = uniform(device, what, &seeded.bytes());
        let resources = [
            vec![
                (0, uniform.as_entire_binding()),
                (2, lit.lights.as_entire_binding()),
                (4, lit.views.as_entire_binding()),
                (5, wgpu::BindingResource::TextureView(&lit.maps)),
            ],
            [(0, Some(seeded.costs)), (1, Some(seeded.matter)), (2, seeded.density)]
                .into_iter()
                .filter_map(|(binding, buffer)| Some((binding, buffer?.as_entire_binding())))
                .collect(),
        ];
        [&self.clear, &self.seed]
            .map(|kernel| [0, 1].map(|group| kernel.bind(device, group, &resources[group as usize])))
    }

    /// For maps of this width, height and number of layers.
    pub(super) fn encode(&self, encoder: &mut Encoder, groups: &Groups, cells: u32, maps: [u32; 3]) {
        let [width, height, layers] = maps;
        let sizes = [[1, cells, cells], [width.div_ceil(GROUP), height.div_ceil(GROUP), layers]];
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("seeds"),
            ..wgpu::ComputePassDescriptor::default()
        });
        for ((kernel, groups), [x, y, z]) in [&self.clear, &self.seed].into_iter().zip(groups).zip(sizes) {
            pass.set_pipeline(&kernel.pipeline);
            for (index, group) in (0..).zip(groups) {
                pass.set_bind_group(index, group.as_ref());
            }
            pass.dispatch_workgroups(x, y, z);
        }
    }
}

impl Seeded<'_> {
    /// `OpticalPathSeeding` of the recipe.
    fn bytes(&self) -> Vec<u8> {
        let Self { grid, extinction, largest, channel, .. } = *self;
        let record = Record::new("OpticalPathSeeding").within("grid", |record| grid.fill(record));
        // No light has a share of nothing.
        let largest = largest.max(f32::MIN_POSITIVE);
        record.with("extinction", extinction).with("largest", largest).with("channel", channel).bytes()
    }
}

#[cfg(test)]
mod tests;
