// The display pass of this example, behind the cookbook's module `srgb`: samples become the pixels of
// a screen.

// Samples along each side of a pixel.
override SAMPLES: u32;

@group(0) @binding(0) var samples: texture_2d<f32>;

// One triangle that covers the target.
@vertex
fn display_vertex(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    return vec4f(4.0f * f32(vertex & 1u) - 1.0f, 4.0f * f32(vertex >> 1u) - 1.0f, 0.0f, 1.0f);
}

// Dark paper with a soft light behind the stone, as `cook render` puts it behind its pictures.
fn backdrop(pixel: vec2f) -> vec3f {
    let size = vec2f(textureDimensions(samples) / SAMPLES);
    let from_light = (pixel - vec2f(0.5f, 0.55f) * size) / min(size.x, size.y);
    let falloff = exp(-3.0f * dot(from_light, from_light));
    return mix(vec3f(0.006f, 0.007f, 0.010f), vec3f(0.055f, 0.062f, 0.078f), falloff);
}

@fragment
fn display_fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let first = vec2u(position.xy) * SAMPLES;
    let behind = backdrop(position.xy);
    var light = vec3f(0.0f);
    for (var row = 0u; row < SAMPLES; row++) {
        for (var column = 0u; column < SAMPLES; column++) {
            let found = textureLoad(samples, first + vec2u(column, row), 0);
            // The tone curve first: a pixel emits the mean of what its samples would emit. The other way
            // round one bright glint among fifteen dark samples makes a white pixel, and edges are jagged.
            light += srgb_tone_curve(found.rgb + (1.0f - found.a) * behind);
        }
    }
    return vec4f(srgb_encode_color(light / f32(SAMPLES * SAMPLES)), 1.0f);
}
