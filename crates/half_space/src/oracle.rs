//! The oracle in f64. H comes from its logarithm, an integral with an arctangent, by the trapezoidal
//! rule: Chandrasekhar, "Radiative Transfer", section 39; the angle is substituted so that nothing has
//! a peak. Moments of H and reflectances under diffuse light are quadratures of it, interpolated by
//! Chebyshev's polynomials in gamma. The boundary's reflectance is an integral of Fresnel's law over
//! the hyperbolic angle in which both amplitudes are rational. Where the shader's formula is a fit that
//! stands for no closed truth (`gain`, `slant`), its polynomials are summed term by term. The tests
//! compare H with the integral equation, and the whole law with all reflections inside.

use glam::DVec2;
use std::f64::consts::PI;
use std::sync::OnceLock;

/// The module's constants, repeated so that an error in them does not carry over to the oracle.
const GRAZING: f32 = 1e-18;
const LEAST_TURNED: f32 = 0.001;
const LAST_EDGE: f32 = 0.981;

/// The five Gauss points on [-1, 1] and their weights.
pub(crate) const GAUSS: [(f64, f64); 5] = [
    (-0.906179845938664, 0.23692688505618908),
    (-0.5384693101056831, 0.47862867049936647),
    (0.0, 128.0 / 225.0),
    (0.5384693101056831, 0.47862867049936647),
    (0.906179845938664, 0.23692688505618908),
];

/// Number of Chebyshev nodes in gamma; 32 interpolate to 4e-14.
const NODES: usize = 32;

/// Returns the integral of `f` over [low, high], in equal panels no wider than `panel`.
pub(crate) fn integral(low: f64, high: f64, panel: f64, f: impl Fn(f64) -> f64) -> f64 {
    let count = ((high - low) / panel).ceil().max(1.0);
    let half = 0.5 * (high - low) / count;
    (0..count as u32)
        .map(|index| {
            let middle = low + half * (2.0 * f64::from(index) + 1.0);
            half * GAUSS.iter().map(|(node, weight)| weight * f(middle + half * node)).sum::<f64>()
        })
        .sum()
}

/// Returns the tangents and weights of the trapezoidal rule over t, with tan φ = e^t. The integrand
/// is analytic up to an imaginary part of π/2, so that a step of 0.4 is right to e^(-π² / 0.4), 2e-11.
fn tangents() -> &'static [(f64, f64)] {
    static TANGENTS: OnceLock<Vec<(f64, f64)>> = OnceLock::new();
    TANGENTS.get_or_init(|| {
        let node = |index: i32| {
            let t = 0.4 * f64::from(index);
            (t.exp(), 0.4 / (2.0 * PI * t.cosh()))
        };
        (-70..=70).map(node).collect()
    })
}

/// Returns ln H = -1/π ∫ ln(1 - ω θ cot θ) dφ over [0, π/2], with tan θ = tan φ / cosine.
fn ln_h(cosine: f64, gamma: f64) -> f64 {
    let albedo = (1.0 - gamma) * (1.0 + gamma);
    let term = |&(tangent, weight): &(f64, f64)| {
        let x = tangent / cosine;
        let part = x.atan() / x;
        let logarithm = if albedo * part < 0.5 {
            (-albedo * part).ln_1p()
        } else {
            let square = x * x;
            let series = square * (1.0 / 3.0 - square * (0.2 - square * (1.0 / 7.0 - square / 9.0)));
            let rest = if x < 0.05 { series } else { 1.0 - part };
            (gamma * gamma + albedo * rest).ln()
        };
        weight * logarithm
    };
    -tangents().iter().map(term).sum::<f64>()
}

fn clamped(cosine: f64, gamma: f64) -> (f64, f64) {
    (cosine.clamp(f64::from(GRAZING), 1.0), gamma.clamp(0.0, 1.0))
}

/// Computes H from its logarithm.
pub fn h(cosine: f64, gamma: f64) -> f64 {
    let (cosine, gamma) = clamped(cosine, gamma);
    ln_h(cosine, gamma).exp()
}

/// Computes Hapke's line with both terms halved.
pub fn h_paper(cosine: f64, gamma: f64) -> f64 {
    (0.5 + cosine) / (0.5 + cosine * gamma)
}

/// Computes 1 - γH from the sum of both logarithms.
pub fn directional(cosine: f64, gamma: f64) -> f64 {
    let (cosine, gamma) = clamped(cosine, gamma);
    -(ln_h(cosine, gamma) + (gamma - 1.0).ln_1p()).exp_m1()
}

/// Returns [`directional`]: the naive form is the same function, computed badly.
pub fn directional_naive(cosine: f64, gamma: f64) -> f64 {
    directional(cosine, gamma)
}

/// Computes N = (1 - γH) / ((1 - γ) H); for γ = 1 the limit, an integral of m / (cosine + m).
pub fn escape(cosine: f64, gamma: f64) -> f64 {
    let (cosine, gamma) = clamped(cosine, gamma);
    if gamma == 1.0 {
        1.0 - cosine * cosine.recip().ln_1p()
    } else {
        directional(cosine, gamma) / ((1.0 - gamma) * h(cosine, gamma))
    }
}

/// A function of gamma at the Chebyshev nodes of [0, 1]: node, barycentric weight and value.
struct Interpolated([(f64, f64, f64); NODES]);

impl Interpolated {
    fn of(f: impl Fn(f64) -> f64) -> Self {
        Self(std::array::from_fn(|index| {
            let angle = PI * (index as f64 + 0.5) / NODES as f64;
            let node = 0.5 - 0.5 * angle.cos();
            let sign = if index % 2 == 0 { 1.0 } else { -1.0 };
            (node, sign * angle.sin(), f(node))
        }))
    }

    /// Returns the interpolating polynomial by the barycentric formula.
    fn at(&self, gamma: f64) -> f64 {
        let (mut sum, mut weights) = (0.0, 0.0);
        for (node, weight, value) in &self.0 {
            let distance = gamma - node;
            if distance == 0.0 {
                return *value;
            }
            sum += weight / distance * value;
            weights += weight / distance;
        }
        sum / weights
    }
}

/// Returns the mean of `f` over the hemisphere, weighted with the cosine. The cosine is a square, since
/// H has an infinite slope at 0.
pub(crate) fn mean(f: impl Fn(f64) -> f64) -> f64 {
    integral(0.0, 1.0, 1.0 / 16.0, |u| 4.0 * u * u * u * f(u * u))
}

/// Returns twice the first moment of H.
fn moment(gamma: f64) -> f64 {
    static MOMENTS: OnceLock<Interpolated> = OnceLock::new();
    MOMENTS.get_or_init(|| Interpolated::of(|gamma| mean(|cosine| h(cosine, gamma)))).at(gamma)
}

/// Computes the quotient from the mean of [`directional`].
pub fn darkening(gamma: f64) -> f64 {
    static QUOTIENTS: OnceLock<Interpolated> = OnceLock::new();
    let quotient = |gamma: f64| (1.0 - gamma) / mean(|cosine| directional(cosine, gamma));
    QUOTIENTS.get_or_init(|| Interpolated::of(quotient)).at(gamma.clamp(0.0, 1.0))
}

/// Computes the mean of [`directional`].
pub fn reflectance(gamma: f64) -> f64 {
    let gamma = gamma.clamp(0.0, 1.0);
    (1.0 - gamma) / darkening(gamma)
}

/// Searches for the gamma of a reflectance by the odds of absorption.
pub fn gamma_of_reflectance(reflectance: f64) -> f64 {
    gamma_of_entered(reflectance, 0.0)
}

/// Computes gamma from the odds of scattering.
pub fn gamma(albedo: f64, anisotropy: f64) -> f64 {
    let albedo = albedo.clamp(0.0, 1.0);
    let turned = (1.0 - anisotropy.clamp(-1.0, 1.0)).max(LEAST_TURNED.into());
    let odds = albedo / (1.0 - albedo) * turned;
    (1.0 + odds).sqrt().recip()
}

/// Returns [`gamma`]: the naive form is the same function, computed badly.
pub fn gamma_naive(albedo: f64, anisotropy: f64) -> f64 {
    gamma(albedo, anisotropy)
}

fn sum(cosine_eye: f64, cosine_light: f64) -> f64 {
    cosine_eye.clamp(f64::from(GRAZING), 1.0) + cosine_light.clamp(f64::from(GRAZING), 1.0)
}

/// Computes Chandrasekhar's law with the H of this file.
pub fn brdf(cosine_eye: f64, cosine_light: f64, gamma: f64) -> f64 {
    let gamma = gamma.clamp(0.0, 1.0);
    let both = h(cosine_eye, gamma) * h(cosine_light, gamma);
    (1.0 - gamma) * (1.0 + gamma) * both / (4.0 * PI * sum(cosine_eye, cosine_light))
}

/// Returns [`brdf`]: the naive form is the same function, computed badly.
pub fn brdf_naive(cosine_eye: f64, cosine_light: f64, gamma: f64) -> f64 {
    brdf(cosine_eye, cosine_light, gamma)
}

/// Computes the quotient of the law and Lambert's; its limit where both are 0.
pub fn factor(cosine_eye: f64, cosine_light: f64, gamma: f64) -> f64 {
    let gamma = gamma.clamp(0.0, 1.0);
    if gamma == 1.0 {
        return 0.5 * darkening(gamma) / sum(cosine_eye, cosine_light);
    }
    PI * brdf(cosine_eye, cosine_light, gamma) / reflectance(gamma)
}

/// Returns [`factor`]: the naive form is the same function, computed badly.
pub fn factor_naive(cosine_eye: f64, cosine_light: f64, gamma: f64) -> f64 {
    factor(cosine_eye, cosine_light, gamma)
}

/// Divides H by twice its first moment.
pub fn exit(cosine: f64, gamma: f64) -> f64 {
    let gamma = gamma.clamp(0.0, 1.0);
    h(cosine, gamma) / moment(gamma)
}

/// Computes the cosine of the angle of Snell's law.
pub fn refract(cosine: f64, relative_index: f64) -> f64 {
    let cosine = cosine.clamp(f64::from(GRAZING), 1.0);
    let index = relative_index.clamp(1.0, 4.0);
    if index == 1.0 {
        return cosine;
    }
    (((1.0 - cosine) * (1.0 + cosine)).sqrt() / index).asin().cos()
}

/// Integrates Fresnel's reflectance over v with c = √(n² - 1) sinh v. The root of n² - 1 + c² is then
/// √(n² - 1) cosh v, and both amplitudes are rational in e^(-2v).
pub fn edge(relative_index: f64) -> f64 {
    let index = relative_index.clamp(1.0, 4.0);
    let m = (index - 1.0) * (index + 1.0);
    if m == 0.0 {
        return 0.0;
    }
    let reflected = |v: f64| {
        let s = (-2.0 * v).exp();
        // 1 - tanh v.
        let rest = 2.0 * s / (1.0 + s);
        let square = index * index;
        let p = (m - square * rest) / (square * (1.0 - rest) + 1.0);
        0.5 * (s * s + p * p) * (2.0 * v).sinh()
    };
    let ratio = integral(0.0, m.sqrt().recip().asinh(), 0.125, reflected);
    (m * (1.0 + ratio)).sqrt() / index
}

/// Returns [`edge`]: the naive form is the same function, computed badly.
pub fn edge_naive(relative_index: f64) -> f64 {
    edge(relative_index)
}

fn clamped_edge(edge: f64) -> f64 {
    edge.clamp(0.0, f64::from(LAST_EDGE))
}

/// Returns Σ a γ^i e^j.
fn polynomial(terms: &[(f64, i32, i32)], gamma: f64, edge: f64) -> f64 {
    terms.iter().map(|(factor, i, j)| factor * gamma.powi(*i) * edge.powi(*j)).sum()
}

/// Sums the fit's polynomials term by term.
pub fn gain(gamma: f64, edge: f64) -> f64 {
    let (gamma, edge) = (gamma.clamp(0.0, 1.0), clamped_edge(edge));
    let white = [(1.0093106, 0, 0), (1.0942524, 1, 0), (-0.39723844, 0, 1)];
    let dark = [(-1.0689417, 1, 0), (2.48031, 1, 1), (-0.06959722, 2, 0), (1.6286656, 2, 1)];
    let over = [(1.0, 0, 0), (3.3934849, 0, 1), (-1.3134133, 0, 2)];
    let passed = 1.0 - edge * edge;
    polynomial(&over, gamma, edge)
        / (4.0 * PI * (passed * polynomial(&white, gamma, edge) + polynomial(&dark, gamma, edge)))
}

/// Sums the fit's polynomials term by term.
pub fn slant(gamma: f64, edge: f64) -> f64 {
    let (gamma, edge) = (gamma.clamp(0.0, 1.0), clamped_edge(edge));
    let over = [(2.3512168, 1, 2), (-0.04584427, 2, 2)];
    let under = [(1.0, 0, 0), (1.3143637, 0, 1), (1.3818834, 1, 1)];
    1.0 + polynomial(&over, gamma, edge) / polynomial(&under, gamma, edge)
}

/// Returns Pade's form of order 2 of 1 - ln(1 + y) / y with y = edge / cosine.
fn below(cosine: f64, edge: f64) -> f64 {
    let share = edge / (cosine + edge);
    let y = share / (1.0 - share);
    if y < 1e9 { y * (15.0 + 8.0 * y) / (30.0 + 36.0 * y + 9.0 * y * y) } else { 8.0 / 9.0 }
}

/// Adds what the boundary has thrown back to the law.
pub fn inside(cosine_eye: f64, cosine_light: f64, gamma: f64, edge: f64, gain: f64) -> f64 {
    let (gamma, edge, gain) = (gamma.clamp(0.0, 1.0), clamped_edge(edge), gain.clamp(0.0, 100.0));
    let cosines = DVec2::new(cosine_eye, cosine_light).clamp(DVec2::splat(f64::from(GRAZING)), DVec2::ONE);
    let albedo = (1.0 - gamma) * (1.0 + gamma);
    let [eye, light] = cosines.to_array().map(|cosine| albedo * h(cosine, gamma) * below(cosine, edge));
    brdf(cosines.x, cosines.y, gamma) + gain * eye * light
}

/// Evaluates [`inside`] at the refracted cosines.
pub fn dielectric(cosine_eye: f64, cosine_light: f64, gamma: f64, relative_index: f64, edge: f64, gain: f64) -> f64 {
    let [eye, light] = [cosine_eye, cosine_light].map(|cosine| refract(cosine, relative_index));
    inside(eye, light, gamma, edge, gain) / relative_index.clamp(1.0, 4.0).powi(2)
}

/// Returns the odds of absorption: the share 1 - r = γ ∫ 2 m H over r, times what the boundary does.
fn odds(gamma: f64, edge: f64) -> f64 {
    slant(gamma, edge) * gamma * moment(gamma) / (reflectance(gamma) * (1.0 - edge) * (1.0 + edge))
}

/// Computes the share from the odds of absorption.
pub fn entered(gamma: f64, edge: f64) -> f64 {
    let (gamma, edge) = (gamma.clamp(0.0, 1.0), clamped_edge(edge));
    1.0 / (1.0 + odds(gamma, edge))
}

/// Searches for the gamma whose odds of absorption are those of the shares.
pub fn gamma_of_shares(reflected: f64, absorbed: f64) -> f64 {
    let [reflected, absorbed] = [reflected, absorbed].map(|part| part.clamp(0.0, 1.0).abs());
    gamma_of_odds(absorbed / reflected, 0.0)
}

/// Searches for the gamma whose odds of absorption are those of the share.
pub fn gamma_of_entered(share: f64, edge: f64) -> f64 {
    // Not -0, over which the odds are negative.
    let share = share.clamp(0.0, 1.0).abs();
    gamma_of_odds((1.0 - share) / share, clamped_edge(edge))
}

/// Bisects the odds of absorption, which rise with gamma and keep their digits if it is small.
fn gamma_of_odds(wanted: f64, edge: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..128 {
        let middle = 0.5 * (low + high);
        if odds(middle, edge) < wanted {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}
