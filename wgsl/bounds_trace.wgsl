// bounds_trace: where a ray meets the bounds of another body, a box or an ellipsoid of any size, place and turn.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0
// Source: Kay and Kajiya, "Ray Tracing Complex Scenes", SIGGRAPH 1986 (slabs); Haines, Günther and
//   Akenine-Möller, "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems, 2019,
//   chapter 7.
//
// The bounds of a body are the box [-1, 1]^3 or the unit ball around the origin, in a space of their
// own. The body's matrix maps the world to that space, and a ray with it:
//
//   let position = (bounds_from_world * vec4f(world_position, 1.0f)).xyz;
//   let direction = (bounds_from_world * vec4f(world_direction, 0.0f)).xyz;
//   let distance = bounds_trace_cuboid(position, direction);
//
// The direction keeps the length that the matrix gives it. Distances are in units of that length, so
// they are the same in the world, and the nearest of several bodies is the one at the smallest
// distance above 0. The normal there, of the box or of the ball, goes back by the transpose:
//
//   let point = position + distance * direction;
//   let normal = bounds_trace_cuboid_normal(point);   // of the ball: point
//   let world_normal = normalize((vec4f(normal, 0.0f) * bounds_from_world).xyz);

// Distance of a ray that meets nothing.
const BOUNDS_TRACE_NONE: f32 = -1.0f;
// Slope below which a ray is parallel to a side of the box.
const BOUNDS_TRACE_PARALLEL: f32 = 1e-20f;

// Distance at which a ray from outside enters the box [-1, 1]^3: where it lies between both planes of all three pairs.
// A ray parallel to a pair counts as one that runs inwards, at a slope so small that it arrives far behind the box.
// Returns: distance above 0; BOUNDS_TRACE_NONE for a ray that misses the box, starts inside it, or leaves it behind.
// Units: distances are in units of the length of `direction`; the box has half a side of 1.
// Domain: |direction| in [1e-3, 1e3]; coordinates of `position` up to 1e4, the largest L. The line passes the box's
//   edges, on either side, by at least 2^-10 + 2^-18 L; `position` is at least 2^-10 from its surface, along L's axis.
// Outside: finite for positions and directions up to 1e17; a ray in the plane of a side meets the box; a ray that
//   touches an edge meets it; from a start on a side, BOUNDS_TRACE_NONE.
// Accuracy: lavapipe 1 ulp; portable 3 ulp
fn bounds_trace_cuboid(position: vec3f, direction: vec3f) -> f32 {
    let parallel = vec3f(BOUNDS_TRACE_PARALLEL);
    let inward = select(parallel, -parallel, position >= vec3f(0.0f));
    let slope = select(direction, inward, abs(direction) < parallel);
    let first = (-1.0f - position) / slope;
    let second = (1.0f - position) / slope;
    let enter = min(first, second);
    let leave = max(first, second);
    let entry = max(max(enter.x, enter.y), enter.z);
    let exit = min(min(leave.x, leave.y), leave.z);
    if (entry <= 0.0f || entry > exit) {
        return BOUNDS_TRACE_NONE;
    }
    return entry;
}

// Normal of the box's side that a point on the box belongs to: the axis of the point's largest
// coordinate. On an edge or at a corner x comes before y, and y before z. A coordinate of 0 counts as
// positive; sign() would be 0 there, which is no normal.
// Returns: outward unit normal, along an axis.
// Units: none; only ratios of the coordinates matter.
// Domain: points with a largest coordinate in [2^-40, 2^40]; those on the box have one of 1.
// Outside: for any finite point a unit vector along an axis; at the origin, that of x.
// Accuracy: lavapipe 0 ulp; portable 0 ulp
fn bounds_trace_cuboid_normal(point: vec3f) -> vec3f {
    let size = abs(point);
    let toward = select(vec3f(-1.0f), vec3f(1.0f), point >= vec3f(0.0f));
    if (size.x >= size.y && size.x >= size.z) {
        return vec3f(toward.x, 0.0f, 0.0f);
    }
    if (size.y >= size.z) {
        return vec3f(0.0f, toward.y, 0.0f);
    }
    return vec3f(0.0f, 0.0f, toward.z);
}

// Distance at which a ray from outside enters the unit ball, by the line's closest point to the middle. The usual
// radicand, b^2 - a c, is a difference of two numbers as large as the squared distance.
// Returns: distance above 0; BOUNDS_TRACE_NONE for a ray that misses the ball, starts inside it, or leaves it behind.
// Units: distances are in units of the length of `direction`; the ball has a radius of 1.
// Domain: |direction| in [1e-3, 1e3], coordinates of `position` up to 1e4. The line passes the ball's silhouette by
//   at least 2^-10 + 2^-18 |position|, inside or outside, and `position` lies at least 2^-10 from its surface.
// Outside: finite for positions up to 1e9 and directions in [1e-9, 1e9]; a ray that touches the ball meets it; from a
//   start on it, BOUNDS_TRACE_NONE; with a direction of 0, BOUNDS_TRACE_NONE.
// Accuracy: lavapipe 7 ulp + 2 backward; portable 14 ulp + 4 backward
fn bounds_trace_ball(position: vec3f, direction: vec3f) -> f32 {
    let outside = dot(position, position) - 1.0f;
    let toward = -dot(position, direction);
    if (outside <= 0.0f || toward <= 0.0f) {
        return BOUNDS_TRACE_NONE;
    }
    let squared = dot(direction, direction);
    let closest = position + (toward / squared) * direction;
    let radicand = 1.0f - dot(closest, closest);
    if (radicand < 0.0f) {
        return BOUNDS_TRACE_NONE;
    }
    return outside / (toward + sqrt(squared * radicand));
}
