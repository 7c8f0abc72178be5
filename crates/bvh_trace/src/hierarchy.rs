//! A bounding volume hierarchy over a mesh, in the layout of the storage buffers of
//! `wgsl/recipes/trace.wgsl` and `gem_bvh.wgsl`.
//!
//! Built here because no crate fits. obvhs 0.4 has the right layout, 32-byte nodes with adjacent
//! children, and few dependencies; but its clustering does not bound the depth, as a shader's stack
//! requires, and with debug assertions, as in the test builds, it panics on some degenerate meshes
//! and overflows the stack with 20,000 equal triangles. bvh 0.13 keeps an enum of nodes with
//! parents, or a list of 36-byte nodes to skip through, which has no near-to-far order, and it
//! depends on nalgebra. The remaining work is short: splits by the surface area heuristic in bins
//! (Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", 2007), and halving
//! wherever those would make the hierarchy too deep.

use crate::traversal::BVH_TRACE_DEPTH;
use glam::{DVec3, Vec3, Vec4};

/// Largest number of triangles in a leaf. Four take 3 % longer in a bunny, one 6 % in a brilliant.
const MOST_IN_A_LEAF: usize = 2;
/// Number of bins along each axis; splits are tried between them.
const BINS: usize = 16;
/// Cost of a step down relative to a triangle: two boxes and their transfer from memory.
const STEP: f64 = 1.0;

/// A hierarchy of boxes over the triangles of a mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bvh {
    /// Nodes of 32 bytes each, `BvhTraceNode` in WGSL: (lower corner, count) and (upper corner,
    /// first), the last component of each being the bits of a `u32`. A node with count above 0 is a
    /// leaf of the triangles first, …, first + count - 1; one with 0 is an inner node whose
    /// children are the nodes first and first + 1. The root is the first node, and a node precedes
    /// its children. Empty if the mesh has no triangle.
    pub nodes: Vec<[Vec4; 2]>,
    /// Three vertex indices per triangle, in the order of the leaves.
    pub indices: Vec<u32>,
    /// Number in the mesh of each of these triangles.
    pub order: Vec<u32>,
}

/// A triangle and its box.
#[derive(Clone, Copy, Debug)]
struct Triangle {
    number: u32,
    lower: Vec3,
    upper: Vec3,
}

impl Triangle {
    /// Returns the middle of the box, in f64, where the sum of two huge corners does not overflow.
    fn middle(&self) -> DVec3 {
        0.5 * (self.lower.as_dvec3() + self.upper.as_dvec3())
    }
}

/// A box that grows.
#[derive(Clone, Copy, Debug)]
struct Extent {
    lower: Vec3,
    upper: Vec3,
}

impl Extent {
    const EMPTY: Self = Self { lower: Vec3::INFINITY, upper: Vec3::NEG_INFINITY };

    fn of(triangles: &[Triangle]) -> Self {
        triangles.iter().fold(Self::EMPTY, |extent, triangle| extent.with(triangle.lower, triangle.upper))
    }

    fn with(self, lower: Vec3, upper: Vec3) -> Self {
        Self { lower: self.lower.min(lower), upper: self.upper.max(upper) }
    }

    fn join(self, other: Self) -> Self {
        self.with(other.lower, other.upper)
    }

    /// Returns half the surface area, 0 if the box is empty; in f64, which holds the square of
    /// every f32.
    fn area(self) -> f64 {
        let size = (self.upper.as_dvec3() - self.lower.as_dvec3()).max(DVec3::ZERO);
        size.x * size.y + size.y * size.z + size.z * size.x
    }
}

impl Bvh {
    /// Builds the hierarchy of a mesh, at most [`BVH_TRACE_DEPTH`] nodes deep below its root.
    /// `indices` are three per triangle, counter-clockwise from outside. Triangles with a corner that
    /// is not finite, or that does not exist, cannot be hit and are left out.
    #[must_use]
    pub fn build(positions: &[Vec3], indices: &[u32]) -> Self {
        let corner = |index: u32| positions.get(index as usize).copied().filter(|position| position.is_finite());
        let mut triangles: Vec<Triangle> = indices
            .chunks_exact(3)
            .zip(0..)
            .filter_map(|(corners, number)| {
                let [a, b, c] = [corner(corners[0])?, corner(corners[1])?, corner(corners[2])?];
                Some(Triangle { number, lower: a.min(b).min(c), upper: a.max(b).max(c) })
            })
            .collect();
        if triangles.is_empty() {
            return Self::default();
        }
        let nodes = nodes(&mut triangles);
        let order: Vec<u32> = triangles.iter().map(|triangle| triangle.number).collect();
        let corners = |number: &u32| indices[3 * *number as usize..][..3].iter().copied();
        Self { nodes, indices: order.iter().flat_map(corners).collect(), order }
    }

    /// Returns the largest number of nodes below the root on the way to a leaf; 0 without nodes.
    #[must_use]
    pub fn depth(&self) -> usize {
        let mut depths = vec![0; self.nodes.len()];
        for (index, node) in self.nodes.iter().enumerate() {
            if node[0].w.to_bits() == 0 {
                let first = node[1].w.to_bits() as usize;
                depths[first] = depths[index] + 1;
                depths[first + 1] = depths[index] + 1;
            }
        }
        depths.into_iter().max().unwrap_or(0)
    }
}

/// Builds the nodes, and sorts the triangles into the order of the leaves.
fn nodes(triangles: &mut [Triangle]) -> Vec<[Vec4; 2]> {
    let mut nodes = vec![[Vec4::ZERO; 2]];
    let mut open = vec![(0, 0..triangles.len(), 0)];
    while let Some((node, range, depth)) = open.pop() {
        let part = &mut triangles[range.clone()];
        let extent = Extent::of(part);
        let (count, first) = match split(part, extent, depth) {
            None => (part.len(), range.start),
            Some(middle) => {
                let first = nodes.len();
                nodes.extend([[Vec4::ZERO; 2]; 2]);
                // The first child is built next, so that it and its contents are close by in
                // memory.
                open.push((first + 1, range.start + middle..range.end, depth + 1));
                open.push((first, range.start..range.start + middle, depth + 1));
                (0, first)
            }
        };
        // A mesh has fewer than 2³² / 3 triangles and less than twice as many nodes, because its
        // indices are counted by u32.
        let bits = |number: usize| f32::from_bits(number as u32);
        nodes[node] = [extent.lower.extend(bits(count)), extent.upper.extend(bits(first))];
    }
    nodes
}

/// Returns the number of levels that halving needs for this many triangles.
fn levels(count: usize) -> usize {
    count.div_ceil(MOST_IN_A_LEAF).next_power_of_two().ilog2() as usize
}

/// Moves the triangles of the first child to the front and returns their number, or `None` for a
/// leaf.
fn split(part: &mut [Triangle], extent: Extent, depth: usize) -> Option<usize> {
    if part.len() <= 1 {
        return None;
    }
    let (low, high) = part.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), triangle| {
        (low.min(triangle.middle()), high.max(triangle.middle()))
    });
    let size = high - low;
    let bin = |triangle: &Triangle, axis: usize| {
        let share = (triangle.middle()[axis] - low[axis]) / size[axis];
        ((share * BINS as f64) as usize).min(BINS - 1)
    };
    // The cheapest (cost, axis, first bin of the second child); costs are areas times triangles.
    let mut best: Option<(f64, usize, usize)> = None;
    for axis in (0..3).filter(|axis| size[*axis] > 0.0) {
        let mut bins = [(0usize, Extent::EMPTY); BINS];
        for triangle in part.iter() {
            let (count, extent) = &mut bins[bin(triangle, axis)];
            *count += 1;
            *extent = extent.with(triangle.lower, triangle.upper);
        }
        let join = |a: (usize, Extent), b: (usize, Extent)| (a.0 + b.0, a.1.join(b.1));
        for start in 1..BINS {
            let [first, second] =
                [&bins[..start], &bins[start..]].map(|bins| bins.iter().copied().fold((0, Extent::EMPTY), join));
            // The remaining levels must suffice for halving either child.
            if first.0.min(second.0) == 0 || depth + 1 + levels(first.0.max(second.0)) > BVH_TRACE_DEPTH {
                continue;
            }
            let cost = first.1.area() * first.0 as f64 + second.1.area() * second.0 as f64;
            if best.is_none_or(|best| cost < best.0) {
                best = Some((cost, axis, start));
            }
        }
    }
    let as_leaf = extent.area() * (part.len() as f64 - STEP);
    match best {
        Some((cost, ..)) if part.len() <= MOST_IN_A_LEAF && cost >= as_leaf => None,
        Some((_, axis, start)) => {
            part.sort_by_key(|triangle| bin(triangle, axis) >= start);
            Some(part.partition_point(|triangle| bin(triangle, axis) < start))
        }
        // All in one place, or too deep already.
        None if part.len() <= MOST_IN_A_LEAF => None,
        None => {
            let axis = (0..3).max_by(|a, b| size[*a].total_cmp(&size[*b])).unwrap_or(0);
            let half = part.len() / 2;
            part.select_nth_unstable_by(half, |a, b| a.middle()[axis].total_cmp(&b.middle()[axis]));
            Some(half)
        }
    }
}
