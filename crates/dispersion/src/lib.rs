//! Mirror of `wgsl/dispersion.wgsl`: refractive indices by wavelength, and one traced ray that
//! carries the directions of all wavelengths. Imagire, "Proxy Geometry Gem Rendering",
//! eq. (10)-(12), and the exact derivative of Snell's law.
//!
//! The WGSL file states the units, domain and accuracy of each function. This file follows it line
//! by line.
//!
//! ```
//! use lapidary_dispersion::{DISPERSION_BLUE, DISPERSION_DIAMOND, DISPERSION_RED, sellmeier};
//!
//! let [red, blue] = [DISPERSION_RED, DISPERSION_BLUE].map(|wavelength| sellmeier(DISPERSION_DIAMOND, wavelength));
//! assert!(2.40 < red && red < blue && blue < 2.46);
//! ```

pub mod channels;
#[cfg(feature = "formulas")]
pub mod formulas;
pub mod oracle;

use glam::{Vec3, vec3};

/// A material's index of refraction: n² - 1 = constant + Σ strengths w² / (w² - resonances), with
/// the wavelength w in µm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DispersionSellmeier {
    /// Constant term; 0 for most materials.
    pub constant: f32,
    /// Strengths of up to three resonances.
    pub strengths: Vec3,
    /// Squares of the resonance wavelengths, in µm².
    pub resonances: Vec3,
}

/// Diamond, Peter 1923.
pub const DISPERSION_DIAMOND: DispersionSellmeier = DispersionSellmeier {
    constant: 0.0,
    strengths: vec3(0.3306, 4.3356, 0.0),
    resonances: vec3(0.030625, 0.011236, 0.0),
};
/// Sapphire and ruby, the ordinary ray, Malitson 1962.
pub const DISPERSION_CORUNDUM: DispersionSellmeier = DispersionSellmeier {
    constant: 0.0,
    strengths: vec3(1.4313493, 0.65054713, 5.3414021),
    resonances: vec3(0.0052799261, 0.0142382647, 325.017834),
};
/// Quartz, the ordinary ray, Ghosh 1999.
pub const DISPERSION_QUARTZ: DispersionSellmeier = DispersionSellmeier {
    constant: 0.28604141,
    strengths: vec3(1.07044083, 1.10202242, 0.0),
    resonances: vec3(0.0100585997, 100.0, 0.0),
};
/// N-BK7, the common optical crown glass, Schott.
pub const DISPERSION_CROWN_GLASS: DispersionSellmeier = DispersionSellmeier {
    constant: 0.0,
    strengths: vec3(1.03961212, 0.231792344, 1.01046945),
    resonances: vec3(0.00600069867, 0.0200179144, 103.560653),
};
/// Cubic zirconia, Wood and Nassau 1982.
pub const DISPERSION_CUBIC_ZIRCONIA: DispersionSellmeier = DispersionSellmeier {
    constant: 0.0,
    strengths: vec3(1.347091, 2.117788, 9.452943),
    resonances: vec3(0.00391162685, 0.0278018941, 591.490125),
};
/// Rutile, the ordinary ray, DeVore 1951.
pub const DISPERSION_RUTILE: DispersionSellmeier = DispersionSellmeier {
    constant: 1.87314944,
    strengths: vec3(3.03985056, 0.0, 0.0),
    resonances: vec3(0.0803, 0.0, 0.0),
};
/// Strontium titanate, Dodge 1986.
pub const DISPERSION_STRONTIUM_TITANATE: DispersionSellmeier = DispersionSellmeier {
    constant: 0.0,
    strengths: vec3(3.042143, 1.170065, 30.83326),
    resonances: vec3(0.0217828671, 0.0872071692, 1101.31458),
};

/// Wavelength of the Fraunhofer line B, in nm.
pub const DISPERSION_LINE_B: f32 = 686.7;
/// Wavelength of the Fraunhofer line C, in nm.
pub const DISPERSION_LINE_C: f32 = 656.3;
/// Wavelength of the d line of helium, in nm. An index given without a wavelength is the index at
/// this line.
pub const DISPERSION_LINE_D: f32 = 587.6;
/// Wavelength of the Fraunhofer line F, in nm.
pub const DISPERSION_LINE_F: f32 = 486.1;
/// Wavelength of the Fraunhofer line G, in nm.
pub const DISPERSION_LINE_G: f32 = 430.8;

/// Wavelength in nm that represents the red channel.
pub const DISPERSION_RED: f32 = 609.0;
/// Wavelength in nm that represents the green channel.
pub const DISPERSION_GREEN: f32 = 539.0;
/// Wavelength in nm that represents the blue channel.
pub const DISPERSION_BLUE: f32 = 453.0;

/// The paper's green channel, as a frequency relative to red.
pub const DISPERSION_PAPER_GREEN: f32 = DISPERSION_RED / DISPERSION_GREEN;
/// The paper's blue channel, as a frequency relative to red.
pub const DISPERSION_PAPER_BLUE: f32 = DISPERSION_RED / DISPERSION_BLUE;

/// The paper's small number.
pub const DISPERSION_PAPER_EPSILON: f32 = 2e-4;
/// Square of 2⁻²⁰. Shorter chords are noise.
pub const DISPERSION_PAPER_CHORD: f32 = 9.094947017729282e-13;
/// Smallest n cos(angle of refraction) by which a gradient is divided.
pub const DISPERSION_CRITICAL: f32 = 0.0625;

/// Returns the index of refraction by Sellmeier's formula; wavelength in nm.
pub fn sellmeier(material: DispersionSellmeier, wavelength: f32) -> f32 {
    // From nm² to µm².
    let squared = wavelength * wavelength * 1e-6;
    let terms = squared / (squared - material.resonances);
    (1.0 + material.constant + material.strengths.dot(terms)).max(1.0).sqrt().max(1.0)
}

/// Returns the index of refraction by Cauchy's formula; wavelength in nm, coefficients in 1, µm²,
/// µm⁴.
pub fn cauchy(coefficients: Vec3, wavelength: f32) -> f32 {
    // From nm² to µm².
    let squared = wavelength * wavelength * 1e-6;
    coefficients.x + (coefficients.y + coefficients.z / squared) / squared
}

/// Returns the index of refraction as defined by glTF (KHR_materials_dispersion); `dispersion` is
/// 20 / V_d.
pub fn abbe(index: f32, dispersion: f32, wavelength: f32) -> f32 {
    let spread = (index - 1.0) * dispersion / 20.0;
    (index + spread * (523655.0 / (wavelength * wavelength) - 1.5168)).max(1.0)
}

/// Returns the Abbe number V_d from the indices at Fraunhofer lines.
pub fn abbe_number(index_d: f32, index_f: f32, index_c: f32) -> f32 {
    (index_d - 1.0) / (index_f - index_c).max(1e-12)
}

/// Returns the gradient after a ray enters the gem.
pub fn enter(direction: Vec3, normal: Vec3, relative_index: f32) -> Vec3 {
    let cosine = (-normal.dot(direction)).max(0.0);
    let radicand = (relative_index - 1.0) * (relative_index + 1.0) + cosine * cosine;
    let tangent = direction + cosine * normal;
    let across = tangent.dot(tangent) / radicand.max(DISPERSION_CRITICAL * DISPERSION_CRITICAL).sqrt();
    (tangent + across * normal) / (-relative_index * relative_index)
}

/// Returns the gradient after a refraction, or after total internal reflection.
pub fn refract(direction: Vec3, gradient: Vec3, normal: Vec3, relative_index: f32, relative_index_slope: f32) -> Vec3 {
    let cosine = (-normal.dot(direction)).max(0.0);
    let cosine_slope = -normal.dot(gradient);
    let radicand = (relative_index - 1.0) * (relative_index + 1.0) + cosine * cosine;
    if radicand < 0.0 {
        return gradient + 2.0 * cosine_slope * normal;
    }
    let tangent = direction + cosine * normal;
    let bending = relative_index_slope / relative_index;
    let leaning = gradient + cosine_slope * normal - bending * tangent;
    // If the gradient lies along the normal, rounding leaves a larger part along the normal than
    // remains along the surface. The normal part is therefore removed a second time.
    let along = leaning - normal.dot(leaning) * normal;
    let across = (bending * tangent.dot(tangent) + cosine * cosine_slope) / radicand.sqrt().max(DISPERSION_CRITICAL);
    (along - across * normal) / relative_index
}

/// Computes the derivative of refraction in its usual form from eq. (6), with eta = 1 / n.
pub fn refract_naive(
    direction: Vec3,
    gradient: Vec3,
    normal: Vec3,
    relative_index: f32,
    relative_index_slope: f32,
) -> Vec3 {
    let eta = 1.0 / relative_index;
    let eta_slope = -relative_index_slope * eta * eta;
    let cosine = -normal.dot(direction);
    let cosine_slope = -normal.dot(gradient);
    let squared_sine = 1.0 - cosine * cosine;
    let root = (1.0 - eta * eta * squared_sine).sqrt();
    let root_slope = (eta * eta * cosine * cosine_slope - eta * eta_slope * squared_sine) / root;
    eta * gradient + eta_slope * direction + (eta_slope * cosine + eta * cosine_slope - root_slope) * normal
}

/// Returns the gradient after a reflection, which is linear.
pub fn reflect(gradient: Vec3, normal: Vec3) -> Vec3 {
    gradient - 2.0 * normal.dot(gradient) * normal
}

/// Returns the direction at the wavelength whose index exceeds that of `direction` by
/// `index_offset`.
pub fn direction(direction: Vec3, gradient: Vec3, index_offset: f32) -> Vec3 {
    (direction + index_offset * gradient).normalize()
}

/// Returns the direction in which a ray spreads on entry, eq. (10); 0 if the ray is not bent.
pub fn paper_enter(direction: Vec3, refracted: Vec3) -> Vec3 {
    let chord = refracted - direction;
    let squared = chord.dot(chord);
    if squared < DISPERSION_PAPER_CHORD {
        return Vec3::ZERO;
    }
    chord / squared.sqrt()
}

/// Computes eq. (10) as printed.
pub fn paper_enter_naive(direction: Vec3, refracted: Vec3) -> Vec3 {
    (refracted - direction).normalize()
}

/// Computes eq. (11) for a refraction from the difference of two refracted rays.
pub fn paper_refract(direction: Vec3, spread: Vec3, normal: Vec3, relative_index: f32, epsilon: f32) -> Vec3 {
    let shifted = direction + epsilon * (spread - direction.dot(spread) * direction);
    let cosine = -normal.dot(direction);
    let cosine_shifted = -normal.dot(shifted);
    let excess = (relative_index - 1.0) * (relative_index + 1.0);
    let radicand = excess + cosine * cosine;
    if radicand < 0.0 {
        return paper_reflect(direction, spread, normal, epsilon);
    }
    let radicand_shifted = (excess + cosine_shifted * cosine_shifted).max(0.0);
    let refracted = (direction + (cosine - radicand.sqrt()) * normal) / relative_index;
    let refracted_shifted = (shifted + (cosine_shifted - radicand_shifted.sqrt()) * normal) / relative_index;
    let difference = refracted_shifted - refracted;
    let squared = difference.dot(difference);
    if squared == 0.0 {
        return Vec3::ZERO;
    }
    difference / squared.sqrt()
}

/// Computes eq. (11) for a refraction as printed, with the built-in `refract` for eq. (6).
pub fn paper_refract_naive(direction: Vec3, spread: Vec3, normal: Vec3, relative_index: f32, epsilon: f32) -> Vec3 {
    let eta = 1.0 / relative_index;
    ((direction + epsilon * spread).refract(normal, eta) - direction.refract(normal, eta)).normalize()
}

/// Computes eq. (11) for a reflection from the difference of two reflected rays.
pub fn paper_reflect(direction: Vec3, spread: Vec3, normal: Vec3, epsilon: f32) -> Vec3 {
    let shifted = direction + epsilon * (spread - direction.dot(spread) * direction);
    let difference = shifted.reflect(normal) - direction.reflect(normal);
    let squared = difference.dot(difference);
    if squared == 0.0 {
        return Vec3::ZERO;
    }
    difference / squared.sqrt()
}

/// Returns the direction at another frequency, eq. (12). `strength` is our addition: 1 is the
/// paper's value.
pub fn paper_direction(direction: Vec3, spread: Vec3, distance: f32, frequency_ratio: f32, strength: f32) -> Vec3 {
    (direction + strength * distance * (frequency_ratio - 1.0) * spread).normalize()
}

#[cfg(test)]
mod tests;
