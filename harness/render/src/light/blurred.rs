//! The environment blurred for rough metals, and the table of what a metal reflects, as the part `metal` reads them.

use super::environment::STUDIO_LARGEST;
use crate::error::RenderError;
use crate::frame::compute::{self, Binding, RecipeRun};
use crate::frame::record::Record;
use crate::frame::shader::ShaderError;
use crate::frame::{Builder, Contents, Sampler, Texture, level_size};
use crate::material::textures::levels::of_linear;
use exr::prelude::f16;
use glam::{DVec2, DVec3, UVec2, Vec4};
use lapidary_environment::oracle;
use lapidary_gpu::Gpu;
use lapidary_scene::Environment;
use rayon::prelude::*;
use std::sync::OnceLock;

/// Bindings in group 0: the environment, and the sampler and the table.
pub(crate) const ENVIRONMENT: u32 = 21;
pub(crate) const TABLES: [u32; 2] = [22, 23];

/// Columns and rows of the first level.
const SIZE: [u32; 2] = [1024, 512];
/// Number of levels, for even steps of the roughness from 0 to 1.
const LEVELS: u32 = 7;
/// Directions for each texel of the second level; of each further one twice as many.
const DIRECTIONS: u32 = 32;
/// Samples along each side of a texel of the first level, at least.
const SAMPLES: u32 = 2;

/// Side of the table of reflectance.
const TABLE: u32 = 64;
/// Facets for each of its texels: their mean is within 0.5 % of quadrature.
const FACETS: u32 = 1024;

/// Side of the recipe's workgroups.
const WORKGROUP: u32 = 8;
/// Largest radiance that a half float holds, with room for its rounding.
const LARGEST: f32 = 65_000.0;

/// Adds the blurred environment to the frame.
///
/// # Errors
/// If the device refuses the recipe or the memory.
pub(crate) fn texture(builder: &mut Builder<'_>, environment: &Environment) -> Result<Texture, RenderError> {
    let levels = match builder.gpu() {
        Some(gpu) => Contents::Bytes(levels(gpu, environment)?),
        None => Contents::LeftOut,
    };
    let [width, height] = SIZE;
    Ok(builder.mipped("blurred environment", wgpu::TextureFormat::Rgba16Float, [width, height, 1], (LEVELS, levels)))
}

/// Adds the table of reflectance to the frame, and the sampler of both.
///
/// # Errors
/// If the device refuses the recipe or the memory.
pub(crate) fn table(builder: &mut Builder<'_>) -> Result<(Texture, Sampler), RenderError> {
    let contents = match builder.gpu() {
        Some(gpu) => Contents::Bytes(reflectance(gpu)?),
        None => Contents::LeftOut,
    };
    let format = (wgpu::TextureDimension::D2, wgpu::TextureFormat::Rg16Float);
    let table = builder.texture("metal's reflectance", format, [TABLE, TABLE, 1], contents);
    let address = [wgpu::AddressMode::Repeat, wgpu::AddressMode::ClampToEdge];
    Ok((table, builder.sampler("blurred environment's sampler", address)))
}

/// Returns the bytes of all levels.
fn levels(gpu: &Gpu, environment: &Environment) -> Result<Vec<u8>, ShaderError> {
    // The studio is always the same, and every frame with a metal asks.
    static STUDIO: OnceLock<Vec<u8>> = OnceLock::new();
    if let (Environment::Studio, Some(known)) = (environment, STUDIO.get()) {
        return Ok(known.clone());
    }
    let made = blurred(gpu, environment)?;
    if let Environment::Studio = environment {
        return Ok(STUDIO.get_or_init(|| made).clone());
    }
    Ok(made)
}

fn blurred(gpu: &Gpu, environment: &Environment) -> Result<Vec<u8>, ShaderError> {
    let sharp = of_linear(SIZE, seen(environment));
    let largest = match environment {
        Environment::Studio => STUDIO_LARGEST,
        Environment::Map(_) => sharp[0].iter().map(|texel| texel.truncate().max_element()).fold(0.0, f32::max),
    };
    let scale = f16::from_f32((largest / LARGEST).max(1.0));
    let encoded = |texel: Vec4| {
        let [red, green, blue] = (texel.truncate() / scale.to_f32()).to_array().map(f16::from_f32);
        [red, green, blue, scale].map(f16::to_le_bytes)
    };
    let mut bytes: Vec<u8> = sharp[0].iter().flat_map(|texel| encoded(*texel)).flatten().collect();
    let radiance: Vec<Vec4> = sharp.iter().flatten().copied().collect();
    for level in 1..LEVELS {
        let size = UVec2::from_array(level_size(SIZE, level));
        let roughness = level as f32 / (LEVELS - 1) as f32;
        let tables = Record::new("SplitSumTables").with("size", size).with("first", UVec2::from_array(SIZE));
        let tables = tables.with("levels", sharp.len() as u32).with("count", DIRECTIONS << (level - 1));
        let tables = tables.with("alpha", roughness * roughness);
        let texels = bake(gpu, "split_sum_tables_environment", (tables, size), bytemuck::cast_slice(&radiance))?;
        bytes.extend(texels.into_iter().flat_map(encoded).flatten());
    }
    Ok(bytes)
}

/// Returns the environment by direction, row by row from the zenith.
fn seen(environment: &Environment) -> Vec<Vec4> {
    let samples = match environment {
        Environment::Studio => SAMPLES,
        Environment::Map(map) => map.width.div_ceil(SIZE[0]).max(SAMPLES),
    };
    let [columns, rows] = SIZE.map(|side| f64::from(side * samples));
    let texel = |place: usize| {
        let corner = [place as u32 % SIZE[0], place as u32 / SIZE[0]].map(|part| f64::from(part * samples));
        let mut sum = DVec3::ZERO;
        for sample in 0..samples * samples {
            let [x, y] = [sample % samples, sample / samples].map(|part| f64::from(part) + 0.5);
            let uv = DVec2::new((corner[0] + x) / columns, (corner[1] + y) / rows);
            sum += environment.radiance(oracle::direction_from_uv(uv));
        }
        (sum / f64::from(samples * samples)).as_vec3().extend(1.0)
    };
    (0..SIZE[0] as usize * SIZE[1] as usize).into_par_iter().map(texel).collect()
}

/// Returns the bytes of the table.
fn reflectance(gpu: &Gpu) -> Result<Vec<u8>, ShaderError> {
    static TABLES: OnceLock<Vec<u8>> = OnceLock::new();
    if let Some(known) = TABLES.get() {
        return Ok(known.clone());
    }
    let size = UVec2::splat(TABLE);
    let tables = Record::new("SplitSumTables").with("size", size).with("count", FACETS);
    let tables = tables.with("first", UVec2::ONE).with("levels", 1_u32).with("alpha", 0.0_f32);
    let texels = bake(gpu, "split_sum_tables_reflectance", (tables, size), &[0; 16])?;
    let parts = texels.iter().flat_map(|texel| [texel.x, texel.y]);
    let bytes = parts.flat_map(|part| f16::from_f32(part).to_le_bytes()).collect();
    Ok(TABLES.get_or_init(|| bytes).clone())
}

/// Runs an entry point of the recipe `split_sum_tables`; returns its texels, row by row.
fn bake(gpu: &Gpu, entry: &str, (tables, size): (Record, UVec2), radiance: &[u8]) -> Result<Vec<Vec4>, ShaderError> {
    let run = RecipeRun {
        recipe: "split_sum_tables",
        entry,
        constants: &[],
        bindings: &[&[
            Binding::Uniform(&tables.bytes()),
            Binding::Storage(radiance),
            Binding::Result(u64::from(size.x) * u64::from(size.y) * 16),
        ]],
        workgroups: [size.x.div_ceil(WORKGROUP), size.y.div_ceil(WORKGROUP), 1],
    };
    let words = compute::run_recipe(gpu, &run)?;
    let texel = |words: &[u32]| Vec4::from_array([0, 1, 2, 3].map(|channel| f32::from_bits(words[channel])));
    Ok(words.chunks_exact(4).map(texel).collect())
}
