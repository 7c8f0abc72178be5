//! Mirror of the part `wgsl/recipes/parts/trace_nearest.wgsl`, line by line: the loop over the
//! nodes and the loop over all triangles, on the buffers that its recipes bind.

use crate::{BVH_TRACE_NONE, BvhTraceHit, BvhTraceRay};
use glam::{Vec3, Vec4};

/// Largest number of nodes between the root and a leaf, the capacity of the stack.
pub const BVH_TRACE_DEPTH: usize = 32;
/// A distance farther than any hit.
pub const BVH_TRACE_FAR: f32 = 1e37;

/// Returns the lower corner of a node's box.
fn lower_of(node: &[Vec4; 2]) -> Vec3 {
    node[0].truncate()
}

fn upper_of(node: &[Vec4; 2]) -> Vec3 {
    node[1].truncate()
}

/// Returns the number of triangles of a leaf; 0 for an inner node.
fn count_of(node: &[Vec4; 2]) -> u32 {
    node[0].w.to_bits()
}

/// Returns the first triangle of a leaf, or the first child of an inner node.
fn first_of(node: &[Vec4; 2]) -> u32 {
    node[1].w.to_bits()
}

/// Test of one triangle: [`crate::triangle`] or [`crate::triangle_naive`].
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

/// Returns the nearest triangle through which the ray leaves the solid, found with the hierarchy.
/// `nodes` are pairs of (lower corner, count as bits) and (upper corner, first as bits). `indices`
/// are in the order of the leaves. `left` is the triangle just left, or [`BVH_TRACE_NONE`].
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

/// Does the same as [`trace`] with another triangle test.
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
    let mut first = first_of(&nodes[0]);
    let mut count = count_of(&nodes[0]);
    let mut found = true;
    while found {
        // Down to a leaf.
        while found && count == 0 {
            let (one, other) = (&nodes[first as usize], &nodes[first as usize + 1]);
            let box_one = crate::r#box(ray, lower_of(one), upper_of(one), hit.distance);
            let box_other = crate::r#box(ray, lower_of(other), upper_of(other), hit.distance);
            // The nearer child first: its hits cull the farther child.
            let other_first = box_other.hit && (!box_one.hit || box_other.entry < box_one.entry);
            let mut node = if other_first { first + 1 } else { first };
            if box_one.hit && box_other.hit {
                stack[depth] = 2 * first + 1 - node;
                entries[depth] = box_one.entry.max(box_other.entry);
                depth += 1;
            }
            // Back to the last box that may still hold a nearer hit.
            found = box_one.hit || box_other.hit;
            while depth > 0 && !found {
                depth -= 1;
                node = stack[depth];
                found = entries[depth] <= hit.distance;
            }
            first = first_of(&nodes[node as usize]);
            count = count_of(&nodes[node as usize]);
        }
        if found {
            for triangle in first..first + count {
                hit = test(positions, indices, hit, ray, triangle, left, with);
            }
            let mut node = 0;
            found = false;
            while depth > 0 && !found {
                depth -= 1;
                node = stack[depth];
                found = entries[depth] <= hit.distance;
            }
            first = first_of(&nodes[node as usize]);
            count = count_of(&nodes[node as usize]);
        }
    }
    hit
}

/// Returns the same from a loop over all triangles, the paper's comparison.
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

/// Returns whether the ray hit a triangle.
pub fn met(hit: &BvhTraceHit) -> bool {
    hit.triangle != BVH_TRACE_NONE
}
