use super::*;
use crate::frame::Bound;
use crate::frame::{Contents, Executor};
use crate::light::lighting::Lighting;
use crate::settings::Settings;
use crate::shadow::light_views::{self, LightView};
use crate::shadow::reflective_shadow_map::view_buffer;
use glam::{IVec3, UVec3, Vec3, Vec4};
use lapidary_assay::extremum::larger;
use lapidary_gpu::{AdapterChoice, Gpu};
use lapidary_optical_path::{OPTICAL_PATH_UNREACHED, decode, seed};
use lapidary_scene::{Bounds, Light, Scene};
use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt as _, SeedableRng as _};

/// Voxels along each side; 40 do not fill the words of their rows.
const CELLS: u32 = 40;
/// Texels along each side of a map; not a multiple of the workgroup size.
const SIDE: u32 = 37;
const EXTINCTION: f32 = 0.7;

fn bounds() -> Bounds {
    Bounds { min: Vec3::new(-3.0, 2.0, -1.0), max: Vec3::new(5.0, 7.0, 4.0) }
}

/// Returns a sun and two lamps, the second within the bounds. They take one layer, one layer and
/// six layers.
fn lights() -> Vec<Light> {
    vec![
        Light::Directional { toward: Vec3::new(0.6, 0.8, 0.0), irradiance: Vec3::new(1.0, 2.0, 0.5) },
        Light::Point { position: Vec3::new(1.0, 30.0, 2.0), intensity: Vec3::new(300.0, 100.0, 900.0) },
        Light::Point { position: Vec3::new(1.1, 4.3, 1.2), intensity: Vec3::new(2.0, 3.0, 4.0) },
    ]
}

/// Returns world positions with N·L: some outside the grid, some unlit, some without a surface.
fn texels(count: usize, grid: VoxelGrid) -> Vec<Vec4> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(5);
    let size = grid.spacing * CELLS as f32;
    let texel = |_| {
        let place = Vec3::from_array([(); 3].map(|()| 1.1 * random.random::<f32>() - 0.05));
        let cosine = [random.random::<f32>(), 0.0, -1.0][[0, 0, 0, 1, 2][random.random_range(0..5)]];
        (grid.origin + size * place).extend(cosine)
    };
    (0..count).map(texel).collect()
}

/// Mirrors the recipe in f32, except for the lights. Returns for each voxel the least of the costs
/// from the texels around it.
fn mirror(
    grid: VoxelGrid,
    (matter, density): (&[bool], Option<&[f32]>),
    (texels, views): (&[Vec4], &[LightView]),
    (largest, channel): (f32, usize),
) -> Vec<f32> {
    let mut costs = vec![OPTICAL_PATH_UNREACHED; grid.count()];
    let lights = lights();
    let extinction = |index: usize| EXTINCTION * density.map_or(1.0, |density| density[index]);
    for (number, texel) in texels.iter().enumerate() {
        let view = &views[number / (SIDE * SIDE) as usize];
        let position = texel.truncate();
        let inside = (position - grid.origin) / grid.spacing;
        if texel.w <= 0.0 || inside.cmplt(Vec3::ZERO).any() || inside.cmpgt(Vec3::splat(CELLS as f32)).any() {
            continue;
        }
        let voxel = inside.floor().as_uvec3().min(UVec3::splat(CELLS - 1));
        let lit_voxel = grid.index(voxel);
        if !matter[lit_voxel] {
            continue;
        }
        let arrival = lights[view.light as usize].arrival(position.as_dvec3());
        let share = arrival.irradiance.as_vec3()[channel] * texel.w / largest;
        for place in 0..27 {
            let near = voxel.as_ivec3() + IVec3::new(place % 3, place / 3 % 3, place / 9) - 1;
            if near.cmplt(IVec3::ZERO).any() || near.cmpge(IVec3::splat(CELLS as i32)).any() {
                continue;
            }
            let index = grid.index(near.as_uvec3());
            if matter[index] {
                let offset = position.distance(grid.centre(near.as_uvec3()));
                let cost = seed(share, 0.5 * (extinction(lit_voxel) + extinction(index)), offset);
                costs[index] = costs[index].min(cost);
            }
        }
    }
    costs
}

#[test]
fn every_voxel_has_the_least_cost_of_the_lit_texels_about_it() {
    let gpu = Gpu::shared(&AdapterChoice::from_environment()).expect("a device");
    let scene = Scene { lights: lights(), ..Scene::named("bunny").expect("built in") };
    let settings = Settings::of_size(8, 8);
    let grid = VoxelGrid::about(bounds(), CELLS);
    let views = light_views::views(&lights(), bounds(), None);
    assert_eq!(views.len(), 8);
    let texels = texels(views.len() * (SIDE * SIDE) as usize, grid);
    let format = (wgpu::TextureDimension::D2, wgpu::TextureFormat::Rgba32Float);
    let size = [SIDE, SIDE, views.len() as u32];
    // Every third voxel is air, and the density differs from voxel to voxel.
    let matter: Vec<bool> = (0..grid.count()).map(|index| index * 7 % 3 != 0).collect();
    let words = grid.words_per_row();
    let mut bits = vec![0u32; (words * CELLS * CELLS) as usize];
    for voxel in (0..grid.count()).filter(|index| matter[*index]).map(|index| grid.voxel(index)) {
        bits[(words * (voxel.y + CELLS * voxel.z) + voxel.x / 32) as usize] |= 1 << (voxel.x % 32);
    }
    let density: Vec<f32> = (0..grid.count()).map(|index| 0.25 + (index * 13 % 17) as f32).collect();
    for (dense, channel) in [(false, 0), (true, 1), (true, 2)] {
        let mut builder = Builder::new(Some(gpu));
        let contents = Contents::Bytes(bytemuck::cast_slice(&texels).to_vec());
        let maps = builder.texture("maps", format, size, contents);
        let maps = Bound::Texture(maps, wgpu::TextureViewDimension::D2Array);
        let lights = Lighting::new(&scene, &settings, [1, 1]).lights(&mut builder);
        let lit = Lit { lights, views: view_buffer(&mut builder, &views), maps, size };
        let constants = [("EFFECT_EXTINCTION_PER_VOXEL", f64::from(u8::from(dense)))];
        let seeds = Seeds::new(&mut builder, &constants).expect("compiled");
        let matter_buffer = builder.storage("matter", bytemuck::cast_slice(&bits));
        let density_buffer = builder.storage("densities", bytemuck::cast_slice(&density));
        // The buffer is not cleared, as if left over from another frame.
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
        let costs = builder.buffer("costs", 4 * grid.count() as u64, usage);
        let seeded = Seeded {
            grid,
            matter: matter_buffer,
            density: dense.then_some(density_buffer),
            costs,
            extinction: EXTINCTION,
            largest: 5.0,
            channel,
        };
        let dispatches = seeds.dispatches(&mut builder, &lit, &seeded);
        builder.compute("seeds", dispatches, 1);
        let executor = Executor::new(gpu, builder.finish()).expect("made");
        executor.run(|_, _| {}).expect("run");
        let found = executor.words(costs).expect("read back");
        let density = dense.then_some(&density[..]);
        let wanted = mirror(grid, (&matter, density), (&texels, &views), (5.0, channel as usize));
        let (mut reached, mut worst) = (0, 0.0f32);
        for (index, (bits, wanted)) in found.into_iter().zip(wanted).enumerate() {
            let found = decode(bits);
            assert_eq!(found == OPTICAL_PATH_UNREACHED, wanted == OPTICAL_PATH_UNREACHED, "{index}: {found} {wanted}");
            if wanted < OPTICAL_PATH_UNREACHED {
                worst = larger(worst, (found - wanted).abs() / wanted.max(1.0));
                reached += 1;
            }
        }
        println!("{reached} voxels, off by {worst:.1e} of their costs at most");
        // The bound covers the accuracy of optical_path_seed and a few roundings of share, distance
        // and extinction, each counted once.
        assert!(reached > 20_000 && reached < grid.count() && worst < 16.0 * f32::EPSILON, "{reached} {worst}");
    }
}
