//! Exact results in f64. Indices come from the oscillator form, in wavenumbers. Gradients are rates
//! of angles: in the plane of incidence, n sin θ_t = sin θ_i differentiates to n cos θ_t θ_t' = cos
//! θ_i θ_i' - n' sin θ_t; across it, the azimuth turns both rays alike. The mirror never forms an
//! angle. The bound near the critical angle is the same as in the module, because it is a
//! definition.

use glam::{DQuat, DVec3, dvec3};
use std::f64::consts::{FRAC_PI_2, PI};

/// A material's index of refraction: n² - 1 = constant + Σ strengths w² / (w² - resonances), with
/// the wavelength w in µm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DispersionSellmeier {
    /// Constant term; 0 for most materials.
    pub constant: f64,
    /// Strengths of up to three resonances.
    pub strengths: DVec3,
    /// Squares of the resonance wavelengths, in µm².
    pub resonances: DVec3,
}

/// Diamond, Peter 1923.
pub const DISPERSION_DIAMOND: DispersionSellmeier = DispersionSellmeier {
    constant: 0.0,
    strengths: dvec3(0.3306, 4.3356, 0.0),
    resonances: dvec3(0.1750 * 0.1750, 0.1060 * 0.1060, 0.0),
};
/// Sapphire and ruby, the ordinary ray, Malitson 1962.
pub const DISPERSION_CORUNDUM: DispersionSellmeier = DispersionSellmeier {
    constant: 0.0,
    strengths: dvec3(1.4313493, 0.65054713, 5.3414021),
    resonances: dvec3(0.0726631 * 0.0726631, 0.1193242 * 0.1193242, 18.028251 * 18.028251),
};
/// Quartz, the ordinary ray, Ghosh 1999.
pub const DISPERSION_QUARTZ: DispersionSellmeier = DispersionSellmeier {
    constant: 0.28604141,
    strengths: dvec3(1.07044083, 1.10202242, 0.0),
    resonances: dvec3(0.0100585997, 100.0, 0.0),
};
/// N-BK7, the common optical crown glass, Schott.
pub const DISPERSION_CROWN_GLASS: DispersionSellmeier = DispersionSellmeier {
    constant: 0.0,
    strengths: dvec3(1.03961212, 0.231792344, 1.01046945),
    resonances: dvec3(0.00600069867, 0.0200179144, 103.560653),
};
/// Cubic zirconia, Wood and Nassau 1982.
pub const DISPERSION_CUBIC_ZIRCONIA: DispersionSellmeier = DispersionSellmeier {
    constant: 0.0,
    strengths: dvec3(1.347091, 2.117788, 9.452943),
    resonances: dvec3(0.062543 * 0.062543, 0.166739 * 0.166739, 24.320570 * 24.320570),
};
/// Rutile, the ordinary ray, DeVore 1951.
pub const DISPERSION_RUTILE: DispersionSellmeier = DispersionSellmeier {
    constant: 5.913 - 1.0 - 0.2441 / 0.0803,
    strengths: dvec3(0.2441 / 0.0803, 0.0, 0.0),
    resonances: dvec3(0.0803, 0.0, 0.0),
};
/// Strontium titanate, Dodge 1986.
pub const DISPERSION_STRONTIUM_TITANATE: DispersionSellmeier = DispersionSellmeier {
    constant: 0.0,
    strengths: dvec3(3.042143, 1.170065, 30.83326),
    resonances: dvec3(0.1475902 * 0.1475902, 0.2953086 * 0.2953086, 33.18606 * 33.18606),
};

/// Length below which a chord is noise.
const CHORD: f64 = 1.0 / (1 << 20) as f64;
/// Smallest n cos θ_t by which a gradient is divided.
const CRITICAL: f64 = 1.0 / 16.0;

/// Computes the index in wavenumbers k = 1 / w: each term is a strength over 1 - (k w_resonance)².
pub fn sellmeier(material: DispersionSellmeier, wavelength: f64) -> f64 {
    let wavenumber = 1e3 / wavelength;
    let oscillator = |strength: f64, resonance: f64| strength / (1.0 - resonance * wavenumber.powi(2));
    let excess: f64 = (0..3).map(|index| oscillator(material.strengths[index], material.resonances[index])).sum();
    (0.5 * (material.constant + excess).max(0.0).ln_1p()).exp()
}

/// Sums the terms in wavenumbers.
pub fn cauchy(coefficients: DVec3, wavelength: f64) -> f64 {
    let wavenumber = 1e3 / wavelength;
    coefficients.x + coefficients.y * wavenumber.powi(2) + coefficients.z * wavenumber.powi(4)
}

/// Computes the offset from the wavelength w_0 at which glTF's formula gives the index itself:
/// 523655 (1 / w² - 1 / w_0²), in factors.
pub fn abbe(index: f64, dispersion: f64, wavelength: f64) -> f64 {
    let neutral = (523655.0f64 / 1.5168).sqrt();
    let offset = 1.5168 * (neutral - wavelength) * (neutral + wavelength) / wavelength.powi(2);
    let number = 20.0 / dispersion;
    (index + (index - 1.0) / number * offset).max(1.0)
}

/// Computes the quotient as a difference of logarithms.
pub fn abbe_number(index_d: f64, index_f: f64, index_c: f64) -> f64 {
    if index_d == 1.0 { 0.0 } else { ((index_d - 1.0).ln() - (index_f - index_c).max(1e-12).ln()).exp() }
}

/// Computes θ_t' = -tan θ_t / n, because θ_i is constant.
pub fn enter(direction: DVec3, normal: DVec3, relative_index: f64) -> DVec3 {
    let plane = Incidence::new(direction, normal);
    let sine = plane.incident.sine / relative_index;
    let refraction = plane.refraction(relative_index).unwrap_or(Angle { sine, cosine: 0.0 });
    plane.turned(&refraction, relative_index, -refraction.sine)
}

/// Differentiates Snell's law in angles; reflects the gradient if the law has no solution.
pub fn refract(
    direction: DVec3,
    gradient: DVec3,
    normal: DVec3,
    relative_index: f64,
    relative_index_slope: f64,
) -> DVec3 {
    let plane = Incidence::new(direction, normal);
    let Some(refraction) = plane.refraction(relative_index) else { return reflect(gradient, plane.normal) };
    let Angle { sine, cosine } = plane.incident;
    let rate = gradient.dot(cosine * plane.tangent + sine * plane.normal);
    let across = gradient.dot(plane.binormal()) / relative_index;
    let moved = cosine * rate - relative_index_slope * refraction.sine;
    // Rounding leaves a part of the gradient along the ray, which lengthens the ray: the tangential
    // part by the same factor, the cosine by c² / root² of it.
    let longer = gradient.dot(sine * plane.tangent - cosine * plane.normal) / relative_index;
    let root = (relative_index * refraction.cosine).max(CRITICAL);
    let lengthened = longer * (sine * plane.tangent - cosine * cosine / root * plane.normal);
    plane.turned(&refraction, relative_index, moved) + across * plane.binormal() + lengthened
}

/// Rotates by half a turn about the normal and reverses the sign, which is a reflection at the
/// plane.
pub fn reflect(gradient: DVec3, normal: DVec3) -> DVec3 {
    -(DQuat::from_axis_angle(normal.normalize(), PI) * gradient)
}

/// Normalizes the sum by its angles on the sphere.
pub fn direction(direction: DVec3, gradient: DVec3, index_offset: f64) -> DVec3 {
    on_sphere(direction + index_offset * gradient)
}

/// Computes the direction of the chord from its angles.
pub fn paper_enter(direction: DVec3, refracted: DVec3) -> DVec3 {
    let chord = refracted - direction;
    if chord.length() < CHORD { DVec3::ZERO } else { on_sphere(chord) }
}

/// Refracts both rays in angles. If the second would be totally reflected, it is taken along the
/// surface.
pub fn paper_refract(direction: DVec3, spread: DVec3, normal: DVec3, relative_index: f64, epsilon: f64) -> DVec3 {
    let shifted = turned(direction, spread, epsilon);
    let [first, second] = [direction, shifted].map(|ray| {
        let plane = Incidence::new(ray, normal);
        let grazing = plane.incident.sine / relative_index * plane.tangent;
        plane.refraction(relative_index).map(|refraction| plane.direction(&refraction)).ok_or(grazing)
    });
    let Ok(first) = first else { return paper_reflect(direction, spread, normal, epsilon) };
    on_sphere(second.unwrap_or_else(|grazing| grazing) - first)
}

/// Reflects the difference of the rays, because a reflection preserves lengths.
pub fn paper_reflect(direction: DVec3, spread: DVec3, normal: DVec3, epsilon: f64) -> DVec3 {
    reflect(on_sphere(turned(direction, spread, epsilon) - direction), normal)
}

/// Normalizes the sum by its angles on the sphere.
pub fn paper_direction(direction: DVec3, spread: DVec3, distance: f64, frequency_ratio: f64, strength: f64) -> DVec3 {
    on_sphere(direction + strength * distance * (frequency_ratio - 1.0) * spread)
}

/// Sine and cosine of an angle from the normal.
struct Angle {
    sine: f64,
    cosine: f64,
}

/// A ray at a plane: the angle of incidence, the unit tangent along which the ray moves, and the
/// unit normal.
struct Incidence {
    incident: Angle,
    tangent: DVec3,
    normal: DVec3,
}

impl Incidence {
    fn new(direction: DVec3, normal: DVec3) -> Self {
        let normal = normal.normalize();
        let along = normal.cross(direction);
        // A ray from behind the plane counts as grazing incidence, as in the module.
        let angle = along.length().atan2(-normal.dot(direction)).min(FRAC_PI_2);
        // At normal incidence every plane through the normal is the plane of incidence.
        let tangent = along.cross(normal).try_normalize().unwrap_or_else(|| normal.any_orthonormal_vector());
        let incident = if angle == FRAC_PI_2 {
            Angle { sine: 1.0, cosine: 0.0 }
        } else {
            Angle { sine: angle.sin(), cosine: angle.cos() }
        };
        Self { incident, tangent, normal }
    }

    fn binormal(&self) -> DVec3 {
        self.normal.cross(self.tangent)
    }

    /// Applies Snell's law; `None` under total internal reflection. cos² θ_t = (n - sin θ_i)(n +
    /// sin θ_i) / n², with n - sin θ_i = (n - 1) + 2 sin²((π/2 - θ_i)/2), keeps its digits for n
    /// near 1 at grazing incidence.
    fn refraction(&self, relative_index: f64) -> Option<Angle> {
        let Angle { sine, cosine } = self.incident;
        let complement = cosine.atan2(sine);
        let below = (relative_index - 1.0) + 2.0 * (0.5 * complement).sin().powi(2);
        let squared = below * (relative_index + sine);
        (squared >= 0.0).then(|| Angle { sine: sine / relative_index, cosine: squared.sqrt() / relative_index })
    }

    /// Returns the ray at `angle` to the normal beyond the plane.
    fn direction(&self, angle: &Angle) -> DVec3 {
        angle.sine * self.tangent - angle.cosine * self.normal
    }

    /// Returns the rate of the ray at `angle` for n cos θ_t θ_t' = `moved`: cos θ_t θ_t' along the
    /// tangent and sin θ_t θ_t' along the normal. Only the part along the normal is divided by cos
    /// θ_t.
    fn turned(&self, angle: &Angle, relative_index: f64, moved: f64) -> DVec3 {
        let root = (relative_index * angle.cosine).max(CRITICAL);
        moved / relative_index * self.tangent + angle.sine * moved / root * self.normal
    }
}

/// Turns `direction` towards `spread` by its angle to `direction + epsilon * spread`.
fn turned(direction: DVec3, spread: DVec3, epsilon: f64) -> DVec3 {
    let across = spread - spread.dot(direction) / direction.length_squared() * direction;
    let angle = (epsilon * across.length()).atan2(direction.length() + epsilon * spread.dot(direction));
    angle.cos() * direction + angle.sin() * direction.length() * across.normalize_or_zero()
}

/// Returns the unit vector along `vector`, by its polar angle and azimuth; 0 for 0.
fn on_sphere(vector: DVec3) -> DVec3 {
    if vector == DVec3::ZERO {
        return DVec3::ZERO;
    }
    let polar = vector.x.hypot(vector.y).atan2(vector.z);
    let azimuth = vector.y.atan2(vector.x);
    dvec3(polar.sin() * azimuth.cos(), polar.sin() * azimuth.sin(), polar.cos())
}
