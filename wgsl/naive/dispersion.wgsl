// dispersion: forms found elsewhere, kept to show where they fail. They follow the module and use its names.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0

// The derivative of refraction in its usual form from eq. (6), with eta = 1 / n. Kept for
// comparison.
// Returns: the gradient after refraction.
// Units: as for dispersion_refract.
// Domain: as for dispersion_refract if the ray is refracted, away from the critical angle and from
//   relative_index = 1 at grazing incidence.
// Outside: infinite at the critical angle, not a number under total internal reflection.
// Accuracy: naive
fn dispersion_refract_naive(
    direction: vec3f,
    gradient: vec3f,
    normal: vec3f,
    relative_index: f32,
    relative_index_slope: f32,
) -> vec3f {
    let eta = 1.0f / relative_index;
    let eta_slope = -relative_index_slope * eta * eta;
    let cosine = -dot(normal, direction);
    let cosine_slope = -dot(normal, gradient);
    let squared_sine = 1.0f - cosine * cosine;
    let root = sqrt(1.0f - eta * eta * squared_sine);
    let root_slope = (eta * eta * cosine * cosine_slope - eta * eta_slope * squared_sine) / root;
    return eta * gradient + eta_slope * direction + (eta_slope * cosine + eta * cosine_slope - root_slope) * normal;
}

// Eq. (10) as printed.
// Returns: unit vector.
// Units: none; unit vectors.
// Domain: |direction| = |refracted| = 1, at least 1e-3 apart.
// Outside: noise of unit length where they nearly coincide; not a number where they do.
// Accuracy: naive
fn dispersion_paper_enter_naive(direction: vec3f, refracted: vec3f) -> vec3f {
    return normalize(refracted - direction);
}

// Eq. (11) for a refraction: the normalized difference of the refracted ray and one turned towards the spread, its
// length restored to first order. The first chooses the branch; the second, totally reflected, follows the surface.
// Returns: unit vector; 0 if the difference is 0, as for a spread of 0.
// Units: none; unit vectors and a ratio.
// Domain: |direction| = |normal| = 1, |spread| = 1 or 0, normal . direction < 0, relative_index in [1/4, 4], epsilon
//   in [1e-4, 1e-3].
// Outside: finite. A difference of f32 directions: at 2e-4 noise of 1e-3, more at grazing incidence and near
//   relative_index = 1.
// Accuracy: naive
fn dispersion_paper_refract(
    direction: vec3f,
    spread: vec3f,
    normal: vec3f,
    relative_index: f32,
    epsilon: f32,
) -> vec3f {
    let shifted = direction + epsilon * (spread - dot(direction, spread) * direction);
    let cosine = -dot(normal, direction);
    let cosine_shifted = -dot(normal, shifted);
    let excess = (relative_index - 1.0f) * (relative_index + 1.0f);
    let radicand = excess + cosine * cosine;
    if (radicand < 0.0f) {
        return dispersion_paper_reflect(direction, spread, normal, epsilon);
    }
    let radicand_shifted = max(excess + cosine_shifted * cosine_shifted, 0.0f);
    let refracted = (direction + (cosine - sqrt(radicand)) * normal) / relative_index;
    let refracted_shifted = (shifted + (cosine_shifted - sqrt(radicand_shifted)) * normal) / relative_index;
    let difference = refracted_shifted - refracted;
    let squared = dot(difference, difference);
    if (squared == 0.0f) {
        return vec3f(0.0f);
    }
    return difference / sqrt(squared);
}

// Eq. (11) for a refraction as printed, with the built-in `refract` for eq. (6).
// Returns: unit vector.
// Units: as for dispersion_paper_refract.
// Domain: as for dispersion_paper_refract, with spread . direction = 0 and both rays refracted.
// Outside: not a number for a spread of 0; where one ray is totally reflected, the other's
//   direction; where both are, not a number.
// Accuracy: naive
fn dispersion_paper_refract_naive(
    direction: vec3f,
    spread: vec3f,
    normal: vec3f,
    relative_index: f32,
    epsilon: f32,
) -> vec3f {
    let eta = 1.0f / relative_index;
    return normalize(refract(direction + epsilon * spread, normal, eta) - refract(direction, normal, eta));
}

// Eq. (11) for a reflection. Reflection is linear, so this is dispersion_reflect of the spread,
// except for noise and for the spread's part along the ray.
// Returns: unit vector; 0 if the difference is 0, as for a spread of 0.
// Units: none; unit vectors.
// Domain: |direction| = |normal| = 1, |spread| = 1 or 0, epsilon in [1e-4, 1e-3].
// Outside: finite.
// Accuracy: naive
fn dispersion_paper_reflect(direction: vec3f, spread: vec3f, normal: vec3f, epsilon: f32) -> vec3f {
    let shifted = direction + epsilon * (spread - dot(direction, spread) * direction);
    let difference = reflect(shifted, normal) - reflect(direction, normal);
    let squared = dot(difference, difference);
    if (squared == 0.0f) {
        return vec3f(0.0f);
    }
    return difference / sqrt(squared);
}

// Eq. (12): the direction at another frequency. It contains a length, the path through the stone, but no index of
// refraction, so the same stone modelled in other units disperses differently.
// Returns: unit direction; `strength`, our addition, is 1 in the paper; others are fitted to material and model size.
// Units: `distance` in the model's units, from where the ray enters to where it leaves; `frequency_ratio` is the
//   paper's lambda / lambda_0, which are frequencies: wavelength_0 / wavelength.
// Domain: |direction| = 1, |spread| = 1 or 0, |spread . direction| <= 3/4, |strength distance (frequency_ratio - 1)|
//   up to 1e18.
// Outside: not a number where the sum is 0.
// Accuracy: naive
fn dispersion_paper_direction(
    direction: vec3f,
    spread: vec3f,
    distance: f32,
    frequency_ratio: f32,
    strength: f32,
) -> vec3f {
    return normalize(direction + strength * distance * (frequency_ratio - 1.0f) * spread);
}
