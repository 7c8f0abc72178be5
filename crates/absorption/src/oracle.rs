//! The oracle in f64, by equal layers, as in the derivation of the law itself. A medium is cut into
//! layers so thin that each is a short series, and the transmittances of the layers are multiplied.
//! The optical depth is the integral of dT / T, by Gaussian quadrature. No logarithm, exponential
//! or power function is called.

use glam::DVec3;

/// Lower end of the clamp, 2^-126.
const DARKEST: f64 = f32::MIN_POSITIVE as f64;

/// Positive nodes of the 12-point Gauss-Legendre rule on [-1, 1], with their weights. Abramowitz
/// and Stegun, table 25.4.
const GAUSS: [(f64, f64); 6] = [
    (0.125233408511468915, 0.249147045813402785),
    (0.367831498998180194, 0.233492536538354809),
    (0.587317954286617447, 0.203167426723065922),
    (0.769902674194304687, 0.160078328543346226),
    (0.904117256370474857, 0.106939325995318431),
    (0.981560634246719251, 0.047175336386511827),
];

/// Returns ∫ dt / t from the transmittance to 1: the integral from 1/2 to 1 for each whole octave,
/// plus the integral over the remaining part of an octave.
pub fn optical_depth(transmittance: f64) -> f64 {
    let mut left = transmittance.clamp(DARKEST, 1.0);
    let mut octaves = 0.0;
    while left < 0.5 {
        left *= 2.0;
        octaves += 1.0;
    }
    octaves * inverse_integral(0.5) + inverse_integral(left)
}

/// Returns ∫ dt / t from `low` in [1/2, 1] to 1.
fn inverse_integral(low: f64) -> f64 {
    let (middle, half) = (0.5 * (1.0 + low), 0.5 * (1.0 - low));
    // 1 / (middle - half x) + 1 / (middle + half x)
    let pair = |node: f64| 2.0 * middle / ((middle - half * node) * (middle + half * node));
    half * GAUSS.iter().map(|(node, weight)| weight * pair(*node)).sum::<f64>()
}

/// Returns the optical depth divided by the distance.
pub fn coefficient(attenuation_color: DVec3, attenuation_distance: f64) -> DVec3 {
    // The limits are the f32 constants, to the last place.
    if attenuation_distance <= 0.0 || attenuation_distance >= f64::from(1e30f32) {
        return DVec3::ZERO;
    }
    attenuation_color.map(optical_depth) / attenuation_distance.max(f64::from(1e-30f32))
}

/// Multiplies 2^k equal layers, each with an optical depth h of at most 1/2 and a transmittance of
/// 1 - h + h²/2 - ….
pub fn transmittance(coefficient: DVec3, distance: f64) -> DVec3 {
    coefficient.map(|coefficient| {
        let mut thickness = coefficient * distance.max(0.0);
        if thickness > 700.0 {
            // Far below the smallest f32.
            return 0.0;
        }
        let mut doublings = 0;
        while thickness > 0.5 {
            thickness *= 0.5;
            doublings += 1;
        }
        // 1 - h (1 - h/2 (1 - h/3 (…))).
        let layer = (1..=16).rev().fold(1.0, |rest, term| 1.0 - thickness / f64::from(term) * rest);
        (0..doublings).fold(layer, |transmittance, _| transmittance * transmittance)
    })
}
