// cdrf: curvature-dependent reflectance: diffuse light's clamped cosine, blurred as a curved, translucent surface does.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0
// Source: Kubo, Dobashi and Morishima, "Real-time Rendering of Translucent Materials using
//   Curvature-Dependent Reflectance Function": max(cos t, 0) convolved with a Gaussian of sigma =
//   sigma0 curvature. The closed forms are derived in docs/cdrf.md. Abramowitz and Stegun,
//   "Handbook of Mathematical Functions", 26.2.17 (normal distribution); Moshier, Cephes, asinf.
//
// Every reflectance function takes the cosine N . L, of either sign, because that is what a shader
// has, and sigma in radians. Multiply the result by albedo / pi and by the light's irradiance; it
// already contains the cosine.

// From this sigma on the Fourier series is summed; below it the single-edge form is used. At the
// switch both are within 6e-8 of the truth.
const CDRF_SWITCH: f32 = 0.3f;
// The same switch for the cheap form, whose two pieces are within 1.3e-5 and 1.4e-5 there.
const CDRF_CHEAP_SWITCH: f32 = 0.35f;
// The same switch for the spherical form, whose pieces are within 1.2e-6 and 4e-8 there.
const CDRF_SPHERICAL_SWITCH: f32 = 0.1f;
// Wider Gaussians count as this one: e^(-8 * 8 / 2) is 1e-14, so only the mean is left, to the last
// place.
const CDRF_WIDEST: f32 = 8.0f;
// Lower limit of divisors: 2^-126, the smallest number that an implementation may not flush to
// zero.
const CDRF_SMALLEST: f32 = 1.1754943508222875e-38f;

// Makes a number from any source, such as a vertex attribute or a quotient of derivatives, safe to
// calculate with. It tests the bits, because WGSL may assume that there are neither NaNs nor
// infinities, and a comparison then finds none.
// Returns: `value`; 0 for a NaN; +-1e18 for larger magnitudes and infinities.
// Units: that of `value`.
// Domain: any bits.
// Outside: nothing; a subnormal may count as zero.
// Accuracy: lavapipe 0 ulp; portable 0 ulp
fn cdrf_finite(value: f32) -> f32 {
    let bits = bitcast<u32>(value);
    let magnitude = bits & 0x7fffffffu;
    if magnitude > 0x7f800000u {
        return 0.0f;
    }
    // 0x5d5e0b6b is the bit pattern of 1e18. Positive floats have the same order as their bits.
    return bitcast<f32>((bits & 0x80000000u) | min(magnitude, 0x5d5e0b6bu));
}

// Width of the Gaussian from the material's scattering and the surface's curvature. The sign of the
// curvature does not matter: a hollow blurs as much as a ridge, because the normal turns as fast.
// Returns: max(sigma0, 0) |curvature| in [0, 1e36], finite for any input; 0, which is Lambert's
//   law, if either is 0 or a NaN.
// Units: radians; sigma0 in a length (about the scattering distance), curvature in its inverse.
// Domain: any bits; magnitudes count as at most 1e18.
// Outside: nothing.
// Accuracy: lavapipe 1 ulp; portable 1 ulp
fn cdrf_sigma(sigma0: f32, curvature: f32) -> f32 {
    return max(cdrf_finite(sigma0), 0.0f) * abs(cdrf_finite(curvature));
}

// Width of the Gaussian by the power law that random walks through spheres follow better than sigma0
// curvature: the width grows more slowly than the curvature. docs/cdrf.md has the fit.
// Returns: 1.8 (mean_free_path |curvature|)^0.59 in [1.5e-7, 3.3e21], finite for any input; the least,
//   which is Lambert's law to 6e-8, if either is 0 or a NaN.
// Units: radians; mean_free_path in a length, curvature in its inverse.
// Domain: any bits; magnitudes count as at most 1e18, products as at least 1e-12.
// Outside: nothing.
// Accuracy: lavapipe 3.6e-5 rel; portable 3.6e-5 rel
fn cdrf_sigma_power(mean_free_path: f32, curvature: f32) -> f32 {
    let turn = max(cdrf_sigma(mean_free_path, curvature), 1e-12f);
    return 1.8f * exp2(0.59f * log2(turn));
}

// What scattering does to the light on a curved surface, as random walks through spheres have it.
struct CdrfDrift {
    // Width of the Gaussian in radians, 1.5 |turn|.
    sigma: f32,
    // For cdrf_shifted: light leaves farther from the light than it entered. In [-0.89, 0.89].
    shift: f32,
    // Factor of the reflectance in [0.24, 1]: light that is hardly absorbed finds its way out anywhere,
    // so that a small body sends back no more than it received.
    share: f32,
}

// The drift of light below a curved surface, which leaves some mean free path farther from the light than it enters.
// With the drift apart, the width is proportional to the curvature: docs/cdrf.md.
// Returns: width, shift and share; 0, 0 and 1, Lambert's law, without curvature or if either of the first two is a NaN.
// Units: mean_free_path in a length, curvature, negative in a hollow, in its inverse; gamma is sqrt(1 - albedo).
// Domain: any mean_free_path, negative values count as 0; any curvature; products count as at most 1 in magnitude, a
//   radius of one mean free path; any gamma, clamped to [0, 1].
// Outside: nothing.
// Accuracy: lavapipe sigma 2 ulp, shift 1.1e-6 rel, share 6e-7 rel;
//   portable sigma 4 ulp, shift 2.1e-6 rel, share 1.2e-6 rel
fn cdrf_drift(mean_free_path: f32, curvature: f32, gamma: f32) -> CdrfDrift {
    let turn = clamp(max(cdrf_finite(mean_free_path), 0.0f) * cdrf_finite(curvature), -1.0f, 1.0f);
    let g = clamp(gamma, 0.0f, 1.0f);
    let magnitude = abs(turn);
    let sideways = 1.9f * turn / (1.0f + 3.2f * g);
    let absorbed = max(g * g + 0.041f * magnitude, CDRF_SMALLEST);
    return CdrfDrift(
        1.5f * magnitude,
        sideways / sqrt(1.0f + sideways * sideways),
        min(1.0f / (1.0f + 0.13f * magnitude * (magnitude / absorbed)), 1.0f),
    );
}

// Cosine of the light where the light that leaves here has entered. For a small shift the angle
// becomes less by shift times its sine, as the drift has it; for any it is the aberration of a direction by a
// speed, (cosine + shift) / (1 + shift cosine), which keeps both poles; as a sum, rounding keeps them too.
// Returns: in [-1, 1]; `cosine` for a shift of 0.
// Units: none.
// Domain: any cosine, clamped to [-1, 1]; any shift, clamped to [-0.9, 0.9].
// Outside: nothing.
// Accuracy: lavapipe 1.1e-6 abs; portable 2.2e-6 abs
fn cdrf_shifted(cosine: f32, shift: f32) -> f32 {
    let c = clamp(cosine, -1.0f, 1.0f);
    let b = clamp(shift, -0.9f, 0.9f);
    return c + b * ((1.0f - c) * (1.0f + c)) / (1.0f + b * c);
}

// Angle from its sine. WGSL allows the built-in asin an absolute error of 6.8e-5, or the error of
// an arctangent that is off by 4096 ulp; at a sharp terminator the angle counts in units of sigma.
// It is a polynomial up to 1/2 and the half-angle formula beyond, whose 1 - |sine| is exact.
// Returns: angle in [-pi/2, pi/2].
// Units: radians.
// Domain: any sine, clamped to [-1, 1].
// Outside: nothing.
// Accuracy: lavapipe 5 ulp; portable 12 ulp
fn cdrf_arcsine(sine: f32) -> f32 {
    let a = min(abs(sine), 1.0f);
    let outer = a > 0.5f;
    let half = 0.5f * (1.0f - a);
    let square = select(a * a, half, outer);
    let root = select(a, sqrt(half), outer);
    let rest = square * (0.16666752f + square * (0.074953003f + square * (0.045470026f
        + square * (0.024181311f + square * 0.042163199f))));
    let small = root + root * rest;
    let angle = select(small, 1.5707964f - 2.0f * small, outer);
    return sign(sine) * angle;
}

// Distance from the terminator in standard deviations. At the limit of 12 nothing of a Gaussian is
// left, whatever the quotient.
// Returns: x / sigma, within [-12, 12]; 0 at the terminator, also for sigma = 0.
// Units: x and sigma in radians.
// Domain: x in [-pi/2, pi/2], sigma >= 0.
// Outside: finite while the quotient is; a negative sigma counts as 0.
// Accuracy: lavapipe 2 ulp; portable 5 ulp
fn cdrf_deviations(x: f32, sigma: f32) -> f32 {
    return clamp(x / max(sigma, CDRF_SMALLEST), -12.0f, 12.0f);
}

// Density of the standard normal distribution.
// Returns: e^(-u^2 / 2) / sqrt(2 pi), in [0, 0.39895].
// Units: none.
// Domain: u in [-12, 12].
// Outside: as long as u^2 is finite.
// Accuracy: lavapipe 1.4e-7 abs; portable 2.2e-7 abs
fn cdrf_normal_density(u: f32) -> f32 {
    return 0.3989423f * exp(-0.5f * u * u);
}

// Standard normal distribution: the share of a Gaussian below `u` standard deviations.
// Returns: share in [0, 1], accurate to 7.5e-8 and rounding; exactly 1 from 6 on.
// Units: none.
// Domain: any finite u, clamped to [-12, 12].
// Outside: nothing.
// Accuracy: lavapipe 8.3e-7 abs; portable 1.9e-6 abs
fn cdrf_normal_share(u: f32) -> f32 {
    let a = min(abs(u), 12.0f);
    let t = 1.0f / (1.0f + 0.2316419f * a);
    let tail = cdrf_normal_density(a) * t * (0.31938153f + t * (-0.35656378f
        + t * (1.7814779f + t * (-1.8212560f + t * 1.3302744f))));
    return 0.5f + sign(u) * (0.5f - tail);
}

// Lambert's law, the first rung: no scattering at all.
// Returns: max(cosine, 0), in [0, 1].
// Units: none.
// Domain: any cosine, clamped to [-1, 1].
// Outside: nothing.
// Accuracy: lavapipe 0 ulp; portable 0 ulp
fn cdrf_lambert(cosine: f32) -> f32 {
    return clamp(cosine, 0.0f, 1.0f);
}

// Wrap lighting, the second rung: the cosine is shifted up by `wrap` and scaled so that a sphere
// receives as much light as before. Among the multiples of sigma, wrap = sigma / 2 stays closest to
// the convolution up to sigma = 0.5.
// Returns: max(cosine + wrap, 0) / (1 + wrap)^2 in [0, 1] with wrap = min(sigma / 2, 1); Lambert's
//   law, divided by 1, for sigma = 0.
// Units: sigma in radians.
// Domain: any cosine, clamped to [-1, 1]; any sigma, negative values count as 0.
// Outside: nothing.
// Accuracy: lavapipe 5 ulp; portable 16 ulp
fn cdrf_wrap(cosine: f32, sigma: f32) -> f32 {
    let wrap = clamp(0.5f * sigma, 0.0f, 1.0f);
    let spread = 1.0f + wrap;
    return min(max(min(cosine, 1.0f) + wrap, 0.0f) / (spread * spread), 1.0f);
}

// Truncated Fourier series of the convolution. Over the whole line the clamped cosine is periodic,
// and a Gaussian damps its harmonic of order m by e^(-m^2 sigma^2 / 2). Since
// cos 2nt (-1)^n = T_n(1 - 2c^2), with T_n the Chebyshev polynomials, no angle is needed.
// Returns: 1/pi + e^(-sigma^2/2) c / 2 - 2/pi sum of e^(-2 n^2 sigma^2) T_n(1 - 2c^2) / (4n^2 - 1)
//   for n from 1 to `terms`.
// Units: sigma in radians.
// Domain: any cosine, clamped to [-1, 1]; sigma clamped to [0, 8]; terms up to 16.
// Outside: nothing, but the time that more terms take.
// Accuracy: lavapipe 9.7e-7 abs; portable 2e-6 abs
fn cdrf_series(cosine: f32, sigma: f32, terms: u32) -> f32 {
    let c = clamp(cosine, -1.0f, 1.0f);
    let s = clamp(sigma, 0.0f, CDRF_WIDEST);
    let variance = s * s;
    let decay = exp(-2.0f * variance);
    let decay_squared = decay * decay;
    // decay^(n^2): the exponent grows by 2n + 1 from each n to the next.
    var weight = decay;
    var ratio = decay_squared * decay;
    let twice_y = 2.0f - 4.0f * c * c;
    var previous = 1.0f;
    var current = 0.5f * twice_y;
    var sum = 0.0f;
    for (var n = 1u; n <= terms; n++) {
        let order = 2.0f * f32(n);
        sum += weight * current / (order * order - 1.0f);
        weight *= ratio;
        ratio *= decay_squared;
        let next = twice_y * current - previous;
        previous = current;
        current = next;
    }
    return 0.31830987f + 0.5f * exp(-0.5f * variance) * c - 0.63661975f * sum;
}

// The convolution near one terminator, for a Gaussian too narrow to reach the other: e^(-sigma^2/2) c P(u) +
// sigma p(u) K. P and p are the normal distribution and its density, u is the terminator's distance in sigmas.
// It is exact for a single edge, but for K, an integral that is expanded to the sixth order: docs/cdrf.md.
// Returns: reflectance in [0, 1]; exactly max(cosine, 0) for sigma = 0.
// Units: sigma in radians.
// Domain: any cosine, clamped to [-1, 1]; sigma at most 0.3, negative values count as 0.
// Outside: not negative and finite, ever less accurate: off by 4.8e-7 at 0.35, 1.2e-4 at 0.5.
// Accuracy: lavapipe 5e-7 abs; portable 1.2e-6 abs
fn cdrf_edge(cosine: f32, sigma: f32) -> f32 {
    let c = clamp(cosine, -1.0f, 1.0f);
    let s = clamp(sigma, 0.0f, CDRF_WIDEST);
    let x = cdrf_arcsine(c);
    let u = cdrf_deviations(x, s);
    let v = s * s;
    let q = x * x;
    let sixth = q * q * q + v * (20.0f * q * q + v * (87.0f * q + 48.0f * v));
    let fourth = q * q + v * (9.0f * q + 8.0f * v);
    let carried = 1.0f - (q + 2.0f * v) / 6.0f + fourth / 120.0f - sixth / 5040.0f;
    // Power series of e^(-v/2), exactly 1 at 0. The last coefficient, 1/48 in the series, is
    // adjusted to make up for the remainder, to 3e-8.
    let decay = 1.0f - v * (0.5f - v * (0.125f - v * 0.02064f));
    return clamp(decay * c * cdrf_normal_share(u) + s * cdrf_normal_density(u) * carried, 0.0f, 1.0f);
}

// The accurate convolution: the single-edge form if the Gaussian is narrow, the series of the
// wrapped form if it is wide.
// Returns: reflectance in [0, 1]; exactly max(cosine, 0) for sigma = 0; 1/pi from sigma = 8 on.
// Units: sigma in radians.
// Domain: any cosine, clamped to [-1, 1]; any sigma, negative values count as 0.
// Outside: nothing.
// Accuracy: lavapipe 5e-7 abs; portable 1.5e-6 abs
fn cdrf_accurate(cosine: f32, sigma: f32) -> f32 {
    if sigma < CDRF_SWITCH {
        return cdrf_edge(cosine, sigma);
    }
    return max(cdrf_series(cosine, sigma, 7u), 0.0f);
}

// The cheap convolution: no angle, no loop, one exponential and one division. If the Gaussian is
// narrow, a fitted bump around the terminator is added to a damped Lambert's law; if it is wide, four
// terms of the series are summed.
// Returns: reflectance in [0, 1], within 1.5e-5 of cdrf_accurate, so it is monotonic and continuous
//   only to 3e-5; max(cosine, 0) for sigma = 0.
// Units: sigma in radians.
// Domain: cosine in [-1, 1]; any sigma, negative values count as 0.
// Outside: the formula goes on, up to 1: off by rounding where the cosine is; finite up to 10.
// Accuracy: lavapipe 1.5e-5 abs; portable 1.7e-5 abs
fn cdrf_cheap(cosine: f32, sigma: f32) -> f32 {
    let c = cosine;
    let s = clamp(sigma, 0.0f, CDRF_WIDEST);
    let v = s * s;
    let decay = exp(-0.5f * v);
    // |c| / sigma, finite for sigma = 0. The bump ends where its root reaches 0, about six standard
    // deviations away, and is 0 beyond.
    let u = abs(c) / (s + 1e-7f);
    let still = 0.79465324f + u * (-0.24850852f + u * (-0.017153223f
        + u * (0.0062746328f + u * (0.0022976348f - u * 0.00039362809f))));
    let first = -0.063232761f + u * (0.033584461f + u * (0.0047414034f - u * 0.037048171f));
    let second = -0.014675331f + u * (0.19972939f - u * 0.2402912f);
    let root = still + v * (first + v * second);
    let root_squared = select(0.0f, root * root, root > 0.0f);
    let narrow = decay * select(0.0f, c, c > 0.0f) + s * root_squared * root_squared;
    // The weights of the series are powers of this one: 1, 4, 9 and 16.
    let decay_squared = decay * decay;
    let weight = decay_squared * decay_squared;
    let weight_squared = weight * weight;
    let weight_cubed = weight_squared * weight;
    let weight_fifth = weight_squared * weight_cubed;
    let y = 1.0f - 2.0f * c * c;
    let y_second = 2.0f * y * y - 1.0f;
    let y_third = 2.0f * y * y_second - y;
    let y_fourth = 2.0f * y_second * y_second - 1.0f;
    let even = weight * (0.21220659f * y + weight_cubed * (0.04244132f * y_second
        + weight_fifth * (0.018189136f * y_third + weight_fifth * weight_squared * (0.010105076f * y_fourth))));
    let wide = 0.31830987f + decay * (0.5f * c) - even;
    return min(abs(select(wide, narrow, s < CDRF_CHEAP_SWITCH)), 1.0f);
}

// The accurate convolution for a material whose channels scatter over different distances.
// Returns: reflectance of each channel in [0, 1]; never a NaN for any sigma0 or curvature.
// Units: sigma0 in a length, curvature in its inverse.
// Domain: any cosine, clamped to [-1, 1]; sigma0 and curvature as for cdrf_sigma.
// Outside: nothing.
// Accuracy: lavapipe 5e-7 abs; portable 1.5e-6 abs
fn cdrf_rgb(cosine: f32, sigma0: vec3f, curvature: f32) -> vec3f {
    return vec3f(
        cdrf_accurate(cosine, cdrf_sigma(sigma0.x, curvature)),
        cdrf_accurate(cosine, cdrf_sigma(sigma0.y, curvature)),
        cdrf_accurate(cosine, cdrf_sigma(sigma0.z, curvature)),
    );
}

// Sine of an angle of any size, in turns. WGSL's own may be off by 2^-11, and holds only within one
// turn. The nearest whole turn is subtracted and the rest folded at +-1/4, both without rounding; a
// polynomial in odd powers follows.
// Returns: sin(2 pi turns) in [-1, 1], accurate to rounding; exactly 0 at every half turn.
// Units: turns.
// Domain: any finite angle.
// Outside: nothing.
// Accuracy: lavapipe 5 ulp; portable 8 ulp; order kept
fn cdrf_sine(turns: f32) -> f32 {
    let wrapped = turns - round(turns);
    let folded = clamp(wrapped, -0.5f - wrapped, 0.5f - wrapped);
    let s = folded * folded;
    return folded * (6.2831855f - s * (41.34168f - s * (81.602234f - s * (76.57499f - s * 39.710918f))));
}

// The convolution by numerical quadrature, the slow rung: it follows the definition directly and
// needs no theory. It integrates over the standard deviations t of the Gaussian, one lit half turn
// at a time, so that no panel contains a kink. Each half turn within six standard deviations has 16
// panels of Gauss's three-point rule.
// Returns: reflectance, within rounding of [0, 1].
// Units: sigma in radians.
// Domain: any cosine, clamped to [-1, 1]; sigma clamped to [2^-120, 8].
// Outside: nothing.
// Accuracy: lavapipe 5.7e-6 abs; portable 3.5e-5 abs
fn cdrf_quadrature(cosine: f32, sigma: f32) -> f32 {
    let s = clamp(sigma, 7.5231638e-37f, CDRF_WIDEST);
    let x = cdrf_arcsine(cosine);
    let reach = i32(ceil(s));
    var sum = 0.0f;
    for (var lobe = -reach; lobe <= reach; lobe++) {
        // The sine of x - s t is positive from the end of the lobe, where it is 0, to half a turn
        // before it.
        let end = (x + 6.2831855f * f32(lobe)) / s;
        let low = max(end - 3.1415927f / s, -6.0f);
        let high = min(end, 6.0f);
        if low < high {
            let width = (high - low) / 16.0f;
            for (var panel = 0u; panel < 16u; panel++) {
                let middle = low + width * (f32(panel) + 0.5f);
                for (var point = -1i; point <= 1i; point++) {
                    let t = middle + width * 0.38729835f * f32(point);
                    let weight = select(0.2777778f, 0.44444445f, point == 0i);
                    sum += weight * width * exp(-0.5f * t * t) * cdrf_sine((x - s * t) * 0.15915494f);
                }
            }
        }
    }
    return 0.3989423f * sum;
}

// Local piece of the spherical form: the edge of a hemisphere instead of that of a half turn.
// Returns: reflectance in [0, 1]; exactly max(cosine, 0) for sigma = 0.
// Units: sigma in radians.
// Domain: any cosine, clamped to [-1, 1]; sigma at most 0.1, negative values count as 0.
// Outside: not negative and finite, ever less accurate.
// Accuracy: lavapipe 1.8e-6 abs; portable 2.5e-6 abs
fn cdrf_spherical_edge(cosine: f32, sigma: f32) -> f32 {
    let c = clamp(cosine, -1.0f, 1.0f);
    let s = clamp(sigma, 0.0f, CDRF_WIDEST);
    let x = cdrf_arcsine(c);
    let u = cdrf_deviations(x, s);
    let v = s * s;
    let decay = 1.0f - v * (1.0f - 0.5f * v);
    let carried = 1.0f - x * x / 6.0f - 0.5833333f * v;
    return clamp(decay * c * cdrf_normal_share(u) + s * cdrf_normal_density(u) * carried, 0.0f, 1.0f);
}

// The energy-conserving choice: the clamped cosine diffused over the sphere of directions instead of a circle.
// This damps the Legendre polynomial of degree l by e^(-l (l + 1) sigma^2 / 2) and preserves the mean.
// Returns: reflectance in [0, 1]; exactly max(cosine, 0) for sigma = 0; tends to 1/4, the mean over the sphere.
// Units: sigma in radians.
// Domain: any cosine, clamped to [-1, 1]; any sigma, negative values count as 0.
// Outside: nothing.
// Accuracy: lavapipe 1.8e-6 abs; portable 2.5e-6 abs
fn cdrf_spherical(cosine: f32, sigma: f32) -> f32 {
    if sigma < CDRF_SPHERICAL_SWITCH {
        return cdrf_spherical_edge(cosine, sigma);
    }
    let c = clamp(cosine, -1.0f, 1.0f);
    let s = min(sigma, CDRF_WIDEST);
    let decay = exp(-s * s);
    // decay^(l (l + 1) / 2): the exponent grows by the next degree from each degree to the next.
    var weight = decay;
    var ratio = decay * decay;
    // Legendre polynomials of degree l - 2 and l - 1.
    var previous = 1.0f;
    var current = c;
    var sum = 0.25f + 0.5f * weight * c;
    // Integral of c P_l(c) over [0, 1]; it is 0 for every odd degree above 1.
    var moment = 0.125f;
    for (var l = 2u; l <= 44u; l += 2u) {
        let degree = f32(l);
        let even = ((2.0f * degree - 1.0f) * c * current - (degree - 1.0f) * previous) / degree;
        weight *= ratio;
        ratio *= decay;
        sum += (degree + 0.5f) * moment * weight * even;
        weight *= ratio;
        ratio *= decay;
        current = ((2.0f * degree + 1.0f) * c * even - degree * current) / (degree + 1.0f);
        previous = even;
        moment *= (1.0f - degree) / (degree + 4.0f);
    }
    return max(sum, 0.0f);
}

// Response of the spherical form to each degree of the surrounding light: the factors of the radiance's harmonics
// of that degree in the direction of the normal. Degree 3 and even degrees from 6 on are left out: docs/cdrf.md.
// Returns: factors of degrees 0, 1, 2 and 4: pi, 2 pi / 3 d, pi / 4 d^3, -pi / 24 d^10 with d = e^(-sigma^2).
// Units: steradians; sigma in radians.
// Domain: any sigma; negative values count as 0.
// Outside: nothing.
// Accuracy: lavapipe 7.3e-7 abs; portable 1.5e-6 abs
fn cdrf_harmonic_weights(sigma: f32) -> vec4f {
    let s = clamp(sigma, 0.0f, CDRF_WIDEST);
    let decay = exp(-s * s);
    let cube = decay * decay * decay;
    return vec4f(3.1415927f, 2.0943952f * decay, 0.7853982f * cube, -0.1308997f * cube * cube * cube * decay);
}

// Position of a reflectance in the lookup table, as fractions of the distance from the centre of the
// first texel to that of the last. Rows are sigma / (1 + sigma): all of [0, infinity), closest where
// the function changes most.
// Returns: coordinates in [0, 1]; 0 for cosine -1 and for sigma 0.
// Units: sigma in radians.
// Domain: any cosine, clamped to [-1, 1]; sigma up to 1e36, negative values count as 0.
// Outside: nothing.
// Accuracy: lavapipe 3 ulp + 1 backward; portable 5 ulp + 1 backward
fn cdrf_table_coordinates(cosine: f32, sigma: f32) -> vec2f {
    let s = clamp(sigma, 0.0f, 1e36f);
    return vec2f(0.5f + 0.5f * clamp(cosine, -1.0f, 1.0f), min(s / (1.0f + s), 1.0f));
}

// Value of a texel of the table. `tint` holds each channel's sigma0 as a share of the largest, whose sigma looks
// the table up. Cosine and sigma are quotients of whole numbers, since 1 - v would cancel in the last rows.
// Returns: reflectance of each channel in [0, 1]; the last row is for sigma = infinity if tint is not 0.
// Units: texels, counted from 0.
// Domain: texel below size; size from 1 to 16384 on each side; tint 0 or in [1e-20, 1].
// Outside: a texel beyond the last counts as the last. A size below 2 counts as 2.
// Accuracy: lavapipe 8e-7 abs; portable 2e-6 abs
fn cdrf_table_texel(texel: vec2u, size: vec2u, tint: vec3f) -> vec3f {
    let last = max(size, vec2u(2u)) - 1u;
    let place = vec2f(min(texel, last));
    let end = vec2f(last);
    let cosine = (2.0f * place.x - end.x) / end.x;
    // 1e-30 stands for 0: multiplied by the smallest tint, the sigma of the last row is at least
    // 1e10, and from 8 on the reflectance is that of infinity.
    let sigma = place.y / max(end.y - place.y, 1e-30f);
    return vec3f(
        cdrf_accurate(cosine, tint.x * sigma),
        cdrf_accurate(cosine, tint.y * sigma),
        cdrf_accurate(cosine, tint.z * sigma),
    );
}

// Sampler coordinates of a position in the table. A texel's value is at its centre, half a texel
// from the edge of the texture.
// Returns: coordinates in [1/2, size - 1/2] / size.
// Units: fractions of the texture.
// Domain: coordinates in [0, 1]; size from 1 to 16384.
// Outside: extrapolates; size 0 has no texel.
// Accuracy: lavapipe 4 ulp; portable 6 ulp
fn cdrf_texture_coordinates(coordinates: vec2f, size: vec2u) -> vec2f {
    let whole = vec2f(size);
    return (coordinates * (whole - 1.0f) + 0.5f) / whole;
}

// The four texels around a position in the table and their blend weights.
struct CdrfTexels {
    // Column and row of the texel at the lower coordinates.
    lower: vec2u,
    // Column and row of the texel at the higher coordinates.
    upper: vec2u,
    // Share of `upper` in each direction, in [0, 1].
    weight: vec2f,
}

// Texels and weights of a bilinear lookup, for formats that the sampler cannot filter (32-bit
// float).
// Returns: columns below size.x, rows below size.y, weights in [0, 1].
// Units: texels.
// Domain: coordinates in [0, 1]; size from 1 to 16384.
// Outside: coordinates are clamped to [0, 1].
// Accuracy: lavapipe lower 2 backward, upper 2 backward, weight 1e-7 abs + 2 backward;
//   portable lower 4 backward, upper 4 backward, weight 2e-7 abs + 4 backward
fn cdrf_texels(coordinates: vec2f, size: vec2u) -> CdrfTexels {
    let at = clamp(coordinates, vec2f(0.0f), vec2f(1.0f)) * (vec2f(size) - 1.0f);
    let lower = vec2u(at);
    // floor sees the rounded product, a fused difference the exact one, which may be smaller.
    return CdrfTexels(lower, min(lower + 1u, size - 1u), max(at - floor(at), vec2f(0.0f)));
}

// Blends four texels.
// Returns: bilinear mean: lower left if weight is 0, upper right if it is 1.
// Units: that of the texels.
// Domain: weight in [0, 1]; texels of magnitude at most 1e18.
// Outside: extrapolates.
// Accuracy: lavapipe 6e-7 rel; portable 1e-6 rel
fn cdrf_blend(weight: vec2f, lower_left: vec3f, lower_right: vec3f, upper_left: vec3f, upper_right: vec3f) -> vec3f {
    let lower = lower_left * (1.0f - weight.x) + lower_right * weight.x;
    let upper = upper_left * (1.0f - weight.x) + upper_right * weight.x;
    return lower * (1.0f - weight.y) + upper * weight.y;
}
