use super::*;
use crate::frame::Executor;
use glam::{UVec3, Vec3};
use lapidary_assay::extremum::larger;
use lapidary_gpu::{AdapterChoice, Gpu};
use lapidary_scene::Bounds;
use std::sync::Arc;

/// Voxels along each side; 40 do not fill the words of their rows.
const CELLS: [u32; 2] = [32, 40];

fn grid(cells: u32) -> VoxelGrid {
    VoxelGrid::about(Bounds { min: Vec3::new(-3.0, 2.0, -1.0), max: Vec3::new(5.0, 7.0, 4.0) }, cells)
}

/// Runs the recipe for the voxels selected by `is_matter`, and returns the densities.
fn found(grid: VoxelGrid, density: &Density, is_matter: impl Fn(UVec3) -> bool) -> Vec<f32> {
    let gpu = Gpu::shared(&AdapterChoice::from_environment()).expect("a device");
    let words = grid.words_per_row();
    let mut bits = vec![0u32; (words * grid.cells * grid.cells) as usize];
    for voxel in (0..grid.count()).map(|index| grid.voxel(index)).filter(|voxel| is_matter(*voxel)) {
        bits[(words * (voxel.y + grid.cells * voxel.z) + voxel.x / 32) as usize] |= 1 << (voxel.x % 32);
    }
    let mut builder = Builder::new(Some(gpu));
    let matter = builder.storage("matter", bytemuck::cast_slice(&bits));
    run(gpu, builder, grid, density, Where::Near(matter))
}

/// Runs the recipe, and returns the densities.
fn run(gpu: &Gpu, mut builder: Builder<'_>, grid: VoxelGrid, density: &Density, places: Where) -> Vec<f32> {
    let densities = Densities::new(&mut builder, grid, density, places).expect("compiled").expect("it differs");
    densities.encode(&mut builder);
    let executor = Executor::new(gpu, builder.finish()).expect("made");
    executor.run(|_, _| {}).expect("run");
    executor.words(densities.buffer).expect("a device").into_iter().map(f32::from_bits).collect()
}

/// Returns a grid that neither covers the voxels nor lies within them, and veins, each with the
/// tolerated error of the device.
fn densities() -> [(Density, f32); 2] {
    let size = UVec3::new(3, 5, 2);
    let values = (0..30).map(|k| 0.5 + 3.0 * ((k * 17 % 29) as f32) / 29.0).collect();
    let measured = DensityGrid::new(Vec3::new(-1.0, 0.0, -2.0), Vec3::new(4.0, 9.0, 3.0), size, values).expect("sound");
    let veins = VeinsPattern { frequency: 0.4, width: 0.3, least: 0.25, greatest: 3.0, octaves: 3, seed: 5 };
    // The error of a weight is a few last places of the position in the grid, up to 5, times the
    // difference of the densities. For veins, see their Accuracy line.
    [(Density::Grid(Arc::new(measured)), 3e-5), (Density::Veins(veins), 1e-3)]
}

#[test]
fn every_voxel_has_the_density_of_its_middle() {
    for (density, tolerance) in densities() {
        for cells in CELLS {
            let grid = grid(cells);
            let (mut worst, mut least, mut most) = (0.0f32, f32::INFINITY, 0.0f32);
            for (index, found) in found(grid, &density, |_| true).into_iter().enumerate() {
                worst = larger(worst, (found - density.at(grid.centre(grid.voxel(index)))).abs());
                (least, most) = (least.min(found), most.max(found));
            }
            println!("{least} to {most}, off by {worst:.1e}");
            assert!(worst <= tolerance && least < 0.7 && most > 2.5, "{cells} {density:?}: {worst} {least} {most}");
        }
    }
}

#[test]
fn a_voxel_beside_matter_has_its_density_too() {
    for (density, tolerance) in densities() {
        for cells in CELLS {
            let grid = grid(cells);
            // A few voxels at the ends of words and of the grid, and some in between.
            let matter = [[0, 0, 0], [31, 9, 9], [32 % cells, 20, 20], [cells - 1; 3], [15, 16, 17]].map(UVec3::from);
            let found = found(grid, &density, |voxel| matter.contains(&voxel));
            let mut free = 0;
            for (index, found) in found.into_iter().enumerate() {
                let voxel = grid.voxel(index);
                let beside = |other: &UVec3| (voxel.as_ivec3() - other.as_ivec3()).abs().max_element() <= 1;
                if matter.iter().any(beside) {
                    let wanted = density.at(grid.centre(voxel));
                    assert!((found - wanted).abs() <= tolerance, "{cells} {voxel}: {found} for {wanted}");
                } else {
                    free += usize::from(found == 0.0);
                }
            }
            // Voxels far from all matter are left out.
            assert!(free > grid.count() / 2, "{free}");
        }
    }
}

#[test]
fn a_listed_tile_has_its_densities_and_no_other() {
    let gpu = Gpu::shared(&AdapterChoice::from_environment()).expect("a device");
    for (density, tolerance) in densities() {
        for cells in CELLS {
            let grid = grid(cells);
            let side = cells.div_ceil(4);
            let listed = [0, side, side * side * side - 1];
            let mut builder = Builder::new(Some(gpu));
            let tiles = builder.storage("tiles", bytemuck::cast_slice(&listed));
            let counts = bytemuck::cast_slice(&[3u32, 1, 1]).to_vec();
            let workgroups = builder.filled("tile count", counts, wgpu::BufferUsages::INDIRECT);
            let found = run(gpu, builder, grid, &density, Where::Listed { tiles, workgroups });
            for (index, found) in found.into_iter().enumerate() {
                let voxel = grid.voxel(index);
                let tile = voxel / 4;
                let is_listed = listed.contains(&(tile.x + side * (tile.y + side * tile.z)));
                let wanted = if is_listed { density.at(grid.centre(voxel)) } else { 0.0 };
                assert!((found - wanted).abs() <= tolerance, "{cells} {voxel}: {found} for {wanted}");
            }
        }
    }
}

#[test]
fn a_body_of_one_density_needs_none() {
    let mut builder = Builder::new(None);
    let matter = builder.storage("matter", &[0; 4]);
    assert!(
        Densities::new(&mut builder, grid(16), &Density::Uniform, Where::Near(matter))
            .expect("nothing to compile")
            .is_none()
    );
}
