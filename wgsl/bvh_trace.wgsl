// bvh_trace: rays inside a closed mesh of any shape, against triangles and the boxes of a bounding volume hierarchy, without leaks.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0, hash 7e89a06b7dbe6d6c
// Source: Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013 (axis permutation, shear,
//   edge functions); Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013 (conservative boxes). The naive triangle: Möller
//   and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997. Compared with: Imagire, "Proxy Geometry Gem
//   Rendering", Fig. 7.
//
// Woop, Benthin and Wald find the same sign for an edge from both of its sides by giving both the very same roundings,
// and repeat an edge function that comes out as 0 in f64. WGSL promises neither: a compiler may fuse a product and a
// sum on one side only, and there is no f64. Here every comparison gives way by a margin that is larger than what WGSL
// lets the rounding be. A triangle that a ray meets in exact arithmetic is not refused, unless it is edge-on to
// rounding, and then its neighbours count; along an edge, and within the margin beside it, both of its triangles count,
// and the nearer one is kept.
//
// Only triangles that the ray leaves the solid through count: counter-clockwise seen from outside, normal . direction >
// 0. From inside there is no other to meet. For those that a ray enters through, from outside, pass b and c exchanged.

// The margin relative to the largest distance of the mesh along an axis, 2^-18, and to the largest coordinate of the
// origin, 2^-21. With e = 2^-23, WGSL's relative error of + - *: a sheared coordinate is off by 7.5 e (offset, depth
// and difference 2 e + 2 e, division 2.5 e, product e), an edge function over its edge by 6 e more, a box's planes by 9
// e; an origin on the surface, as a position that was computed, by 5 e. The worst sum, 7.5 + 6 + 1.7 * 5 = 22 e, is
// under the 32 e of the first. The second is that of the origin's last place, e / 2 to e, in coordinates that may be
// 1.7 times as large.
const BVH_TRACE_MARGIN_REACH = 3.814697265625e-6f;
const BVH_TRACE_MARGIN_ORIGIN = 4.76837158203125e-7f;

// The triangle of a ray that has met none.
const BVH_TRACE_NONE = 0xffffffffu;

// A node as it lies in a storage buffer, 32 bytes.
struct BvhTraceNode {
    lower: vec3f,
    // How many triangles a leaf holds; 0 for an inner node.
    count: u32,
    upper: vec3f,
    // A leaf's first triangle; an inner node's first child, the second follows it.
    first: u32,
}

struct BvhTraceRay {
    origin: vec3f,
    // Unit direction.
    direction: vec3f,
    // 1 / direction, at most 2^24.
    reciprocal: vec3f,
    // With the direction's components turned so that the largest is z: (x / z, y / z, 1 / z).
    shear: vec3f,
    // Which component that is.
    axis: u32,
    // By how far along an axis the ray may be off, the origin's own rounding included.
    margin: f32,
}

// A ray in the coordinates of a body.
struct BvhTraceObjectRay {
    origin: vec3f,
    // Unit direction.
    direction: vec3f,
    // A distance along the ray in the body's coordinates over the same in the world's.
    stretch: f32,
}

struct BvhTraceBox {
    // Distance at which the ray enters the box; 0 from inside.
    entry: f32,
    // Whether it meets the box before the nearest hit.
    hit: bool,
}

struct BvhTraceHit {
    // Along the ray.
    distance: f32,
    // Weights of the second and the third corner.
    barycentrics: vec2f,
    // BVH_TRACE_NONE if there is none.
    triangle: u32,
}

// A vector's components in a cyclic order that brings the one numbered `axis` to z. Being cyclic, it keeps the
// handedness.
// Returns: (vector[axis + 1], vector[axis + 2], vector[axis]), indices modulo 3.
// Units: those of `vector`.
// Domain: axis 0, 1 or 2.
// Outside: 3 and more count as 2.
// Accuracy: lavapipe 0 ulp; portable 0 ulp
fn bvh_trace_turn(vector: vec3f, axis: u32) -> vec3f {
    let x_or_y = select(vector.zxy, vector.yzx, axis == 0u);
    return select(vector, x_or_y, axis < 2u);
}

// A ray of the world in the coordinates of a body. The difference from the body's place comes first: near the body it is exact, while a
// matrix that holds the place as well would leave of the origin what it is rounded to there.
// Returns: BvhTraceObjectRay; `direction` is a unit vector.
// Units: lengths; the rows are those of the matrix that turns and scales differences of the world into the body's, the inverse of its own.
// Domain: |direction| = 1, rows of a matrix that can be inverted, with components up to 1e6 and the turned direction at least 1e-6
//   long; positions up to 1e12.
// Outside: finite while the direction is not turned into 0.
// Accuracy: lavapipe origin 1 ulp + 5 backward, direction 5 ulp + 5 backward, stretch 5 ulp + 5 backward; portable origin 1 ulp + 10 backward, direction 22 ulp + 10 backward, stretch 20 ulp + 10 backward; order kept
fn bvh_trace_to_object(origin: vec3f, direction: vec3f, place: vec3f, row_x: vec3f, row_y: vec3f, row_z: vec3f) -> BvhTraceObjectRay {
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

// What the tests of all boxes and triangles need of a ray, computed once.
// Returns: BvhTraceRay.
// Units: those of the positions; `margin` is a length.
// Domain: |direction| = 1; lower <= upper, the box of the whole mesh; coordinates up to 1e12, the box at least 1e-10
//   large. Trace in object space: where the mesh lies at D times its size from the origin of its coordinates, D 2^-21 of
//   it is margin. bvh_trace_to_object brings a ray of the world there.
// Outside: finite for |direction| in [1e-6, 1e6] and coordinates up to 1e30; a zero direction divides by 0.
// Accuracy: lavapipe origin 0 ulp, direction 0 ulp, reciprocal 1 ulp, shear 1 ulp, axis 0 ulp, margin 3 ulp; portable origin 0 ulp, direction 0 ulp, reciprocal 2.5 ulp, shear 2.5 ulp, axis 0 ulp, margin 5 ulp
fn bvh_trace_ray(origin: vec3f, direction: vec3f, lower: vec3f, upper: vec3f) -> BvhTraceRay {
    let toward = select(vec3f(-1.0f), vec3f(1.0f), direction >= vec3f(0.0f));
    let size = abs(direction);
    // A component below 2^-24 is replaced by that. Its reciprocal is finite, and the ray moves by less than 2^-23 of
    // the mesh while it crosses the mesh, which the margin holds.
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

// Whether a ray meets a box, made larger by the ray's margin on all sides, at a distance in [0, nearest]: the box of a
// triangle that the ray hits before `nearest` is never missed, though its planes be met in any rounding, or the box be
// flat.
// Returns: BvhTraceBox; without a hit, `entry` is the distance of the last plane that the ray enters by, or 0.
// Units: those of the positions.
// Domain: lower <= upper inside the box that the ray was made for; nearest in [0, 1e37].
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

// What a ray has met before its first triangle: nothing up to a distance.
// Returns: BvhTraceHit with BVH_TRACE_NONE.
// Units: those of the positions.
// Domain: limit in [0, 1e37].
// Outside: negative: nothing will be met.
// Accuracy: lavapipe distance 0 ulp, barycentrics 0 ulp, triangle 0 ulp; portable distance 0 ulp, barycentrics 0 ulp, triangle 0 ulp
fn bvh_trace_start(limit: f32) -> BvhTraceHit {
    return BvhTraceHit(limit, vec2f(0.0f), BVH_TRACE_NONE);
}

// A position in the frame of a ray: the ray is its z axis, x and y are two of the coordinate axes, and all three may be
// aslant.
// Returns: (x, y, distance along the ray); position = origin + x e(axis + 1) + y e(axis + 2) + distance direction.
// Units: those of the positions.
// Domain: rays of bvh_trace_ray; coordinates up to 1e12.
// Outside: finite for coordinates up to 1e30.
// Accuracy: lavapipe 2 ulp + 1.5 backward; portable 4 ulp + 3 backward
fn bvh_trace_shear(ray: BvhTraceRay, position: vec3f) -> vec3f {
    let turned = bvh_trace_turn(position - ray.origin, ray.axis);
    return vec3f(turned.xy - ray.shear.xy * turned.z, turned.z * ray.shear.z);
}

// The nearer of a hit and of the triangle a b c, if the ray leaves the solid through that. In the frame of the ray the
// triangle is flat, and counts if the origin lies inside it: if no edge passes it on the wrong side by more than the
// margin. Sharp corners end at the margin as well. Its plane may lie behind the origin by as much as the margin: an
// origin that was computed on one facet can lie outside of the next. Edges are taken as differences, so that the error
// of an edge function is relative to its edge, as the margin is.
// Returns: BvhTraceHit: distance >= 0, and weights in [0, 1]: those of a point of the triangle, though the ray passes
//   beside it, and beside a corner by rounding those of the corner. At equal distances the lower number wins, so that
//   the order of the triangles does not matter.
// Units: those of the positions.
// Domain: a, b, c counter-clockwise from outside, inside the box that the ray was made for; coordinates up to 1e12,
//   edges 0 or at least 1e-10 and 1/1000 of the coordinates; in the frame of the ray at least 1/32 as thick as long.
// Outside: `triangle` equal to `left`, the one just left, never counts. A triangle without area in the frame of the ray
//   need not: its neighbours, of which it is an edge there, do. Of thin ones none is refused that the ray meets, but
//   the point in it is less sure.
// Accuracy: lavapipe distance 4 ulp + 6 backward, barycentrics 4 ulp + 0.0001 abs + 6 backward, triangle 6 backward; portable distance 12 ulp + 17 backward, barycentrics 8 ulp + 0.0002 abs + 17 backward, triangle 17 backward
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
    // Twice the areas that the origin spans with the edges opposite to a, b, c, from the nearer end of each: the area's
    // error is that end's distance times the edge. Seen against the ray where its largest component is negative.
    let squared = vec3f(dot(p.xy, p.xy), dot(q.xy, q.xy), dot(r.xy, r.xy));
    let on_qr = select(q.xy, r.xy, squared.z < squared.y);
    let on_rp = select(r.xy, p.xy, squared.x < squared.z);
    let on_pq = select(p.xy, q.xy, squared.y < squared.x);
    let spanned = vec3f(on_qr.x * qr.y - on_qr.y * qr.x, on_rp.x * rp.y - on_rp.y * rp.x, on_pq.x * pq.y - on_pq.y * pq.x);
    let area = sign(ray.shear.z) * spanned;
    if (triangle == left || area.x + area.y + area.z <= 0.0f) {
        return hit;
    }
    // Distance from an edge times the edge, both measured along the axes: the largest and the sum of the components.
    let give = ray.margin * vec3f(abs(qr.x) + abs(qr.y), abs(rp.x) + abs(rp.y), abs(pq.x) + abs(pq.y));
    let lower = min(min(p.xy, q.xy), r.xy);
    let upper = max(max(p.xy, q.xy), r.xy);
    if (any(area < -give) || any(lower > vec2f(ray.margin)) || any(upper < vec2f(-ray.margin))) {
        return hit;
    }
    let weight = max(area, vec3f(0.0f));
    let total = weight.x + weight.y + weight.z;
    // Distance from the plane times its normal, measured like that from an edge. Divided by `total` it is the distance
    // along the ray, by which a plane close to the origin, met at a shallow angle, may lie far behind.
    let height = weight.x * p.z + weight.y * q.z + weight.z * r.z;
    let normal = abs(cross(qr, rp));
    let distance = max(height / total, 0.0f);
    if (height < -ray.margin * (normal.x + normal.y + normal.z) || distance > hit.distance
        || (distance == hit.distance && triangle > hit.triangle)) {
        return hit;
    }
    return BvhTraceHit(distance, weight.yz / total, triangle);
}
