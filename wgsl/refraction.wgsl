// refraction: a ray refracted at a plane interface, with total internal reflection as an explicit result.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0
// Source: Imagire, "Proxy Geometry Gem Rendering", eq. (6), (7); Born and Wolf, Principles of
//   Optics, 7th ed., section 1.5.
//
// `relative_index` is n = n_transmitted / n_incident, the paper's 1 / eta: 2.417 into a diamond,
// 1 / 2.417 out of it. `normal` is the unit normal on the side from which the ray arrives.

struct RefractionHit {
    // Unit direction of the refracted ray, or of the reflected ray if nothing is refracted.
    direction: vec3f,
    // True under total internal reflection: all light stays on the incident side.
    total: bool,
}

// Relative index of refraction across an interface, the reciprocal of the paper's eta, eq. (7).
// Returns: index_transmitted / index_incident.
// Units: none.
// Domain: both indices in [1, 4].
// Outside: the quotient, while index_incident is not 0.
// Accuracy: lavapipe 0.5 ulp; portable 2.5 ulp
fn refraction_relative_index(index_incident: f32, index_transmitted: f32) -> f32 {
    return index_transmitted / index_incident;
}

// Mirror direction of `incident` at a plane with the normal `normal`. The normal may point to
// either side.
// Returns: unit direction of the reflected ray.
// Units: none; unit vectors.
// Domain: |incident| = |normal| = 1.
// Outside: for other lengths the linear map r - 2 (n . r) n, which then is no reflection.
// Accuracy: lavapipe 9 ulp; portable 15 ulp
fn refraction_reflect(incident: vec3f, normal: vec3f) -> vec3f {
    return incident - 2.0f * dot(normal, incident) * normal;
}

// Radicand of eq. (6), the squared cosine of the angle of refraction. With m = (n - 1)(n + 1) it is
// (m + c²) / n². The difference n - 1 is exact in f32 near n = 1, where 1 - eta² (1 - c²) cancels
// to rounding noise.
// Returns: cos² of the angle of refraction; negative under total internal reflection.
// Units: none; `cosine` is the cosine of the angle of incidence, `relative_index` a ratio.
// Domain: cosine in [0, 1], relative_index in [1/4, 4].
// Outside: the same quotient; finite for |cosine| < 1e9 and relative_index in [1e-9, 1e18].
// Accuracy: lavapipe 5 ulp + 2 backward; portable 12 ulp + 4 backward
fn refraction_radicand(cosine: f32, relative_index: f32) -> f32 {
    let excess = (relative_index - 1.0f) * (relative_index + 1.0f);
    return (excess + cosine * cosine) / (relative_index * relative_index);
}

// Refracts `incident` at a plane with the normal `normal`, or reflects it if refraction is impossible:
// eq. (6), with its difference c - g written as -m / (c + g), which does not cancel as n -> 1.
// Returns: RefractionHit; `direction` is a unit vector in both branches.
// Units: none; unit vectors and a ratio.
// Domain: |incident| = |normal| = 1, normal . incident <= 0, relative_index in [1/4, 4].
// Outside: a normal that faces away from the ray is taken to be at grazing incidence (c = 0): finite,
//   but not unit.
// Accuracy: lavapipe direction 88 ulp + 8 backward, total 8 backward;
//   portable direction 148 ulp + 16 backward, total 16 backward
fn refraction_refract(incident: vec3f, normal: vec3f, relative_index: f32) -> RefractionHit {
    let cosine = max(-dot(normal, incident), 0.0f);
    let excess = (relative_index - 1.0f) * (relative_index + 1.0f);
    let radicand = excess + cosine * cosine;
    if (radicand < 0.0f) {
        return RefractionHit(incident + 2.0f * cosine * normal, true);
    }
    if (excess == 0.0f) {
        // Equal indices do not bend the ray. This case is handled separately because the quotient
        // below would be 0 / 0 at grazing incidence.
        return RefractionHit(incident, false);
    }
    let bend = excess / (cosine + sqrt(radicand));
    return RefractionHit((incident - bend * normal) / relative_index, false);
}
