//! Mirror of the part `wgsl/recipes/parts/trace_nearest.wgsl`: the loops over nodes and over all triangles, line by line, on
//! the buffers that its recipes bind.

use crate::{BVH_TRACE_NONE, BvhTraceHit, BvhTraceRay};
use glam::{Vec3, Vec4};

/// The largest number of nodes between the root and a leaf: what the stack holds.
pub const BVH_TRACE_DEPTH: usize = 32;
/// Farther than anything that a ray may meet.
pub const BVH_TRACE_FAR: f32 = 1e37;

/// The box of a node.
fn lower_of(node: &[Vec4; 2]) -> Vec3 {
    node[0].truncate()
}

fn upper_of(node: &[Vec4; 2]) -> Vec3 {
    node[1].truncate()
}

/// How many triangles a leaf holds; 0 for an inner node.
fn count_of(node: &[Vec4; 2]) -> u32 {
    node[0].w.to_bits()
}

/// A leaf's first triangle; an inner node's first child.
fn first_of(node: &[Vec4; 2]) -> u32 {
    node[1].w.to_bits()
}

/// A test of one triangle: [`crate::triangle`] or [`crate::triangle_naive`].
pub type TriangleFn = fn(BvhTraceHit, BvhTraceRay, Vec3, Vec3, Vec3, u32, u32) -> BvhTraceHit;

fn test(
    positions: &[Vec3],
    indices: &[u32],
    hit: BvhTraceHit,
    ray: BvhTraceRay,
    triangle: u32,
    left: u32,
    with: TriangleFn,
) -> BvhTraceHit {
    let corner = |k: usize| positions[indices[3 * triangle as usize + k] as usize];
    with(hit, ray, corner(0), corner(1), corner(2), triangle, left)
}

/// The nearest triangle that the ray leaves the solid through, found by the hierarchy. `nodes` are pairs of (lower
/// corner, count as bits) and (upper corner, first as bits); `indices` are in the order of the leaves; `left` is the
/// triangle just left, or [`BVH_TRACE_NONE`].
pub fn trace(
    nodes: &[[Vec4; 2]],
    positions: &[Vec3],
    indices: &[u32],
    origin: Vec3,
    direction: Vec3,
    left: u32,
) -> BvhTraceHit {
    trace_with(nodes, positions, indices, origin, direction, left, crate::triangle)
}

/// [`trace`] with another test of a triangle.
pub fn trace_with(
    nodes: &[[Vec4; 2]],
    positions: &[Vec3],
    indices: &[u32],
    origin: Vec3,
    direction: Vec3,
    left: u32,
    with: TriangleFn,
) -> BvhTraceHit {
    let mut hit = crate::start(BVH_TRACE_FAR);
    let ray = crate::ray(origin, direction, lower_of(&nodes[0]), upper_of(&nodes[0]));
    let mut stack = [0u32; BVH_TRACE_DEPTH];
    let mut entries = [0f32; BVH_TRACE_DEPTH];
    let mut depth = 0;
    let mut node = 0;
    loop {
        let current = &nodes[node as usize];
        let first = first_of(current);
        let count = count_of(current);
        if count == 0 {
            let (one, other) = (&nodes[first as usize], &nodes[first as usize + 1]);
            let box_one = crate::r#box(ray, lower_of(one), upper_of(one), hit.distance);
            let box_other = crate::r#box(ray, lower_of(other), upper_of(other), hit.distance);
            // The nearer child first: what it finds culls the farther.
            let other_first = box_other.hit && (!box_one.hit || box_other.entry < box_one.entry);
            let near = if other_first { first + 1 } else { first };
            if box_one.hit && box_other.hit {
                stack[depth] = 2 * first + 1 - near;
                entries[depth] = box_one.entry.max(box_other.entry);
                depth += 1;
            }
            if box_one.hit || box_other.hit {
                node = near;
                continue;
            }
        }
        for triangle in first..first + count {
            hit = test(positions, indices, hit, ray, triangle, left, with);
        }
        // Back to the last box that may still hold something nearer.
        let mut found = false;
        while depth > 0 && !found {
            depth -= 1;
            node = stack[depth];
            found = entries[depth] <= hit.distance;
        }
        if !found {
            break;
        }
    }
    hit
}

/// The same by a loop over all triangles, the paper's comparator.
pub fn trace_all(
    nodes: &[[Vec4; 2]],
    positions: &[Vec3],
    indices: &[u32],
    origin: Vec3,
    direction: Vec3,
    left: u32,
    with: TriangleFn,
) -> BvhTraceHit {
    let mut hit = crate::start(BVH_TRACE_FAR);
    let ray = crate::ray(origin, direction, lower_of(&nodes[0]), upper_of(&nodes[0]));
    for triangle in 0..(indices.len() / 3) as u32 {
        hit = test(positions, indices, hit, ray, triangle, left, with);
    }
    hit
}

/// Whether a ray met anything.
pub fn met(hit: &BvhTraceHit) -> bool {
    hit.triangle != BVH_TRACE_NONE
}
