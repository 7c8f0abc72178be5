// glints: the discs of suns and lamps, which light that leaves a clear body comes from.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: own; the radiance of a disc is its irradiance over π and the square of its angle's sine.
//
// A recipe adds: the part lights. Nothing here casts a shadow.

// Light that leaves a clear body, or that its surface reflects, shows the discs of lights. Called for by
// KHR_lights_punctual.
override EFFECT_LIGHT: bool = false;

//+light {
// First the angle between the rays of neighbouring samples, in radians: a disc's edge is as wide. Then for
// each light its radius, or for a sun the sine of the angle that its radius takes up.
@group(0) @binding(16) var<storage, read> glints: array<f32>;

// Radiance of the discs that are seen from a position in a direction. The rays of two samples part on the
// whole way from the eye, which counts as straight.
fn glints_radiance(position: vec3f, direction: vec3f, eye: vec3f) -> vec3f {
    let way = length(position - eye);
    var radiance = vec3f(0.0f);
    for (var number = 0u; number < arrayLength(&lights); number++) {
        let light = lights[number];
        let arrival = light_arrival(light, position);
        let distance = mix(1.0f, max(length(light.place - position), 1e-30f), light.point);
        let footprint = glints[0] * (1.0f + light.point * way / distance);
        let sine = min(glints[number + 1u] / distance, 1.0f);
        // Wider than a footprint, so that none falls between samples; what it sends stays the same. With
        // an edge that falls linearly over a footprint, a disc of this radius has this size.
        let wide = max(sine, footprint);
        let size = 3.14159265f * (wide * wide + footprint * footprint / 12.0f);
        let aside = length(cross(arrival.direction, direction));
        let seen = clamp((wide - aside) / footprint + 0.5f, 0.0f, 1.0f);
        let ahead = select(0.0f, 1.0f, dot(arrival.direction, direction) > 0.0f);
        radiance += ahead * seen / size * arrival.irradiance;
    }
    return radiance;
}
//+light }
