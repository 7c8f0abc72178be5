//! A bounding volume hierarchy over a mesh, in the layout of the storage buffers of
//! `wgsl/recipes/trace.wgsl` and `gem_bvh.wgsl`.
//!
//! Built here because no crate fits. obvhs 0.4 has nodes of two children and compressed ones of
//! eight, and few dependencies; but its clustering does not bound the depth, as a shader's stack
//! requires, and with debug assertions, as in the test builds, it panics on some degenerate meshes
//! and overflows the stack with 20,000 equal triangles. bvh 0.13 keeps an enum of nodes with
//! parents, or a list of 36-byte nodes to skip through, which has no near-to-far order, and it
//! depends on nalgebra. The remaining work is short: splits by the surface area heuristic in bins
//! (Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", 2007), halving wherever
//! those would make the hierarchy too deep, and boxes in bytes (Ylitie, Karras and Laine, "Efficient
//! Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", HPG 2017).

use crate::traversal::{BVH_TRACE_LEAF, BVH_TRACE_LEVELS};
use crate::{BVH_TRACE_NONE, BvhTraceNode};
use glam::{DVec3, UVec3, UVec4, Vec3, Vec4};
use std::ops::Range;

/// Largest number of triangles in a leaf. One takes 7 % longer in a bunny, 14 % in a brilliant; three
/// take as long.
const MOST_IN_A_LEAF: usize = 2;
/// Largest number of splits above a leaf: each level of nodes takes two at least.
const MOST_SPLITS: usize = 2 * BVH_TRACE_LEVELS;
/// Number of bins along each axis; splits are tried between them.
const BINS: usize = 16;
/// Cost of a split relative to a triangle's test.
const STEP: f64 = 1.0;

/// A hierarchy of boxes over the triangles of a mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bvh {
    /// Nodes, `BvhTraceNode` in WGSL, each before its children; the root is the first. Empty if the
    /// mesh has no triangle.
    pub nodes: Vec<BvhTraceNode>,
    /// Three vertex indices per triangle, in the order of the leaves.
    pub indices: Vec<u32>,
    /// Positions of these vertices, in the layout of a storage buffer; w is 0.
    pub corners: Vec<Vec4>,
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
    /// Builds the hierarchy of a mesh, of at most [`BVH_TRACE_LEVELS`] levels of nodes. `indices` are
    /// three per triangle, counter-clockwise from outside. Triangles with a corner that is not
    /// finite, or that does not exist, cannot be hit and are left out; so are those from 2³⁰ on, whose
    /// numbers do not fit into a node.
    #[must_use]
    pub fn build(positions: &[Vec3], indices: &[u32]) -> Self {
        let corner = |index: u32| positions.get(index as usize).copied().filter(|position| position.is_finite());
        let mut triangles: Vec<Triangle> = indices
            .chunks_exact(3)
            .zip(0..BVH_TRACE_LEAF)
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
        let vertices = |number: &u32| indices[3 * *number as usize..][..3].iter().copied();
        let indices: Vec<u32> = order.iter().flat_map(vertices).collect();
        let corners = indices.iter().map(|index| positions[*index as usize].extend(0.0)).collect();
        Self { nodes, indices, corners, order }
    }

    /// Returns the nodes in the layout of a storage buffer, 16 words each.
    #[must_use]
    pub fn words(&self) -> Vec<[u32; 16]> {
        self.nodes.iter().map(words).collect()
    }

    /// Returns the largest number of nodes on the way from the root to a leaf; 0 without nodes.
    #[must_use]
    pub fn levels(&self) -> usize {
        let mut levels = vec![1; self.nodes.len()];
        for (index, node) in self.nodes.iter().enumerate() {
            for child in node.children.to_array().into_iter().filter(|child| *child < BVH_TRACE_LEAF) {
                levels[child as usize] = levels[index] + 1;
            }
        }
        levels.into_iter().max().unwrap_or(0)
    }
}

fn words(node: &BvhTraceNode) -> [u32; 16] {
    let [x, y, z] = node.corner.to_array().map(f32::to_bits);
    let ([lower_x, lower_y, lower_z], [upper_x, upper_y, upper_z]) = (node.lower.to_array(), node.upper.to_array());
    let [a, b, c, d] = node.children.to_array();
    [x, y, z, node.steps, lower_x, lower_y, lower_z, 0, upper_x, upper_y, upper_z, 0, a, b, c, d]
}

/// A part of the triangles that becomes one child.
struct Part {
    range: Range<usize>,
    extent: Extent,
    /// Where it is split; `None` for a leaf.
    middle: Option<usize>,
    /// Number of splits above.
    depth: usize,
}

impl Part {
    fn of(triangles: &mut [Triangle], range: Range<usize>, depth: usize) -> Self {
        let part = &mut triangles[range.clone()];
        let extent = Extent::of(part);
        let middle = split(part, extent, depth).map(|count| range.start + count);
        Self { range, extent, middle, depth }
    }
}

/// Builds the nodes, and sorts the triangles into the order of the leaves.
fn nodes(triangles: &mut [Triangle]) -> Vec<BvhTraceNode> {
    let whole = 0..triangles.len();
    let mut nodes = vec![BvhTraceNode::EMPTY];
    let root = Part::of(triangles, whole, 0);
    let mut open = vec![(0, root)];
    while let Some((place, part)) = open.pop() {
        let parts = children(triangles, part);
        let mut node = BvhTraceNode::around(parts.iter().map(|part| part.extent));
        let mut inner = Vec::new();
        for (child, part) in parts.into_iter().enumerate() {
            // `build` takes less than 2^30 triangles, and there are fewer nodes.
            if part.middle.is_none() {
                node.children[child] = part.range.start as u32 | (part.range.len() as u32) << 30;
            } else {
                node.children[child] = nodes.len() as u32;
                inner.push((nodes.len(), part));
                nodes.push(BvhTraceNode::EMPTY);
            }
        }
        nodes[place] = node;
        // The first child is built next, so that it and its contents are close by in memory.
        open.extend(inner.into_iter().rev());
    }
    nodes
}

/// Splits a part into two, each of those into two, and then the largest again, until there are
/// four. Each level of nodes so takes up two levels of splits at least.
fn children(triangles: &mut [Triangle], part: Part) -> Vec<Part> {
    let mut parts = vec![part];
    for _ in 0..2 {
        parts = parts.into_iter().flat_map(|part| halves(triangles, part)).collect();
    }
    while parts.len() < 4 {
        let inner = (0..parts.len()).filter(|place| parts[*place].middle.is_some());
        let Some(largest) = inner.max_by(|a, b| parts[*a].extent.area().total_cmp(&parts[*b].extent.area())) else {
            break;
        };
        let part = parts.remove(largest);
        parts.splice(largest..largest, halves(triangles, part));
    }
    parts
}

/// Returns the two halves of a part, or the part itself if it is a leaf.
fn halves(triangles: &mut [Triangle], part: Part) -> Vec<Part> {
    match part.middle {
        None => vec![part],
        Some(middle) => [part.range.start..middle, middle..part.range.end]
            .map(|range| Part::of(triangles, range, part.depth + 1))
            .into(),
    }
}

impl BvhTraceNode {
    /// A node without children.
    const EMPTY: Self = Self {
        corner: Vec3::ZERO,
        steps: 0,
        lower: UVec3::ZERO,
        upper: UVec3::ZERO,
        children: UVec4::splat(BVH_TRACE_NONE),
    };

    /// Returns a node with the boxes of up to four children.
    fn around(extents: impl Iterator<Item = Extent> + Clone) -> Self {
        let whole = extents.clone().fold(Extent::EMPTY, Extent::join);
        let mut node = Self { corner: whole.lower, ..Self::EMPTY };
        for axis in 0..3 {
            let corner = f64::from(whole.lower[axis]);
            let upper = f64::from(whole.upper[axis]);
            // The least power of two of which 255 reach across.
            let step = |exponent: i32| 2f64.powi(exponent - 127);
            let mut exponent = (((upper - corner) / 255.0).log2().ceil() as i32).saturating_add(127).clamp(1, 254);
            while corner + 255.0 * step(exponent) < upper {
                exponent += 1;
            }
            node.steps |= (exponent as u32) << (8 * axis);
            let step = step(exponent);
            for (child, extent) in extents.clone().enumerate() {
                // Rounded outwards. The shader's sum is off by its rounding, which a ray's margin
                // covers.
                let (side, other) = (f64::from(extent.lower[axis]), f64::from(extent.upper[axis]));
                let (mut lower, mut upper) = (((side - corner) / step).floor(), ((other - corner) / step).ceil());
                if corner + lower * step > side {
                    lower -= 1.0;
                }
                if corner + upper * step < other {
                    upper += 1.0;
                }
                let (lower, upper) = (lower as u32, upper as u32);
                node.lower[axis] |= lower << (8 * child);
                node.upper[axis] |= upper << (8 * child);
            }
        }
        node
    }
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
            if first.0.min(second.0) == 0 || depth + 1 + levels(first.0.max(second.0)) > MOST_SPLITS {
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
