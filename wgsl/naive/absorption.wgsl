// absorption: forms found elsewhere, kept to show where they fail. They follow the module and use its names.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0

// The coefficient with the built-in logarithm, the obvious way to write it.
// Returns: -log(attenuation_color) / attenuation_distance.
// Units: the inverse of the unit of `attenuation_distance`.
// Domain: colours in [0.01, 0.9], distances in [1e-3, 1e3].
// Outside: near a colour of 1 off by up to its whole value; infinite or not a number for a colour
//   or a distance of 0.
// Accuracy: naive
fn absorption_coefficient_naive(attenuation_color: vec3f, attenuation_distance: f32) -> vec3f {
    return -log(attenuation_color) / attenuation_distance;
}

// The transmittance as given in KHR_materials_volume: the colour raised to the ratio of the distances.
// Returns: pow(attenuation_color, distance / attenuation_distance).
// Units: none; both distances in the same unit.
// Domain: colours in [0.01, 0.9], attenuation_distance in [1e-3, 1e3], distance at most 4 times
//   attenuation_distance.
// Outside: not a number for two distances of 0; for a colour of 0 at a distance of 0 the device's 2^(0 log2
//   0); along many attenuation distances the error of the logarithm in pow is multiplied by their number.
// Accuracy: naive
fn absorption_transmittance_naive(attenuation_color: vec3f, attenuation_distance: f32, distance: f32) -> vec3f {
    return pow(attenuation_color, vec3f(distance / attenuation_distance));
}
