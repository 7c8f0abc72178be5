// refraction: forms found elsewhere, kept to show where they fail. They follow the module and use its names.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0

// The radicand as printed in eq. (6), with eta = 1 / n.
// Returns: cos² of the angle of refraction; negative under total internal reflection.
// Units: none; `cosine` is the cosine of the angle of incidence, `relative_index` a ratio.
// Domain: cosine in [0, 1], relative_index in [1/4, 4], away from relative_index = 1 at grazing
//   incidence.
// Outside: there the sign, and with it the choice between refraction and reflection, is rounding
//   noise.
// Accuracy: naive
fn refraction_radicand_naive(cosine: f32, relative_index: f32) -> f32 {
    let eta = 1.0f / relative_index;
    return 1.0f - eta * eta * (1.0f - cosine * cosine);
}

// Refraction as printed in eq. (6), with a double cross product. Kept for comparison.
// Returns: RefractionHit; the reflected direction if the radicand is negative.
// Units: none; unit vectors and a ratio.
// Domain: |incident| = |normal| = 1, normal . incident < 0, relative_index in [1/4, 4], away from
//   relative_index = 1 at grazing incidence.
// Outside: near there the direction is off by up to the square root of the rounding unit, and
//   `total` is wrong for some rays.
// Accuracy: naive
fn refraction_refract_naive(incident: vec3f, normal: vec3f, relative_index: f32) -> RefractionHit {
    let eta = 1.0f / relative_index;
    let cosine = -dot(normal, incident);
    let radicand = 1.0f - eta * eta * (1.0f - cosine * cosine);
    if (radicand < 0.0f) {
        return RefractionHit(incident + 2.0f * cosine * normal, true);
    }
    return RefractionHit(-eta * cross(normal, cross(normal, incident)) - sqrt(radicand) * normal, false);
}

// The usual form in shaders: the built-in `refract`, normalized. Under total internal reflection
// `refract` returns the zero vector, which has no direction.
// Returns: RefractionHit; `total` is always false.
// Units: none; unit vectors and a ratio.
// Domain: |incident| = |normal| = 1, normal . incident < 0, relative_index in [1/4, 4], and no
//   total internal reflection.
// Outside: not a number under total internal reflection.
// Accuracy: naive
fn refraction_refract_builtin(incident: vec3f, normal: vec3f, relative_index: f32) -> RefractionHit {
    return RefractionHit(normalize(refract(incident, normal, 1.0f / relative_index)), false);
}
