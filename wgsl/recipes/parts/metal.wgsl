// metal: what a metal reflects of its surroundings and of the lights, rough as it is.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: the module split_sum.
//
// A recipe adds: the modules environment, microfacet and split_sum, the part lights. Both tables are bound here; the
// recipe split_sum_tables bakes them.

// A share of the surface is a metal's: it sends no light back diffusely, and its base colour is what it reflects head
// on. Called for by a metallicFactor above 0 of an opaque body.
override EFFECT_METAL: bool = false;

// Levels of the environment beyond the first.
const METAL_LEVELS: f32 = 6.0f;

// The environment by direction, its levels blurred for the roughnesses 0, 1/6, ... 1. Radiance is the colour times
// alpha.
@group(0) @binding(21) var blurred: texture_2d<f32>;
// Repeats along u.
@group(0) @binding(22) var blurred_sampler: sampler;
// Reflectance by split_sum_texel, in red and green.
@group(0) @binding(23) var metal_table: texture_2d<f32>;

// A metal as the eye sees it at a point.
struct Metal {
    // Share of light that it reflects head on.
    f0: vec3f,
    // Slope of its facets.
    alpha: f32,
    // Share of even light that it reflects towards the eye.
    reflectance: vec3f,
    // Factor on what is reflected once.
    compensation: vec3f,
}

fn metal_seen(f0: vec3f, alpha: f32, cosine_eye: f32) -> Metal {
    let place = split_sum_place(cosine_eye, alpha, textureDimensions(metal_table));
    let table = textureSampleLevel(metal_table, blurred_sampler, place, 0.0f).rg;
    return Metal(f0, alpha, split_sum_reflectance(f0, table), split_sum_compensation(f0, table.x + table.y));
}

// Radiance of the surroundings in a direction, blurred for facets of this slope.
fn metal_surroundings(direction: vec3f, alpha: f32) -> vec3f {
    let uv = environment_uv_from_direction(direction);
    let texel = textureSampleLevel(blurred, blurred_sampler, uv, METAL_LEVELS * sqrt(alpha));
    return texel.rgb * texel.a;
}

// Radiance that it reflects from one light towards the eye.
fn metal_highlight(metal: Metal, arrival: LightArrival, normal: vec3f, toward_eye: vec3f) -> vec3f {
    let half = microfacet_half(arrival.direction, toward_eye);
    let fresnel = split_sum_fresnel(metal.f0, dot(half, arrival.direction));
    let once = microfacet_reflectance(normal, arrival.direction, toward_eye, metal.alpha, 1.0f);
    return arrival.irradiance * once * fresnel * metal.compensation;
}
