// shadow: the share of a light that nothing keeps from a point of a surface, by the lights' maps.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: Williams, "Casting Curved Shadows on Curved Surfaces", 1978; Reeves, Salesin and Cook,
//   "Rendering Antialiased Shadows with Depth Maps", 1987, for comparing before filtering; own: a
//   height in place of a depth (the module reflective_shadow_map).
//
// A recipe adds: the module reflective_shadow_map and the part light_views.

// Visible share in one view of a light, from the four texels around the point, weighted by
// nearness; -1 outside the map.
fn shadow_in_view(layer: u32, position: vec3f, normal: vec3f) -> f32 {
    let size = textureDimensions(maps).x;
    let clip = reflective_shadow_map_clip(views[layer].view, position);
    let place = reflective_shadow_map_texel(clip, f32(size));
    if (any(place < vec2f(0.0f)) || any(place > vec2f(f32(size)))) {
        return -1.0f;
    }
    // As high as a texel is wide: clip.w is the depth in a lamp's map, whose texels grow with the
    // depth, and 1 in a sun's map.
    let bias = 2.0f * views[layer].view.extent * clip.w / f32(size);
    let corner = place - 0.5f;
    let weight = fract(corner);
    let last = i32(size) - 1i;
    let lower = clamp(vec2i(floor(corner)), vec2i(0i), vec2i(last));
    let upper = min(vec2i(floor(corner)) + 1i, vec2i(last));
    let lower_left = shadow_at_texel(vec2i(lower.x, lower.y), layer, position, normal, bias);
    let lower_right = shadow_at_texel(vec2i(upper.x, lower.y), layer, position, normal, bias);
    let upper_left = shadow_at_texel(vec2i(lower.x, upper.y), layer, position, normal, bias);
    let upper_right = shadow_at_texel(vec2i(upper.x, upper.y), layer, position, normal, bias);
    return mix(mix(lower_left, lower_right, weight.x), mix(upper_left, upper_right, weight.x), weight.y);
}

fn shadow_at_texel(texel: vec2i, layer: u32, position: vec3f, normal: vec3f, bias: f32) -> f32 {
    let seen = textureLoad(maps, texel, layer, 0);
    let height = reflective_shadow_map_height(seen.xyz, position, normal);
    return select(0.0f, 1.0f, seen.w < 0.0f || height <= bias);
}

// Visible share in the view of the light that contains the point; 1 if none does.
fn shadow_of_light(light: u32, position: vec3f, normal: vec3f) -> f32 {
    for (var layer = 0u; layer < arrayLength(&views); layer++) {
        if (views[layer].light == light) {
            let visible = shadow_in_view(layer, position, normal);
            if (visible >= 0.0f) {
                return visible;
            }
        }
    }
    return 1.0f;
}
