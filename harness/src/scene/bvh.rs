//! A bounding volume hierarchy over a mesh, as it goes into the storage buffers of `wgsl/recipes/bvh_trace.wgsl`.
//!
//! Built by obvhs: PLOC (parallel locally-ordered clustering) with reinsertion, whose nodes in its small layout are already
//! what a GPU reads, 32 bytes with adjacent children. (The crate bvh keeps an enum of nodes with parents, or a list of
//! 36-byte nodes to skip through, which has no order from near to far, and it brings nalgebra.) Two things are added here.
//! Its clustering does not bound the depth, and a shader's stack must: where a mesh, such as a thousand copies of one triangle, makes
//! it deeper than [`BVH_TRACE_DEPTH`], the triangles are halved instead. And boxes are taken anew from the positions, since obvhs is given
//! them scaled to a unit cube, which neither over- nor underflows in its areas.

use glam::{Vec3, Vec3A, Vec4};
use lapidary_bvh_trace::traversal::BVH_TRACE_DEPTH;
use obvhs::aabb::Aabb;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::{Boundable, BvhBuildParams};

use super::Mesh;

/// Most triangles in a leaf.
const MOST_IN_A_LEAF: usize = 4;

/// How obvhs builds. A step down costs two boxes and their way from memory, about as much as a triangle.
const PARAMETERS: BvhBuildParams = BvhBuildParams {
    max_prims_per_leaf: MOST_IN_A_LEAF as u32,
    collapse_traversal_cost: 1.0,
    ..BvhBuildParams::medium_build()
};

/// A hierarchy of boxes over the triangles of a mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bvh {
    /// 32 bytes each, `BvhTraceNode` in WGSL: (lower corner, count) and (upper corner, first), the last of each a `u32` as bits. With
    /// count above 0 a leaf of the triangles first, …, first + count - 1; with 0 an inner node whose children are the nodes first
    /// and first + 1. The root is the first node, and a node stands before its children. None if the mesh has no triangle.
    pub nodes: Vec<[Vec4; 2]>,
    /// Three vertex indices a triangle, in the order of the leaves.
    pub indices: Vec<u32>,
    /// For each of these triangles its number in the mesh.
    pub order: Vec<u32>,
}

impl Bvh {
    /// The hierarchy of `mesh`, at most [`BVH_TRACE_DEPTH`] nodes deep below its root. Triangles with a corner that is not finite,
    /// or that does not exist, cannot be met and are left out.
    #[must_use]
    pub fn build(mesh: &Mesh) -> Self {
        let corner = |index: u32| mesh.positions.get(index as usize).copied().filter(|position| position.is_finite());
        let triangles: Vec<Triangle> = mesh
            .indices
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
        let links = clustered(&triangles);
        let laid_out = links.laid_out().unwrap_or_else(|| {
            halved(&triangles).laid_out().expect("2³² triangles, halved, lie 32 deep")
        });
        laid_out.into_bvh(&triangles, mesh)
    }

    /// The largest number of nodes below the root on the way to a leaf; 0 without nodes.
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

/// A triangle's box.
#[derive(Clone, Copy, Debug)]
struct Triangle {
    number: u32,
    lower: Vec3,
    upper: Vec3,
}

/// A tree without boxes: nodes in any order, children side by side.
struct Links {
    nodes: Vec<Link>,
    /// Places in the list of triangles; leaves are ranges of it.
    order: Vec<u32>,
}

#[derive(Clone, Copy)]
struct Link {
    count: u32,
    first: u32,
}

/// A triangle's box, scaled for obvhs.
struct Scaled(Aabb);

impl Boundable for Scaled {
    fn aabb(&self) -> Aabb {
        self.0
    }
}

/// The tree by obvhs.
fn clustered(triangles: &[Triangle]) -> Links {
    let all = |corner: fn(&Triangle) -> Vec3, join: fn(Vec3, Vec3) -> Vec3| {
        triangles.iter().map(corner).reduce(join).unwrap_or_default().as_dvec3()
    };
    let (lower, upper) = (all(|t| t.lower, Vec3::min), all(|t| t.upper, Vec3::max));
    // A mesh without any extent stays the point that it is.
    let scale = 1.0 / (upper - lower).max_element().max(f64::MIN_POSITIVE);
    let scaled = |corner: Vec3| Vec3A::from(((corner.as_dvec3() - lower) * scale).as_vec3());
    let boxes: Vec<Scaled> =
        triangles.iter().map(|triangle| Scaled(Aabb::new(scaled(triangle.lower), scaled(triangle.upper)))).collect();
    let built = build_bvh2(&boxes, PARAMETERS, &mut std::time::Duration::default());
    let nodes = built.nodes.iter().map(|node| Link { count: node.prim_count, first: node.first_index }).collect();
    Links { nodes, order: built.primitive_indices }
}

/// The tree by halves: as shallow as can be.
fn halved(triangles: &[Triangle]) -> Links {
    let mut order: Vec<u32> = (0..).take(triangles.len()).collect();
    let mut nodes = vec![Link { count: 0, first: 0 }];
    let mut open = vec![(0, 0, order.len())];
    while let Some((node, start, end)) = open.pop() {
        if end - start <= MOST_IN_A_LEAF {
            nodes[node] = Link { count: (end - start) as u32, first: start as u32 };
            continue;
        }
        let part = &mut order[start..end];
        // Twice the middles; half of each first, since the sum of two huge corners overflows.
        let middle = |index: &u32| {
            let triangle = &triangles[*index as usize];
            0.5 * triangle.lower + 0.5 * triangle.upper
        };
        let join = |join: fn(Vec3, Vec3) -> Vec3| part.iter().map(middle).reduce(join).unwrap_or_default().as_dvec3();
        let size = join(Vec3::max) - join(Vec3::min);
        let axis = (0..3).max_by(|a, b| size[*a].total_cmp(&size[*b])).unwrap_or(0);
        let half = part.len() / 2;
        part.select_nth_unstable_by(half, |a, b| middle(a)[axis].total_cmp(&middle(b)[axis]));
        let first = nodes.len();
        nodes[node] = Link { count: 0, first: first as u32 };
        nodes.extend([Link { count: 0, first: 0 }; 2]);
        open.push((first, start, start + half));
        open.push((first + 1, start + half, end));
    }
    Links { nodes, order }
}

impl Links {
    /// The same tree with each node before its children and the leaves' triangles in the order of the nodes; none if it is too
    /// deep for the shader's stack.
    fn laid_out(&self) -> Option<Links> {
        let mut nodes = vec![Link { count: 0, first: 0 }];
        let mut order = Vec::with_capacity(self.order.len());
        let mut open = vec![(0usize, 0usize, 0usize)];
        while let Some((from, to, depth)) = open.pop() {
            if depth > BVH_TRACE_DEPTH {
                return None;
            }
            let Link { count, first } = self.nodes[from];
            let first = first as usize;
            if count > 0 {
                nodes[to] = Link { count, first: order.len() as u32 };
                order.extend_from_slice(&self.order[first..first + count as usize]);
            } else {
                let children = nodes.len();
                nodes[to] = Link { count: 0, first: children as u32 };
                nodes.extend([Link { count: 0, first: 0 }; 2]);
                open.push((first + 1, children + 1, depth + 1));
                open.push((first, children, depth + 1));
            }
        }
        Some(Links { nodes, order })
    }

    /// With boxes and vertices.
    fn into_bvh(self, triangles: &[Triangle], mesh: &Mesh) -> Bvh {
        let mut boxes = vec![(Vec3::ZERO, Vec3::ZERO); self.nodes.len()];
        let join = |a: (Vec3, Vec3), b: (Vec3, Vec3)| (a.0.min(b.0), a.1.max(b.1));
        // Children stand after their parents.
        for (index, node) in self.nodes.iter().enumerate().rev() {
            let first = node.first as usize;
            boxes[index] = if node.count == 0 {
                join(boxes[first], boxes[first + 1])
            } else {
                let held = &self.order[first..first + node.count as usize];
                let held = held.iter().map(|index| &triangles[*index as usize]);
                held.map(|triangle| (triangle.lower, triangle.upper)).reduce(join).unwrap_or_default()
            };
        }
        let nodes = self.nodes.iter().zip(boxes).map(|(node, (lower, upper))| {
            [lower.extend(f32::from_bits(node.count)), upper.extend(f32::from_bits(node.first))]
        });
        let order: Vec<u32> = self.order.iter().map(|index| triangles[*index as usize].number).collect();
        let corners = |number: &u32| {
            let start = 3 * *number as usize;
            mesh.indices[start..start + 3].iter().copied()
        };
        Bvh { nodes: nodes.collect(), indices: order.iter().flat_map(corners).collect(), order }
    }
}
