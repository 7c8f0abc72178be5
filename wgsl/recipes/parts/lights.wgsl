// lights: points and suns, in a list of any length.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: own; the two kinds are those of glTF's KHR_lights_punctual without a range.
//
// A recipe adds: its own way to shade. Nothing here casts a shadow. The list is bound here; it has one black light where there is none.

struct Light {
    // Towards a sun, unit; or where a point is.
    place: vec3f,
    // 0 for a sun, 1 for a point.
    point: f32,
    // Linear RGB: a sun's irradiance square to it, a point's radiant intensity.
    power: vec3f,
}

@group(0) @binding(2) var<storage, read> lights: array<Light>;

struct LightArrival {
    // Unit, towards the light.
    direction: vec3f,
    // On a surface square to it, linear RGB.
    irradiance: vec3f,
}

// What arrives from a light. At the very place of a point light there is no direction, and nothing arrives.
fn light_arrival(light: Light, position: vec3f) -> LightArrival {
    let way = light.place - light.point * position;
    let squared = dot(way, way);
    if (squared < 1.1754944e-38f) {
        return LightArrival(vec3f(0.0f), vec3f(0.0f));
    }
    return LightArrival(way * inverseSqrt(squared), light.power / mix(1.0f, squared, light.point));
}
