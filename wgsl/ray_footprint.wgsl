// ray_footprint: the part of a pixel that shows what lies beyond a facet's edge, and the neighbours that show the same.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0
// Source: Igehy, "Tracing Ray Differentials", SIGGRAPH 1999, eq. (10) to (17), for flat surfaces; the
//   mixing of neighbours: Persson, "Geometry Buffer Anti-Aliasing", in GPU Pro 3, 2012, for edges of
//   the drawn mesh. The edges seen through facets, their shares, and the growth: own.
//
// A footprint is what a step of one pixel, to the right or down, does to a point on a ray: an offset.
// A flat facet reflects an offset as it reflects a direction (refraction_reflect), so that it neither
// jumps nor diverges on its way through a stone. Only its part across the ray has a meaning: what lies
// along the ray moves the point on the ray itself.
//
// At each hit the runner-up, the plane that the ray would have met next, gives the nearest edge, as a
// line in the pixel. What lies beyond the line is another path through the stone, which the neighbour
// on that side follows. With `rest`, the share of the pixel that is its own so far, and `seen`, the
// part of the light that is still to come:
//
//   let edge = ray_footprint_edge(direction, right, down, nearest, runner_up, gap);
//   let share = rest * seen * ray_footprint_share(edge);
//   neighbours += ray_footprint_neighbours(edge, share);
//   rest -= share;
//
// A second pass then mixes the four neighbours in, by these shares: ray_footprint_mix.

// How much wider an offset is after a way inside than on the facet that the eye sees, as one number for
// both axes and all reflections. Across the plane of incidence it is exact; in that plane rays spread less.
// Returns: factor, at least 1.
// Units: `distance` of the eye from the facet and `travelled`, the way inside, in any common unit of
//   length; `relative_index` is a ratio.
// Domain: distance in [1e-4, 1e9], travelled in [0, 1e9], relative_index in [1, 4].
// Outside: finite for distances from 2^-40 on, ways up to 2^60 and an index from 2^-20 on.
// Accuracy: lavapipe 3 ulp; portable 11 ulp
fn ray_footprint_growth(distance: f32, travelled: f32, relative_index: f32) -> f32 {
    return 1.0f + travelled / (relative_index * distance);
}

// The edge at which the plane that a ray meets gives way to the runner-up, as a line in the pixel. Nothing is
// divided: the difference of the two distances, times both slopes of the ray, is linear in the pixel.
// Returns: (f, gx, gy): the runner-up is met where gx x + gy y > f, x and y in pixels right and down; the edge is f /
//   |g| pixels off.
// Units: those of the offsets. `gap` is the distance along the ray from the nearest plane to the runner-up.
// Domain: unit vectors; direction . nearest and direction . runner_up in [0, 1], the larger at least 1e-3; gap in [0,
//   1e4]; offsets `right` and `down` at the point of the hit, up to 1e4.
// Outside: finite for offsets and a gap up to 2^30 and other vectors up to 2^10; where one slope is below 0, so is f.
// Accuracy: lavapipe 1 ulp + 8 backward; portable 2 ulp + 16 backward
fn ray_footprint_edge(
    direction: vec3f, right: vec3f, down: vec3f, nearest: vec3f, runner_up: vec3f, gap: f32
) -> vec3f {
    let slope = dot(nearest, direction);
    let slope_runner_up = dot(runner_up, direction);
    // Perpendicular to the ray, so that parts of the offsets along it drop out: slope * runner_up -
    // slope_runner_up * nearest, which would cancel where the planes are nearly one.
    let across = cross(direction, cross(runner_up - nearest, nearest));
    return vec3f(gap * slope * slope_runner_up, dot(across, right), dot(across, down));
}

// The share of a pixel beyond a line: the area of the unit square around the middle in which
// g . p > f.
// Returns: area in [0, 1/2], but for rounding; 1/2 for a line through the middle, 0 without a
//   gradient.
// Units: pixels; `edge` is (f, gx, gy) in any common unit.
// Domain: f in [0, 1e9]; gx and gy 0, or of a magnitude in [1e-15, 1e9].
// Outside: for f below 0, the area of -f.
// Accuracy: lavapipe 6 ulp + 2 backward; portable 14 ulp + 4 backward
fn ray_footprint_share(edge: vec3f) -> f32 {
    let f = abs(edge.x);
    let longer = max(abs(edge.y), abs(edge.z));
    let shorter = min(abs(edge.y), abs(edge.z));
    // The line leaves the square at a corner.
    let reach = 0.5f * (longer + shorter);
    if (f >= reach) {
        return 0.0f;
    }
    // Between two opposite sides, it cuts off a trapezoid.
    if (f <= 0.5f * (longer - shorter)) {
        return 0.5f - f / longer;
    }
    // Between two sides that meet, a triangle.
    let height = reach - f;
    return (height / longer) * (height / (2.0f * shorter));
}

// The neighbours that show what lies beyond a line: the two on that side, each by how far it lies
// beyond the line, so that one that the line has just reached begins with nothing.
// Returns: shares of the neighbours to the right, left, below and above, which add up to `share`; 0
//   if the line lies beyond all of them.
// Units: `edge` is (f, gx, gy) in any common unit; `share` is a ratio.
// Domain: f in [0, 1e9]; gx and gy 0, or of a magnitude in [1e-15, 1e9]; share in [0, 1].
// Outside: an f below 0 counts as 0.
// Accuracy: lavapipe 4 ulp + 2 backward; portable 10 ulp + 4 backward
fn ray_footprint_neighbours(edge: vec3f, share: f32) -> vec4f {
    let f = max(edge.x, 0.0f);
    let beyond = max(vec4f(edge.y, -edge.y, edge.z, -edge.z) - f, vec4f(0.0f));
    let sum = beyond.x + beyond.y + beyond.z + beyond.w;
    if (sum == 0.0f) {
        return vec4f(0.0f);
    }
    return beyond * (share / sum);
}

// A pixel with its neighbours' shares mixed in: the second pass.
// Returns: the mean of the five, weighted by the shares and by what they leave to the pixel itself.
// Units: those of the pixels, such as linear radiance; `shares` of the neighbours to the right, left,
//   below and above, and their sum at most 1.
// Domain: pixels 0 or in [1e-15, 1e15], shares 0 or in [1e-6, 1].
// Outside: finite for pixels up to 1e30 and shares up to 1e6; where shares add up to more than 1, the
//   pixel itself counts below 0.
// Accuracy: lavapipe 2 ulp + 4 backward; portable 4 ulp + 6 backward
fn ray_footprint_mix(own: vec4f, right: vec4f, left: vec4f, below: vec4f, above: vec4f, shares: vec4f) -> vec4f {
    let rest = 1.0f - (shares.x + shares.y + shares.z + shares.w);
    return rest * own + shares.x * right + shares.y * left + shares.z * below + shares.w * above;
}
