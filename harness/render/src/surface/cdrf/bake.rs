//! The recipe `cdrf_table`, run on a device.

use crate::frame::compute::{self, Binding, RecipeRun};
use crate::frame::record::Record;
use crate::frame::shader::ShaderError;
use glam::{UVec2, Vec3};
use lapidary_gpu::Gpu;

/// Side of the recipe's workgroups.
const WORKGROUP: u32 = 8;

/// Bakes a table of `size` on the GPU, row by row.
///
/// # Errors
/// If the device refuses the recipe or the memory.
pub fn bake(gpu: &Gpu, size: UVec2, tint: Vec3) -> Result<Vec<Vec3>, ShaderError> {
    let bake = Record::new("CdrfTableBake").with("size", size).with("tint", tint).bytes();
    let bytes = u64::from(size.x) * u64::from(size.y) * 16;
    let run = RecipeRun {
        recipe: "cdrf_table",
        entry: "cdrf_table_bake",
        constants: &[],
        bindings: &[&[Binding::Uniform(&bake), Binding::Result(bytes)]],
        workgroups: [size.x.div_ceil(WORKGROUP), size.y.div_ceil(WORKGROUP), 1],
    };
    let words = compute::run_recipe(gpu, &run)?;
    let texel = |words: &[u32]| Vec3::from_array([0, 1, 2].map(|channel| f32::from_bits(words[channel])));
    Ok(words.chunks_exact(4).map(texel).collect())
}
