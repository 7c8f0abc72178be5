//! Mirror of `wgsl/random_walk.wgsl`: random walks of light in a scattering medium. The WGSL
//! file states the units, domain and accuracy of each function. This file follows it line by line.
//! [`slab`] mirrors the recipe `random_walk_slab`.
//!
//! ```
//! use glam::UVec4;
//! use lapidary_random_walk::{free_path, random};
//!
//! // Four numbers in [0, 1) from a pixel, a sample and a step.
//! let u = random(UVec4::new(640, 480, 7, 0));
//! assert!(u.min_element() >= 0.0 && u.max_element() < 1.0);
//! // Half of all photons travel farther than ln 2 mean free paths.
//! assert!((free_path(0.5, 1.0) - std::f32::consts::LN_2).abs() < 1e-6);
//! ```

#[cfg(feature = "formulas")]
pub mod formulas;
pub mod oracle;
pub mod slab;

use glam::{UVec4, Vec2, Vec3, Vec4};

/// Outcome of a tentative collision: the light is scattered.
pub const RANDOM_WALK_SCATTERED: u32 = 0;
/// Outcome of a tentative collision: the light is absorbed.
pub const RANDOM_WALK_ABSORBED: u32 = 1;
/// Outcome of a tentative collision: the light passes.
pub const RANDOM_WALK_PASSED: u32 = 2;
/// Least majorant; smaller ones count as this.
pub const RANDOM_WALK_THINNEST: f32 = 1e-30;
/// Largest majorant of a free path, 2^126; larger ones count as this.
pub const RANDOM_WALK_DENSEST: f32 = 8.507059e37;
/// Largest magnitude of the anisotropy.
pub const RANDOM_WALK_STRAIGHTEST: f32 = 0.999999;

/// Two unit vectors that form a right-handed basis with a normal as the third.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RandomWalkBasis {
    /// Unit vector at right angles to the normal.
    pub tangent: Vec3,
    /// Cross product normal x tangent.
    pub bitangent: Vec3,
}

/// Light after a boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RandomWalkCrossing {
    /// Unit direction, refracted or reflected.
    pub direction: Vec3,
    /// True if the light crosses the boundary.
    pub crosses: bool,
}

/// Returns the random bits of a counter, by pcg4d.
pub fn bits(counter: UVec4) -> UVec4 {
    let mut v = counter.wrapping_mul(UVec4::splat(1664525)).wrapping_add(UVec4::splat(1013904223));
    v.x = v.x.wrapping_add(v.y.wrapping_mul(v.w));
    v.y = v.y.wrapping_add(v.z.wrapping_mul(v.x));
    v.z = v.z.wrapping_add(v.x.wrapping_mul(v.y));
    v.w = v.w.wrapping_add(v.y.wrapping_mul(v.z));
    v ^= v >> UVec4::splat(16);
    v.x = v.x.wrapping_add(v.y.wrapping_mul(v.w));
    v.y = v.y.wrapping_add(v.z.wrapping_mul(v.x));
    v.z = v.z.wrapping_add(v.x.wrapping_mul(v.y));
    v.w = v.w.wrapping_add(v.y.wrapping_mul(v.z));
    v
}

/// Returns four numbers in [0, 1), multiples of 2⁻²⁴.
pub fn random(counter: UVec4) -> Vec4 {
    (bits(counter) >> UVec4::splat(8)).as_vec4() * 5.9604645e-8
}

/// Returns the distance to the next tentative collision.
pub fn free_path(u: f32, majorant: f32) -> f32 {
    let v = u.clamp(0.0, 0.99999994);
    let bits = (1.0 - v).to_bits().cast_signed();
    let exponent = (bits - 0x3f3504f3) >> 23;
    let mantissa = f32::from_bits((bits - (exponent << 23)).cast_unsigned());
    let less = if exponent == 0 { -v } else { mantissa - 1.0 };
    let s = less / (2.0 + less);
    let square = s * s;
    let series = 1.0 + square * (0.33333334 + square * (0.2 + square * 0.14595));
    let depth = (-exponent) as f32 * 0.6931472 - 2.0 * s * series;
    depth / majorant.clamp(RANDOM_WALK_THINNEST, RANDOM_WALK_DENSEST)
}

/// Computes the free path by the built-in logarithm, a naive form.
pub fn free_path_naive(u: f32, majorant: f32) -> f32 {
    -(1.0 - u).ln() / majorant
}

/// Returns the outcome of a tentative collision (delta tracking).
pub fn collision(u: f32, scattering: f32, absorption: f32, majorant: f32) -> u32 {
    let place = u * majorant;
    let sum = scattering + absorption;
    if place >= sum && (sum < majorant || sum == 0.0) {
        return RANDOM_WALK_PASSED;
    }
    if place >= scattering && absorption > 0.0 { RANDOM_WALK_ABSORBED } else { RANDOM_WALK_SCATTERED }
}

/// Returns a transmittance after a tentative collision (ratio tracking).
pub fn ratio(transmittance: f32, density: f32, majorant: f32) -> f32 {
    let most = majorant.max(RANDOM_WALK_THINNEST);
    transmittance * ((most - density).max(0.0) / most)
}

/// Computes the same with the quotient taken first, a naive form.
pub fn ratio_naive(transmittance: f32, density: f32, majorant: f32) -> f32 {
    transmittance * (1.0 - density / majorant)
}

/// Returns Henyey and Greenstein's phase function, in 1/sr.
pub fn phase(cosine: f32, g: f32) -> f32 {
    let a = g.abs().min(RANDOM_WALK_STRAIGHTEST);
    let c = (sign(g) * cosine).clamp(-1.0, 1.0);
    let rest = 1.0 - a;
    let squared = rest * rest + 2.0 * a * (1.0 - c);
    0.07957747 * rest * (1.0 + a) / (squared * squared.sqrt())
}

/// Returns the sign as in WGSL: 0 for 0.
fn sign(value: f32) -> f32 {
    if value == 0.0 { 0.0 } else { value.signum() }
}

/// Computes the phase function as printed in the literature, a naive form.
pub fn phase_naive(cosine: f32, g: f32) -> f32 {
    0.07957747 * (1.0 - g * g) / (1.0 + g * g - 2.0 * g * cosine).powf(1.5)
}

/// Returns the cosine and sine of a deflection, sampled by a uniform number.
pub fn deflection(u: f32, g: f32) -> Vec2 {
    let a = g.clamp(-RANDOM_WALK_STRAIGHTEST, RANDOM_WALK_STRAIGHTEST);
    let v = u.clamp(0.0, 1.0);
    let forwards = (1.0 + a) * v;
    let backwards = (1.0 - a) * (1.0 - v);
    let sum = forwards + backwards;
    let root = (1.0 - a) * (1.0 + a) / sum;
    let above = forwards * (1.0 + a + root) / sum;
    let below = backwards * (1.0 - a + root) / sum;
    Vec2::new(0.5 * (above - below), (above * below).sqrt())
}

/// Computes the deflection as printed in the literature, a naive form.
pub fn deflection_naive(u: f32, g: f32) -> Vec2 {
    let root = (1.0 - g * g) / (1.0 - g + 2.0 * g * u);
    let cosine = (1.0 + g * g - root * root) / (2.0 * g);
    Vec2::new(cosine, (1.0 - cosine * cosine).max(0.0).sqrt())
}

/// Returns the cosine and sine of an angle in turns.
pub fn azimuth(turns: f32) -> Vec2 {
    let wrapped = turns - turns.round_ties_even();
    let folded = Vec2::new(0.25 - wrapped.abs(), wrapped.max(-0.5 - wrapped).min(0.5 - wrapped));
    let s = folded * folded;
    folded * (6.2831855 - s * (41.34168 - s * (81.602234 - s * (76.57499 - s * 39.710918))))
}

/// Returns two unit vectors at right angles to a normal and to each other.
pub fn basis(normal: Vec3) -> RandomWalkBasis {
    let side = if normal.z >= 0.0 { 1.0 } else { -1.0 };
    let a = -1.0 / (side + normal.z);
    let b = normal.x * normal.y * a;
    RandomWalkBasis {
        tangent: Vec3::new(1.0 + side * normal.x * normal.x * a, side * b, -side * normal.x),
        bitangent: Vec3::new(b, side + normal.y * normal.y * a, -normal.y),
    }
}

/// Computes the basis without the branch, a naive form.
pub fn basis_naive(normal: Vec3) -> RandomWalkBasis {
    let a = 1.0 / (1.0 + normal.z);
    let b = -normal.x * normal.y * a;
    RandomWalkBasis {
        tangent: Vec3::new(1.0 - normal.x * normal.x * a, b, -normal.x),
        bitangent: Vec3::new(b, 1.0 - normal.y * normal.y * a, -normal.y),
    }
}

/// Returns the direction after a scattering event.
pub fn turn(direction: Vec3, deflection: Vec2, azimuth: Vec2) -> Vec3 {
    let basis = basis(direction);
    let aside = azimuth.x * basis.tangent + azimuth.y * basis.bitangent;
    let turned = deflection.x * direction + deflection.y * aside;
    turned * (1.5 - 0.5 * turned.dot(turned))
}

/// Returns a uniformly distributed direction.
pub fn isotropic(u: Vec2) -> Vec3 {
    let v = u.x.clamp(0.0, 1.0);
    let radius = 2.0 * (v * (1.0 - v)).sqrt();
    let around = azimuth(u.y);
    Vec3::new(radius * around.x, radius * around.y, 1.0 - 2.0 * v)
}

/// Reflects or refracts light at a smooth dielectric boundary, by chance.
pub fn boundary(incident: Vec3, normal: Vec3, relative_index: f32, u: f32) -> RandomWalkCrossing {
    let m = (relative_index - 1.0) * (relative_index + 1.0);
    if m == 0.0 {
        return RandomWalkCrossing { direction: incident, crosses: true };
    }
    let c = (-normal.dot(incident)).clamp(0.0, 1.0);
    let sine_squared = (1.0 - c) * (1.0 + c);
    let n_squared = relative_index * relative_index;
    let nc_squared = n_squared * c * c;
    let g = (nc_squared + m * sine_squared).max(0.0).sqrt();
    let s_root = c + g;
    let s = m / (s_root * s_root).max(m.abs());
    let p_root = n_squared * c + g;
    let p_numerator = m * (nc_squared - sine_squared);
    let p = p_numerator / (p_root * p_root).max(p_numerator.abs());
    if g == 0.0 || u < 0.5 * (s * s + p * p) {
        return RandomWalkCrossing { direction: incident + 2.0 * c * normal, crosses: false };
    }
    RandomWalkCrossing { direction: (incident - m / s_root * normal) / relative_index, crosses: true }
}

#[cfg(test)]
mod tests;
