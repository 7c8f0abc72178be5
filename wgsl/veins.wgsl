// veins: density of veined stone at a point of space: the surfaces on which gradient noise is 0, blurred.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0
// Source: Perlin, "Improving Noise", SIGGRAPH 2002 (fade and gradients); Jarzynski and Olano, "Hash
//   Functions for GPU Rendering", JCGT 9(3), 2020 (pcg4d); Ebert et al., "Texturing and Modeling",
//   3rd ed., 2003, ch. 2 (octaves, marble).
//
// The density stays within its bounds, so the greater bound is a majorant for delta tracking.

// Positions are clamped to this many cells from the origin on each axis. Beyond it, a cell spans at
// most two steps of a float.
const VEINS_FARTHEST: f32 = 4194304.0f;
// The minimum width of a vein, in units of the noise; smaller widths are clamped to it.
const VEINS_NARROWEST: f32 = 0.0009765625f;
// The maximum width, 2^20, whose square is finite; larger widths are clamped to it. From this width
// on, everything is vein, to the last place.
const VEINS_WIDEST: f32 = 1048576.0f;
// The maximum number of octaves.
const VEINS_MOST_OCTAVES = 8u;

struct VeinsCell {
    // Corner of the cell at the lower coordinates.
    corner: vec3i,
    // Position relative to that corner, in [0, 1].
    offset: vec3f,
}

struct VeinsPattern {
    // Number of cells of the first octave per unit of length.
    frequency: f32,
    // Value of the noise at which a vein's density has fallen halfway to `least`.
    width: f32,
    // Density between the veins; also the lower bound of the density if `greatest` is larger.
    least: f32,
    // Density in the middle of a vein.
    greatest: f32,
    octaves: u32,
    seed: u32,
}

// Cell of the noise at a point.
// Returns: VeinsCell. An offset just below the upper border of a cell may be rounded to 1; an
//   offset of 0 in the next cell gives the same noise.
// Units: cells.
// Domain: any position, clamped to +-4194304 on each axis.
// Outside: nothing.
// Accuracy: lavapipe corner 0 ulp, offset 1 ulp; portable corner 0 ulp, offset 1 ulp
fn veins_cell(position: vec3f) -> VeinsCell {
    let p = clamp(position, vec3f(-VEINS_FARTHEST), vec3f(VEINS_FARTHEST));
    let lower = floor(p);
    return VeinsCell(vec3i(lower), p - lower);
}

// Random bits for a corner of the grid, by pcg4d; identical on every device.
// Returns: 32 bits.
// Units: none.
// Domain: any corner and seed.
// Outside: nothing.
// Accuracy: lavapipe 0 ulp; portable 0 ulp
fn veins_hash(corner: vec3i, seed: u32) -> u32 {
    var v = vec4u(bitcast<vec3u>(corner), seed) * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v ^= v >> vec4u(16u);
    return v.x + v.y * v.w;
}

// One of the twelve directions from the centre of a cube to the middles of its edges.
// Returns: a vector with one component 0 and the other two +-1.
// Units: none.
// Domain: any bits.
// Outside: nothing.
// Accuracy: lavapipe 0 ulp; portable 0 ulp
fn veins_gradient(bits: u32) -> vec3f {
    // The highest bits are mixed best.
    let first = select(1.0f, -1.0f, (bits & 0x80000000u) != 0u);
    let second = select(1.0f, -1.0f, (bits & 0x40000000u) != 0u);
    let axis = bits % 3u;
    if axis == 0u {
        return vec3f(0.0f, first, second);
    }
    if axis == 1u {
        return vec3f(first, 0.0f, second);
    }
    return vec3f(first, second, 0.0f);
}

// The contribution of one corner to the noise, before fading: a plane through 0 at that corner.
// Returns: gradient . (offset - corner), in [-2, 2].
// Units: none.
// Domain: a cell within +-4194304, an offset in [0, 1], `corner` with components 0 or 1.
// Outside: the plane goes on.
// Accuracy: lavapipe 2.4e-7 abs; portable 2.4e-7 abs
fn veins_corner(cell: VeinsCell, corner: vec3i, seed: u32) -> f32 {
    return dot(veins_gradient(veins_hash(cell.corner + corner, seed)), cell.offset - vec3f(corner));
}

// Gradient noise. Perlin's fade of degree five makes value, slope and curvature continuous across
// cell borders.
// Returns: noise in [-1.1, 1.1], 0 at the corners of the grid, with mean 0.
// Units: position in cells.
// Domain: any position, clamped to +-4194304 on each axis.
// Outside: nothing.
// Accuracy: lavapipe 4.5e-6 abs; portable 1e-5 abs
fn veins_noise(position: vec3f, seed: u32) -> f32 {
    let cell = veins_cell(position);
    let o = cell.offset;
    let fade = o * o * o * (o * (o * 6.0f - 15.0f) + 10.0f);
    let near = vec4f(
        veins_corner(cell, vec3i(0i, 0i, 0i), seed),
        veins_corner(cell, vec3i(0i, 1i, 0i), seed),
        veins_corner(cell, vec3i(0i, 0i, 1i), seed),
        veins_corner(cell, vec3i(0i, 1i, 1i), seed),
    );
    let far = vec4f(
        veins_corner(cell, vec3i(1i, 0i, 0i), seed),
        veins_corner(cell, vec3i(1i, 1i, 0i), seed),
        veins_corner(cell, vec3i(1i, 0i, 1i), seed),
        veins_corner(cell, vec3i(1i, 1i, 1i), seed),
    );
    let along_x = near + fade.x * (far - near);
    let along_y = along_x.xz + fade.y * (along_x.yw - along_x.xz);
    return along_y.x + fade.z * (along_y.y - along_y.x);
}

// A sum of octaves of the noise. Each has twice the frequency and half the amplitude of the one
// before, and a different seed.
// Returns: the sum, in [-2.2, 2.2].
// Units: position in cells of the first octave.
// Domain: positions within +-32768; up to 8 octaves.
// Outside: positions up to 2^120 are clamped for each octave; more octaves count as 8.
// Accuracy: lavapipe 8e-6 abs; portable 2e-5 abs
fn veins_fractal(position: vec3f, octaves: u32, seed: u32) -> f32 {
    var sum = 0.0f;
    var amplitude = 1.0f;
    var place = position;
    for (var octave = 0u; octave < min(octaves, VEINS_MOST_OCTAVES); octave++) {
        sum += amplitude * veins_noise(place, seed + octave);
        amplitude *= 0.5f;
        place *= 2.0f;
    }
    return sum;
}

// A vein where the noise passes through 0: a Lorentzian curve, which has no crease. It is computed
// as a quotient of squares, because the error of a quotient value / width would be doubled and
// added to the error of a second division.
// Returns: share of vein in (0, 1]: 1 at value 0, 1/2 at +-width.
// Units: value and width in units of the noise.
// Domain: values within +-4; any width, clamped to [2^-10, 2^20].
// Outside: anything where the value's square overflows.
// Accuracy: lavapipe 4 ulp; portable 9 ulp
fn veins_fold(value: f32, width: f32) -> f32 {
    let half = clamp(width, VEINS_NARROWEST, VEINS_WIDEST);
    let squared = half * half;
    return min(squared / (squared + value * value), 1.0f);
}

// Density of veined stone: the factor for the scattering and absorption coefficients.
// Returns: density between pattern.least (between the veins) and pattern.greatest (in the middle of
//   a vein). Either may be the greater.
// Units: position in a unit of length; density none.
// Domain: |position| frequency at most 32768; width in [1/16, 4], densities in [0, 4], up to 8
//   octaves.
// Outside: as veins_fractal and veins_fold; a smaller width is as accurate as the noise, whose
//   error it magnifies by its inverse.
// Accuracy: lavapipe 4e-4 abs + 1 backward; portable 1e-3 abs + 1 backward
fn veins_density(position: vec3f, pattern: VeinsPattern) -> f32 {
    let value = veins_fractal(position * pattern.frequency, pattern.octaves, pattern.seed);
    let share = veins_fold(value, pattern.width);
    return pattern.least * (1.0f - share) + pattern.greatest * share;
}
