// environment: forms found elsewhere, kept to show where they fail. They follow the module and use its names.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0

// environment_uv_from_direction with normalize and acos, the usual form: acos amplifies the
// rounding of y without bound at the poles.
// Returns: environment_uv_from_direction(direction), with v to about 1e-4 near the poles.
// Units: fractions of the map.
// Domain: lengths in [1e-15, 1e15], at least 0.1 radians from the poles.
// Outside: v jumps to the pole within 3e-4 radians of it, up to 1.1e-4 off; at the pole u is 1 for
//   x = -0; lengths whose square over- or underflows (1e-23, 1e19) give another direction or no
//   number.
// Accuracy: naive
fn environment_uv_from_direction_naive(direction: vec3f) -> vec2f {
    let unit = normalize(direction);
    return vec2f(0.5f + atan2(unit.z, unit.x) * 0.15915494f, acos(unit.y) * 0.31830987f);
}

// environment_texels with both coordinates clamped, as in a sampler left at its default: this
// leaves a seam along the -x meridian.
// Returns: environment_texels(uv, size) away from the borders.
// Units: texels.
// Domain: u in [1 / size.x, 1 - 1 / size.x], v in [1 / size.y, 1 - 1 / size.y].
// Outside: half a texel from the seam, the texel across it is missed.
// Accuracy: naive
fn environment_texels_naive(uv: vec2f, size: vec2u) -> EnvironmentTexels {
    let corner = uv * vec2f(size) - 0.5f;
    let lower = vec2u(max(floor(corner), vec2f(0.0f)));
    let upper = min(lower + 1u, size - 1u);
    return EnvironmentTexels(lower, upper, corner - floor(corner));
}

// environment_softbox without the test of the depth's sign: every light appears a second time, on
// the opposite side.
// Returns: environment_softbox(...) for axis . direction > 0.
// Units: as for environment_softbox.
// Domain: as for environment_softbox, with axis . direction > 0.
// Outside: the light's mirror image for axis . direction < 0.
// Accuracy: naive
fn environment_softbox_naive(direction: vec3f, axis: vec3f, up: vec3f, half_size: vec2f, softness: f32) -> f32 {
    let depth = dot(direction, axis);
    let right = cross(up, axis);
    let position = vec2f(dot(direction, right), dot(direction, up)) * (1.0f / depth);
    let inside = (half_size + softness - abs(position)) * (0.5f / softness);
    let t = clamp(inside, vec2f(0.0f), vec2f(1.0f));
    let coverage = t * t * (3.0f - 2.0f * t);
    return coverage.x * coverage.y;
}
