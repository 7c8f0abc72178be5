// random_walk: walks of light in a scattering medium: random numbers, free paths, tracking, phase function, boundary.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0
// Source: Jarzynski and Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020 (pcg4d);
//   Woodcock, Murphy, Hemmings and Longworth, "Techniques used in the GEM code", 1965 (delta
//   tracking); Novak, Selle and Jarosz, "Residual Ratio Tracking for Estimating Attenuation in
//   Participating Media", 2014, eq. (7); Henyey and Greenstein, "Diffuse radiation in the galaxy",
//   1941; Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017; Born and Wolf,
//   "Principles of Optics", 7th ed., 1.5.2. The rearrangements are derived in docs/random_walk.md.
//
// A walk takes all its randomness from random_walk_random: four numbers per counter. One word of
// the counter may identify the walk and another its step.

// Outcomes of a tentative collision.
const RANDOM_WALK_SCATTERED = 0u;
const RANDOM_WALK_ABSORBED = 1u;
const RANDOM_WALK_PASSED = 2u;
// The least majorant; smaller ones count as this. Free paths are then at most 1.7e31 long.
const RANDOM_WALK_THINNEST: f32 = 1e-30f;
// The largest majorant of a free path, 2^126: the reciprocal of a larger one is subnormal, and may be 0.
const RANDOM_WALK_DENSEST: f32 = 8.507059e37f;
// The largest magnitude of the anisotropy. Light turns by a thousandth of a degree on average
// there, and for the next floats the turn would round to none.
const RANDOM_WALK_STRAIGHTEST: f32 = 0.999999f;

struct RandomWalkBasis {
    // Unit vectors that form a right-handed basis with the normal as the third.
    tangent: vec3f,
    bitangent: vec3f,
}

struct RandomWalkCrossing {
    // Unit direction, refracted or reflected.
    direction: vec3f,
    // True if the light crosses the boundary.
    crosses: bool,
}

// The random bits of a counter, by pcg4d, the same on every device. Neighbouring counters give
// unrelated bits.
// Returns: 4 x 32 bits, a bijection of the counter.
// Units: none.
// Domain: any counter.
// Outside: nothing.
// Accuracy: lavapipe 0 ulp; portable 0 ulp
fn random_walk_bits(counter: vec4u) -> vec4u {
    var v = counter * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v ^= v >> vec4u(16u);
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

// The random numbers of a counter.
// Returns: four numbers in [0, 1), multiples of 2^-24, so that each number and its distance from 1
//   are exact.
// Units: none.
// Domain: any counter.
// Outside: nothing.
// Accuracy: lavapipe 0 ulp; portable 0 ulp
fn random_walk_random(counter: vec4u) -> vec4f {
    return vec4f(random_walk_bits(counter) >> vec4u(8u)) * 5.9604645e-8f;
}

// The distance to the next tentative collision, -ln(1 - u) / majorant. The logarithm is taken of a
// mantissa near 1, whose distance from 1 is -u itself as long as u is small; computing 1 - u would
// have rounded u away.
// Returns: a length in [0, 1.7e31], exponentially distributed for a uniform u; 0 for u = 0.
// Units: the inverse of the majorant's.
// Domain: u in [0, 1), clamped to that; any majorant, clamped to [1e-30, 2^126].
// Outside: nothing; u below 2^-120 may count as 0.
// Accuracy: lavapipe 9 ulp; portable 24 ulp
fn random_walk_free_path(u: f32, majorant: f32) -> f32 {
    let v = clamp(u, 0.0f, 0.99999994f);
    let bits = bitcast<i32>(1.0f - v);
    // 0x3f3504f3 is the bit pattern of the square root of 1/2. The mantissa lies between it and its
    // inverse, so |s| is at most 0.1716.
    let exponent = (bits - 0x3f3504f3i) >> 23u;
    let mantissa = bitcast<f32>(bits - (exponent << 23u));
    let less = select(mantissa - 1.0f, -v, exponent == 0i);
    let s = less / (2.0f + less);
    let square = s * s;
    // The truncated series of artanh(s) / s. The last coefficient, 1/7 in the series, also absorbs
    // the remaining terms, which leaves an error of 7e-9.
    let series = 1.0f + square * (0.33333334f + square * (0.2f + square * 0.14595f));
    let depth = f32(-exponent) * 0.6931472f - 2.0f * s * series;
    return depth / clamp(majorant, RANDOM_WALK_THINNEST, RANDOM_WALK_DENSEST);
}

// The outcome of a tentative collision (delta tracking). Where the medium is thinner than the
// majorant, light passes with the probability of the difference, so free paths are correct in a
// medium of any density below the majorant.
// Returns: RANDOM_WALK_SCATTERED, RANDOM_WALK_ABSORBED or RANDOM_WALK_PASSED.
// Units: coefficients per unit of length, all in the same unit.
// Domain: u in [0, 1); scattering and absorption at least 0, their sum at most the majorant.
// Outside: light never passes where the sum exceeds the majorant: the walk is biased.
// Accuracy: lavapipe 2 backward; portable 2 backward
fn random_walk_collision(u: f32, scattering: f32, absorption: f32, majorant: f32) -> u32 {
    let place = u * majorant;
    let sum = scattering + absorption;
    // If the coefficients add up to the majorant, a place that rounds up to it still counts as a
    // collision with the medium.
    if place >= sum && (sum < majorant || sum == 0.0f) {
        return RANDOM_WALK_PASSED;
    }
    return select(RANDOM_WALK_SCATTERED, RANDOM_WALK_ABSORBED, place >= scattering && absorption > 0.0f);
}

// A transmittance after a tentative collision, estimated by ratio tracking. The mean over walks is
// e to the minus the optical depth. The difference of two nearby floats is exact; the difference of
// 1 and a quotient is not.
// Returns: transmittance (majorant - density) / majorant; 0 if the density exceeds the majorant.
// Units: density and majorant per unit of length.
// Domain: transmittance in [0, 1]; density at least 0; majorant at least 1e-30.
// Outside: a smaller majorant counts as 1e-30.
// Accuracy: lavapipe 3 ulp; portable 8 ulp
fn random_walk_ratio(transmittance: f32, density: f32, majorant: f32) -> f32 {
    let most = max(majorant, RANDOM_WALK_THINNEST);
    return transmittance * (max(most - density, 0.0f) / most);
}

// Henyey and Greenstein's phase function. 1 + g^2 - 2 g cos is written (1 - |g|)^2 + 2 |g| (1 -
// cos), which does not cancel.
// Returns: the share of scattered light per solid angle, above 0; 1 / (4 pi) for g = 0. Its
//   integral over the sphere is 1, its mean cosine g.
// Units: 1/sr.
// Domain: any cosine of the angle between the directions before and after, clamped to [-1, 1]; any
//   anisotropy g, clamped to [-0.999999, 0.999999].
// Outside: nothing.
// Accuracy: lavapipe 12 ulp; portable 32 ulp
fn random_walk_phase(cosine: f32, g: f32) -> f32 {
    let a = min(abs(g), RANDOM_WALK_STRAIGHTEST);
    let c = clamp(sign(g) * cosine, -1.0f, 1.0f);
    let rest = 1.0f - a;
    let squared = rest * rest + 2.0f * a * (1.0f - c);
    return 0.07957747f * rest * (1.0f + a) / (squared * sqrt(squared));
}

// A deflection sampled from Henyey and Greenstein's phase function by a uniform number. Both 1 +
// cos and 1 - cos are products of positive terms, so they do not cancel for any g, and the sine is
// accurate however small it is.
// Returns: the cosine and sine of the angle between the directions before and after, the sine at
//   least 0; -1, 0 for u = 0 and 1, 0 for u = 1.
// Units: none.
// Domain: any u, clamped to [0, 1]; any anisotropy g, clamped to [-0.999999, 0.999999].
// Outside: nothing.
// Accuracy: lavapipe 12 ulp; portable 40 ulp
fn random_walk_deflection(u: f32, g: f32) -> vec2f {
    let a = clamp(g, -RANDOM_WALK_STRAIGHTEST, RANDOM_WALK_STRAIGHTEST);
    let v = clamp(u, 0.0f, 1.0f);
    let forwards = (1.0f + a) * v;
    let backwards = (1.0f - a) * (1.0f - v);
    // 1 + g (2 u - 1).
    let sum = forwards + backwards;
    let root = (1.0f - a) * (1.0f + a) / sum;
    let above = forwards * (1.0f + a + root) / sum;
    let below = backwards * (1.0f - a + root) / sum;
    return vec2f(0.5f * (above - below), sqrt(above * below));
}

// The cosine and sine of an angle in turns. WGSL's own are only accurate to an absolute 2^-11. The
// polynomial is that of cdrf_sine; the cosine is the sine of a quarter turn minus the angle.
// Returns: cos(2 pi turns) and sin(2 pi turns).
// Units: turns.
// Domain: any finite angle.
// Outside: nothing.
// Accuracy: lavapipe 5 ulp; portable 8 ulp; order kept
fn random_walk_azimuth(turns: f32) -> vec2f {
    let wrapped = turns - round(turns);
    let folded = vec2f(0.25f - abs(wrapped), clamp(wrapped, -0.5f - wrapped, 0.5f - wrapped));
    let s = folded * folded;
    return folded * (6.2831855f - s * (41.34168f - s * (81.602234f - s * (76.57499f - s * 39.710918f))));
}

// Two unit vectors at right angles to a third and to each other, by Duff et al. The branch keeps
// the magnitude of the divisor at 1 or more.
// Returns: RandomWalkBasis; tangent x bitangent = normal. It jumps where normal.z changes sign, as
//   any basis must somewhere.
// Units: none; unit vectors.
// Domain: |normal| = 1.
// Outside: finite, but no unit vectors.
// Accuracy: lavapipe tangent 8 ulp, bitangent 8 ulp; portable tangent 12 ulp, bitangent 12 ulp
fn random_walk_basis(normal: vec3f) -> RandomWalkBasis {
    let side = select(-1.0f, 1.0f, normal.z >= 0.0f);
    let a = -1.0f / (side + normal.z);
    let b = normal.x * normal.y * a;
    return RandomWalkBasis(
        vec3f(1.0f + side * normal.x * normal.x * a, side * b, -side * normal.x),
        vec3f(b, side + normal.y * normal.y * a, -normal.y),
    );
}

// The direction after a scattering event. The last factor is a Newton step towards unit length;
// without it the length drifts over a long walk.
// Returns: unit direction.
// Units: none; deflection and azimuth are the cosine and sine of an angle.
// Domain: |direction| = |deflection| = |azimuth| = 1.
// Outside: finite, but no unit vector.
// Accuracy: lavapipe 16 ulp; portable 28 ulp
fn random_walk_turn(direction: vec3f, deflection: vec2f, azimuth: vec2f) -> vec3f {
    let basis = random_walk_basis(direction);
    let aside = azimuth.x * basis.tangent + azimuth.y * basis.bitangent;
    let turned = deflection.x * direction + deflection.y * aside;
    return turned * (1.5f - 0.5f * dot(turned, turned));
}

// A uniformly distributed direction.
// Returns: unit direction, uniform on the sphere for uniform numbers.
// Units: none.
// Domain: u.x clamped to [0, 1]; u.y any finite number, of which only the fraction matters.
// Outside: nothing.
// Accuracy: lavapipe 9 ulp; portable 16 ulp; order kept
fn random_walk_isotropic(u: vec2f) -> vec3f {
    let v = clamp(u.x, 0.0f, 1.0f);
    let radius = 2.0f * sqrt(v * (1.0f - v));
    let around = random_walk_azimuth(u.y);
    return vec3f(radius * around.x, radius * around.y, 1.0f - 2.0f * v);
}

// The path of light at a smooth dielectric boundary, reflected with the probability of Fresnel's reflectance for
// unpolarised light, else refracted. Both are those of the modules fresnel and refraction, from one root.
// Returns: RandomWalkCrossing.
// Units: none; `relative_index` is n_transmitted / n_incident, `normal` is on the side that the light comes from.
// Domain: |incident| = |normal| = 1, normal . incident <= 0, relative_index in [1/4, 4], u in [0, 1). For
//   relative_index = 1 light always crosses.
// Outside: a normal that faces away from the light counts as grazing: finite, but no unit vector.
// Accuracy: lavapipe direction 12 ulp + 24 backward, crosses 24 backward;
//   portable direction 24 ulp + 160 backward, crosses 160 backward
fn random_walk_boundary(incident: vec3f, normal: vec3f, relative_index: f32, u: f32) -> RandomWalkCrossing {
    // n^2 - 1 in two factors: the difference of two nearby floats is exact, the difference of their
    // squares is not.
    let m = (relative_index - 1.0f) * (relative_index + 1.0f);
    if m == 0.0f {
        return RandomWalkCrossing(incident, true);
    }
    let c = clamp(-dot(normal, incident), 0.0f, 1.0f);
    let sine_squared = (1.0f - c) * (1.0f + c);
    let n_squared = relative_index * relative_index;
    let nc_squared = n_squared * c * c;
    // n times the cosine of refraction; 0 from the critical angle on.
    let g = sqrt(max(nc_squared + m * sine_squared, 0.0f));
    let s_root = c + g;
    let s = m / max(s_root * s_root, abs(m));
    let p_root = n_squared * c + g;
    let p_numerator = m * (nc_squared - sine_squared);
    let p = p_numerator / max(p_root * p_root, abs(p_numerator));
    // g == 0 is total reflection even where WGSL lets a quotient of equals be less than 1.
    if g == 0.0f || u < 0.5f * (s * s + p * p) {
        return RandomWalkCrossing(incident + 2.0f * c * normal, false);
    }
    return RandomWalkCrossing((incident - m / s_root * normal) / relative_index, true);
}
