// bodies: what a ray that leaves a body meets among the bounds of a few others.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: the modules bounds_trace and environment.
//
// A recipe adds: the modules bounds_trace and environment. A ray that starts inside bounds does not
// meet them.

// Rays that leave meet the bounds of other bodies. Called for by the user.
override EFFECT_BOUNDS_TRACE: bool = false;

//+bounds_trace {
const BODIES_NONE: u32 = 0xffffffffu;
// Value of Body.shape for an ellipsoid.
const BODIES_BALL: u32 = 1u;

// A body by its bounds and by what it sends.
struct Body {
    // Rows of the matrix from world space to the space in which the bounds are the cube from -1 to
    // 1, or the unit ball.
    bounds_from_world: mat3x4f,
    // Spherical harmonics of degrees 0 to 2 of what it sends by the normal of its surface: radiance,
    // linear RGB.
    radiance: array<vec4f, 9>,
    // 0 a box, 1 an ellipsoid.
    shape: u32,
}

@group(0) @binding(9) var<storage, read> bodies: array<Body>;

// The body that a ray meets first.
struct BodiesHit {
    // BODIES_NONE if there is none.
    number: u32,
    distance: f32,
}

fn bodies_hit(position: vec3f, direction: vec3f) -> BodiesHit {
    var nearest = BodiesHit(BODIES_NONE, 3.4e38f);
    for (var number = 0u; number < arrayLength(&bodies); number++) {
        let to_bounds = bodies[number].bounds_from_world;
        let start = vec4f(position, 1.0f) * to_bounds;
        let along = vec4f(direction, 0.0f) * to_bounds;
        var distance = 0.0f;
        if (bodies[number].shape == BODIES_BALL) {
            distance = bounds_trace_ball(start, along);
        } else {
            distance = bounds_trace_cuboid(start, along);
        }
        if (distance != BOUNDS_TRACE_NONE && distance < nearest.distance) {
            nearest = BodiesHit(number, distance);
        }
    }
    return nearest;
}

// Radiance that a body sends against a ray that meets it at a distance.
fn bodies_radiance(hit: BodiesHit, position: vec3f, direction: vec3f) -> vec3f {
    let to_bounds = bodies[hit.number].bounds_from_world;
    let point = vec4f(position + hit.distance * direction, 1.0f) * to_bounds;
    var normal = point;
    if (bodies[hit.number].shape != BODIES_BALL) {
        normal = bounds_trace_cuboid_normal(point);
    }
    let basis = environment_harmonics(normalize((to_bounds * normal).xyz));
    let radiance = basis.zeroth * bodies[hit.number].radiance[0]
        + basis.first[0] * bodies[hit.number].radiance[1]
        + basis.first[1] * bodies[hit.number].radiance[2]
        + basis.first[2] * bodies[hit.number].radiance[3]
        + basis.second[0] * bodies[hit.number].radiance[4]
        + basis.second[1] * bodies[hit.number].radiance[5]
        + basis.second[2] * bodies[hit.number].radiance[6]
        + basis.second[3] * bodies[hit.number].radiance[7]
        + basis.second[4] * bodies[hit.number].radiance[8];
    return max(radiance.rgb, vec3f(0.0f));
}
//+bounds_trace }
