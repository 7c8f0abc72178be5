// reflection: light and environment that a dielectric surface sends back without letting them in.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: the modules fresnel and microfacet.
//
// A recipe adds: the modules fresnel and microfacet, the parts lights and surroundings. Effects
// belong to a scene, roughness to a material: alpha is the width of the microfacets' slopes, the
// square of the roughness, and 0 for a polished surface.

// Highlights of the lights on a rough surface. Called for by KHR_materials_ior above 1 and a
// roughness above 0.
override EFFECT_MICROFACET: bool = false;
// Reflection of the environment in a polished surface. Called for by KHR_materials_ior above 1 and
// a roughness of 0.
override EFFECT_REFLECTION: bool = false;

// Radiance that a rough surface reflects from one light towards the eye.
fn reflection_highlight(arrival: LightArrival, normal: vec3f, toward_eye: vec3f, index: f32, alpha: f32) -> vec3f {
    let half = microfacet_half(arrival.direction, toward_eye);
    let fresnel = fresnel_dielectric(dot(half, arrival.direction), index);
    return arrival.irradiance * microfacet_reflectance(normal, arrival.direction, toward_eye, alpha, fresnel);
}

// Radiance from inside, with the environment's reflection on top if the surface is polished. The
// share of light that is reflected does not come from inside.
fn reflection_over(radiance: vec3f, normal: vec3f, toward_eye: vec3f, index: f32, alpha: f32) -> vec3f {
    if (alpha == 0.0f) {
        let reflectance = fresnel_dielectric(dot(normal, toward_eye), index);
        return mix(radiance, surroundings_radiance(reflect(-toward_eye, normal)), reflectance);
    }
    return radiance;
}
