//! Mirrors of the recipes' kernels over whole buffers, on the CPU.

use crate::{OPTICAL_PATH_UNREACHED, decode, edge, edge_paper, encode, godunov, relax};
use glam::{IVec3, UVec3, Vec3};

/// A cube of voxels with its matter. Voxel (x, y, z) has the number x + cells (y + cells z).
#[derive(Clone, Copy, Debug)]
pub struct Body<'a> {
    /// Voxels along an edge.
    pub cells: u32,
    /// A voxel's edge.
    pub spacing: f32,
    /// Whether there is matter, by voxel.
    pub matter: &'a [bool],
    /// At least 0, in the inverse of the spacing's unit, by voxel.
    pub extinction: &'a [f32],
}

impl Body<'_> {
    /// The voxel's number, where it lies in the cube and holds matter.
    pub fn node(&self, voxel: IVec3) -> Option<usize> {
        let cells = self.cells as i32;
        let inside = voxel.cmpge(IVec3::ZERO).all() && voxel.cmplt(IVec3::splat(cells)).all();
        let index = inside.then(|| (voxel.x + cells * (voxel.y + cells * voxel.z)) as usize);
        index.filter(|index| self.matter[*index])
    }

    /// The voxel with this number.
    pub fn voxel(&self, index: usize) -> IVec3 {
        let (index, cells) = (index as u32, self.cells);
        UVec3::new(index % cells, index / cells % cells, index / cells / cells).as_ivec3()
    }

    /// The neighbours of a voxel by its stencil of 6, 18 or 26, with the lengths of the edges to them.
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

/// What a solve begins from: nothing but costs, and those in matter alone.
pub fn seeded(body: &Body<'_>, seeds: &[f32]) -> Vec<f32> {
    let costs = seeds.iter().zip(body.matter);
    costs.map(|(seed, matter)| if *matter { decode(encode(*seed)) } else { OPTICAL_PATH_UNREACHED }).collect()
}

/// One pass in which every voxel takes the least that its neighbours offer.
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

/// One pass of the paper's: the voxels in `written` offer their costs; returned are those that took an offer.
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

/// One pass of Godunov's update over all voxels, each from what those before it have become, in order of their numbers or in reverse.
/// Returns the largest change, in units of the cost where that is above 1.
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
