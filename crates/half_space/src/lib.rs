//! Mirror of `wgsl/half_space.wgsl`: the law by which light enters and leaves a half space of
//! scattering matter. The WGSL file states the units, domain and accuracy of each function. This file
//! follows it line by line.
//!
//! ```
//! use lapidary_half_space::{directional, edge, entered, gamma, gamma_of_reflectance, reflectance};
//!
//! // Chandrasekhar's values for an albedo of single scattering of 0.9.
//! let matter = gamma(0.9, 0.0);
//! assert!((directional(1.0, matter) - 0.414_947).abs() < 1e-4);
//! assert!((reflectance(matter) - 0.478_024).abs() < 1e-4);
//! assert!((gamma_of_reflectance(reflectance(matter)) - matter).abs() < 1e-5);
//! // Water reflects 47 % of diffuse light from inside. Matter that absorbs nothing returns all.
//! assert!((edge(1.33).powi(2) - 0.472).abs() < 1e-3);
//! assert_eq!(entered(0.0, edge(1.33)), 1.0);
//! ```

#[cfg(feature = "formulas")]
pub mod formulas;
pub mod oracle;

use glam::Vec2;

/// Cosines below this count as it.
pub const HALF_SPACE_GRAZING: f32 = 1e-18;
/// Shares of light that add up to less than this count as it.
pub const HALF_SPACE_NO_LIGHT: f32 = 1e-30;
/// The least share of scattered light that counts as turned.
pub const HALF_SPACE_LEAST_TURNED: f32 = 0.001;
/// The largest relative index.
pub const HALF_SPACE_DENSEST: f32 = 4.0;
/// Upper limit of the edge.
pub const HALF_SPACE_LAST_EDGE: f32 = 0.981;

/// Returns gamma of matter whose scattering has the mean cosine `anisotropy`.
pub fn gamma(albedo: f32, anisotropy: f32) -> f32 {
    let scattered = albedo.clamp(0.0, 1.0);
    let absorbed = (1.0 - scattered).clamp(0.0, 1.0);
    let turned = (1.0 - anisotropy.clamp(-1.0, 1.0)).max(HALF_SPACE_LEAST_TURNED);
    (absorbed / (absorbed + scattered * turned)).sqrt().min(1.0)
}

/// Computes gamma by way of the similar albedo, a naive form.
pub fn gamma_naive(albedo: f32, anisotropy: f32) -> f32 {
    let similar = albedo * (1.0 - anisotropy) / (1.0 - albedo * anisotropy);
    (1.0 - similar).sqrt()
}

/// Returns gamma of index-matched matter that reflects and absorbs diffuse light in these shares of any
/// whole.
pub fn gamma_of_shares(reflected: f32, absorbed: f32) -> f32 {
    let parts = Vec2::new(reflected, absorbed).clamp(Vec2::ZERO, Vec2::ONE);
    let whole = (parts.x + parts.y).max(HALF_SPACE_NO_LIGHT);
    let r = parts.x / whole;
    let rest = parts.y / whole;
    let square = 0.33745154 + 0.62182603 * r;
    let linear = 0.66254846 + 1.647105 * r;
    (2.0 * rest / (linear + (linear * linear + 4.0 * square * rest).sqrt())).min(1.0)
}

/// Returns gamma of index-matched matter that reflects the share `reflectance` of diffuse light.
pub fn gamma_of_reflectance(reflectance: f32) -> f32 {
    let r = reflectance.clamp(0.0, 1.0);
    gamma_of_shares(r, 1.0 - r)
}

/// Returns the quotient of 1 - gamma and the reflectance under diffuse light.
pub fn darkening(gamma: f32) -> f32 {
    let g = gamma.clamp(0.0, 1.0);
    (1.0 + g * (1.647105 + 0.62182603 * g)) / (1.0 + 0.33745154 * g)
}

/// Returns the share of diffuse light that index-matched matter reflects.
pub fn reflectance(gamma: f32) -> f32 {
    ((1.0 - gamma.clamp(0.0, 1.0)) / darkening(gamma)).min(1.0)
}

/// Returns the part of 1 / H that scattering makes: N of 1 / H = gamma + (1 - gamma) N.
pub fn escape(cosine: f32, gamma: f32) -> f32 {
    let c = cosine.clamp(HALF_SPACE_GRAZING, 1.0);
    let g = gamma.clamp(0.0, 1.0);
    let single = 1.0 - c * (1.0 + 1.0 / c).ln();
    let first = 0.5 - (c + 0.5) * single;
    let second = 0.33333334 - 0.5 * c + (c * c - 0.33333334) * single;
    let slope = 1.0546412 + g * (0.9806169 - 0.6828335 * g);
    let bend = 0.12875553 + g * (1.6066018 - 0.94174538 * g);
    single + (1.0 - g) * (slope * first - bend * second)
}

/// Returns Chandrasekhar's H function for isotropic scattering.
pub fn h(cosine: f32, gamma: f32) -> f32 {
    let g = gamma.clamp(0.0, 1.0);
    1.0 / (g + (1.0 - g) * escape(cosine, g))
}

/// Computes H in Hapke's one line, a naive form.
pub fn h_paper(cosine: f32, gamma: f32) -> f32 {
    (1.0 + 2.0 * cosine) / (1.0 + 2.0 * cosine * gamma)
}

/// Returns the share of the light from one direction that index-matched matter reflects.
pub fn directional(cosine: f32, gamma: f32) -> f32 {
    let g = gamma.clamp(0.0, 1.0);
    let scattered = (1.0 - g) * escape(cosine, g);
    (scattered / (g + scattered)).min(1.0)
}

/// Computes the same as it is printed, a naive form.
pub fn directional_naive(cosine: f32, gamma: f32) -> f32 {
    1.0 - gamma * h(cosine, gamma)
}

/// Returns the BRDF of index-matched matter: Chandrasekhar's law of diffuse reflection.
pub fn brdf(cosine_eye: f32, cosine_light: f32, gamma: f32) -> f32 {
    let g = gamma.clamp(0.0, 1.0);
    let sum = cosine_eye.clamp(HALF_SPACE_GRAZING, 1.0) + cosine_light.clamp(HALF_SPACE_GRAZING, 1.0);
    let albedo = (1.0 - g) * (1.0 + g);
    0.07957747 * albedo * h(cosine_eye, g) * h(cosine_light, g) / sum
}

/// Computes the same as it is printed, a naive form.
pub fn brdf_naive(cosine_eye: f32, cosine_light: f32, gamma: f32) -> f32 {
    let albedo = 1.0 - gamma * gamma;
    let both = h(cosine_eye, gamma) * h(cosine_light, gamma);
    0.07957747 * albedo * both / (cosine_eye + cosine_light)
}

/// Returns the law as a factor on Lambert's with the same reflectance under diffuse light.
pub fn factor(cosine_eye: f32, cosine_light: f32, gamma: f32) -> f32 {
    let g = gamma.clamp(0.0, 1.0);
    let sum = cosine_eye.clamp(HALF_SPACE_GRAZING, 1.0) + cosine_light.clamp(HALF_SPACE_GRAZING, 1.0);
    let relative = 0.25 * (1.0 + g) * darkening(g);
    relative * h(cosine_eye, g) * h(cosine_light, g) / sum
}

/// Computes the same as a quotient of the two laws, a naive form.
pub fn factor_naive(cosine_eye: f32, cosine_light: f32, gamma: f32) -> f32 {
    let albedo = 1.0 - gamma * gamma;
    let both = h(cosine_eye, gamma) * h(cosine_light, gamma);
    0.25 * albedo * both / (cosine_eye + cosine_light) / reflectance(gamma)
}

/// Returns the angular law of light that comes from deep inside, as a factor.
pub fn exit(cosine: f32, gamma: f32) -> f32 {
    let g = gamma.clamp(0.0, 1.0);
    let inverse_moment = (1.0 + g * (1.647105 + 0.62182603 * g)) / (2.3096535 + 0.95927757 * g);
    h(cosine, g) * inverse_moment
}

/// Returns the cosine of the refracted direction in the denser matter.
pub fn refract(cosine: f32, relative_index: f32) -> f32 {
    let c = cosine.clamp(HALF_SPACE_GRAZING, 1.0);
    let n = relative_index.clamp(1.0, HALF_SPACE_DENSEST);
    let refracted = ((n - 1.0) * (n + 1.0) + c * c).sqrt() / n;
    refracted.max(c).min(1.0)
}

/// Returns the root of the share of diffuse light that the boundary reflects back inside.
pub fn edge(relative_index: f32) -> f32 {
    let n = relative_index.clamp(1.0, HALF_SPACE_DENSEST);
    let x = n - 1.0;
    let numerator = 1.1665642 + x * (118.47884 + x * (711.88998 + x * 312.90763));
    let denominator = 1.0 + x * (102.81827 + x * (666.10355 + x * 316.42606));
    (x * (n + 1.0) * numerator / denominator).sqrt() / n
}

/// Computes the same by Walsh's closed form, a naive form.
pub fn edge_naive(relative_index: f32) -> f32 {
    let n = relative_index;
    let square = n * n;
    let fourth = square * square;
    let ratio = (n - 1.0) / (n + 1.0);
    let plain = 0.5 + (n - 1.0) * (3.0 * n + 1.0) / (6.0 * (n + 1.0) * (n + 1.0));
    let polarised =
        square * (square - 1.0) * (square - 1.0) / ((square + 1.0) * (square + 1.0) * (square + 1.0)) * ratio.ln();
    let rational = 2.0 * n * square * (square + 2.0 * n - 1.0) / ((square + 1.0) * (fourth - 1.0));
    let rest = 8.0 * fourth * (fourth + 1.0) / ((square + 1.0) * (fourth - 1.0) * (fourth - 1.0)) * n.ln();
    let outside = plain + polarised - rational + rest;
    (1.0 - (1.0 - outside) / square).sqrt()
}

/// Returns the strength of the light that the boundary has thrown back inside.
pub fn gain(gamma: f32, edge: f32) -> f32 {
    let g = gamma.clamp(0.0, 1.0);
    let e = edge.clamp(0.0, HALF_SPACE_LAST_EDGE);
    let passed = (1.0 - e) * (1.0 + e);
    let white = passed * (1.0093106 + 1.0942524 * g - 0.39723844 * e);
    let dark = g * (2.48031 * e - 1.0689417 + g * (1.6286656 * e - 0.06959722));
    0.07957747 * (1.0 + e * (3.3934849 - 1.3134133 * e)) / (white + dark)
}

/// Returns the BRDF between directions inside the boundary.
pub fn inside(cosine_eye: f32, cosine_light: f32, gamma: f32, edge: f32, gain: f32) -> f32 {
    let g = gamma.clamp(0.0, 1.0);
    let e = edge.clamp(0.0, HALF_SPACE_LAST_EDGE);
    let cosines = Vec2::new(cosine_eye, cosine_light).clamp(Vec2::splat(HALF_SPACE_GRAZING), Vec2::ONE);
    let p = e / (cosines + e);
    let below = p * (15.0 - 7.0 * p) / (30.0 - p * (24.0 - 3.0 * p));
    let sum = cosines.x + cosines.y;
    let albedo = (1.0 - g) * (1.0 + g);
    let thrown_back = gain.clamp(0.0, 100.0) * albedo * below.x * below.y;
    let both = h(cosines.x, g) * h(cosines.y, g);
    albedo * both * (0.07957747 / sum + thrown_back)
}

/// Returns the BRDF of matter behind a boundary, without the shares that pass it.
pub fn dielectric(cosine_eye: f32, cosine_light: f32, gamma: f32, relative_index: f32, edge: f32, gain: f32) -> f32 {
    let n = relative_index.clamp(1.0, HALF_SPACE_DENSEST);
    let eye = refract(cosine_eye, n);
    let light = refract(cosine_light, n);
    inside(eye, light, gamma, edge, gain) / (n * n)
}

/// Returns how the odds of absorption behind a boundary exceed those by Saunderson's formula.
pub fn slant(gamma: f32, edge: f32) -> f32 {
    let g = gamma.clamp(0.0, 1.0);
    let e = edge.clamp(0.0, HALF_SPACE_LAST_EDGE);
    1.0 + e * e * g * (2.3512168 - 0.04584427 * g) / (1.0 + e * (1.3143637 + 1.3818834 * g))
}

/// Returns the share of the diffuse light that has entered matter behind a boundary and leaves it.
pub fn entered(gamma: f32, edge: f32) -> f32 {
    let g = gamma.clamp(0.0, 1.0);
    let e = edge.clamp(0.0, HALF_SPACE_LAST_EDGE);
    let left = (1.0 - g) * (1.0 + 0.33745154 * g) * (1.0 - e) * (1.0 + e);
    let absorbed = slant(g, e) * g * (2.3096535 + 0.95927757 * g);
    (left / (left + absorbed)).min(1.0)
}

/// Returns gamma of matter behind a boundary that returns this share of diffuse light.
pub fn gamma_of_entered(share: f32, edge: f32) -> f32 {
    let s = share.clamp(0.0, 1.0);
    let e = edge.clamp(0.0, HALF_SPACE_LAST_EDGE);
    let absorbed = (1.0 - s) * (1.0 - e) * (1.0 + e);
    let mut gamma = gamma_of_shares(s, absorbed);
    for _turn in 0..4 {
        let left = s * slant(gamma, e);
        gamma = gamma_of_shares(left, absorbed);
    }
    gamma
}

#[cfg(test)]
mod tests;
