// surroundings: light from far away, the procedural studio or an image.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: the module environment.
//
// A recipe adds: the module environment. The image is bound here.

// The environment is an image instead of the procedural studio. Called for by the user, who
// supplies the image.
override EFFECT_ENVIRONMENT_MAP: bool = false;

@group(0) @binding(1) var environment_map: texture_2d<f32>;

// Radiance that arrives from a direction.
fn surroundings_radiance(direction: vec3f) -> vec3f {
    if (EFFECT_ENVIRONMENT_MAP) {
        // Filtered by hand: 32-bit float textures need not be filterable.
        let texels = environment_texels(environment_uv_from_direction(direction), textureDimensions(environment_map));
        let lower_left = textureLoad(environment_map, texels.lower, 0).rgb;
        let lower_right = textureLoad(environment_map, vec2u(texels.upper.x, texels.lower.y), 0).rgb;
        let upper_left = textureLoad(environment_map, vec2u(texels.lower.x, texels.upper.y), 0).rgb;
        let upper_right = textureLoad(environment_map, texels.upper, 0).rgb;
        let lower = mix(lower_left, lower_right, texels.weight.x);
        let upper = mix(upper_left, upper_right, texels.weight.x);
        return mix(lower, upper, texels.weight.y);
    }
    return environment_studio(direction);
}
