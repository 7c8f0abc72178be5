//! Mirror of `wgsl/refraction.wgsl`: a ray refracted at a plane interface, with total internal
//! reflection as an explicit result. After Imagire, "Proxy Geometry Gem Rendering", eq. (6), (7).
//!
//! The WGSL file states the units, domain and accuracy of each function. This file mirrors it line
//! by line.
//!
//! ```
//! use glam::{Vec3, vec3};
//! use lapidary_refraction::refract;
//!
//! // From diamond into air, at 45 degrees: total internal reflection.
//! let hit = refract(vec3(0.70710677, -0.70710677, 0.0), Vec3::Y, 1.0 / 2.42);
//! assert!(hit.total && hit.direction.y > 0.0);
//! ```

#[cfg(feature = "formulas")]
pub mod formulas;
pub mod oracle;

use glam::Vec3;

/// Result of refraction at an interface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RefractionHit {
    /// Unit direction of the refracted ray, or of the reflected ray if nothing is refracted.
    pub direction: Vec3,
    /// True under total internal reflection: all light stays on the incident side.
    pub total: bool,
}

/// Relative index of refraction n = n_transmitted / n_incident, the reciprocal of eta in eq. (7).
pub fn relative_index(index_incident: f32, index_transmitted: f32) -> f32 {
    index_transmitted / index_incident
}

/// Mirror direction of `incident` at a plane with the normal `normal`.
pub fn reflect(incident: Vec3, normal: Vec3) -> Vec3 {
    incident - 2.0 * normal.dot(incident) * normal
}

/// Radicand of eq. (6), cos² of the angle of refraction, negative under total internal reflection.
pub fn radicand(cosine: f32, relative_index: f32) -> f32 {
    let excess = (relative_index - 1.0) * (relative_index + 1.0);
    (excess + cosine * cosine) / (relative_index * relative_index)
}

/// The radicand as printed in eq. (6).
pub fn radicand_naive(cosine: f32, relative_index: f32) -> f32 {
    let eta = 1.0 / relative_index;
    1.0 - eta * eta * (1.0 - cosine * cosine)
}

/// Refracts `incident` at a plane with the normal `normal`, or reflects it if refraction is
/// impossible.
pub fn refract(incident: Vec3, normal: Vec3, relative_index: f32) -> RefractionHit {
    let cosine = (-normal.dot(incident)).max(0.0);
    let excess = (relative_index - 1.0) * (relative_index + 1.0);
    let radicand = excess + cosine * cosine;
    if radicand < 0.0 {
        return RefractionHit { direction: incident + 2.0 * cosine * normal, total: true };
    }
    if excess == 0.0 {
        // Equal indices do not bend the ray. This case is handled separately because the quotient
        // below would be 0 / 0 at grazing incidence.
        return RefractionHit { direction: incident, total: false };
    }
    let bend = excess / (cosine + radicand.sqrt());
    RefractionHit { direction: (incident - bend * normal) / relative_index, total: false }
}

/// Refraction as printed in eq. (6), with a double cross product.
pub fn refract_naive(incident: Vec3, normal: Vec3, relative_index: f32) -> RefractionHit {
    let eta = 1.0 / relative_index;
    let cosine = -normal.dot(incident);
    let radicand = 1.0 - eta * eta * (1.0 - cosine * cosine);
    if radicand < 0.0 {
        return RefractionHit { direction: incident + 2.0 * cosine * normal, total: true };
    }
    RefractionHit { direction: -eta * normal.cross(normal.cross(incident)) - radicand.sqrt() * normal, total: false }
}

/// The usual form in shaders: the built-in `refract`, normalized. Not a number under total internal
/// reflection.
pub fn refract_builtin(incident: Vec3, normal: Vec3, relative_index: f32) -> RefractionHit {
    RefractionHit { direction: incident.refract(normal, 1.0 / relative_index).normalize(), total: false }
}
