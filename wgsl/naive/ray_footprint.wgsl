// ray_footprint: forms found elsewhere, kept to show where they fail. They follow the module and use its names.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0

// ray_footprint_edge from the offsets on the two planes, as ray differentials are transferred to a
// plane that is hit (Igehy, eq. 10). Kept to show where it fails: on a facet seen edge-on the offset
// is infinite.
// Returns: (f, gx, gy), as ray_footprint_edge.
// Units: those of the offsets.
// Domain: that of ray_footprint_edge, with slopes of at least 0.25, planes on either side of the
//   ray, a gap, and offsets towards one of them.
// Outside: as the formula gives.
// Accuracy: naive
fn ray_footprint_edge_naive(
    direction: vec3f, right: vec3f, down: vec3f, nearest: vec3f, runner_up: vec3f, gap: f32
) -> vec3f {
    let slope = dot(nearest, direction);
    let slope_runner_up = dot(runner_up, direction);
    let sooner = vec2f(dot(nearest, right), dot(nearest, down)) / slope;
    let later = vec2f(dot(runner_up, right), dot(runner_up, down)) / slope_runner_up;
    return slope * slope_runner_up * vec3f(gap, later - sooner);
}
