//! Mirrors of the recipes' kernels over whole buffers, on the CPU.

use crate::{OPTICAL_PATH_UNREACHED, decode, edge, edge_paper, encode, godunov, relax};
use glam::{IVec3, UVec3, Vec3};

/// A cube of voxels and its matter. Voxel (x, y, z) has the index x + cells (y + cells z).
#[derive(Clone, Copy, Debug)]
pub struct Body<'a> {
    /// Number of voxels along an edge of the cube.
    pub cells: u32,
    /// Edge length of a voxel.
    pub spacing: f32,
    /// Whether there is matter, for each voxel.
    pub matter: &'a [bool],
    /// Extinction of each voxel, at least 0, in the inverse of the spacing's unit.
    pub extinction: &'a [f32],
}

impl Body<'_> {
    /// Returns the index of a voxel; `None` if it lies outside of the cube or holds no matter.
    pub fn node(&self, voxel: IVec3) -> Option<usize> {
        let cells = self.cells as i32;
        let inside = voxel.cmpge(IVec3::ZERO).all() && voxel.cmplt(IVec3::splat(cells)).all();
        let index = inside.then(|| (voxel.x + cells * (voxel.y + cells * voxel.z)) as usize);
        index.filter(|index| self.matter[*index])
    }

    /// Returns the voxel with this index.
    pub fn voxel(&self, index: usize) -> IVec3 {
        let (index, cells) = (index as u32, self.cells);
        UVec3::new(index % cells, index / cells % cells, index / cells / cells).as_ivec3()
    }

    /// Returns the neighbours of a voxel in a stencil of 6, 18 or 26, with the lengths of the edges
    /// to them.
    pub fn neighbours(&self, index: usize, stencil: u32) -> impl Iterator<Item = (usize, f32)> + '_ {
        let voxel = self.voxel(index);
        (0..27).filter_map(move |place: i32| {
            let offset = IVec3::new(place % 3, place / 3 % 3, place / 9) - 1;
            let axes = offset.abs().element_sum();
            let in_stencil = axes == 1 || (axes == 2 && stencil >= 18) || (axes == 3 && stencil == 26);
            let length = [0.0, 1.0, 1.4142135, 1.7320508][axes as usize];
            self.node(voxel + offset).filter(|_| in_stencil).map(|node| (node, self.spacing * length))
        })
    }
}

/// Returns the costs from which a solve begins: valid ones in matter, unreached elsewhere.
pub fn seeded(body: &Body<'_>, seeds: &[f32]) -> Vec<f32> {
    let costs = seeds.iter().zip(body.matter);
    costs.map(|(seed, matter)| if *matter { decode(encode(*seed)) } else { OPTICAL_PATH_UNREACHED }).collect()
}

/// Runs one pass in which every voxel takes the least cost that its neighbours offer.
pub fn pull(body: &Body<'_>, stencil: u32, costs: &[f32]) -> Vec<f32> {
    let node = |(index, cost): (usize, &f32)| {
        if !body.matter[index] {
            return *cost;
        }
        body.neighbours(index, stencil).fold(*cost, |cost, (neighbour, length)| {
            let edge = edge(body.extinction[index], body.extinction[neighbour], length);
            relax(cost, costs[neighbour], edge)
        })
    };
    costs.iter().enumerate().map(node).collect()
}

/// Runs one pass of the paper's method: the voxels in `written` offer their costs. Returns the
/// voxels that took an offer.
pub fn push(body: &Body<'_>, costs: &mut [f32], written: &[usize]) -> Vec<usize> {
    let mut lowered = Vec::new();
    for &index in written {
        for (neighbour, _) in body.neighbours(index, 6) {
            let edge = edge_paper(body.extinction[index], body.extinction[neighbour]);
            let offered = relax(OPTICAL_PATH_UNREACHED, costs[index], edge);
            if offered < costs[neighbour] {
                costs[neighbour] = offered;
                lowered.push(neighbour);
            }
        }
    }
    lowered.sort_unstable();
    lowered.dedup();
    lowered
}

/// Runs one pass of Godunov's update over all voxels, in the order of their indices or in reverse.
/// Each voxel uses the new costs of those before it. Returns the largest change, in units of the
/// cost if the cost is above 1.
pub fn upwind(body: &Body<'_>, costs: &mut [f32], reversed: bool) -> f32 {
    let mut change: f32 = 0.0;
    for step in 0..costs.len() {
        let index = if reversed { costs.len() - 1 - step } else { step };
        if !body.matter[index] {
            continue;
        }
        let voxel = body.voxel(index);
        let cost = |offset: IVec3| body.node(voxel + offset).map_or(OPTICAL_PATH_UNREACHED, |node| costs[node]);
        let axis = |axis: IVec3| cost(-axis).min(cost(axis));
        let least = Vec3::new(axis(IVec3::X), axis(IVec3::Y), axis(IVec3::Z));
        let before = costs[index];
        costs[index] = before.min(godunov(least, body.spacing * body.extinction[index]));
        change = change.max((before - costs[index]) / before.max(1.0));
    }
    change
}
