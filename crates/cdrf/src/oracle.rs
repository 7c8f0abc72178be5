//! The oracle in f64. The convolution follows its definition, an integral over the Gaussian by
//! Gaussian quadrature, one lit half turn at a time; if the Gaussian is wider than a radian, the
//! integral is over the wrapped Gaussian instead. The Fourier series of the shader is not used, and
//! a closed form only if no terminator is in reach. The spherical form sums Laplace's integral for
//! the Legendre polynomials.

use glam::{DVec2, DVec3, DVec4, UVec2};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::OnceLock;

/// Half the width of a Gaussian in standard deviations: the part beyond is 3e-12 of it.
const REACH: f64 = 7.0;

/// The five Gauss points on [-1, 1] and their weights.
const GAUSS: [(f64, f64); 5] = [
    (-0.906179845938664, 0.23692688505618908),
    (-0.5384693101056831, 0.47862867049936647),
    (0.0, 128.0 / 225.0),
    (0.5384693101056831, 0.47862867049936647),
    (0.906179845938664, 0.23692688505618908),
];

/// Returns the integral of `f` over [low, high], in panels no wider than `panel`.
fn integral(low: f64, high: f64, panel: f64, f: impl Fn(f64) -> f64) -> f64 {
    if low >= high {
        return 0.0;
    }
    let count = ((high - low) / panel).ceil();
    let half = 0.5 * (high - low) / count;
    (0..count as u32)
        .map(|index| {
            let middle = low + half * (2.0 * f64::from(index) + 1.0);
            half * GAUSS.iter().map(|(node, weight)| weight * f(middle + half * node)).sum::<f64>()
        })
        .sum()
}

fn density(t: f64) -> f64 {
    (-0.5 * t * t).exp() / TAU.sqrt()
}

/// Returns the convolution of max(cos θ, 0), as a periodic function, with a Gaussian. With
/// x = π/2 - θ it is the convolution of max(sin x, 0).
pub fn accurate(cosine: f64, sigma: f64) -> f64 {
    let cosine = cosine.clamp(-1.0, 1.0);
    if sigma <= 0.0 {
        return cosine.max(0.0);
    }
    let x = cosine.asin();
    if (x.abs() / sigma).min((PI - x.abs()) / sigma) > REACH {
        // The Gaussian reaches no terminator: all is dark, or a plain cosine, whose amplitude it
        // damps.
        return cosine.max(0.0) * (-0.5 * sigma * sigma).exp();
    }
    if sigma < 1.0 {
        // Over standard deviations t: sin(x - σt) > 0 for t between (x - π)/σ and x/σ, and in every
        // further period.
        (-2..=2)
            .map(|turn| {
                let shift = TAU * f64::from(turn);
                let (low, high) = ((x + shift - PI) / sigma, (x + shift) / sigma);
                integral(low.max(-REACH), high.min(REACH), 1.0, |t| (x + shift - sigma * t).sin() * density(t))
            })
            .sum()
    } else {
        // Over the lit half turn: the wrapped Gaussian as Jacobi's theta function, which converges
        // fast for a wide Gaussian.
        let damped: [f64; 8] = std::array::from_fn(|n| (-0.5 * (n as f64 * sigma).powi(2)).exp());
        let wrapped = |d: f64| {
            let cosine = d.cos();
            // cos(n d) by Clenshaw's recurrence.
            let (next, after) =
                damped.iter().skip(1).rev().fold((0.0, 0.0), |(b, c), term| (term + 2.0 * cosine * b - c, b));
            (0.5 + cosine * next - after) / PI
        };
        integral(-FRAC_PI_2, FRAC_PI_2, 0.6, |phi| phi.cos() * wrapped(FRAC_PI_2 - x - phi))
    }
}

/// Returns the convolution of the clamped cosine as a single lobe, dark everywhere beyond 90°.
pub fn single_lobe(cosine: f64, sigma: f64) -> f64 {
    let x = cosine.asin();
    let (low, high) = ((x - PI) / sigma, x / sigma);
    integral(low.max(-REACH), high.min(REACH), 0.5, |t| (x - sigma * t).sin() * density(t))
}

/// Returns [`accurate`]: the same function, for a narrow Gaussian.
pub fn edge(cosine: f64, sigma: f64) -> f64 {
    accurate(cosine, sigma)
}

/// Returns the convolution of a straight line that starts at the terminator.
pub fn edge_naive(cosine: f64, sigma: f64) -> f64 {
    integral(-REACH, (cosine / sigma).min(REACH), 0.5, |t| (cosine - sigma * t) * density(t))
}

/// Returns the truncated series.
pub fn series_naive(cosine: f64, sigma: f64) -> f64 {
    series(cosine, sigma, 4)
}

/// Returns [`accurate`]: the same function, computed badly by the mirror.
pub fn angle_naive(cosine: f64, sigma: f64) -> f64 {
    accurate(cosine, sigma)
}

/// Returns [`accurate`]: the same function, in the range in which the naive form holds.
pub fn accurate_naive(cosine: f64, sigma: f64) -> f64 {
    accurate(cosine, sigma)
}

/// Returns [`accurate`]: the same function, also by quadrature, with other nodes and in f64.
pub fn quadrature(cosine: f64, sigma: f64) -> f64 {
    accurate(cosine, sigma)
}

/// Returns the quotient, from its magnitude and its sign.
pub fn deviations(x: f64, sigma: f64) -> f64 {
    if x == 0.0 {
        return 0.0;
    }
    let sigma = sigma.max(f64::from(f32::MIN_POSITIVE));
    (x.abs() / sigma).min(12.0).copysign(x)
}

/// Returns the density by its definition.
pub fn normal_density(u: f64) -> f64 {
    density(u)
}

/// Replaces a NaN by 0 and limits magnitudes to the f32 1e18.
pub fn finite(value: f64) -> f64 {
    let most = f64::from(1e18f32);
    if value.is_nan() { 0.0 } else { value.clamp(-most, most) }
}

/// Returns the product of the valid parts of both.
pub fn sigma(sigma0: f64, curvature: f64) -> f64 {
    if sigma0.is_nan() || curvature.is_nan() || sigma0 < 0.0 {
        return 0.0;
    }
    let most = f64::from(1e18f32);
    sigma0.min(most) * curvature.abs().min(most)
}

/// Returns the plain product, which is right for valid values.
pub fn sigma_naive(sigma0: f64, curvature: f64) -> f64 {
    sigma(sigma0, curvature)
}

/// Returns the power law of the product, at least of 1e-12.
pub fn sigma_power(mean_free_path: f64, curvature: f64) -> f64 {
    1.8 * sigma(mean_free_path, curvature).max(f64::from(1e-12f32)).powf(0.59)
}

/// Returns the power law, which is right for valid values.
pub fn sigma_power_naive(mean_free_path: f64, curvature: f64) -> f64 {
    sigma_power(mean_free_path, curvature)
}

/// What scattering does to the light on a curved surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CdrfDrift {
    /// Width of the Gaussian in radians.
    pub sigma: f64,
    /// Shift of the cosine.
    pub shift: f64,
    /// Factor of the reflectance.
    pub share: f64,
}

/// Takes the shift as the sine of an angle whose tangent is the way sideways, and the share as a
/// quotient of what is absorbed and all.
pub fn drift(mean_free_path: f64, curvature: f64, gamma: f64) -> CdrfDrift {
    let magnitude = sigma(mean_free_path, curvature).min(1.0);
    let gamma = gamma.clamp(0.0, 1.0);
    let sideways = 1.9 * magnitude / (1.0 + 3.2 * gamma);
    let absorbed = gamma.powi(2) + 0.041 * magnitude;
    CdrfDrift {
        sigma: 1.5 * magnitude,
        shift: if curvature < 0.0 { -1.0 } else { 1.0 } * sideways.atan().sin(),
        share: if magnitude == 0.0 { 1.0 } else { absorbed / (absorbed + 0.13 * magnitude.powi(2)) },
    }
}

/// Adds the rapidities of which cosine and shift are the hyperbolic tangents.
pub fn shifted(cosine: f64, shift: f64) -> f64 {
    let most = f64::from(0.9f32);
    (cosine.clamp(-1.0, 1.0).atanh() + shift.clamp(-most, most).atanh()).tanh()
}

/// Returns the arcsine of the standard library.
pub fn arcsine(sine: f64) -> f64 {
    sine.clamp(-1.0, 1.0).asin()
}

/// Sums Taylor's series of the integral of the density, whose terms are all positive:
/// φ(u) Σ u^(2k+1) / (1·3·…·(2k+1)).
pub fn normal_share(u: f64) -> f64 {
    if u.abs() > 8.0 {
        return if u < 0.0 { 0.0 } else { 1.0 };
    }
    let (mut term, mut sum, mut odd) = (u, u, 1.0);
    // Once `odd` exceeds u² the terms fall. Up to 8 standard deviations the largest is 1e13. The sum
    // ends at terms of 1e-17 of it.
    while odd < u * u || term.abs() > 1e-17 * sum.abs() {
        odd += 2.0;
        term *= u * u / odd;
        sum += term;
    }
    0.5 + density(u) * sum
}

/// Returns the mean of the cosine and its magnitude.
pub fn lambert(cosine: f64) -> f64 {
    let cosine = cosine.clamp(-1.0, 1.0);
    0.5 * (cosine + cosine.abs())
}

/// Returns (c + w) / (1 + w)² with w = σ/2, its numerator and denominator multiplied by 4.
pub fn wrap(cosine: f64, sigma: f64) -> f64 {
    let sigma = sigma.clamp(0.0, 2.0);
    (4.0 * cosine.clamp(-1.0, 1.0) + 2.0 * sigma).max(0.0) / (2.0 + sigma).powi(2)
}

/// Sums the harmonics one by one, with angles.
pub fn series(cosine: f64, sigma: f64, terms: u32) -> f64 {
    let theta = cosine.clamp(-1.0, 1.0).acos();
    let sigma = sigma.clamp(0.0, 8.0);
    let harmonic = |order: u32| (-0.5 * (f64::from(order) * sigma).powi(2)).exp() * (f64::from(order) * theta).cos();
    let even = (1..=terms).map(|n| {
        let sign = if n % 2 == 0 { -1.0 } else { 1.0 };
        sign * harmonic(2 * n) / (4.0 * f64::from(n).powi(2) - 1.0)
    });
    1.0 / PI + 0.5 * harmonic(1) + 2.0 / PI * even.sum::<f64>()
}

/// Returns [`accurate`], which the cheap form approximates.
pub fn cheap(cosine: f64, sigma: f64) -> f64 {
    accurate(cosine, sigma)
}

/// Evaluates channel by channel.
pub fn rgb(cosine: f64, sigma0: DVec3, curvature: f64) -> DVec3 {
    DVec3::from_array(sigma0.to_array().map(|sigma0| accurate(cosine, sigma(sigma0, curvature))))
}

/// Returns the sine of the standard library, after whole turns are subtracted. Past a quarter turn
/// it uses the remaining angle to the half turn, so that half turns are exact.
pub fn sine(turns: f64) -> f64 {
    let turns = turns - turns.round();
    if turns.abs() > 0.25 { (TAU * (0.5 - turns.abs())).sin().copysign(turns) } else { (TAU * turns).sin() }
}

/// Returns ∫ c P_l(c) dc over [0, 1] times (2l + 1) / 2, for even l ≥ 2. By Legendre's equation the
/// integral is -P_l(0) / ((l - 1)(l + 2)), with P_l(0) the central binomial coefficient over 2^l
/// with the sign (-1)^(l/2).
fn coefficient(l: u32) -> f64 {
    let at_zero = (1..=l / 2).fold(1.0, |product, k| product * (1.0 - 2.0 * f64::from(k)) / (2.0 * f64::from(k)));
    let l = f64::from(l);
    -(l + 0.5) * at_zero / ((l - 1.0) * (l + 2.0))
}

/// Returns the coefficients of all even degrees that are ever needed.
fn coefficients() -> &'static [f64] {
    static COEFFICIENTS: OnceLock<Vec<f64>> = OnceLock::new();
    COEFFICIENTS.get_or_init(|| (0..40).map(|half| if half == 0 { 0.25 } else { coefficient(2 * half) }).collect())
}

/// Returns the clamped cosine diffused over the sphere. From sigma = 0.1 on it uses Laplace's
/// integral: P_l(cos θ) is the mean over ψ of (cos θ + i sin θ cos ψ)^l. From 1e-3 to 0.1 it uses
/// the series with Bonnet's recurrence, because the shader has a closed form there. Below 1e-3 it
/// uses the convolution on the circle: sphere and circle differ there only by e^(-σ²/2), to 1e-9.
pub fn spherical(cosine: f64, sigma: f64) -> f64 {
    let cosine = cosine.clamp(-1.0, 1.0);
    if sigma < 1e-3 {
        return accurate(cosine, sigma) * (-0.5 * sigma.max(0.0).powi(2)).exp();
    }
    let damped = |l: u32| (-0.5 * f64::from(l * (l + 1)) * sigma * sigma).exp();
    let last = (6.0 / sigma).ceil().max(2.0) as u32;
    let first = 0.25 + 0.5 * damped(1) * cosine;
    if sigma >= 0.1 {
        let used = 1..=last / 2 + 1;
        let coefficients: Vec<f64> = used.map(|half| coefficients()[half as usize] * damped(2 * half)).collect();
        let nodes = last / 2 + 2;
        let sine_squared = (1.0 - cosine) * (1.0 + cosine);
        let sum: f64 = (0..nodes)
            .map(|node| {
                // By symmetry half a circle of ψ and z² alone suffice; only the real part counts.
                let psi = PI * (f64::from(node) + 0.5) / f64::from(nodes);
                let imaginary = psi.cos();
                let re = cosine * cosine - sine_squared * imaginary * imaginary;
                let im = 2.0 * cosine * sine_squared.sqrt() * imaginary;
                // Horner's scheme in z².
                let (re_sum, _) = coefficients.iter().rev().fold((0.0, 0.0), |(a, b), coefficient| {
                    let (a, b) = (a + coefficient, b);
                    (a * re - b * im, a * im + b * re)
                });
                re_sum
            })
            .sum();
        return first + sum / f64::from(nodes);
    }
    let (mut previous, mut current, mut at_zero, mut sum) = (1.0, cosine, 1.0, first);
    let step = (-sigma * sigma).exp();
    let (mut weight, mut ratio) = (step, step);
    for l in 2..=last {
        let degree = f64::from(l);
        ratio *= step;
        weight *= ratio;
        let next = ((2.0 * degree - 1.0) * cosine * current - (degree - 1.0) * previous) / degree;
        (previous, current) = (current, next);
        if l % 2 == 0 {
            at_zero *= (1.0 - degree) / degree;
            sum -= (degree + 0.5) * at_zero / ((degree - 1.0) * (degree + 2.0)) * weight * next;
        }
    }
    sum
}

/// Returns [`spherical`]: the same function, for a narrow Gaussian.
pub fn spherical_edge(cosine: f64, sigma: f64) -> f64 {
    spherical(cosine, sigma)
}

/// Returns the factors of Funk and Hecke: 4π/(2l+1) times the Legendre coefficient of the form,
/// from the moments of the cosine integrated over the lit half.
pub fn harmonic_weights(sigma: f64) -> DVec4 {
    let sigma = sigma.max(0.0);
    DVec4::from_array([0u32, 1, 2, 4].map(|l| {
        let moment = integral(0.0, 1.0, 0.25, |c| c * legendre(l, c));
        TAU * moment * (-0.5 * f64::from(l * (l + 1)) * sigma * sigma).exp()
    }))
}

/// Returns Legendre's polynomial by Bonnet's recurrence.
fn legendre(l: u32, x: f64) -> f64 {
    let step = |(before, last): (f64, f64), k: u32| {
        let k = f64::from(k);
        (last, ((2.0 * k + 1.0) * x * last - k * before) / (k + 1.0))
    };
    (0..l).fold((0.0, 1.0), step).1
}

/// Returns the cosine's distance from -1, and 1 - 1 / (1 + σ).
pub fn table_coordinates(cosine: f64, sigma: f64) -> DVec2 {
    let sigma = sigma.max(0.0);
    let row = if sigma < 1.0 { sigma / (1.0 + sigma) } else { 1.0 - 1.0 / (1.0 + sigma) };
    DVec2::new((cosine.clamp(-1.0, 1.0) - -1.0) / 2.0, row)
}

/// Returns the convolution at a texel's position: the column counts cosines up from -1, the row is
/// the odds of sigma to 1.
pub fn table_texel(texel: UVec2, size: UVec2, tint: DVec3) -> DVec3 {
    let last = (size.max(UVec2::splat(2)) - 1).as_dvec2();
    let fraction = texel.as_dvec2().min(last) / last;
    let sigma = if fraction.y < 1.0 { (1.0 - fraction.y).recip() - 1.0 } else { 1e40 };
    DVec3::from_array(tint.to_array().map(|tint| accurate(2.0 * fraction.x - 1.0, tint * sigma)))
}

/// Interpolates between half a texel from one edge and half a texel from the other.
pub fn texture_coordinates(coordinates: DVec2, size: UVec2) -> DVec2 {
    let half = 0.5 / size.as_dvec2();
    half + coordinates * (1.0 - 2.0 * half)
}

/// Returns the coordinates unchanged.
pub fn texture_coordinates_naive(coordinates: DVec2) -> DVec2 {
    coordinates
}

/// The four texels around a position in the table and their blend weights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CdrfTexels {
    /// Column and row of the texel at the lower coordinates.
    pub lower: UVec2,
    /// Column and row of the texel at the higher coordinates.
    pub upper: UVec2,
    /// Share of `upper` in each direction, in [0, 1].
    pub weight: DVec2,
}

/// Splits the distance from the centre of the first texel into its whole part and the remainder.
pub fn texels(coordinates: DVec2, size: UVec2) -> CdrfTexels {
    let side = |coordinate: f64, size: u32| {
        let offset = coordinate.clamp(0.0, 1.0) * f64::from(size - 1);
        (offset.trunc() as u32, (offset.trunc() as u32 + 1).min(size - 1), offset.fract())
    };
    let (column, row) = (side(coordinates.x, size.x), side(coordinates.y, size.y));
    CdrfTexels {
        lower: UVec2::new(column.0, row.0),
        upper: UVec2::new(column.1, row.1),
        weight: DVec2::new(column.2, row.2),
    }
}

/// Weights the four corners by their areas.
pub fn blend(weight: DVec2, lower_left: DVec3, lower_right: DVec3, upper_left: DVec3, upper_right: DVec3) -> DVec3 {
    let other = 1.0 - weight;
    other.x * other.y * lower_left
        + weight.x * other.y * lower_right
        + other.x * weight.y * upper_left
        + weight.x * weight.y * upper_right
}

/// Returns the normal distribution of `u` by its definition, for the test of [`normal_share`].
pub fn normal_share_by_quadrature(u: f64) -> f64 {
    integral(-10.0, u, 0.25, density)
}
