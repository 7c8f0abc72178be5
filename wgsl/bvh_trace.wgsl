// bvh_trace: rays inside a closed mesh of any shape, through a bounding volume hierarchy to triangles, without leaks.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0
// Source: Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013 (axis
//   permutation, shear, edge functions); Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013
//   (conservative boxes). The naive triangle: Möller and Trumbore, "Fast, Minimum Storage
//   Ray/Triangle Intersection", 1997. Compared with: Imagire, "Proxy Geometry Gem Rendering",
//   Fig. 7.
//
// Woop, Benthin and Wald get the same sign for an edge from both of its triangles, because both
// compute it with identical rounding; an edge function of 0 is computed again in f64. WGSL
// guarantees neither: a compiler may fuse a product and a sum on one side of the edge only, and
// there is no f64. Here every comparison is relaxed by a margin larger than any rounding error that
// WGSL allows. A triangle that a ray meets in exact arithmetic is not rejected, unless it is so
// nearly edge-on that its area drowns in rounding; in that case its neighbours count. On an edge,
// and within the margin beside it, both of its triangles count, and the nearer hit is kept.
//
// Only triangles through which the ray leaves the solid count: counter-clockwise seen from outside,
// normal . direction > 0. From inside, there are no others to meet. To find the triangles through
// which a ray enters from outside, pass b and c exchanged.

// The two factors of the margin: 2^-18 of the mesh's largest distance from the origin along an
// axis, and 2^-21 of the origin's largest coordinate. With e = 2^-23, the relative error of + - *
// in WGSL: a sheared coordinate is off by 7.5 e (offset, depth and difference 2 e + 2 e, division
// 2.5 e, product e). An edge function divided by its edge is off by another 6 e, the planes of a box
// by 9 e. An origin on the surface is a computed position and off by 5 e. The worst sum,
// 7.5 + 6 + 1.7 * 5 = 22 e, is below the 32 e of the first factor. The second factor covers the
// last place of the origin, e / 2 to e, in coordinates that may be 1.7 times as large.
const BVH_TRACE_MARGIN_REACH = 3.814697265625e-6f;
const BVH_TRACE_MARGIN_ORIGIN = 4.76837158203125e-7f;

// Triangle index that stands for "no hit".
const BVH_TRACE_NONE = 0xffffffffu;

// A node in the layout of a storage buffer: 64 bytes for up to four children. The boxes of the
// children are given in steps from a corner of the node, rounded outwards.
struct BvhTraceNode {
    // The corner from which the steps are counted.
    corner: vec3f,
    // Three bytes, from the lowest: the exponents of the steps along x, y and z, as in the bits of
    // an f32. A step is a power of two.
    steps: u32,
    // Lower sides of the boxes along x, y and z: a byte for each child, from the lowest.
    lower: vec3u,
    // Upper sides, likewise.
    upper: vec3u,
    // What each child is: the number of a node, below 2^30; or a leaf, its number of triangles, 1 to
    // 3, in the two highest bits and its first triangle in the others; or BVH_TRACE_NONE.
    children: vec4u,
}

// The box of a child.
struct BvhTraceExtent {
    lower: vec3f,
    upper: vec3f,
}

struct BvhTraceRay {
    origin: vec3f,
    // Unit direction.
    direction: vec3f,
    // 1 / direction by component, at most 2^24 in magnitude.
    reciprocal: vec3f,
    // (x / z, y / z, 1 / z) of the direction, its components permuted so that the largest is z.
    shear: vec3f,
    // Index of the direction's largest component.
    axis: u32,
    // Bound on the error of the ray along an axis, as a length, including the rounding of the
    // origin.
    margin: f32,
}

// A ray in the coordinates of a body (object space).
struct BvhTraceObjectRay {
    origin: vec3f,
    // Unit direction.
    direction: vec3f,
    // Distance along the ray in the body's coordinates, divided by the same distance in the world.
    stretch: f32,
}

struct BvhTraceBox {
    // Distance at which the ray enters the box; 0 if it starts inside.
    entry: f32,
    // True if the ray meets the box before the nearest hit.
    hit: bool,
}

struct BvhTraceHit {
    // Distance along the ray.
    distance: f32,
    // Weights of the second and the third corner, in [0, 1].
    barycentrics: vec2f,
    // Index of the triangle; BVH_TRACE_NONE for no hit.
    triangle: u32,
}

// Permutes the components of a vector cyclically so that component `axis` becomes z. A cyclic
// permutation keeps the handedness.
// Returns: (vector[axis + 1], vector[axis + 2], vector[axis]), indices modulo 3.
// Units: those of `vector`.
// Domain: axis 0, 1 or 2.
// Outside: 3 and more count as 2.
// Accuracy: lavapipe 0 ulp; portable 0 ulp
fn bvh_trace_turn(vector: vec3f, axis: u32) -> vec3f {
    let x_or_y = select(vector.zxy, vector.yzx, axis == 0u);
    return select(vector, x_or_y, axis < 2u);
}

// Transforms a ray from world space to the coordinates of a body. The body's position is subtracted first: a
// matrix that includes the translation would round the origin as world coordinates are rounded.
// Returns: BvhTraceObjectRay; `direction` is a unit vector.
// Units: lengths; the rows rotate and scale differences of world positions: the inverse of the body's own matrix.
// Domain: |direction| = 1; rows of an invertible matrix, with components up to 1e6; the transformed direction at
//   least 1e-6 long; positions up to 1e12.
// Outside: finite while the direction is not turned into 0.
// Accuracy: lavapipe origin 1 ulp + 5 backward, direction 5 ulp + 5 backward, stretch 5 ulp + 5 backward;
//   portable origin 1 ulp + 10 backward, direction 22 ulp + 10 backward, stretch 20 ulp + 10 backward
fn bvh_trace_to_object(
    origin: vec3f, direction: vec3f, place: vec3f, row_x: vec3f, row_y: vec3f, row_z: vec3f
) -> BvhTraceObjectRay {
    let offset = origin - place;
    let turned = vec3f(dot(row_x, direction), dot(row_y, direction), dot(row_z, direction));
    let size = max(abs(turned.x), max(abs(turned.y), abs(turned.z)));
    let scaled = turned / size;
    let length_of_scaled = sqrt(dot(scaled, scaled));
    return BvhTraceObjectRay(
        vec3f(dot(row_x, offset), dot(row_y, offset), dot(row_z, offset)),
        scaled / length_of_scaled,
        size * length_of_scaled,
    );
}

// The ray data shared by all box and triangle tests, computed once per ray.
// Returns: BvhTraceRay.
// Units: those of the positions; `margin` is a length.
// Domain: |direction| = 1; lower <= upper, the bounding box of the whole mesh; coordinates up to 1e12, the
//   box at least 1e-10 large. Trace in object space (bvh_trace_to_object): if the mesh lies at D times its
//   size from the origin of its coordinates, the margin grows by D 2^-21 of the mesh's size.
// Outside: finite for |direction| in [1e-6, 1e6] and coordinates up to 1e30; a zero direction divides by 0.
// Accuracy: lavapipe origin 0 ulp, direction 0 ulp, reciprocal 1 ulp, shear 1 ulp, axis 0 ulp, margin 3 ulp;
//   portable origin 0 ulp, direction 0 ulp, reciprocal 2.5 ulp, shear 2.5 ulp, axis 0 ulp, margin 5 ulp
fn bvh_trace_ray(origin: vec3f, direction: vec3f, lower: vec3f, upper: vec3f) -> BvhTraceRay {
    let toward = select(vec3f(-1.0f), vec3f(1.0f), direction >= vec3f(0.0f));
    let size = abs(direction);
    // A component below 2^-24 is replaced by that value, so its reciprocal is finite. The ray then
    // strays by less than 2^-23 of the mesh while crossing it, which the margin covers.
    let reciprocal = toward / max(size, vec3f(5.9604644775390625e-8f));
    let largest = max(size.x, max(size.y, size.z));
    let axis = select(select(0u, 1u, size.y == largest), 2u, size.z == largest);
    let turned = bvh_trace_turn(direction, axis);
    let shear = vec3f(turned.xy, 1.0f) / turned.z;
    let reach = max(abs(lower - origin), abs(upper - origin));
    let place = abs(origin);
    let margin = BVH_TRACE_MARGIN_REACH * max(reach.x, max(reach.y, reach.z))
        + BVH_TRACE_MARGIN_ORIGIN * max(place.x, max(place.y, place.z));
    return BvhTraceRay(origin, direction, reciprocal, shear, axis, margin);
}

// The box of a child of a node.
// Returns: BvhTraceExtent; for a place without a child, the node's corner twice.
// Units: those of the positions.
// Domain: child 0 to 3; coordinates up to 1e12; exponents of 1 to 167, steps of 2^-126 to 2^40.
// Outside: a child of 4 and more counts as its remainder by 4; finite for exponents up to 240 and
//   coordinates up to 1e30.
// Accuracy: lavapipe lower 1 ulp, upper 1 ulp; portable lower 1 ulp, upper 1 ulp
fn bvh_trace_child_box(node: BvhTraceNode, child: u32) -> BvhTraceExtent {
    let exponents = (vec3u(node.steps) >> vec3u(0u, 8u, 16u)) & vec3u(255u);
    let step = bitcast<vec3f>(exponents << vec3u(23u));
    let place = vec3u(8u * (child & 3u));
    // A product with a power of two is exact, so only the sum rounds.
    let lower = node.corner + vec3f((node.lower >> place) & vec3u(255u)) * step;
    let upper = node.corner + vec3f((node.upper >> place) & vec3u(255u)) * step;
    return BvhTraceExtent(lower, upper);
}

// The box around all children of a node; around the whole mesh if the node is the root.
// Returns: BvhTraceExtent.
// Units: those of the positions.
// Domain: coordinates up to 1e12; exponents of 1 to 167, steps of 2^-126 to 2^40.
// Outside: finite for exponents up to 240 and coordinates up to 1e30.
// Accuracy: lavapipe lower 1 ulp, upper 1 ulp; portable lower 1 ulp, upper 1 ulp
fn bvh_trace_bounds(node: BvhTraceNode) -> BvhTraceExtent {
    let a = bvh_trace_child_box(node, 0u);
    let b = bvh_trace_child_box(node, 1u);
    let c = bvh_trace_child_box(node, 2u);
    let d = bvh_trace_child_box(node, 3u);
    return BvhTraceExtent(
        min(min(a.lower, b.lower), min(c.lower, d.lower)),
        max(max(a.upper, b.upper), max(c.upper, d.upper)),
    );
}

// Whether a ray meets a box, enlarged by the ray's margin on all sides, at a distance in [0, nearest]. The
// box of a triangle that the ray hits before `nearest` is never missed, however the distances of its planes
// are rounded, and even if the box is flat.
// Returns: BvhTraceBox; without a hit, `entry` is the distance of the last of the planes through which the
//   ray enters, or 0.
// Units: those of the positions.
// Domain: lower <= upper, within the box that the ray was made for; nearest in [0, 1e37].
// Outside: finite for coordinates up to 1e30; where lower > upper, the box between them less the margin.
// Accuracy: lavapipe entry 2 ulp + 2 backward, hit 2 backward; portable entry 4 ulp + 3 backward, hit 3 backward
fn bvh_trace_box(ray: BvhTraceRay, lower: vec3f, upper: vec3f, nearest: f32) -> BvhTraceBox {
    let first = (lower - ray.origin - ray.margin) * ray.reciprocal;
    let second = (upper - ray.origin + ray.margin) * ray.reciprocal;
    let enter = min(first, second);
    let leave = max(first, second);
    let entry = max(max(enter.x, enter.y), max(enter.z, 0.0f));
    let exit = min(min(leave.x, leave.y), min(leave.z, nearest));
    return BvhTraceBox(entry, entry <= exit);
}

// Initial hit record of a ray, before its first triangle: no hit up to the distance `limit`.
// Returns: BvhTraceHit with BVH_TRACE_NONE.
// Units: those of the positions.
// Domain: limit in [0, 1e37].
// Outside: negative: nothing will be met.
// Accuracy: lavapipe distance 0 ulp, barycentrics 0 ulp, triangle 0 ulp;
//   portable distance 0 ulp, barycentrics 0 ulp, triangle 0 ulp
fn bvh_trace_start(limit: f32) -> BvhTraceHit {
    return BvhTraceHit(limit, vec2f(0.0f), BVH_TRACE_NONE);
}

// A position in the frame of a ray: the ray is the z axis, and x and y are two of the coordinate
// axes. The frame may be oblique.
// Returns: (x, y, distance along the ray);
//   position = origin + x e(axis + 1) + y e(axis + 2) + distance direction.
// Units: those of the positions.
// Domain: rays from bvh_trace_ray; coordinates up to 1e12.
// Outside: finite for coordinates up to 1e30.
// Accuracy: lavapipe 2 ulp + 1.5 backward; portable 4 ulp + 3 backward
fn bvh_trace_shear(ray: BvhTraceRay, position: vec3f) -> vec3f {
    let turned = bvh_trace_turn(position - ray.origin, ray.axis);
    return vec3f(turned.xy - ray.shear.xy * turned.z, turned.z * ray.shear.z);
}

// The nearer of `hit` and a hit with the triangle a b c, if the ray leaves the solid through it: docs/bvh_trace.md.
// Returns: BvhTraceHit: distance >= 0, weights in [0, 1] of a point in it; at equal distances the lower index.
// Units: those of the positions.
// Domain: a, b, c counter-clockwise from outside, within the ray's box; coordinates up to 1e12; edges 0, or at least
//   1e-10 and 1/1000 of the coordinates; in the ray's frame, a triangle at least 1/32 as thick as long.
// Outside: `triangle` equal to `left`, the one just left, never counts. A triangle without area in the ray's frame need
//   not: its neighbours at that edge do. Of thin ones none that the ray meets is refused, but its point is less sure.
// Accuracy: lavapipe distance 4 ulp + 6 backward, barycentrics 4 ulp + 0.0001 abs + 6 backward, triangle 6 backward;
//   portable distance 12 ulp + 17 backward, barycentrics 8 ulp + 0.0002 abs + 17 backward, triangle 17 backward
fn bvh_trace_triangle(
    hit: BvhTraceHit,
    ray: BvhTraceRay,
    a: vec3f,
    b: vec3f,
    c: vec3f,
    triangle: u32,
    left: u32,
) -> BvhTraceHit {
    let p = bvh_trace_shear(ray, a);
    let q = bvh_trace_shear(ray, b);
    let r = bvh_trace_shear(ray, c);
    let qr = r - q;
    let rp = p - r;
    let pq = q - p;
    // Twice the areas spanned by the origin and the edges opposite a, b, c. Each is computed from the
    // nearer end of its edge: the error of an area is the distance of that end times the edge. If the
    // direction's largest component is negative, the frame is seen against the ray, and the sign changes.
    let squared = vec3f(dot(p.xy, p.xy), dot(q.xy, q.xy), dot(r.xy, r.xy));
    let on_qr = select(q.xy, r.xy, squared.z < squared.y);
    let on_rp = select(r.xy, p.xy, squared.x < squared.z);
    let on_pq = select(p.xy, q.xy, squared.y < squared.x);
    let spanned = vec3f(
        on_qr.x * qr.y - on_qr.y * qr.x,
        on_rp.x * rp.y - on_rp.y * rp.x,
        on_pq.x * pq.y - on_pq.y * pq.x
    );
    let area = sign(ray.shear.z) * spanned;
    if (triangle == left || area.x + area.y + area.z <= 0.0f) {
        return hit;
    }
    // Distance from an edge times the length of the edge, both measured along the axes: the
    // distance as the largest component, the length as the sum of the components.
    let give = ray.margin * vec3f(abs(qr.x) + abs(qr.y), abs(rp.x) + abs(rp.y), abs(pq.x) + abs(pq.y));
    let lower = min(min(p.xy, q.xy), r.xy);
    let upper = max(max(p.xy, q.xy), r.xy);
    if (any(area < -give) || any(lower > vec2f(ray.margin)) || any(upper < vec2f(-ray.margin))) {
        return hit;
    }
    let weight = max(area, vec3f(0.0f));
    let total = weight.x + weight.y + weight.z;
    // Distance from the plane times its normal, measured in the same way as the distance from an
    // edge. Divided by `total` it is the distance along the ray, but measured that way a plane
    // close to the origin may be far behind it, if the ray meets it at a shallow angle.
    let height = weight.x * p.z + weight.y * q.z + weight.z * r.z;
    let normal = abs(cross(qr, rp));
    let distance = max(height / total, 0.0f);
    if (height < -ray.margin * (normal.x + normal.y + normal.z) || distance > hit.distance
        || (distance == hit.distance && triangle > hit.triangle)) {
        return hit;
    }
    return BvhTraceHit(distance, weight.yz / total, triangle);
}
