//! Exact results in f64: integers by 64-bit arithmetic, paths by `ln_1p`, deflections by the
//! triangle of sides 1, g and the root, bases by a rotation, boundaries by angles (Fresnel's sines
//! and tangents, Snell's law).

use glam::{DQuat, DVec2, DVec3, DVec4, UVec4};
use std::f64::consts::{PI, TAU};

// The module's constants, repeated so that an error in them does not carry over to the oracle.
const THINNEST: f64 = 1e-30;
const DENSEST: f64 = 8.507059173023462e37;
const STRAIGHTEST: f64 = 0.999999f32 as f64;

/// Two unit vectors that form a right-handed basis with a normal as the third.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RandomWalkBasis {
    /// Unit vector at right angles to the normal.
    pub tangent: DVec3,
    /// Cross product normal x tangent.
    pub bitangent: DVec3,
}

/// Light after a boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RandomWalkCrossing {
    /// Unit direction, refracted or reflected.
    pub direction: DVec3,
    /// True if the light crosses the boundary.
    pub crosses: bool,
}

/// Returns the remainder of `value` divided by 2^32.
fn rest(value: u64) -> u64 {
    value % (1 << 32)
}

/// Computes the bits with 64-bit integers, which do not overflow, from a table of each word and its
/// factors.
pub fn bits(counter: UVec4) -> UVec4 {
    let mut words = counter.to_array().map(|word| rest(u64::from(word) * 1_664_525 + 1_013_904_223));
    for round in 0..2 {
        for (to, a, b) in [(0, 1, 3), (1, 2, 0), (2, 0, 1), (3, 1, 2)] {
            words[to] = rest(words[to] + rest(words[a] * words[b]));
        }
        if round == 0 {
            words = words.map(|word| word ^ (word / (1 << 16)));
        }
    }
    UVec4::from_array(words.map(|word| word as u32))
}

/// Divides the bits by 2^32 and truncates to 24 binary places.
pub fn random(counter: UVec4) -> DVec4 {
    let places = 2f64.powi(24);
    DVec4::from_array(bits(counter).to_array().map(|bits| (f64::from(bits) / 256.0).floor() / places))
}

/// Computes the path with the logarithm of 1 + x.
pub fn free_path(u: f64, majorant: f64) -> f64 {
    -(-u.clamp(0.0, 1.0 - 2f64.powi(-24))).ln_1p() / majorant.clamp(THINNEST, DENSEST)
}

/// Calls [`free_path`]: the naive form is the same function, computed badly.
pub fn free_path_naive(u: f64, majorant: f64) -> f64 {
    free_path(u, majorant)
}

/// Compares `u` with shares of the majorant.
pub fn collision(u: f64, scattering: f64, absorption: f64, majorant: f64) -> u32 {
    // If the majorant is 0, light passes.
    let shares = [scattering, scattering + absorption].map(|sum| if majorant == 0.0 { 0.0 } else { sum / majorant });
    shares.iter().filter(|share| u >= **share).count() as u32
}

/// Multiplies the transmittance by 1 minus the share of real collisions.
pub fn ratio(transmittance: f64, density: f64, majorant: f64) -> f64 {
    transmittance * (1.0 - density / majorant.max(THINNEST)).max(0.0)
}

/// Calls [`ratio`]: the naive form is the same function, computed badly.
pub fn ratio_naive(transmittance: f64, density: f64, majorant: f64) -> f64 {
    ratio(transmittance, density, majorant)
}

/// Returns (1 - g²) / (4π d³), with d the distance from the point g on the axis to the point on the
/// unit circle.
pub fn phase(cosine: f64, g: f64) -> f64 {
    let g = g.clamp(-STRAIGHTEST, STRAIGHTEST);
    let c = cosine.clamp(-1.0, 1.0);
    let distance = (c - g).hypot(((1.0 - c) * (1.0 + c)).sqrt());
    (1.0 - g * g) / (4.0 * PI * distance.powi(3))
}

/// Calls [`phase`]: the naive form is the same function, except for the clamp.
pub fn phase_naive(cosine: f64, g: f64) -> f64 {
    phase(cosine, g)
}

/// Uses the half angle of the triangle of sides 1, |g| and the root; for a small g, the first order
/// in g.
pub fn deflection(u: f64, g: f64) -> DVec2 {
    let (g, u) = (g.clamp(-STRAIGHTEST, STRAIGHTEST), u.clamp(0.0, 1.0));
    if g < 0.0 {
        let mirrored = deflection(1.0 - u, -g);
        return DVec2::new(-mirrored.x, mirrored.y);
    }
    let t = 2.0 * u - 1.0;
    if u == 0.0 || u == 1.0 {
        return DVec2::new(t, 0.0);
    }
    if g < 1e-5 {
        // The derivative of the cosine with respect to g at 0, and its effect on the sine.
        let sine = 2.0 * (u * (1.0 - u)).sqrt();
        let more = 1.5 * g * sine;
        return DVec2::new(t + more * sine, sine - more * t);
    }
    // 1 + g t, and from it half the perimeter minus a side, in a form that does not cancel for u
    // next to 0 and to 1.
    let sum = (1.0 - g) + 2.0 * g * u;
    let root = (1.0 - g) * (1.0 + g) / sum;
    let half = 0.5 * (1.0 + g + root);
    let less_one = g * (1.0 - g) * (1.0 - u) / sum;
    let less_root = g * (1.0 + g) * u / sum;
    let near = (less_one * (half - g)).sqrt();
    let angle = 2.0 * near.atan2((half * less_root).sqrt());
    DVec2::new(angle.cos(), angle.sin())
}

/// Calls [`deflection`]: the naive form is the same function, computed badly.
pub fn deflection_naive(u: f64, g: f64) -> DVec2 {
    deflection(u, g)
}

/// Uses the built-in functions of the fraction.
pub fn azimuth(turns: f64) -> DVec2 {
    let (sine, cosine) = (TAU * turns.fract()).sin_cos();
    DVec2::new(cosine, sine)
}

/// Rotates x and y by the shortest rotation from the pole on the normal's side to the normal;
/// below, y is reversed.
pub fn basis(normal: DVec3) -> RandomWalkBasis {
    let side = if normal.z >= 0.0 { 1.0 } else { -1.0 };
    let rotation = to_normal(side, normal);
    RandomWalkBasis { tangent: rotation * DVec3::X, bitangent: rotation * (side * DVec3::Y) }
}

/// Returns the shortest rotation from ±z to a vector.
fn to_normal(side: f64, normal: DVec3) -> DQuat {
    let pole = DVec3::new(0.0, 0.0, side);
    let across = pole.cross(normal);
    let angle = across.length().atan2(pole.dot(normal));
    across.try_normalize().map_or(DQuat::IDENTITY, |axis| DQuat::from_axis_angle(axis, angle))
}

/// Uses the rotation from +z alone, which is a different function below.
pub fn basis_naive(normal: DVec3) -> RandomWalkBasis {
    let rotation = to_normal(1.0, normal);
    RandomWalkBasis { tangent: rotation * DVec3::X, bitangent: rotation * DVec3::Y }
}

/// Rotates the direction by the angle, about the axis at right angles to the plane in which it
/// turns.
pub fn turn(direction: DVec3, deflection: DVec2, azimuth: DVec2) -> DVec3 {
    let basis = basis(direction);
    let around = azimuth.y.atan2(azimuth.x);
    let aside = around.cos() * basis.tangent + around.sin() * basis.bitangent;
    let axis = direction.cross(aside).normalize();
    let angle = deflection.y.atan2(deflection.x);
    DQuat::from_axis_angle(axis, angle) * direction.normalize()
}

/// Uses the polar angle, whose half has the sine √u.
pub fn isotropic(u: DVec2) -> DVec3 {
    let half = u.x.clamp(0.0, 1.0).sqrt().asin();
    let (sine, cosine) = (2.0 * half).sin_cos();
    let around = azimuth(u.y);
    DVec3::new(sine * around.x, sine * around.y, cosine)
}

/// Returns Fresnel's reflectance by angles; 1 if Snell's law has no solution.
fn reflectance(incidence: f64, relative_index: f64) -> f64 {
    let sine = incidence.sin() / relative_index;
    if sine >= 1.0 {
        return 1.0;
    }
    if incidence < 1e-6 {
        return ((relative_index - 1.0) / (relative_index + 1.0)).powi(2);
    }
    let refraction = sine.asin();
    let (less, more) = (incidence - refraction, incidence + refraction);
    0.5 * ((less.sin() / more.sin()).powi(2) + (less.tan() / more.tan()).powi(2))
}

/// Uses the angles of incidence and refraction in their plane.
pub fn boundary(incident: DVec3, normal: DVec3, relative_index: f64, u: f64) -> RandomWalkCrossing {
    if relative_index == 1.0 {
        return RandomWalkCrossing { direction: incident, crosses: true };
    }
    let normal = normal.normalize();
    let cosine = -normal.dot(incident);
    let along = (incident + cosine * normal).try_normalize().unwrap_or(DVec3::ZERO);
    let incidence = normal.cross(incident).length().atan2(cosine.max(0.0));
    if u < reflectance(incidence, relative_index) {
        let direction = incidence.sin() * along + incidence.cos() * normal;
        return RandomWalkCrossing { direction, crosses: false };
    }
    let refraction = (incidence.sin() / relative_index).min(1.0).asin();
    let direction = refraction.sin() * along - refraction.cos() * normal;
    RandomWalkCrossing { direction, crosses: true }
}
