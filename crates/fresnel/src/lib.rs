//! Mirror of `wgsl/fresnel.wgsl`: the share of unpolarised light that an interface between two
//! dielectrics reflects. The WGSL file states the units, domain and accuracy of each function. This
//! file follows it line by line.
//!
//! ```
//! use lapidary_fresnel::{dielectric, normal_incidence};
//!
//! // From air into glass: 4 % straight on, all at grazing incidence.
//! assert!((normal_incidence(1.5) - 0.04).abs() < 1e-7);
//! assert_eq!(dielectric(0.0, 1.5), 1.0);
//! // From inside, beyond the critical angle.
//! assert_eq!(dielectric(0.5, 1.0 / 1.5), 1.0);
//! ```

#[cfg(feature = "formulas")]
pub mod formulas;
pub mod oracle;

/// Returns the reflectance of a dielectric interface, exact for unpolarised light, with total
/// internal reflection. `cosine` is the cosine of the angle of incidence, `relative_index` is
/// n_transmitted / n_incident.
pub fn dielectric(cosine: f32, relative_index: f32) -> f32 {
    let m = (relative_index - 1.0) * (relative_index + 1.0);
    if m == 0.0 {
        return 0.0;
    }
    let c = cosine.clamp(0.0, 1.0);
    let sine_squared = (1.0 - c) * (1.0 + c);
    let n_squared = relative_index * relative_index;
    let nc_squared = n_squared * c * c;
    let g = (nc_squared + m * sine_squared).max(0.0).sqrt();
    let s_root = c + g;
    let s = m / (s_root * s_root).max(m.abs());
    let p_root = n_squared * c + g;
    let p_numerator = m * (nc_squared - sine_squared);
    let p = p_numerator / (p_root * p_root).max(p_numerator.abs());
    (0.5 * (s * s + p * p)).min(1.0)
}

/// Computes the same reflectance as in textbooks, a naive form: quotients of cosines.
pub fn dielectric_textbook(cosine: f32, relative_index: f32) -> f32 {
    let eta = 1.0 / relative_index;
    let cosine_transmitted = (1.0 - eta * eta * (1.0 - cosine * cosine)).max(0.0).sqrt();
    let s = (cosine - relative_index * cosine_transmitted) / (cosine + relative_index * cosine_transmitted);
    let p = (relative_index * cosine - cosine_transmitted) / (relative_index * cosine + cosine_transmitted);
    0.5 * (s * s + p * p)
}

/// Returns the reflectance at normal incidence, the F0 of shading models.
pub fn normal_incidence(relative_index: f32) -> f32 {
    let amplitude = (relative_index - 1.0) / (relative_index + 1.0);
    (amplitude * amplitude).min(1.0)
}

/// Computes Schlick's approximation, the cheap rung, with the cosine in the optically thinner
/// medium.
pub fn schlick(cosine: f32, relative_index: f32) -> f32 {
    let m = (relative_index - 1.0) * (relative_index + 1.0);
    let c = cosine.clamp(0.0, 1.0);
    let sine_squared = (1.0 - c) * (1.0 + c);
    let nc = relative_index * c;
    let cosine_transmitted = (nc * nc + m * sine_squared).max(0.0).sqrt() / relative_index;
    let rest = 1.0 - c.min(cosine_transmitted);
    let rest_squared = rest * rest;
    let normal_incidence = normal_incidence(relative_index);
    (normal_incidence + (1.0 - normal_incidence) * (rest_squared * rest_squared * rest)).min(1.0)
}

#[cfg(test)]
mod tests;
