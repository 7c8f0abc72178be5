// fresnel: the share of unpolarised light that an interface between two dielectrics reflects.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0
// Source: Born and Wolf, "Principles of Optics", 7th ed., 1.5.2, eq. (20a), (21a); rearranged as
//   docs/fresnel.md shows. Schlick, "An Inexpensive BRDF Model for Physically-based Rendering",
//   1994, eq. (15).

// Reflectance of a dielectric interface, exact for unpolarised light, with total internal reflection. Each amplitude (x
// - y) / (x + y) is multiplied by (x + y) / (x + y): x^2 - y^2 has a closed form without roots, which does not cancel.
// Returns: reflectance in [0, 1], the mean of the two polarisations; 1 under total internal reflection.
// Units: none. `cosine` is that of the angle of incidence, -dot(normal, incident); `relative_index` n_transmitted /
//   n_incident.
// Domain: relative_index in [1/4, 4]; any cosine, clamped to [0, 1]: below 0, as at a silhouette, it counts as grazing
//   incidence, above 1, by rounding, as normal incidence. relative_index = 1 gives 0, even at grazing incidence.
// Outside: finite and in [0, 1] for relative_index in [2^-30, 2^30].
// Accuracy: lavapipe 19.5 ulp + 0.92 backward; portable 128 ulp + 8 backward; order kept
fn fresnel_dielectric(cosine: f32, relative_index: f32) -> f32 {
    // n^2 - 1 as two factors: the difference of two nearby floats is exact, the difference of their
    // squares is not.
    let m = (relative_index - 1.0f) * (relative_index + 1.0f);
    if m == 0.0f {
        return 0.0f;
    }
    let c = clamp(cosine, 0.0f, 1.0f);
    let sine_squared = (1.0f - c) * (1.0f + c);
    let n_squared = relative_index * relative_index;
    let nc_squared = n_squared * c * c;
    // n times the cosine of the angle of refraction; 0 from the critical angle on. Of the ways to
    // write m + c^2, this one keeps both terms small if their sum is small. In m + c^2 itself, with
    // a small n, c^2 would be rounded near 1 although the sum is only n^2.
    let g = sqrt(max(nc_squared + m * sine_squared, 0.0f));
    // |amplitude| = 1 is total reflection. Each numerator exceeds its denominator beyond the
    // critical angle, and never does so on this side of it. Taking the larger of the two as the
    // denominator therefore replaces the branch and also bounds the amplitude.
    let s_root = c + g;
    let s = m / max(s_root * s_root, abs(m));
    let p_root = n_squared * c + g;
    let p_numerator = m * (nc_squared - sine_squared);
    let p = p_numerator / max(p_root * p_root, abs(p_numerator));
    // WGSL allows a quotient of equal values to exceed 1.
    return min(0.5f * (s * s + p * p), 1.0f);
}

// Reflectance at normal incidence, the F0 of shading models.
// Returns: ((n - 1) / (n + 1))^2, in [0, 0.36].
// Units: none; `relative_index` is n_transmitted / n_incident. Its inverse gives the same
//   reflectance.
// Domain: relative_index in [1/4, 4].
// Outside: as the formula gives, in [0, 1] for every positive relative_index up to 2^120.
// Accuracy: lavapipe 6 ulp; portable 20 ulp; order kept
fn fresnel_normal_incidence(relative_index: f32) -> f32 {
    let amplitude = (relative_index - 1.0f) / (relative_index + 1.0f);
    return min(amplitude * amplitude, 1.0f);
}

// Schlick's approximation, the cheap rung: a fifth power joins the exact value at normal incidence to 1
// at grazing incidence. It uses the smaller cosine, in the thinner medium: from the denser side the
// reflectance is 1 from the critical angle on.
// Returns: reflectance in [0, 1]; 1 under total internal reflection.
// Units: the same as for fresnel_dielectric.
// Domain: the same as for fresnel_dielectric. relative_index = 1 gives (1 - cosine)^5 instead of 0: the
//   approximation does not vanish when the interface does.
// Outside: finite and in [0, 1] for relative_index in [2^-30, 2^30].
// Accuracy: lavapipe 10 ulp + 2 backward; portable 32 ulp + 16 backward
fn fresnel_schlick(cosine: f32, relative_index: f32) -> f32 {
    let m = (relative_index - 1.0f) * (relative_index + 1.0f);
    let c = clamp(cosine, 0.0f, 1.0f);
    let sine_squared = (1.0f - c) * (1.0f + c);
    let nc = relative_index * c;
    let cosine_transmitted = sqrt(max(nc * nc + m * sine_squared, 0.0f)) / relative_index;
    let rest = 1.0f - min(c, cosine_transmitted);
    let rest_squared = rest * rest;
    let normal_incidence = fresnel_normal_incidence(relative_index);
    return min(normal_incidence + (1.0f - normal_incidence) * (rest_squared * rest_squared * rest), 1.0f);
}
