// environment: coordinates and texels of a latitude-longitude radiance map, and a studio that makes gems sparkle.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0
// Source: Blinn and Newell, "Texture and Reflection in Computer Generated Images" (1976), for the
//   map; the convention is that of Khronos's glTF Sample Renderer and three.js: +Y up,
//   u = 1/2 + atan2(z, x) / 2 pi. The studio is our own.
//
// Angles are measured in turns (1 turn = 2 pi), because a texture coordinate is already one:
// quarter turns are then exact, and u and v stay inside [0, 1] without a clamp. The module has its
// own arctangent and sine. WGSL allows atan2 an error of 4096 ulp (2.4e-4 in u, one texel of a 4096
// map), and sine an error of 2^-11 (a "unit" vector that is off by 5e-4).

// Angle of the point (x, y) in turns, counterclockwise from +x: the arctangent of a ratio in [0, 1] by a
// polynomial in odd powers, extended to all octants.
// Returns: turns in [-1/2, 1/2]; 0 at the origin; 1/2 on the negative x axis, for a zero y of either sign.
// Units: turns; x and y in any common unit.
// Domain: x and y are each zero or of magnitude in [2^-126, 2^126].
// Outside: finite; a subnormal may count as zero.
// Accuracy: lavapipe 6 ulp; portable 12 ulp; order kept
fn environment_turns(y: f32, x: f32) -> f32 {
    let longer = max(abs(x), abs(y));
    let shorter = min(abs(x), abs(y));
    // Subnormal numbers may be flushed to 0, and the quotient would be 0 / 0.
    let ratio = shorter / max(longer, 1.1754944e-38f);
    let s = ratio * ratio;
    var turns = ratio * (0.15915492f - s * (0.053049512f - s * (0.031782802f - s * (0.022312697f
        - s * (0.015779087f - s * (0.009467554f - s * (0.0038598904f - s * 0.00074695825f)))))));
    if abs(y) > abs(x) {
        turns = 0.25f - turns;
    }
    if x < 0.0f {
        turns = 0.5f - turns;
    }
    return select(turns, -turns, y < 0.0f);
}

// Length of the vector (a, b). The squares can neither overflow nor underflow.
// Returns: sqrt(a^2 + b^2).
// Units: the unit of a and b.
// Domain: a and b are each zero or of magnitude in [2^-126, 2^126].
// Outside: finite below 2^127; a subnormal may count as zero.
// Accuracy: lavapipe 3 ulp; portable 12 ulp; order kept
fn environment_hypot(a: f32, b: f32) -> f32 {
    let longer = max(abs(a), abs(b));
    let ratio = min(abs(a), abs(b)) / max(longer, 1.1754944e-38f);
    return longer * sqrt(1.0f + ratio * ratio);
}

// Sine of an angle in turns, of any size. The nearest whole number of turns is subtracted and the rest
// folded at +-1/4, both without rounding; there it is a polynomial in odd powers. The cosine is
// -environment_sine(turns - 0.25f).
// Returns: sin(2 pi turns), in [-1, 1] up to rounding; exactly 0 at every half turn.
// Units: turns.
// Domain: any finite angle.
// Outside: nothing.
// Accuracy: lavapipe 5 ulp; portable 8 ulp; order kept
fn environment_sine(turns: f32) -> f32 {
    let wrapped = turns - round(turns);
    let folded = clamp(wrapped, -0.5f - wrapped, 0.5f - wrapped);
    let s = folded * folded;
    return folded * (6.2831855f - s * (41.34168f - s * (81.602234f - s * (76.57499f - s * 39.710918f))));
}

// Latitude-longitude coordinates of a direction of any length. The polar angle is computed from both legs of
// its triangle, which keeps full precision at the poles.
// Returns: u, v in [0, 1]. u = 1/2 + atan2(z, x) / 2 pi, so the seam is at -x (u is 1 on it and 0 just behind
//   it) and the middle is at +x. v is 0 at +Y (zenith), 1/2 at the horizon and 1 at -Y. At both poles u = 1/2.
// Units: fractions of the map.
// Domain: not the zero vector; each component is zero or of magnitude in [2^-126, 2^126].
// Outside: (1/2, 0) for the zero vector; subnormal components may count as zero.
// Accuracy: lavapipe 1.5e-7 abs; portable 5e-7 abs; order kept
fn environment_uv_from_direction(direction: vec3f) -> vec2f {
    let u = 0.5f + environment_turns(direction.z, direction.x);
    let v = 2.0f * environment_turns(environment_hypot(direction.x, direction.z), direction.y);
    return vec2f(u, v);
}

// Direction of latitude-longitude coordinates: the inverse of environment_uv_from_direction.
// The azimuth is u - 1/2 turns. The half turn is expressed by the signs, because subtracting it
// would round a small u.
// Returns: unit direction; exactly along +-Y at v = 0 and v = 1 for any u, though its length is
//   rounded.
// Units: fractions of the map.
// Domain: u, v in [0, 1].
// Outside: u repeats with period 1; v runs on over the pole, down the other side.
// Accuracy: lavapipe 8 ulp; portable 20 ulp
fn environment_direction_from_uv(uv: vec2f) -> vec3f {
    let polar = 0.5f * uv.y;
    let sin_polar = environment_sine(polar);
    let cos_polar = -environment_sine(polar - 0.25f);
    let sin_azimuth = -environment_sine(uv.x);
    let cos_azimuth = environment_sine(uv.x - 0.25f);
    return vec3f(sin_polar * cos_azimuth, cos_polar, sin_polar * sin_azimuth);
}

// The four texels around a point of the map, and their blend weights.
struct EnvironmentTexels {
    // Column and row of the texel at the lower coordinates.
    lower: vec2u,
    // Column and row of the texel at the higher coordinates.
    upper: vec2u,
    // Blend weight of `upper` along each axis.
    weight: vec2f,
}

// Texels and weights of a bilinear lookup, for maps that the sampler cannot filter (32-bit float).
// Columns wrap, rows are clamped. The radiance is mix(mix(t[lower.x, lower.y], t[upper.x, lower.y],
// weight.x), mix(t[lower.x, upper.y], t[upper.x, upper.y], weight.x), weight.y).
// Returns: columns below size.x, rows below size.y, weights in [0, 1].
// Units: texels; texel i covers [i, i + 1] / size, and its value is at its centre.
// Domain: u in [0, 4], v in [0, 1]; size from 1 to 16384.
// Outside: u of either sign repeats, less exactly below 0, as long as it is finite; v is clamped.
// Accuracy: lavapipe lower 2 backward, upper 2 backward, weight 1e-7 abs + 2 backward;
//   portable lower 4 backward, upper 4 backward, weight 2e-7 abs + 4 backward; order kept
fn environment_texels(uv: vec2f, size: vec2u) -> EnvironmentTexels {
    // The value of a texel is at its centre, half a texel from its edge.
    let column = (uv.x - floor(uv.x)) * f32(size.x) - 0.5f;
    let row = clamp(clamp(uv.y, 0.0f, 1.0f) * f32(size.y) - 0.5f, 0.0f, f32(size.y) - 1.0f);
    // To the left of the first centre the column is -1; adding the width turns it into the last
    // column.
    let left = u32(floor(column) + f32(size.x)) % size.x;
    let top = u32(floor(row));
    let lower = vec2u(left, top);
    let upper = vec2u((left + 1u) % size.x, min(top + 1u, size.y - 1u));
    return EnvironmentTexels(lower, upper, vec2f(column - floor(column), row - floor(row)));
}

// The real spherical harmonics of a direction, orthonormal over the sphere, of degrees 0, 1, 2 and
// 4: the degrees of a clamped cosine, except those with the smallest coefficients. With light from
// all directions projected onto them, its effect on a surface is a short sum. Within each degree,
// the order runs from -l to l.
struct EnvironmentHarmonics {
    // Degree 0: constant.
    zeroth: f32,
    // Degree 1, in the order y, z, x.
    first: vec3f,
    // Degree 2.
    second: array<f32, 5u>,
    // Degree 4.
    fourth: array<f32, 9u>,
}

// Spherical harmonics as polynomials in the direction's components, with z as the polar axis.
// Returns: values of at most 0.85 in magnitude; in each degree, their squares add up to (2
//   l + 1) / 4 pi.
// Units: none.
// Domain: |direction| = 1.
// Outside: finite for components up to 1e9.
// Accuracy: lavapipe zeroth 1 ulp, first 1.5 ulp, second 4e-7 abs, fourth 2e-6 abs;
//   portable zeroth 1 ulp, first 2 ulp, second 6e-7 abs, fourth 3e-6 abs
fn environment_harmonics(direction: vec3f) -> EnvironmentHarmonics {
    let x = direction.x;
    let y = direction.y;
    let z = direction.z;
    let xx = x * x;
    let yy = y * y;
    let zz = z * z;
    let first = 0.48860252f * direction.yzx;
    let second = array<f32, 5u>(
        1.0925485f * x * y,
        1.0925485f * y * z,
        0.31539157f * (3.0f * zz - 1.0f),
        1.0925485f * x * z,
        0.54627424f * (xx - yy),
    );
    let fourth = array<f32, 9u>(
        2.5033429f * x * y * (xx - yy),
        1.7701308f * y * z * (3.0f * xx - yy),
        0.9461747f * x * y * (7.0f * zz - 1.0f),
        0.66904655f * y * z * (7.0f * zz - 3.0f),
        0.10578555f * (zz * (35.0f * zz - 30.0f) + 3.0f),
        0.66904655f * x * z * (7.0f * zz - 3.0f),
        0.47308735f * (xx - yy) * (7.0f * zz - 1.0f),
        1.7701308f * x * z * (xx - 3.0f * yy),
        0.62583573f * (xx * (xx - 3.0f * yy) - yy * (3.0f * xx - yy)),
    );
    return EnvironmentHarmonics(0.28209478f, first, second, fourth);
}

// Coverage of a direction by a rectangular light with soft edges, perpendicular to `axis` at distance 1,
// its vertical along `up`. On its plane each edge is a smoothstep that extends `softness` to both sides.
// Returns: coverage in [0, 1]: 1 inside, 0 outside and in the entire half space behind.
// Units: none; sizes are relative to the light's distance, i.e. tangents of angles.
// Domain: |direction| = |axis| = |up| = 1, axis . up = 0, axis . direction at most 0 or at least 2^-100;
//   softness in [1/256, 1]; each component of half_size in [softness, 8].
// Outside: any length of direction gives the same, as long as products stay finite; softness 0 has no edge
//   to divide by.
// Accuracy: lavapipe 6 ulp + 3 backward; portable 16 ulp + 8 backward
fn environment_softbox(direction: vec3f, axis: vec3f, up: vec3f, half_size: vec2f, softness: f32) -> f32 {
    let depth = dot(direction, axis);
    // The projection ignores the sign of the depth: without this test, -axis would hit the middle
    // of the light. The smallest normal number still has a finite reciprocal.
    if depth < 1.1754944e-38f {
        return 0.0f;
    }
    let right = cross(up, axis);
    // Reciprocals are used because a division costs as much as several multiplications; the
    // division by a constant softness costs nothing at all.
    let position = vec2f(dot(direction, right), dot(direction, up)) * (1.0f / depth);
    let inside = (half_size + softness - abs(position)) * (0.5f / softness);
    let t = clamp(inside, vec2f(0.0f), vec2f(1.0f));
    let coverage = t * t * (3.0f - 2.0f * t);
    return coverage.x * coverage.y;
}

// Radiance of a dome that changes from `ground` at the nadir to `zenith` at the zenith.
// The square keeps the horizon close to the ground's radiance, so that a gem is seen against a dark
// background.
// Returns: ground (1 - w) + zenith w with w = ((1 + y) / 2)^2.
// Units: linear radiance, the unit of `ground` and `zenith`.
// Domain: |direction| = 1; ground, zenith >= 0.
// Outside: y beyond +-1 extrapolates.
// Accuracy: lavapipe 4 ulp + 3 backward; portable 10 ulp + 6 backward
fn environment_dome(direction: vec3f, ground: vec3f, zenith: vec3f) -> vec3f {
    let height = 0.5f + 0.5f * direction.y;
    let weight = height * height;
    return ground * (1.0f - weight) + zenith * weight;
}

// A jeweller's studio: a dim tent over dark paper, with a few small, bright lights. Contrast creates
// scintillation, and narrow lights create fire. Axes and up vectors are Pythagorean quadruples, so they
// are orthogonal as written.
// Returns: linear Rec. 709 radiance, each channel in [0.0239, 20.4]; continuous. No two lights overlap.
// Units: radiance, 1 = diffuse white at exposure 1.
// Domain: |direction| = 1.
// Outside: lights do not depend on the length, the dome extrapolates.
// Accuracy: lavapipe 8.5 ulp + 3.5 backward; portable 24 ulp + 12 backward
fn environment_studio(direction: vec3f) -> vec3f {
    // Surround: dark paper below, a dim, slightly blue tent above.
    let surround = environment_dome(direction, vec3f(0.025f, 0.024f, 0.026f), vec3f(0.26f, 0.30f, 0.38f));
    // Key light: a square softbox at the front left, high and slightly warm.
    let key = vec3f(9.0f, 8.4f, 7.2f) * environment_softbox(direction,
        vec3f(-2.0f, 6.0f, 3.0f) / 7.0f, vec3f(6.0f, 3.0f, -2.0f) / 7.0f, vec2f(0.28f, 0.28f), 0.05f);
    // Overhead: a long neutral strip just behind the zenith, which the table and the upper halves
    // reflect.
    let overhead = vec3f(13.0f, 13.0f, 13.0f) * environment_softbox(direction,
        vec3f(0.0f, 24.0f, -7.0f) / 25.0f, vec3f(0.0f, 7.0f, 24.0f) / 25.0f, vec2f(0.70f, 0.06f), 0.03f);
    // Two upright strips, cool from the right and warm from the back left, give the two sides of
    // the bezels different colours.
    let cool_strip = vec3f(7.0f, 8.6f, 10.0f) * environment_softbox(direction,
        vec3f(6.0f, 3.0f, 2.0f) / 7.0f, vec3f(-2.0f, 6.0f, -3.0f) / 7.0f, vec2f(0.08f, 0.45f), 0.04f);
    let warm_strip = vec3f(9.0f, 7.2f, 5.0f) * environment_softbox(direction,
        vec3f(-2.0f, 1.0f, -2.0f) / 3.0f, vec3f(2.0f, 2.0f, -1.0f) / 3.0f, vec2f(0.09f, 0.40f), 0.04f);
    // Three sparks, too small to light the stone but bright enough for dispersion to spread them
    // into colours.
    let back_spark = vec3f(20.0f, 19.0f, 17.0f) * environment_softbox(direction,
        vec3f(4.0f, 7.0f, -4.0f) / 9.0f, vec3f(1.0f, 4.0f, 8.0f) / 9.0f, vec2f(0.08f, 0.08f), 0.03f);
    let front_spark = vec3f(15.0f, 16.0f, 18.0f) * environment_softbox(direction,
        vec3f(1.0f, 2.0f, 2.0f) / 3.0f, vec3f(-2.0f, 2.0f, -1.0f) / 3.0f, vec2f(0.07f, 0.07f), 0.03f);
    let low_spark = vec3f(16.0f, 16.0f, 16.0f) * environment_softbox(direction,
        vec3f(2.0f, 3.0f, -6.0f) / 7.0f, vec3f(6.0f, 2.0f, 3.0f) / 7.0f, vec2f(0.06f, 0.06f), 0.03f);
    // Two cards from below, like the white paper that a jeweller holds there: they keep the
    // pavilion from going dark when the stone is tilted.
    let back_card = vec3f(2.6f, 2.75f, 2.9f) * environment_softbox(direction,
        vec3f(0.0f, -3.0f, -4.0f) / 5.0f, vec3f(0.0f, 4.0f, -3.0f) / 5.0f, vec2f(0.60f, 0.20f), 0.10f);
    let front_card = vec3f(2.0f, 1.85f, 1.7f) * environment_softbox(direction,
        vec3f(0.0f, -5.0f, 12.0f) / 13.0f, vec3f(0.0f, 12.0f, 5.0f) / 13.0f, vec2f(0.50f, 0.14f), 0.10f);
    return surround + key + overhead + cool_strip + warm_strip
        + back_spark + front_spark + low_spark + back_card + front_card;
}
