//! Mirror of the part `wgsl/recipes/parts/trace_nearest.wgsl`, line by line: the loop over the
//! nodes and the loop over all triangles, on the buffers that its recipes bind.

use crate::{BVH_TRACE_NONE, BvhTraceHit, BvhTraceNode, BvhTraceRay};
use glam::{Vec3, Vec4, Vec4Swizzles as _};

/// Largest number of nodes on the way from the root to a leaf.
pub const BVH_TRACE_LEVELS: usize = 16;
/// Capacity of the stack: three children for each level of nodes.
pub const TRACE_STACK: usize = 3 * BVH_TRACE_LEVELS;
/// A distance farther than any hit.
pub const BVH_TRACE_FAR: f32 = 1e37;
/// The first number of a child that is a leaf.
pub const BVH_TRACE_LEAF: u32 = 0x4000_0000;

/// Test of one triangle: [`crate::triangle`] or [`crate::triangle_naive`].
pub type TriangleFn = fn(BvhTraceHit, BvhTraceRay, Vec3, Vec3, Vec3, u32, u32) -> BvhTraceHit;

fn test(
    corners: &[Vec4],
    hit: BvhTraceHit,
    ray: BvhTraceRay,
    triangle: u32,
    left: u32,
    with: TriangleFn,
) -> BvhTraceHit {
    let [a, b, c] = [0, 1, 2].map(|k| corners[3 * triangle as usize + k].xyz());
    with(hit, ray, a, b, c, triangle, left)
}

/// A child of a node.
#[derive(Clone, Copy)]
struct Child {
    /// Distance at which the ray enters its box; [`BVH_TRACE_FAR`] if the ray does not meet it.
    entry: f32,
    /// As in the node.
    child: u32,
}

fn child(node: BvhTraceNode, place: u32, ray: BvhTraceRay, nearest: f32) -> Child {
    let extent = crate::child_box(node, place);
    let met = crate::r#box(ray, extent.lower, extent.upper, nearest);
    let child = node.children[place as usize];
    Child { entry: if met.hit && child != BVH_TRACE_NONE { met.entry } else { BVH_TRACE_FAR }, child }
}

fn nearer(one: Child, other: Child) -> Child {
    if other.entry < one.entry { other } else { one }
}

fn farther(one: Child, other: Child) -> Child {
    if other.entry < one.entry { one } else { other }
}

/// Puts a child on the stack if the ray meets it, and returns the new height.
fn push(stack: &mut [u32; TRACE_STACK], height: usize, child: Child) -> usize {
    if child.entry < BVH_TRACE_FAR {
        stack[height] = child.child;
        return height + 1;
    }
    height
}

/// Returns the nearest triangle through which the ray leaves the solid, found with the hierarchy.
/// `nodes` and `corners` are those of a [`Bvh`](crate::Bvh). `left` is the triangle just left, or
/// [`BVH_TRACE_NONE`].
pub fn trace(nodes: &[BvhTraceNode], corners: &[Vec4], origin: Vec3, direction: Vec3, left: u32) -> BvhTraceHit {
    trace_with(nodes, corners, origin, direction, left, crate::triangle)
}

/// Does the same as [`trace`] with another triangle test.
pub fn trace_with(
    nodes: &[BvhTraceNode],
    corners: &[Vec4],
    origin: Vec3,
    direction: Vec3,
    left: u32,
    with: TriangleFn,
) -> BvhTraceHit {
    let mut hit = crate::start(BVH_TRACE_FAR);
    let whole = crate::bounds(nodes[0]);
    let ray = crate::ray(origin, direction, whole.lower, whole.upper);
    let mut stack = [0; TRACE_STACK];
    let mut next = 0;
    let mut height = 0;
    let mut found = true;
    while found {
        // Down to a leaf.
        while found && next < BVH_TRACE_LEAF {
            let node = nodes[next as usize];
            let [a, b, c, d] = [0, 1, 2, 3].map(|place| child(node, place, ray, hit.distance));
            // The nearest child first: its hits cull the others, when their boxes are opened.
            let ab = nearer(a, b);
            let cd = nearer(c, d);
            height = push(&mut stack, height, farther(a, b));
            height = push(&mut stack, height, farther(c, d));
            height = push(&mut stack, height, farther(ab, cd));
            let nearest = nearer(ab, cd);
            next = nearest.child;
            found = nearest.entry < BVH_TRACE_FAR;
            if !found && height > 0 {
                height -= 1;
                next = stack[height];
                found = true;
            }
        }
        if found {
            let first = next & (BVH_TRACE_LEAF - 1);
            let end = first + (next >> 30);
            for triangle in first..end {
                hit = test(corners, hit, ray, triangle, left, with);
            }
            found = height > 0;
            if found {
                height -= 1;
                next = stack[height];
            }
        }
    }
    hit
}

/// Returns the same from a loop over all triangles, the paper's comparison.
pub fn trace_all(
    nodes: &[BvhTraceNode],
    corners: &[Vec4],
    origin: Vec3,
    direction: Vec3,
    left: u32,
    with: TriangleFn,
) -> BvhTraceHit {
    let mut hit = crate::start(BVH_TRACE_FAR);
    let whole = crate::bounds(nodes[0]);
    let ray = crate::ray(origin, direction, whole.lower, whole.upper);
    for triangle in 0..(corners.len() / 3) as u32 {
        hit = test(corners, hit, ray, triangle, left, with);
    }
    hit
}

/// Returns whether the ray hit a triangle.
pub fn met(hit: &BvhTraceHit) -> bool {
    hit.triangle != BVH_TRACE_NONE
}
