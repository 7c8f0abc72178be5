// lights: points, spots and suns, in a list of any length.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: own; the three kinds are those of glTF's KHR_lights_punctual without a range.
//
// A recipe adds: its own way to shade. Nothing here casts a shadow. The list is bound here; it has one black light where there is none.

// Lights that shine into a cone. Called for by a spot of KHR_lights_punctual.
override EFFECT_SPOT: bool = false;  //+spot

struct Light {
    // Towards a sun, unit; or where a point or spot is.
    place: vec3f,
    // 0 for a sun, 1 for a point or spot.
    point: f32,
    // Linear RGB: a sun's irradiance square to it, a point's radiant intensity, a spot's about its axis.
    power: vec3f,
    // Cosine of the angle from the axis at which a spot ends; -1 for the others.
    edge: f32,
    // Unit, along a spot's axis, away from it; 0 for the others.
    axis: vec3f,
    // One over what the cosine of a spot's inner angle has beyond the edge; 1 for the others.
    slope: f32,
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
    let direction = way * inverseSqrt(squared);
    var power = light.power;
    if (EFFECT_SPOT) {  //+spot
        let share = clamp((-dot(direction, light.axis) - light.edge) * light.slope, 0.0f, 1.0f);  //+spot
        power *= share * share;  //+spot
    }  //+spot
    return LightArrival(direction, power / mix(1.0f, squared, light.point));
}
