// screen: what a ray that leaves a body meets in the picture of the bodies that were drawn before.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: the module screen_trace.
//
// A recipe adds: the module screen_trace. Draw all other bodies first, and copy their colour and depth to the
// textures that are bound here.

// Rays that leave meet the bodies that the picture shows. Called for by the user.
override EFFECT_SCREEN_TRACE: bool = false;
// Steps of a ray over the picture, all equally long on the screen.
override SCREEN_STEPS: u32 = 8u;

//+screen_trace {
struct ScreenView {
    // The camera of the picture: that of the bodies that are drawn, or of a larger view around it.
    clip_from_world: mat4x4f,
    // Size of the picture in texels; the textures may be larger.
    size: vec2f,
    // Of the projection: z = scale w + offset.
    scale: f32,
    offset: f32,
    // How far bodies reach behind their front, in units of length.
    thickness: f32,
}

// How the picture was drawn.
@group(0) @binding(6) var<uniform> screen: ScreenView;
// Linear radiance; alpha is 0 where no body is seen.
@group(0) @binding(7) var screen_radiance: texture_2d<f32>;
@group(0) @binding(8) var screen_depth: texture_depth_2d;

// The texel that shows a point in clip coordinates.
fn screen_texel(clip: vec4f) -> vec2u {
    let place = (vec2f(0.5f, -0.5f) * clip.xy / clip.w + 0.5f) * screen.size;
    return vec2u(clamp(place, vec2f(0.0f), screen.size - 1.0f));
}

// 1 / w of the surface that is seen where a point in clip coordinates is.
fn screen_surface(clip: vec4f) -> f32 {
    return screen_trace_inverse_w(textureLoad(screen_depth, screen_texel(clip), 0), screen.scale, screen.offset);
}

// Radiance of the surface that is seen where a world point is; alpha is 0 if there is none.
fn screen_seen(position: vec3f) -> vec4f {
    return textureLoad(screen_radiance, screen_texel(screen.clip_from_world * vec4f(position, 1.0f)), 0);
}

// Distance at which a ray meets a surface of the picture; below 0 if it meets none.
fn screen_distance(position: vec3f, direction: vec3f) -> f32 {
    let start = screen.clip_from_world * vec4f(position, 1.0f);
    let along = screen.clip_from_world * vec4f(direction, 0.0f);
    let reach = screen_trace_reach(start, along);
    if (reach == 0.0f) {
        return -1.0f;
    }
    let end_w = start.w + reach * along.w;
    var distance_before = 0.0f;
    var before = 1.0f / start.w;
    var surface_before = screen_surface(start);
    for (var step = 1u; step <= SCREEN_STEPS; step++) {
        let distance = screen_trace_distance(start.w, end_w, reach, f32(step) / f32(SCREEN_STEPS));
        let clip = start + distance * along;
        let here = 1.0f / clip.w;
        let surface = screen_surface(clip);
        if (screen_trace_meets(before, here, surface, screen.thickness)) {
            if (textureLoad(screen_radiance, screen_texel(clip), 0).a > 0.0f) {
                // Where the ray goes through the surface, if the texel there shows the same one.
                let part = screen_trace_crossing(before, surface_before, here, surface);
                let crossed = distance_before
                    + screen_trace_distance(1.0f / before, clip.w, distance - distance_before, part);
                let there = start + crossed * along;
                let is_same = screen_trace_meets(1.0f / there.w, here, screen_surface(there), screen.thickness);
                return select(distance, crossed, is_same);
            }
        }
        distance_before = distance;
        before = here;
        surface_before = surface;
    }
    return -1.0f;
}
//+screen_trace }
