// display: supersamples exposed, put before a backdrop and tone-mapped one by one, then averaged and encoded.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: IEC 61966-2-1:1999 (encoding); Khronos PBR Neutral tone mapper.
// requires: srgb
//
// sRGB is encoded here rather than by an `*-srgb` target, so that every driver rounds in the same
// way.
//
// The tone curve comes before the average: a pixel of the display emits the mean of the light that
// its samples would emit. After the average the curve would come too late: one sample of radiance
// 20 among fifteen dark ones has a mean of 1.25, which is almost white, and a bright edge becomes a
// staircase. The result is that of averaging radiance with each sample weighted by the ratio of its
// curve's value to its radiance.

// Samples along each side of a pixel.
override SAMPLES: u32 = 4u;
// Whether bodies stand before the backdrop; without it, alpha is the share of the pixel that they cover.
override BACKDROP: bool = true;

struct DisplayFrame {
    // Start of this tile in the picture, and size of the picture, in pixels.
    tile: vec2f,
    size: vec2f,
    // Factor for radiance before the tone curve.
    exposure: f32,
}

@group(0) @binding(0) var<uniform> frame: DisplayFrame;
@group(0) @binding(1) var samples: texture_2d<f32>;

struct DisplayOutput {
    // Plain mean of linear radiance before the exposure, without the backdrop; alpha is the share
    // of covered samples.
    @location(0) linear: vec4f,
    // Mean of the tone-mapped samples, encoded, opaque; without the backdrop that of the covered ones, with
    // straight alpha.
    @location(1) encoded: vec4f,
}

// One triangle that covers the target.
@vertex
fn display_vertex(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32(vertex & 1u), f32(vertex >> 1u));
    return vec4f(4.0f * corner - 1.0f, 0.0f, 1.0f);
}

// A backdrop of dark seamless paper, with a soft light behind the stone that falls off towards the
// picture's edges. Linear RGB.
fn display_backdrop(pixel: vec2f) -> vec3f {
    let shorter = min(frame.size.x, frame.size.y);
    let from_light = (pixel - vec2f(0.5f, 0.55f) * frame.size) / shorter;
    let falloff = exp(-3.0f * dot(from_light, from_light));
    return mix(vec3f(0.006f, 0.007f, 0.010f), vec3f(0.055f, 0.062f, 0.078f), falloff);
}

// The picture of bodies alone: the mean of the light that covers a pixel, and how much of it is covered.
fn display_covered(pixel: vec2u) -> DisplayOutput {
    var radiance = vec4f(0.0f);
    var light = vec4f(0.0f);
    for (var row = 0u; row < SAMPLES; row++) {
        for (var column = 0u; column < SAMPLES; column++) {
            let found = textureLoad(samples, pixel * SAMPLES + vec2u(column, row), 0);
            radiance += found;
            if (found.a > 0.0f) {
                light += found.a * vec4f(srgb_tone_curve(frame.exposure * found.rgb / found.a), 1.0f);
            }
        }
    }
    let count = f32(SAMPLES * SAMPLES);
    let mean = light.rgb / select(1.0f, light.a, light.a > 0.0f);
    return DisplayOutput(radiance / count, vec4f(srgb_encode_color(mean), light.a / count));
}

@fragment
fn display_fragment(@builtin(position) position: vec4f) -> DisplayOutput {
    let pixel = vec2u(position.xy);
    if (!BACKDROP) {
        return display_covered(pixel);
    }
    let behind = display_backdrop(frame.tile + position.xy);
    var radiance = vec4f(0.0f);
    var light = vec3f(0.0f);
    for (var row = 0u; row < SAMPLES; row++) {
        for (var column = 0u; column < SAMPLES; column++) {
            let found = textureLoad(samples, pixel * SAMPLES + vec2u(column, row), 0);
            radiance += found;
            light += srgb_tone_curve(frame.exposure * found.rgb + (1.0f - found.a) * behind);
        }
    }
    let count = f32(SAMPLES * SAMPLES);
    return DisplayOutput(radiance / count, vec4f(srgb_encode_color(light / count), 1.0f));
}
