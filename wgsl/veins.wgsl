// veins: density of veined stone at a point of space: the surfaces on which gradient noise is 0, blurred.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0, hash 366710648b89520b
// Source: Perlin, "Improving Noise", SIGGRAPH 2002 (fade and gradients); Jarzynski and Olano, "Hash Functions for GPU Rendering",
//   JCGT 9(3), 2020 (pcg4d); Ebert et al., "Texturing and Modeling", 3rd ed., 2003, ch. 2 (octaves, marble).
//
// The density never leaves its bounds, so that the greatest serves delta tracking as majorant.

// Positions count as at most this many cells from the origin, on each axis: beyond it a float leaves a cell only two steps and fewer.
const VEINS_FARTHEST: f32 = 4194304.0f;
// A vein's width counts as at least this, in units of the noise.
const VEINS_NARROWEST: f32 = 0.0009765625f;
// And as at most this, 2^20, so that its square is finite: from there on all is vein, to the last place.
const VEINS_WIDEST: f32 = 1048576.0f;
// The most octaves that are summed.
const VEINS_MOST_OCTAVES = 8u;

struct VeinsCell {
    // Corner of the cell at the lower coordinates.
    corner: vec3i,
    // From that corner, in [0, 1].
    offset: vec3f,
}

struct VeinsPattern {
    // Cells of the first octave per unit of length.
    frequency: f32,
    // Value of the noise at which a vein's density has fallen half way.
    width: f32,
    // Density between the veins, and the bound that it never goes below where `greatest` is the greater.
    least: f32,
    // Density in the middle of a vein.
    greatest: f32,
    octaves: u32,
    seed: u32,
}

// Cell of the noise at a point.
// Returns: VeinsCell; an offset just below a cell's upper border may be rounded to 1, where the next cell's 0 gives the same noise.
// Units: cells.
// Domain: any position, clamped to +-4194304 on each axis.
// Outside: none is.
// Accuracy: lavapipe corner 0 ulp, offset 1 ulp; portable corner 0 ulp, offset 1 ulp
fn veins_cell(position: vec3f) -> VeinsCell {
    let p = clamp(position, vec3f(-VEINS_FARTHEST), vec3f(VEINS_FARTHEST));
    let lower = floor(p);
    return VeinsCell(vec3i(lower), p - lower);
}

// Random bits of a corner of the grid, by pcg4d: the same on every device.
// Returns: 32 bits.
// Units: none.
// Domain: any corner and seed.
// Outside: none is.
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

// One of the twelve directions from a cube's middle to its edges' middles.
// Returns: a vector with one component 0 and two of +-1.
// Units: none.
// Domain: any bits.
// Outside: none is.
// Accuracy: lavapipe 0 ulp; portable 0 ulp
fn veins_gradient(bits: u32) -> vec3f {
    // The highest bits are the best mixed.
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

// A corner's part in the noise, before it is faded: a plane through 0 at that corner.
// Returns: gradient . (offset - corner), within [-2, 2].
// Units: none.
// Domain: a cell within +-4194304, an offset in [0, 1], `corner` of zeros and ones.
// Outside: the plane goes on.
// Accuracy: lavapipe 2.4e-7 abs; portable 2.4e-7 abs
fn veins_corner(cell: VeinsCell, corner: vec3i, seed: u32) -> f32 {
    return dot(veins_gradient(veins_hash(cell.corner + corner, seed)), cell.offset - vec3f(corner));
}

// Gradient noise. Perlin's fade of the fifth degree makes value, slope and curvature continuous across the borders of cells.
// Returns: noise in [-1.1, 1.1], 0 at the corners of the grid, of mean 0.
// Units: position in cells.
// Domain: any position, clamped to +-4194304 on each axis.
// Outside: none is.
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

// Octaves of the noise, each of twice the frequency and half the amplitude of the one before, and of another seed.
// Returns: their sum, within [-2.2, 2.2].
// Units: position in cells of the first octave.
// Domain: positions within +-32768; octaves up to 8.
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

// A vein where the noise passes 0: Lorentz's curve, which has no crease. As a quotient of squares: an error of the quotient value / width would be
// doubled, and added to that of a second division.
// Returns: share of a vein in (0, 1]: 1 for a value of 0, 1/2 for one of +-width.
// Units: value and width in those of the noise.
// Domain: values within +-4; any width, one below 2^-10 counts as that, one above 2^20 as that.
// Outside: anything where the value's square overflows.
// Accuracy: lavapipe 4 ulp; portable 9 ulp
fn veins_fold(value: f32, width: f32) -> f32 {
    let half = clamp(width, VEINS_NARROWEST, VEINS_WIDEST);
    let squared = half * half;
    return min(squared / (squared + value * value), 1.0f);
}

// Density of veined stone: what scattering and absorption coefficient are multiplied by.
// Returns: density between pattern.least and pattern.greatest; the first between veins, the second in their middle. Either may be the greater.
// Units: position in a length, density none.
// Domain: |position| frequency within 32768; width in [1/16, 4], densities in [0, 4], octaves up to 8.
// Outside: as veins_fractal and veins_fold; a width of less is as right as the noise, whose error it magnifies by its inverse.
// Accuracy: lavapipe 4e-4 abs + 1 backward; portable 1e-3 abs + 1 backward
fn veins_density(position: vec3f, pattern: VeinsPattern) -> f32 {
    let value = veins_fractal(position * pattern.frequency, pattern.octaves, pattern.seed);
    let share = veins_fold(value, pattern.width);
    return pattern.least * (1.0f - share) + pattern.greatest * share;
}
