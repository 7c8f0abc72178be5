//! Ground truth in f64, from Snell's law in angles: n_i sin θ_i = n_t sin θ_t, in the plane of
//! incidence. The mirror never computes an angle.

use glam::DVec3;
use std::f64::consts::FRAC_PI_2;

/// Result of refraction at an interface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RefractionHit {
    /// Unit direction of the refracted ray, or of the reflected ray if nothing is refracted.
    pub direction: DVec3,
    /// True under total internal reflection.
    pub total: bool,
}

/// Computes the quotient of the indices from the difference of their logarithms.
pub fn relative_index(index_incident: f64, index_transmitted: f64) -> f64 {
    (index_transmitted.ln() - index_incident.ln()).exp()
}

/// Applies the law of reflection: in the plane of incidence, the ray leaves at the angle at which
/// it arrived.
pub fn reflect(incident: DVec3, normal: DVec3) -> DVec3 {
    let (angle, tangent, normal) = plane_of_incidence(incident, normal);
    direction_at(angle, tangent, normal)
}

/// Computes cos² θ_t as 1 - sin² θ_t, with sin² θ_i = (1 - cos θ_i)(1 + cos θ_i). Near grazing
/// incidence, 1 - sin θ_i would lose cos² θ_i, so the complement of the angle is used.
pub fn radicand(cosine: f64, relative_index: f64) -> f64 {
    let squared_sine = (1.0 - cosine) * (1.0 + cosine);
    if cosine < 0.5 {
        // n - sin θ_i = (n - 1) + (1 - sin θ_i), with 1 - sin θ_i = 2 sin²((π/2 - θ_i)/2).
        let complement = 2.0 * (0.5 * cosine.asin()).sin().powi(2);
        let sine = squared_sine.sqrt();
        ((relative_index - 1.0) + complement) * (relative_index + sine) / (relative_index * relative_index)
    } else {
        1.0 - squared_sine / (relative_index * relative_index)
    }
}

/// Applies Snell's law, θ_t = asin(sin θ_i / n). Reflection is total if the sine would exceed 1.
pub fn refract(incident: DVec3, normal: DVec3, relative_index: f64) -> RefractionHit {
    let (angle, tangent, normal) = plane_of_incidence(incident, normal);
    // A ray from behind the plane counts as grazing, as the module states.
    let angle = angle.min(FRAC_PI_2);
    if radicand(angle.cos(), relative_index) < 0.0 {
        return RefractionHit { direction: direction_at(angle, tangent, normal), total: true };
    }
    let transmitted = (angle.sin() / relative_index).min(1.0).asin();
    RefractionHit { direction: direction_at(transmitted, tangent, -normal), total: false }
}

/// Returns the angle of incidence in [0, π], the unit tangent along which the ray moves and the
/// unit normal.
fn plane_of_incidence(incident: DVec3, normal: DVec3) -> (f64, DVec3, DVec3) {
    let normal = normal.normalize();
    let along = normal.cross(incident);
    let angle = along.length().atan2(-normal.dot(incident));
    (angle, along.cross(normal).normalize_or_zero(), normal)
}

/// Returns the unit direction at `angle` from `axis` towards `tangent`.
fn direction_at(angle: f64, tangent: DVec3, axis: DVec3) -> DVec3 {
    angle.sin() * tangent + angle.cos() * axis
}
