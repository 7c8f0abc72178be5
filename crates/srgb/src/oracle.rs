//! Ground truth for `srgb`, in f64 and from formulas other than the mirror's.

use glam::DVec3;

/// Solves the inverse problem by bisection: the code value that decodes to `light`. The standard's
/// own threshold selects the piece; there the two pieces are 3e-8 apart.
pub fn encode(light: f64) -> f64 {
    let display = light.clamp(0.0, 1.0);
    if display <= f64::from(0.0031308f32) {
        return display / (1.0 / 12.92);
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if decode_power(middle) < display { low = middle } else { high = middle }
    }
    high
}

/// Computes the power law with logarithms.
pub fn encode_gamma(light: f64) -> f64 {
    if light <= 0.0 { 0.0 } else { (light.min(1.0).ln() / 2.2).exp() }
}

/// Decodes with the line or the power; `decode_power` takes a fifth root instead of a power.
pub fn decode(encoded: f64) -> f64 {
    let code = encoded.clamp(0.0, 1.0);
    if code <= f64::from(0.04045f32) { code * (1.0 / 12.92) } else { decode_power(code) }
}

/// Computes t^2.4 = t^2 (t^2)^(1/5), with the fifth root by Newton's iteration from above.
fn decode_power(code: f64) -> f64 {
    let square = ((code + 0.055) / 1.055).powi(2);
    let mut root = 1.0;
    for _ in 0..12 {
        root -= (root - square / f64::powi(root, 4)) / 5.0;
    }
    square * root
}

/// Applies [`encode`] to each channel.
pub fn encode_color(color: DVec3) -> DVec3 {
    DVec3::from_array(color.to_array().map(encode))
}

/// Applies [`decode`] to each channel.
pub fn decode_color(encoded: DVec3) -> DVec3 {
    DVec3::from_array(encoded.to_array().map(decode))
}

/// Takes green as the base, and red and blue as differences from it: the weights sum to 1.
pub fn luminance(color: DVec3) -> f64 {
    color.y + 0.2126 * (color.x - color.y) + 0.0722 * (color.z - color.y)
}

/// Computes Khronos PBR Neutral from its geometry. The toe is the area under a slope that rises to
/// 1 over [0, 2 F90]. On the shoulder, the reciprocal of the distance to 1 grows linearly with the
/// excess. The desaturation is the centre of mass of the curved colour, with mass 1, and the
/// grey of its peak, with mass K_d times the amount removed by the shoulder.
pub fn tone_curve(color: DVec3) -> DVec3 {
    let radiance = color.max(DVec3::ZERO);
    let smallest = radiance.min_element();
    let knee = 2.0 * 0.04;
    let toe = if smallest < knee { 0.5 * smallest * (smallest / knee) } else { 0.5 * knee + (smallest - knee) };
    let base = (radiance - smallest) + toe;
    let peak = base.max_element();
    let start = 0.8 - 0.04;
    if peak <= start {
        return base;
    }
    let headroom: f64 = 1.0 - start;
    let bent = 1.0 - 1.0 / (headroom.recip() + (peak - start) / (headroom * headroom));
    let mass = 0.15 * (peak - bent);
    (base * (bent / peak) + mass * bent) / (1.0 + mass)
}
