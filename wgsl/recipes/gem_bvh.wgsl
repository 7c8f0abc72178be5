// gem_bvh: a stone of any closed shape by its exact triangles, found through a bounding volume hierarchy.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: the loop over nodes with a stack, as in Aila and Laine, "Understanding the Efficiency of Ray Traversal on GPUs", HPG 2009;
//   the loop over all triangles: Imagire, "Proxy Geometry Gem Rendering", section 5.
// requires: absorption, bvh_trace, dispersion, environment, fresnel, proxy_geometry, refraction
// parts: gem_shading
//
// Draw as the recipe `gem`, with the index buffer in the order of the leaves, and bind the nodes besides.

// Light through the stone; off, only its surface reflects. Called for by KHR_materials_transmission.
override EFFECT_BVH_TRACE: bool = true;
// A loop over all triangles instead of the hierarchy: the paper's comparison.
override TRAVERSAL_LOOP: bool = false;

// The largest number of nodes between the root and a leaf. Whoever builds the hierarchy keeps to it.
const GEM_DEPTH = 32u;
// Farther than anything that a ray may meet.
const GEM_FAR = 1e37f;

// The root first; the two children of a node side by side.
@group(2) @binding(0) var<storage, read> nodes: array<BvhTraceNode>;

struct GemVertex {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) @interpolate(flat, either) face_normal: vec3f,
    @location(2) @interpolate(flat, either) triangle: u32,
}

fn gem_face_normal(triangle: u32) -> vec3f {
    return proxy_geometry_face_normal(
        gem_position(indices[3u * triangle]),
        gem_position(indices[3u * triangle + 1u]),
        gem_position(indices[3u * triangle + 2u]),
    );
}

@vertex
fn gem_vertex(@builtin(vertex_index) vertex: u32) -> GemVertex {
    let position = gem_position(indices[vertex]);
    let triangle = vertex / 3u;
    return GemVertex(view.clip_from_world * vec4f(position, 1.0f), position, gem_face_normal(triangle), triangle);
}

// One triangle, by its number.
fn gem_triangle(hit: BvhTraceHit, ray: BvhTraceRay, triangle: u32, left: u32) -> BvhTraceHit {
    let a = gem_position(indices[3u * triangle]);
    let b = gem_position(indices[3u * triangle + 1u]);
    let c = gem_position(indices[3u * triangle + 2u]);
    return bvh_trace_triangle(hit, ray, a, b, c, triangle, left);
}

// The nearest triangle that a ray leaves the solid through.
fn gem_nearest(origin: vec3f, direction: vec3f, left: u32) -> BvhTraceHit {
    var hit = bvh_trace_start(GEM_FAR);
    let ray = bvh_trace_ray(origin, direction, nodes[0].lower, nodes[0].upper);
    if (TRAVERSAL_LOOP) {
        for (var triangle = 0u; triangle < arrayLength(&indices) / 3u; triangle++) {
            hit = gem_triangle(hit, ray, triangle, left);
        }
        return hit;
    }
    // The farther children, and where the ray enters them.
    var stack: array<u32, GEM_DEPTH>;
    var entries: array<f32, GEM_DEPTH>;
    var depth = 0u;
    var node = 0u;
    loop {
        let first = nodes[node].first;
        let count = nodes[node].count;
        if (count == 0u) {
            let box_one = bvh_trace_box(ray, nodes[first].lower, nodes[first].upper, hit.distance);
            let box_other = bvh_trace_box(ray, nodes[first + 1u].lower, nodes[first + 1u].upper, hit.distance);
            // The nearer child first: what it finds culls the farther.
            let other_first = box_other.hit && (!box_one.hit || box_other.entry < box_one.entry);
            let near = select(first, first + 1u, other_first);
            if (box_one.hit && box_other.hit) {
                stack[depth] = 2u * first + 1u - near;
                entries[depth] = max(box_one.entry, box_other.entry);
                depth++;
            }
            if (box_one.hit || box_other.hit) {
                node = near;
                continue;
            }
        }
        for (var triangle = first; triangle < first + count; triangle++) {
            hit = gem_triangle(hit, ray, triangle, left);
        }
        // Back to the last box that may still hold something nearer.
        var found = false;
        while (depth > 0u && !found) {
            depth--;
            node = stack[depth];
            found = entries[depth] <= hit.distance;
        }
        if (!found) {
            break;
        }
    }
    return hit;
}

// A ray inside: the triangle that it left last, which it cannot meet again at once.
struct GemPlace {
    triangle: u32,
}

fn gem_enter(input: GemVertex) -> GemPlace {
    return GemPlace(input.triangle);
}

fn gem_hit(place: ptr<function, GemPlace>, position: vec3f, direction: vec3f) -> GemHit {
    let nearest = gem_nearest(position, direction, (*place).triangle);
    if (nearest.triangle == BVH_TRACE_NONE) {
        return GemHit(position, -direction, 0.0f, false);
    }
    (*place).triangle = nearest.triangle;
    let normal = gem_face_normal(nearest.triangle);
    return GemHit(position + nearest.distance * direction, -normal, nearest.distance, true);
}

@fragment
fn gem_fragment(input: GemVertex) -> @location(0) vec4f {
    let radiance = gem_radiance(input, EFFECT_BVH_TRACE);
    return vec4f(radiance.surface + radiance.inside, 1.0f);
}

// For a deferred renderer, in place of gem_fragment; gem_composite shows how its lighting pass uses it.
@fragment
fn gem_deferred_fragment(input: GemVertex) -> GemGeometryBuffer {
    return gem_geometry_buffer(input, EFFECT_BVH_TRACE);
}
