// stone_shadow: the share of a light that clear stones let through to a point, per channel.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: own.
//
// A recipe adds: the module reflective_shadow_map and the part light_views. The recipe colored_shadow
// draws what is bound here, from the same views.

// Light that clear stones let through and colour. Called for by a clear stone between a light and the
// surface.
override EFFECT_COLORED_SHADOW: bool = false;

// Optical depth of the way through all stones in red, green and blue, and where the first one begins,
// from 0 at the view's nearest depth to 1 at its farthest.
@group(0) @binding(10) var stones: texture_2d_array<f32>;

// Transmittance of one texel for a point at this depth.
fn stone_shadow_at_texel(texel: vec2i, layer: u32, depth: f32) -> vec3f {
    let seen = textureLoad(stones, texel, layer, 0);
    return select(vec3f(1.0f), min(exp(-seen.rgb), vec3f(1.0f)), depth > seen.a);
}

// Transmittance in the view of the light that contains the point; 1 if none does.
fn stone_shadow_of_light(light: u32, position: vec3f) -> vec3f {
    let size = textureDimensions(stones).x;
    for (var layer = 0u; layer < arrayLength(&views); layer++) {
        if (views[layer].light != light) {
            continue;
        }
        let view = views[layer].view;
        let clip = reflective_shadow_map_clip(view, position);
        let place = reflective_shadow_map_texel(clip, f32(size));
        if (any(place < vec2f(0.0f)) || any(place > vec2f(f32(size)))) {
            continue;
        }
        let depth = select(clip.z, (clip.w - view.near) / (view.far - view.near), view.lamp == 1u);
        let corner = place - 0.5f;
        let weight = fract(corner);
        let last = i32(size) - 1i;
        let lower = clamp(vec2i(floor(corner)), vec2i(0i), vec2i(last));
        let upper = min(vec2i(floor(corner)) + 1i, vec2i(last));
        let lower_left = stone_shadow_at_texel(vec2i(lower.x, lower.y), layer, depth);
        let lower_right = stone_shadow_at_texel(vec2i(upper.x, lower.y), layer, depth);
        let upper_left = stone_shadow_at_texel(vec2i(lower.x, upper.y), layer, depth);
        let upper_right = stone_shadow_at_texel(vec2i(upper.x, upper.y), layer, depth);
        return mix(mix(lower_left, lower_right, weight.x), mix(upper_left, upper_right, weight.x), weight.y);
    }
    return vec3f(1.0f);
}
