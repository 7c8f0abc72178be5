//! The kernels of the recipe `voxelize`, buffer by buffer, with its names and its order of
//! operations.

use crate::VoxelizationGrid;
use glam::{UVec2, Vec3};

/// Output buffers of a frame of the recipe, all 0 at first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Buffers {
    /// A bit for each voxel; each row along x starts at a new word.
    pub matter: Vec<u32>,
    /// The same layout, for the voxels that the surface touches.
    pub surface: Vec<u32>,
    /// A bit for each column, set if the column is crossed an odd number of times behind its last
    /// centre.
    pub beyond: Vec<u32>,
    /// Numbers of voxels whose centre is inside, of voxels that the surface touches, and of columns
    /// that are crossed an odd number of times.
    pub status: [u32; 3],
}

/// Returns the number of words in a row.
pub fn words(grid: VoxelizationGrid) -> u32 {
    grid.cells.div_ceil(32)
}

/// Runs the kernels of a frame one after another. `positions` holds three numbers per vertex.
pub fn frame(grid: VoxelizationGrid, positions: &[f32], indices: &[u32], effect_surface: bool) -> Buffers {
    let columns = grid.cells * grid.cells;
    let bits = vec![0; (columns * words(grid)) as usize];
    let beyond = vec![0; columns.div_ceil(32) as usize];
    let mut buffers = Buffers { matter: bits.clone(), surface: bits, beyond, status: [0; 3] };
    let corners: Vec<Vec3> =
        positions.chunks_exact(3).map(|position| crate::local(grid, Vec3::from_slice(position))).collect();
    for triangle in indices.chunks_exact(3) {
        let [a, b, c] = [0, 1, 2].map(|k| corners[triangle[k] as usize]);
        walk(grid, [a, b, c], effect_surface, &mut buffers);
    }
    for row in 0..columns {
        finish(grid, row, &mut buffers);
    }
    buffers
}

/// Mirrors `voxelization_load` and `voxelization_walk`, for all columns of a triangle in grid
/// coordinates.
pub fn walk(grid: VoxelizationGrid, [a, b, c]: [Vec3; 3], effect_surface: bool, buffers: &mut Buffers) {
    let margin = crate::margin(a, b, c);
    let low = a.min(b.min(c)) - margin;
    let high = a.max(b.max(c)) + margin;
    let y = crate::range(low.y, high.y, grid.cells);
    let z = crate::range(low.z, high.z, grid.cells);
    for place in (z.x..z.y).flat_map(|z| (y.x..y.y).map(move |y| UVec2::new(y, z))) {
        let row = place.x + grid.cells * place.y;
        let column = crate::column(a, b, c, place.as_vec2() + 0.5);
        if column.inside {
            let x = crate::first(column.depth, grid.cells);
            if x < grid.cells {
                buffers.matter[(row * words(grid) + x / 32) as usize] ^= 1 << (x % 32);
            } else {
                buffers.beyond[(row / 32) as usize] ^= 1 << (row % 32);
            }
        }
        if effect_surface {
            let span = crate::span(a, b, c, place.as_vec2());
            let range = crate::range(span.x, span.y, grid.cells);
            for x in range.x..range.y {
                if crate::overlaps(a, b, c, Vec3::new(x as f32, place.x as f32, place.y as f32)) {
                    buffers.surface[(row * words(grid) + x / 32) as usize] |= 1 << (x % 32);
                }
            }
        }
    }
}

/// Mirrors `voxelize_finish` for a row: each crossing flips all bits behind it. A row with an
/// odd number of crossings is not filled.
pub fn finish(grid: VoxelizationGrid, row: u32, buffers: &mut Buffers) {
    let words = words(grid);
    let first = (row * words) as usize;
    let mut crossings = (buffers.beyond[(row / 32) as usize] >> (row % 32)) & 1;
    for word in 0..words as usize {
        crossings += buffers.matter[first + word].count_ones();
    }
    let odd = crossings % 2 == 1;
    let mut inside = 0;
    for word in 0..words as usize {
        let partial = word + 1 == words as usize && !grid.cells.is_multiple_of(32);
        let within = if partial { (1 << (grid.cells % 32)) - 1 } else { u32::MAX };
        let all = crate::prefix(buffers.matter[first + word]) ^ inside;
        inside = if all >> 31 == 1 { u32::MAX } else { 0 };
        let filled = if odd { 0 } else { all & within };
        let skin = buffers.surface[first + word];
        buffers.matter[first + word] = filled | skin;
        buffers.status[0] += filled.count_ones();
        buffers.status[1] += skin.count_ones();
    }
    buffers.status[2] += u32::from(odd);
}
