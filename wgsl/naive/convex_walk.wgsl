// convex_walk: forms found elsewhere, kept to show where they fail. They follow the module and use its names.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0

// convex_walk_square with sign() for the side on which a point lies.
// Returns: coordinates in [-1, 1].
// Units: none; the length of `point` does not matter.
// Domain: x and y of 1/16 to 1 in magnitude, z of 1/1024 to 1.
// Outside: below the origin, a component of 0 takes the direction to the square's middle or to an
//   edge's middle, far from its place.
// Accuracy: naive
fn convex_walk_square_naive(point: vec3f) -> vec2f {
    let inner = point.xy / (abs(point.x) + abs(point.y) + abs(point.z));
    if (point.z >= 0.0f) {
        return inner;
    }
    return (1.0f - abs(inner.yx)) * sign(point.xy);
}
