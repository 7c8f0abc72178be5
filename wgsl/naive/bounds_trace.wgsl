// bounds_trace: forms found elsewhere, kept to show where they fail. They follow the module and use its names.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0

// bounds_trace_cuboid by the slab test as it is printed, divided by the direction as it is.
// Returns: distance above 0, or BOUNDS_TRACE_NONE.
// Units: as bounds_trace_cuboid.
// Domain: that of bounds_trace_cuboid, with components of the direction of at least 1/20 of its
//   length.
// Outside: 0 / 0 for a ray in the plane of a side; relies on infinities for any other that is
//   parallel to one.
// Accuracy: naive
fn bounds_trace_cuboid_naive(position: vec3f, direction: vec3f) -> f32 {
    let first = (-1.0f - position) / direction;
    let second = (1.0f - position) / direction;
    let enter = min(first, second);
    let leave = max(first, second);
    let entry = max(max(enter.x, enter.y), enter.z);
    let exit = min(min(leave.x, leave.y), leave.z);
    if (entry <= 0.0f || entry > exit) {
        return BOUNDS_TRACE_NONE;
    }
    return entry;
}

// bounds_trace_ball by the quadratic formula, as textbooks have it.
// Returns: distance above 0, or BOUNDS_TRACE_NONE.
// Units: as bounds_trace_ball.
// Domain: |direction| in [1/4, 4]; starts in the ball up to 1/2 from the middle, or from 1.5 to 4; the
//   line passes the silhouette by at least 1/10.
// Outside: from 3000 radii on, an ulp of b^2 is the square of the radius, and nothing is left of what
//   decides.
// Accuracy: naive
fn bounds_trace_ball_naive(position: vec3f, direction: vec3f) -> f32 {
    let a = dot(direction, direction);
    let b = dot(position, direction);
    let c = dot(position, position) - 1.0f;
    let discriminant = b * b - a * c;
    if (discriminant < 0.0f) {
        return BOUNDS_TRACE_NONE;
    }
    let entry = (-b - sqrt(discriminant)) / a;
    if (entry <= 0.0f) {
        return BOUNDS_TRACE_NONE;
    }
    return entry;
}
