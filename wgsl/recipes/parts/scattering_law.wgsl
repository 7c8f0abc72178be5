// scattering_law: the angular law of light that a surface of scattering matter sends back, as factors on Lambert's law.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: the modules half_space and fresnel.
//
// A recipe adds: the modules fresnel and half_space. The host computes the matter of each material
// once.

// The law of a half space of scattering matter in place of Lambert's, with the boundary's Fresnel
// transmission if the surface reflects. Called for by a material that scatters.
override EFFECT_HALF_SPACE: bool = false;

struct ScatteringLaw {
    // The root of 1 - albedo of each channel, below 1.
    gamma: vec3f,
    // Index of refraction of the boundary, relative to the medium outside; 1 if the surface reflects
    // nothing.
    index: f32,
    // half_space_gain of each channel.
    gain: vec3f,
    // half_space_edge of the index.
    edge: f32,
    // pi over the reflectance that the base color stands for.
    light: vec3f,
    // 1 if the recipe takes away itself what the boundary reflects of the light towards the eye, else
    // 0.
    polished: f32,
    // Factor of scattering_law_around, which gives it the mean that the law has.
    around: vec3f,
    // Factor of scattering_law_inside, which gives it the mean 1.
    inside: vec3f,
}

// Share of the light that passes the boundary in this direction.
fn scattering_law_passed(cosine: f32, law: ScatteringLaw) -> f32 {
    return 1.0f - fresnel_dielectric(cosine, law.index);
}

// Share of the light that passes the boundary towards the eye, unless the recipe takes that into account.
fn scattering_law_seen(cosine_eye: f32, law: ScatteringLaw) -> f32 {
    return max(scattering_law_passed(cosine_eye, law), law.polished);
}

// Factor for light that has entered at these cosines, one per channel.
fn scattering_law_of_light(cosine_eye: f32, cosines: vec3f, law: ScatteringLaw) -> vec3f {
    let passed = vec3f(
        scattering_law_passed(cosines.x, law),
        scattering_law_passed(cosines.y, law),
        scattering_law_passed(cosines.z, law),
    );
    let returned = vec3f(
        half_space_dielectric(cosine_eye, cosines.x, law.gamma.x, law.index, law.edge, law.gain.x),
        half_space_dielectric(cosine_eye, cosines.y, law.gamma.y, law.index, law.edge, law.gain.y),
        half_space_dielectric(cosine_eye, cosines.z, law.gamma.z, law.index, law.edge, law.gain.z),
    );
    return law.light * scattering_law_seen(cosine_eye, law) * passed * returned;
}

// Factor for light from all around: by reciprocity what matter reflects of light from the eye.
fn scattering_law_around(cosine_eye: f32, law: ScatteringLaw) -> vec3f {
    let inside = half_space_refract(cosine_eye, law.index);
    return law.around * scattering_law_seen(cosine_eye, law) * vec3f(
        half_space_directional(inside, law.gamma.x),
        half_space_directional(inside, law.gamma.y),
        half_space_directional(inside, law.gamma.z),
    );
}

// Factor for light that comes from deep inside.
fn scattering_law_inside(cosine_eye: f32, law: ScatteringLaw) -> vec3f {
    let inside = half_space_refract(cosine_eye, law.index);
    return law.inside * scattering_law_seen(cosine_eye, law) * vec3f(
        half_space_exit(inside, law.gamma.x),
        half_space_exit(inside, law.gamma.y),
        half_space_exit(inside, law.gamma.z),
    );
}
