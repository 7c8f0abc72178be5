//! Mirror of `wgsl/cdrf.wgsl`, line by line: curvature-dependent reflectance. The WGSL file states
//! the units, domain and accuracy of each function.
//!
//! ```
//! use lapidary_cdrf::{accurate, lambert, sigma};
//!
//! // Skin that scatters light over 2 mm, on a finger of 8 mm radius: light beyond the terminator.
//! let sigma = sigma(0.002, 1.0 / 0.008);
//! assert_eq!(lambert(-0.1), 0.0);
//! assert!(accurate(-0.1, sigma) > 0.0);
//! ```

#[cfg(feature = "formulas")]
pub mod formulas;
pub mod oracle;

use glam::{UVec2, Vec2, Vec3, Vec4};

/// From this sigma on the Fourier series is summed; below it the single-edge form is used.
pub const CDRF_SWITCH: f32 = 0.3;
/// The same switch for the cheap form.
pub const CDRF_CHEAP_SWITCH: f32 = 0.35;
/// The same switch for the spherical form.
pub const CDRF_SPHERICAL_SWITCH: f32 = 0.1;
/// Wider Gaussians count as this one.
pub const CDRF_WIDEST: f32 = 8.0;
/// Lower limit of divisors, 2^-126.
pub const CDRF_SMALLEST: f32 = 1.1754943508222875e-38;

/// Returns the sign as WGSL's `sign` does: 0 for 0.
fn sign(value: f32) -> f32 {
    if value == 0.0 { 0.0 } else { value.signum() }
}

/// Makes a number from any source safe to calculate with: a NaN becomes 0, and magnitudes are
/// limited to 1e18.
pub fn finite(value: f32) -> f32 {
    let bits = value.to_bits();
    let magnitude = bits & 0x7fff_ffff;
    if magnitude > 0x7f80_0000 {
        return 0.0;
    }
    f32::from_bits((bits & 0x8000_0000) | magnitude.min(0x5d5e_0b6b))
}

/// Returns the width of the Gaussian, in radians, from the material's scattering and the surface's
/// curvature.
pub fn sigma(sigma0: f32, curvature: f32) -> f32 {
    finite(sigma0).max(0.0) * finite(curvature).abs()
}

/// Returns the plain product, as printed in the paper; a naive form.
pub fn sigma_naive(sigma0: f32, curvature: f32) -> f32 {
    sigma0 * curvature
}

/// Returns the width of the Gaussian, in radians, by the power law of random walks through spheres.
pub fn sigma_power(mean_free_path: f32, curvature: f32) -> f32 {
    let turn = sigma(mean_free_path, curvature).max(1e-12);
    1.8 * (0.59 * turn.log2()).exp2()
}

/// Returns the power law of the plain product; a naive form.
pub fn sigma_power_naive(mean_free_path: f32, curvature: f32) -> f32 {
    1.8 * (mean_free_path * curvature).powf(0.59)
}

/// What scattering does to the light on a curved surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CdrfDrift {
    /// Width of the Gaussian in radians.
    pub sigma: f32,
    /// Shift of the cosine, for [`shifted`].
    pub shift: f32,
    /// Factor of the reflectance.
    pub share: f32,
}

/// Returns the drift of light below a curved surface; `gamma` is the root of 1 - albedo.
pub fn drift(mean_free_path: f32, curvature: f32, gamma: f32) -> CdrfDrift {
    let turn = (finite(mean_free_path).max(0.0) * finite(curvature)).clamp(-1.0, 1.0);
    let g = gamma.clamp(0.0, 1.0);
    let magnitude = turn.abs();
    let sideways = 1.9 * turn / (1.0 + 3.2 * g);
    let absorbed = (g * g + 0.041 * magnitude).max(CDRF_SMALLEST);
    CdrfDrift {
        sigma: 1.5 * magnitude,
        shift: sideways / (1.0 + sideways * sideways).sqrt(),
        share: (1.0 / (1.0 + 0.13 * magnitude * (magnitude / absorbed))).min(1.0),
    }
}

/// Returns the cosine of the light where the light that leaves here has entered.
pub fn shifted(cosine: f32, shift: f32) -> f32 {
    let c = cosine.clamp(-1.0, 1.0);
    let b = shift.clamp(-0.9, 0.9);
    c + b * ((1.0 - c) * (1.0 + c)) / (1.0 + b * c)
}

/// Returns the angle in radians from its sine.
pub fn arcsine(sine: f32) -> f32 {
    let a = sine.abs().min(1.0);
    let outer = a > 0.5;
    let half = 0.5 * (1.0 - a);
    let square = if outer { half } else { a * a };
    let root = if outer { half.sqrt() } else { a };
    let rest = square
        * (0.16666752
            + square * (0.074953003 + square * (0.045470026 + square * (0.024181311 + square * 0.042163199))));
    let small = root + root * rest;
    let angle = if outer { 1.5707964 - 2.0 * small } else { small };
    sign(sine) * angle
}

/// Returns the distance from the terminator in standard deviations.
pub fn deviations(x: f32, sigma: f32) -> f32 {
    (x / sigma.max(CDRF_SMALLEST)).clamp(-12.0, 12.0)
}

/// Returns the density of the standard normal distribution.
pub fn normal_density(u: f32) -> f32 {
    0.3989423 * (-0.5 * u * u).exp()
}

/// Returns the standard normal distribution: the share of a Gaussian below `u` standard deviations.
pub fn normal_share(u: f32) -> f32 {
    let a = u.abs().min(12.0);
    let t = 1.0 / (1.0 + 0.2316419 * a);
    let tail =
        normal_density(a) * t * (0.31938153 + t * (-0.35656378 + t * (1.7814779 + t * (-1.8212560 + t * 1.3302744))));
    0.5 + sign(u) * (0.5 - tail)
}

/// Returns the reflectance by Lambert's law: no scattering at all.
pub fn lambert(cosine: f32) -> f32 {
    cosine.clamp(0.0, 1.0)
}

/// Returns the reflectance by wrap lighting, scaled so that a sphere receives as much light as
/// before.
pub fn wrap(cosine: f32, sigma: f32) -> f32 {
    let wrap = (0.5 * sigma).clamp(0.0, 1.0);
    let spread = 1.0 + wrap;
    ((cosine.min(1.0) + wrap).max(0.0) / (spread * spread)).min(1.0)
}

/// Returns the Fourier series of the convolution, truncated after `terms` terms.
pub fn series(cosine: f32, sigma: f32, terms: u32) -> f32 {
    let c = cosine.clamp(-1.0, 1.0);
    let s = sigma.clamp(0.0, CDRF_WIDEST);
    let variance = s * s;
    let decay = (-2.0 * variance).exp();
    let decay_squared = decay * decay;
    let mut weight = decay;
    let mut ratio = decay_squared * decay;
    let twice_y = 2.0 - 4.0 * c * c;
    let mut previous = 1.0;
    let mut current = 0.5 * twice_y;
    let mut sum = 0.0;
    for n in 1..=terms {
        let order = 2.0 * n as f32;
        sum += weight * current / (order * order - 1.0);
        weight *= ratio;
        ratio *= decay_squared;
        let next = twice_y * current - previous;
        previous = current;
        current = next;
    }
    0.31830987 + 0.5 * (-0.5 * variance).exp() * c - 0.63661975 * sum
}

/// Returns the convolution near one terminator, for sigma up to 0.3.
pub fn edge(cosine: f32, sigma: f32) -> f32 {
    let c = cosine.clamp(-1.0, 1.0);
    let s = sigma.clamp(0.0, CDRF_WIDEST);
    let x = arcsine(c);
    let u = deviations(x, s);
    let v = s * s;
    let q = x * x;
    let sixth = q * q * q + v * (20.0 * q * q + v * (87.0 * q + 48.0 * v));
    let fourth = q * q + v * (9.0 * q + 8.0 * v);
    let carried = 1.0 - (q + 2.0 * v) / 6.0 + fourth / 120.0 - sixth / 5040.0;
    let decay = 1.0 - v * (0.5 - v * (0.125 - v * 0.02064));
    (decay * c * normal_share(u) + s * normal_density(u) * carried).clamp(0.0, 1.0)
}

/// Returns [`edge`] to first order, with an unguarded quotient; a naive form.
pub fn edge_naive(cosine: f32, sigma: f32) -> f32 {
    let u = cosine / sigma;
    cosine * normal_share(u) + sigma * normal_density(u)
}

/// Returns the accurate convolution.
pub fn accurate(cosine: f32, sigma: f32) -> f32 {
    if sigma < CDRF_SWITCH {
        return edge(cosine, sigma);
    }
    series(cosine, sigma, 7).max(0.0)
}

/// Returns [`series`] with four terms for every sigma; a naive form.
pub fn series_naive(cosine: f32, sigma: f32) -> f32 {
    series(cosine, sigma, 4)
}

/// Returns the single-edge form for every sigma, not wrapped around; a naive form.
pub fn accurate_naive(cosine: f32, sigma: f32) -> f32 {
    edge(cosine, sigma)
}

/// Returns the reflectance computed from the angle, as the formula is written; a naive form.
pub fn angle_naive(cosine: f32, sigma: f32) -> f32 {
    accurate(cosine.acos().cos(), sigma)
}

/// Returns the cheap convolution: no angle, no loop, one exponential and one division.
#[rustfmt::skip] // lines of coefficients, as in the shader
pub fn cheap(cosine: f32, sigma: f32) -> f32 {
    let c = cosine;
    let s = sigma.clamp(0.0, CDRF_WIDEST);
    let v = s * s;
    let decay = (-0.5 * v).exp();
    // |c| / sigma, finite for sigma = 0. The bump ends where its root reaches 0, about six standard
    // deviations away, and is 0 beyond.
    let u = c.abs() / (s + 1e-7);
    let still = 0.79465324 + u * (-0.24850852 + u * (-0.017153223 + u * (0.0062746328 + u * (0.0022976348 - u * 0.00039362809))));
    let first = -0.063232761 + u * (0.033584461 + u * (0.0047414034 - u * 0.037048171));
    let second = -0.014675331 + u * (0.19972939 - u * 0.2402912);
    let root = still + v * (first + v * second);
    let root_squared = if root > 0.0 { root * root } else { 0.0 };
    let narrow = decay * (if c > 0.0 { c } else { 0.0 }) + s * root_squared * root_squared;
    // The weights of the series are powers of this one: 1, 4, 9 and 16.
    let decay_squared = decay * decay;
    let weight = decay_squared * decay_squared;
    let weight_squared = weight * weight;
    let weight_cubed = weight_squared * weight;
    let weight_fifth = weight_squared * weight_cubed;
    let y = 1.0 - 2.0 * c * c;
    let y_second = 2.0 * y * y - 1.0;
    let y_third = 2.0 * y * y_second - y;
    let y_fourth = 2.0 * y_second * y_second - 1.0;
    let even = weight * (0.21220659 * y + weight_cubed * (0.04244132 * y_second
        + weight_fifth * (0.018189136 * y_third + weight_fifth * weight_squared * (0.010105076 * y_fourth))));
    let wide = 0.31830987 + decay * (0.5 * c) - even;
    (if s < CDRF_CHEAP_SWITCH { narrow } else { wide }).abs().min(1.0)
}

/// Returns the accurate convolution for a material whose channels scatter over different distances.
pub fn rgb(cosine: f32, sigma0: Vec3, curvature: f32) -> Vec3 {
    Vec3::new(
        accurate(cosine, sigma(sigma0.x, curvature)),
        accurate(cosine, sigma(sigma0.y, curvature)),
        accurate(cosine, sigma(sigma0.z, curvature)),
    )
}

/// Returns the sine of an angle of any size, in turns.
pub fn sine(turns: f32) -> f32 {
    let wrapped = turns - turns.round_ties_even();
    let folded = wrapped.max(-0.5 - wrapped).min(0.5 - wrapped);
    let s = folded * folded;
    folded * (6.2831855 - s * (41.34168 - s * (81.602234 - s * (76.57499 - s * 39.710918))))
}

/// Returns the convolution by numerical quadrature.
pub fn quadrature(cosine: f32, sigma: f32) -> f32 {
    let s = sigma.clamp(7.5231638e-37, CDRF_WIDEST);
    let x = arcsine(cosine);
    let reach = s.ceil() as i32;
    let mut sum = 0.0;
    for lobe in -reach..=reach {
        let end = (x + 6.2831855 * lobe as f32) / s;
        let low = (end - std::f32::consts::PI / s).max(-6.0);
        let high = end.min(6.0);
        if low < high {
            let width = (high - low) / 16.0;
            for panel in 0..16u32 {
                let middle = low + width * (panel as f32 + 0.5);
                for point in -1..=1i32 {
                    let t = middle + width * 0.38729835 * point as f32;
                    let weight = if point == 0 { 0.44444445 } else { 0.2777778 };
                    sum += weight * width * (-0.5 * t * t).exp() * sine((x - s * t) * 0.15915494);
                }
            }
        }
    }
    0.3989423 * sum
}

/// Returns the local piece of the spherical form, for sigma up to 0.1.
pub fn spherical_edge(cosine: f32, sigma: f32) -> f32 {
    let c = cosine.clamp(-1.0, 1.0);
    let s = sigma.clamp(0.0, CDRF_WIDEST);
    let x = arcsine(c);
    let u = deviations(x, s);
    let v = s * s;
    let decay = 1.0 - v * (1.0 - 0.5 * v);
    let carried = 1.0 - x * x / 6.0 - 0.5833333 * v;
    (decay * c * normal_share(u) + s * normal_density(u) * carried).clamp(0.0, 1.0)
}

/// Returns the energy-conserving choice: the clamped cosine diffused over the sphere of directions.
pub fn spherical(cosine: f32, sigma: f32) -> f32 {
    if sigma < CDRF_SPHERICAL_SWITCH {
        return spherical_edge(cosine, sigma);
    }
    let c = cosine.clamp(-1.0, 1.0);
    let s = sigma.min(CDRF_WIDEST);
    let decay = (-s * s).exp();
    let mut weight = decay;
    let mut ratio = decay * decay;
    let mut previous = 1.0;
    let mut current = c;
    let mut sum = 0.25 + 0.5 * weight * c;
    let mut moment = 0.125;
    for l in (2..=44u32).step_by(2) {
        let degree = l as f32;
        let even = ((2.0 * degree - 1.0) * c * current - (degree - 1.0) * previous) / degree;
        weight *= ratio;
        ratio *= decay;
        sum += (degree + 0.5) * moment * weight * even;
        weight *= ratio;
        ratio *= decay;
        current = ((2.0 * degree + 1.0) * c * even - degree * current) / (degree + 1.0);
        previous = even;
        moment *= (1.0 - degree) / (degree + 4.0);
    }
    sum.max(0.0)
}

/// Returns the response of the spherical form to degrees 0, 1, 2 and 4 of the surrounding light.
pub fn harmonic_weights(sigma: f32) -> Vec4 {
    let s = sigma.clamp(0.0, CDRF_WIDEST);
    let decay = (-s * s).exp();
    let cube = decay * decay * decay;
    Vec4::new(3.1415927, 2.0943952 * decay, 0.7853982 * cube, -0.1308997 * cube * cube * cube * decay)
}

/// Returns the position of a reflectance in the lookup table, as fractions of the distance from the
/// centre of the first texel to the centre of the last.
pub fn table_coordinates(cosine: f32, sigma: f32) -> Vec2 {
    let s = sigma.clamp(0.0, 1e36);
    Vec2::new(0.5 + 0.5 * cosine.clamp(-1.0, 1.0), (s / (1.0 + s)).min(1.0))
}

/// Returns the value of a texel of the table; `tint` holds each channel's sigma0 as a share of the
/// largest.
pub fn table_texel(texel: UVec2, size: UVec2, tint: Vec3) -> Vec3 {
    let last = size.max(UVec2::splat(2)) - 1;
    let place = texel.min(last).as_vec2();
    let end = last.as_vec2();
    let cosine = (2.0 * place.x - end.x) / end.x;
    // 1e-30 stands for 0: multiplied by the smallest tint, the sigma of the last row is at least
    // 1e10, and from 8 on the reflectance is that of infinity.
    let sigma = place.y / (end.y - place.y).max(1e-30);
    Vec3::new(accurate(cosine, tint.x * sigma), accurate(cosine, tint.y * sigma), accurate(cosine, tint.z * sigma))
}

/// Returns the whole table, row by row, like the kernel of `wgsl/recipes/cdrf_table.wgsl`.
pub fn table(size: UVec2, tint: Vec3) -> Vec<Vec3> {
    let rows = 0..size.y;
    rows.flat_map(|row| (0..size.x).map(move |column| table_texel(UVec2::new(column, row), size, tint))).collect()
}

/// Returns the sampler coordinates of a position in the table.
pub fn texture_coordinates(coordinates: Vec2, size: UVec2) -> Vec2 {
    let whole = size.as_vec2();
    (coordinates * (whole - 1.0) + 0.5) / whole
}

/// Returns the coordinates without the half texel; a naive form.
pub fn texture_coordinates_naive(coordinates: Vec2) -> Vec2 {
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
    pub weight: Vec2,
}

/// Returns the texels and weights of a bilinear lookup.
pub fn texels(coordinates: Vec2, size: UVec2) -> CdrfTexels {
    let at = coordinates.clamp(Vec2::ZERO, Vec2::ONE) * (size.as_vec2() - 1.0);
    let lower = at.as_uvec2();
    CdrfTexels { lower, upper: (lower + 1).min(size - 1), weight: (at - at.floor()).max(Vec2::ZERO) }
}

/// Blends four texels.
pub fn blend(weight: Vec2, lower_left: Vec3, lower_right: Vec3, upper_left: Vec3, upper_right: Vec3) -> Vec3 {
    let lower = lower_left * (1.0 - weight.x) + lower_right * weight.x;
    let upper = upper_left * (1.0 - weight.x) + upper_right * weight.x;
    lower * (1.0 - weight.y) + upper * weight.y
}

#[cfg(test)]
mod tests;
