// lights: points, spots and suns, in a list of any length.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: own; the three kinds are those of glTF's KHR_lights_punctual without a range.
//
// A recipe adds: its own shading. Nothing here casts a shadow. The list is bound here; if there are
// no lights, it holds one black light.

// Lights that shine into a cone. Called for by a spot light of KHR_lights_punctual.
override EFFECT_SPOT: bool = false;

struct Light {
    // Unit vector towards a sun, or position of a point or spot light.
    place: vec3f,
    // 0 for a sun, 1 for a point or spot light.
    point: f32,
    // Linear RGB: the irradiance of a sun on a surface facing it, the radiant intensity of a point
    // light, the radiant intensity of a spot light along its axis.
    power: vec3f,
    // Cosine of the angle from the axis at which a spot light ends; -1 for other lights.
    edge: f32,
    // Unit vector along a spot light's axis, away from the light; 0 for other lights.
    axis: vec3f,
    // 1 / (cosine of a spot light's inner angle - edge); 1 for other lights.
    slope: f32,
}

@group(0) @binding(2) var<storage, read> lights: array<Light>;

struct LightArrival {
    // Unit vector towards the light.
    direction: vec3f,
    // Irradiance on a surface facing the light, linear RGB.
    irradiance: vec3f,
}

// Radiant intensity of a lamp, or irradiance of a sun; `direction` is the unit vector towards it.
fn light_power(light: Light, direction: vec3f) -> vec3f {
    var power = light.power;
    if (EFFECT_SPOT) {
        let share = clamp((-dot(direction, light.axis) - light.edge) * light.slope, 0.0f, 1.0f);
        power *= share * share;
    }
    return power;
}

// Light that arrives from one light. Exactly at the position of a point light there is no
// direction, and nothing arrives.
fn light_arrival(light: Light, position: vec3f) -> LightArrival {
    let way = light.place - light.point * position;
    let squared = dot(way, way);
    if (squared < 1.1754944e-38f) {
        return LightArrival(vec3f(0.0f), vec3f(0.0f));
    }
    let direction = way * inverseSqrt(squared);
    return LightArrival(direction, light_power(light, direction) / mix(1.0f, squared, light.point));
}
