// Value noise: random values at the corners of a lattice, mixed smoothly between them.

struct Sample {
    value: f32,
    slope: vec2f,
}

fn noise_hash(corner: vec2i) -> u32 {
    var bits = u32(corner.x) * 0x9e3779b9u + u32(corner.y) * 0x85ebca6bu;
    bits = (bits ^ (bits >> 15u)) * 0x2c1b3c6du;
    bits = (bits ^ (bits >> 12u)) * 0x297a2d39u;
    return bits ^ (bits >> 15u);
}

// In [0, 1): the 24 high bits, which an f32 holds.
fn noise_corner(corner: vec2i) -> f32 {
    return f32(noise_hash(corner) >> 8u) * 5.9604645e-8f;
}

// Value and slope at `place`: quintic fading, so that the slope is continuous.
fn noise_sample(place: vec2f) -> Sample {
    let cell = floor(place);
    let t = place - cell;
    let corner = vec2i(cell);
    let a = noise_corner(corner);
    let b = noise_corner(corner + vec2i(1, 0));
    let c = noise_corner(corner + vec2i(0, 1));
    let d = noise_corner(corner + vec2i(1, 1));
    let fade = t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);
    let rise = 30.0f * t * t * (t * (t - 2.0f) + 1.0f);
    let twist = a - b - c + d;
    return Sample(
        a + (b - a) * fade.x + (c - a) * fade.y + twist * fade.x * fade.y,
        rise * (vec2f(b, c) - a + twist * fade.yx),
    );
}

@group(0) @binding(0) var<uniform> scale: f32;
@group(0) @binding(1) var<storage, read_write> heights: array<f32>;

@compute @workgroup_size(64)
fn fill(@builtin(global_invocation_id) id: vec3u) {
    if (id.x < arrayLength(&heights)) {
        heights[id.x] = noise_sample(vec2f(f32(id.x) * scale, 0.5f)).value;
    }
}
