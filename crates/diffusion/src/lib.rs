//! Mirror of `wgsl/diffusion.wgsl`: light that diffuses through matter on a grid. The WGSL file states
//! the units, domain and accuracy of each function. This file follows it line by line.
//!
//! ```
//! use lapidary_diffusion::{DIFFUSION_MILNE, fluence, milne, scattered, segment};
//!
//! // Light diffuses out of glass of index 1.5 as if its surface lay 3.2 times as far out.
//! assert!((milne(1.5) / DIFFUSION_MILNE - 3.2334).abs() < 1e-3);
//! // A thin layer scatters its thickness.
//! assert_eq!(scattered(0.0, 2f32.powi(-40)), 2f32.powi(-40));
//! // Equal ends: what the segment absorbs of 1 is what it sends.
//! assert!((segment(1.0, 1.0, 1.0) - 0.632_121).abs() < 1e-6);
//! // Deep inside matter that absorbs nothing, lit along the normal.
//! assert!((fluence(100.0, 1.0, 0.0, DIFFUSION_MILNE) - 3.0 * (1.0 + DIFFUSION_MILNE)).abs() < 1e-5);
//! ```

#[cfg(feature = "formulas")]
pub mod formulas;
pub mod oracle;

use glam::{Vec2, Vec3};

/// Milne's extrapolation length in mean free paths, for an index-matched surface.
pub const DIFFUSION_MILNE: f32 = 0.7104461;
/// The least density.
pub const DIFFUSION_THINNEST: f32 = 1e-3;
/// The least depth of a node below the surface, in spacings.
pub const DIFFUSION_LEAST_DEPTH: f32 = 0.05;
/// The least distance of two nodes, in spacings.
pub const DIFFUSION_LEAST_DISTANCE: f32 = 0.25;
/// Added to all weights of corners.
pub const DIFFUSION_LEAST_WEIGHT: f32 = 1e-4;
/// The least variance of the nodes' depths, in squared spacings.
pub const DIFFUSION_LEAST_VARIANCE: f32 = 1e-4;
/// The least distance of a node's depth from the mean, in spacings.
pub const DIFFUSION_LEAST_STEP: f32 = 0.01;
/// By how much of itself a node's weight may change over the nodes' range of depths.
pub const DIFFUSION_STEEPEST: f32 = 3.0;
/// The largest relative index.
pub const DIFFUSION_DENSEST: f32 = 2.5;
/// Cosines below this count as it.
pub const DIFFUSION_GRAZING: f32 = 1e-9;
/// The largest optical depth whose transmittance is computed.
pub const DIFFUSION_OPAQUE: f32 = 87.0;
/// The least extrapolation length in mean free paths.
pub const DIFFUSION_NEAREST: f32 = 0.5;
/// The largest extrapolation length in mean free paths.
pub const DIFFUSION_OUTERMOST: f32 = 20.0;
/// The least gamma of a slab: matter that absorbs less counts as this.
pub const DIFFUSION_LEAST_GAMMA: f32 = 1e-6;
/// The largest optical depth of a node.
pub const DIFFUSION_DEEPEST: f32 = 1e6;
/// The least optical distance of two nodes.
pub const DIFFUSION_THINNEST_FACE: f32 = 1e-9;
/// The slope of the fluence's logarithm per mean free path from which the flux limiter is a closed form.
pub const DIFFUSION_STEEP: f32 = 2.0;
/// The largest optical depth along a line.
pub const DIFFUSION_FARTHEST: f32 = 1e15;

/// Returns the extrapolation length at a dielectric boundary, in mean free paths.
pub fn milne(relative_index: f32) -> f32 {
    let x = relative_index.clamp(1.0, DIFFUSION_DENSEST) - 1.0;
    let s = x.sqrt();
    let far = 2.949771 + s * (s * 0.1045422 - 0.9277547);
    let slope = 0.8625412 + s * (4.655942 + s * (1.148223 + s * (s * far - 2.400274)));
    DIFFUSION_MILNE * (1.0 + x * slope)
}

/// Returns the conductance between two nodes through the face of their cells.
pub fn face(open: f32, distance: f32, densities: Vec2) -> f32 {
    let dense = densities.max(Vec2::splat(DIFFUSION_THINNEST));
    2.0 * open / (distance.max(DIFFUSION_LEAST_DISTANCE) * (dense.x + dense.y))
}

/// Computes the same with the harmonic mean of the coefficients, a naive form.
pub fn face_naive(open: f32, distance: f32, densities: Vec2) -> f32 {
    let diffusions = Vec2::ONE / densities;
    open / distance * 2.0 / (1.0 / diffusions.x + 1.0 / diffusions.y)
}

/// Returns the conductance from a node through the surface in its cell.
pub fn surface(area: f32, depth: f32, density: f32, milne: f32) -> f32 {
    let covered = density.max(DIFFUSION_THINNEST) * depth.max(DIFFUSION_LEAST_DEPTH);
    area / (covered + milne)
}

/// Computes the same with a coefficient and a length of its own, a naive form.
pub fn surface_naive(area: f32, depth: f32, density: f32, milne: f32) -> f32 {
    let diffusion = 1.0 / density;
    area * diffusion / (depth + milne * diffusion)
}

/// Returns the fluence between the surface and a node, as a share of the node's.
pub fn profile(depth: f32, node_depth: f32, milne: f32) -> f32 {
    let below = depth.max(0.0);
    if below >= node_depth {
        return 1.0;
    }
    (below + milne) / (node_depth + milne).max(1e-30)
}

/// Computes the same without a guard, a naive form.
pub fn profile_naive(depth: f32, node_depth: f32, milne: f32) -> f32 {
    (depth.min(node_depth) + milne) / (node_depth + milne)
}

/// Returns what the exact law of a half space adds to diffusion's at an angle, as a factor.
pub fn angle(cosine: f32, h: f32, h_normal: f32, gamma: f32, milne: f32) -> f32 {
    let m = cosine.clamp(0.0, 1.0);
    let kappa = 1.7320508 * gamma.clamp(0.0, 1.0);
    h * (1.0 + milne) * (1.0 + kappa * m) / (h_normal * (m + milne) * (1.0 + kappa))
}

/// Returns the means of transmittance over a line, weighted towards its start and towards its end.
pub fn ramps(thickness: f32) -> Vec2 {
    let x = thickness.clamp(0.0, DIFFUSION_FARTHEST);
    if x < 1.0 {
        let square = x * x;
        let even = 0.5 + square * 0.011904762;
        let odd = x * (0.083333336 + square * 0.0005952381);
        let divisor = 1.0 + x * (0.5 + x * (0.10714286 + x * (0.011904762 + x * 0.0005952381)));
        return Vec2::new(even + odd, even - odd) / divisor;
    }
    let left = (-x.min(DIFFUSION_OPAQUE)).exp();
    let mean = (1.0 - left) / x;
    Vec2::new(1.0 - mean, mean - left) / x
}

/// Returns the mean transmittance over optical depths from `near` to `far`.
pub fn mean(near: f32, far: f32) -> f32 {
    let a = near.clamp(0.0, DIFFUSION_FARTHEST);
    let b = far.clamp(0.0, DIFFUSION_FARTHEST);
    let nearest = a.min(b);
    let means = ramps(a.max(b) - nearest);
    (-nearest.min(DIFFUSION_OPAQUE)).exp() * (means.x + means.y)
}

/// Computes the same as a difference over a difference, a naive form.
pub fn mean_naive(near: f32, far: f32) -> f32 {
    ((-near).exp() - (-far).exp()) / (far - near)
}

/// Returns the share of light that collides in a layer below others.
pub fn scattered(depth: f32, thickness: f32) -> f32 {
    let x = thickness.clamp(0.0, DIFFUSION_FARTHEST);
    let means = ramps(x);
    (-depth.clamp(0.0, DIFFUSION_OPAQUE)).exp() * (x * (means.x + means.y)).min(1.0)
}

/// Computes the same as a difference, a naive form.
pub fn scattered_naive(depth: f32, thickness: f32) -> f32 {
    (-depth).exp() - (-(depth + thickness)).exp()
}

/// Returns the light that a segment sends to its start, if what it scatters runs straight.
pub fn segment(start: f32, end: f32, thickness: f32) -> f32 {
    let x = thickness.clamp(0.0, DIFFUSION_FARTHEST);
    let means = ramps(x);
    x * (start * means.x + end * means.y)
}

/// Computes the same as it is printed, a naive form.
pub fn segment_naive(start: f32, end: f32, thickness: f32) -> f32 {
    let q = (-thickness).exp();
    start * (1.0 - q) + (end - start) * (1.0 - q - thickness * q) / thickness
}

/// Returns the light that a segment sends to its start by single scattering.
pub fn unscattered(thickness: f32, near: f32, far: f32) -> f32 {
    let x = thickness.clamp(0.0, DIFFUSION_DEEPEST);
    let a = near.clamp(0.0, DIFFUSION_OPAQUE);
    let b = far.clamp(0.0, DIFFUSION_OPAQUE);
    let last = x + b;
    let nearest = a.min(last);
    let means = ramps(a.max(last) - nearest);
    (-nearest.min(DIFFUSION_OPAQUE)).exp() * (x * (means.x + means.y)).max(0.0)
}

/// Computes the same as it is printed, a naive form.
pub fn unscattered_naive(thickness: f32, near: f32, far: f32) -> f32 {
    let a = thickness + far - near;
    (-near).exp() * thickness * (1.0 - (-a).exp()) / a
}

/// Returns the fluence in a half space at a depth, lit by parallel light.
pub fn fluence(depth: f32, cosine_light: f32, gamma: f32, milne: f32) -> f32 {
    let t = depth.clamp(0.0, DIFFUSION_DEEPEST);
    let c = cosine_light.clamp(DIFFUSION_GRAZING, 1.0);
    let g = gamma.clamp(0.0, 1.0);
    let z = milne.clamp(DIFFUSION_NEAREST, DIFFUSION_OUTERMOST);
    let kappa = 1.7320508 * g;
    let damped = kappa * t;
    let strength = 3.0 * (1.0 - g) * (1.0 + g) * c / (1.0 + kappa * c);
    let surface = z / (1.0 + kappa * z) * (-damped.min(DIFFUSION_OPAQUE)).exp();
    strength * (surface + t * mean(damped, t / c))
}

/// Computes the same as it is printed, a naive form.
pub fn fluence_naive(depth: f32, cosine_light: f32, gamma: f32, milne: f32) -> f32 {
    let kappa = 1.7320508 * gamma;
    let m0 = cosine_light;
    let b = -3.0 * (1.0 - gamma * gamma) * m0 * m0 / (1.0 - kappa * kappa * m0 * m0);
    let a = -b * (1.0 + milne / m0) / (1.0 + kappa * milne);
    a * (-kappa * depth).exp() + b * (-depth / m0).exp()
}

/// Returns the share of light that comes through a slab.
pub fn slab(thickness: f32, gamma: f32, milne: f32) -> f32 {
    let x = thickness.clamp(0.0, DIFFUSION_DEEPEST);
    let g = gamma.clamp(DIFFUSION_LEAST_GAMMA, 1.0);
    let z = milne.clamp(DIFFUSION_NEAREST, DIFFUSION_OUTERMOST);
    let kappa = 1.7320508 * g;
    let means = ramps(x);
    let collided = x * (means.x + means.y);
    let place = x * (means.y / (means.x + means.y));
    // With u for kappa z, of sinh a + u cosh a over (1 + u^2) sinh b + 2 u cosh b the growing exponentials are
    // taken out; what is left are sums of positive terms.
    let u = kappa * z;
    let before = scattered(0.0, 2.0 * kappa * place);
    let all = scattered(0.0, 2.0 * kappa * x);
    let outward = (before + u * (2.0 - before)) / ((1.0 + u * u) * all + 2.0 * u * (2.0 - all));
    let passed = (-(kappa * (x - place)).min(DIFFUSION_OPAQUE)).exp();
    (1.0 - g) * (1.0 + g) * collided * (outward * passed)
}

/// Computes the same as it is printed, a naive form.
pub fn slab_naive(thickness: f32, gamma: f32, milne: f32) -> f32 {
    let kappa = 1.7320508 * gamma;
    let left = (-thickness).exp();
    let collided = 1.0 - left;
    let place = 1.0 - thickness * left / collided;
    let u = kappa * milne;
    let a = kappa * place;
    let b = kappa * thickness;
    let outward = (a.sinh() + u * a.cosh()) / ((1.0 + u * u) * b.sinh() + 2.0 * u * b.cosh());
    (1.0 - gamma * gamma) * collided * outward
}

/// Returns what the eye sees of [`fluence`] from a depth on.
pub fn tail(depth: f32, cosine_eye: f32, cosine_light: f32, gamma: f32, milne: f32) -> f32 {
    let t = depth.clamp(0.0, DIFFUSION_DEEPEST);
    let m = cosine_eye.clamp(DIFFUSION_GRAZING, 1.0);
    let c = cosine_light.clamp(DIFFUSION_GRAZING, 1.0);
    let g = gamma.clamp(0.0, 1.0);
    let z = milne.clamp(DIFFUSION_NEAREST, DIFFUSION_OUTERMOST);
    let kappa = 1.7320508 * g;
    let damped = kappa * t;
    let strength = 3.0 * (1.0 - g) * (1.0 + g) * c / (1.0 + kappa * c);
    let left = (-damped.min(DIFFUSION_OPAQUE)).exp() / (1.0 + kappa * m);
    let share = c / (m + c);
    let surface = (z / (1.0 + kappa * z) + share * m) * left;
    let seen = (-(t / m).min(DIFFUSION_OPAQUE)).exp();
    strength * seen * (surface + share * t * mean(damped, t / c))
}

/// Returns what the grid does not show at a lit surface.
#[expect(clippy::too_many_arguments, reason = "the shader's")]
pub fn local(
    cosine_eye: f32,
    cosine_light: f32,
    law: f32,
    gamma: f32,
    milne: f32,
    depth: f32,
    gap: f32,
    angle: f32,
) -> f32 {
    let m = cosine_eye.clamp(DIFFUSION_GRAZING, 1.0);
    let c = cosine_light.clamp(DIFFUSION_GRAZING, 1.0);
    let exact = law.clamp(0.0, 4.0);
    let g = gamma.clamp(0.0, 1.0);
    let z = milne.clamp(DIFFUSION_NEAREST, DIFFUSION_OUTERMOST);
    let node = depth.clamp(0.0, DIFFUSION_DEEPEST);
    let between = gap.clamp(0.0, DIFFUSION_DEEPEST);
    let end = node + between;
    let first = fluence(node, c, g, z);
    let second = fluence(end, c, g, z);
    let above = first * segment(z / (node + z), 1.0, node / m);
    let seen = (-(node / m).min(DIFFUSION_OPAQUE)).exp();
    let below = seen * segment(first, second, between / m);
    let shown = above + below + tail(end, m, c, g, z);
    exact - 0.07957747 * (1.0 - g) * (1.0 + g) * (c / (m + c) + angle.clamp(0.0, 1.25) * shown)
}

/// Computes the same as closed forms, a naive form.
#[expect(clippy::too_many_arguments, reason = "the shader's")]
pub fn local_naive(
    cosine_eye: f32,
    cosine_light: f32,
    law: f32,
    gamma: f32,
    milne: f32,
    depth: f32,
    gap: f32,
    angle: f32,
) -> f32 {
    let m = cosine_eye;
    let m0 = cosine_light;
    let z = milne;
    let albedo = 1.0 - gamma * gamma;
    let kappa = 1.7320508 * gamma;
    let b = -3.0 * albedo * m0 * m0 / (1.0 - kappa * kappa * m0 * m0);
    let a = -b * (1.0 + z / m0) / (1.0 + kappa * z);
    let end = depth + gap;
    let q = (-depth / m).exp();
    let q_end = (-end / m).exp();
    let deep_end = (-kappa * end).exp();
    let lit_end = (-end / m0).exp();
    let first = a * (-kappa * depth).exp() + b * (-depth / m0).exp();
    let second = a * deep_end + b * lit_end;
    let above = first / (depth + z) * (z + m - (depth + z + m) * q);
    let below = first * (q - q_end) + (second - first) / gap * (m * q - (gap + m) * q_end);
    let rest = (a * deep_end / (1.0 + kappa * m) + b * lit_end / (1.0 + m / m0)) * q_end;
    law - 0.07957747 * albedo * (m0 / (m + m0) + angle * (above + below + rest))
}

/// Returns what the grid does not show under light that comes alike from all around.
pub fn local_around(cosine_eye: f32, law: f32, gamma: f32, milne: f32, depth: f32, gap: f32, angle: f32) -> f32 {
    let m = cosine_eye.clamp(DIFFUSION_GRAZING, 1.0);
    let exact = law.clamp(0.0, 1.0);
    let g = gamma.clamp(0.0, 1.0);
    let z = milne.clamp(DIFFUSION_NEAREST, DIFFUSION_OUTERMOST);
    let node = depth.clamp(0.0, DIFFUSION_DEEPEST);
    let between = gap.clamp(0.0, DIFFUSION_DEEPEST);
    let end = node + between;
    let kappa = 1.7320508 * g;
    let first = (-(kappa * node).min(DIFFUSION_OPAQUE)).exp() / (1.0 + kappa * z);
    let second = (-(kappa * end).min(DIFFUSION_OPAQUE)).exp() / (1.0 + kappa * z);
    // At the surface the grid shows the mean of the node's fluence and of that outside.
    let above = segment((first * z + node) / (node + z), first, node / m);
    let below = (-(node / m).min(DIFFUSION_OPAQUE)).exp() * segment(first, second, between / m);
    let shown = above + below + (-(end / m).min(DIFFUSION_OPAQUE)).exp() * second / (1.0 + kappa * m);
    exact - (1.0 - g) * (1.0 + g) * angle.clamp(0.0, 1.25) * shown
}

/// Returns the weight of one of the eight nodes about a point.
pub fn weight(fraction: Vec3, corner: u32, volume: f32) -> f32 {
    let inside = fraction.clamp(Vec3::ZERO, Vec3::ONE);
    let sides = Vec3::new((corner & 1) as f32, ((corner >> 1) & 1) as f32, ((corner >> 2) & 1) as f32);
    let along = sides * inside + (Vec3::ONE - sides) * (Vec3::ONE - inside);
    (along.x * along.y * along.z + DIFFUSION_LEAST_WEIGHT) * volume
}

/// Returns how the nodes' weights change with their depth, so that their mean depth is the point's.
pub fn slope(missing: f32, variance: f32, above: f32, below: f32) -> f32 {
    let wanted = missing / variance.max(DIFFUSION_LEAST_VARIANCE);
    let steepest = DIFFUSION_STEEPEST / (above + below).max(DIFFUSION_LEAST_STEP);
    let falling = (1.0 / below.max(DIFFUSION_LEAST_STEP)).min(steepest);
    let rising = (1.0 / above.max(DIFFUSION_LEAST_STEP)).min(steepest);
    wanted.clamp(-falling, rising)
}

/// Returns the factor of a flux limiter on the conductance between two nodes (Levermore and Pomraning).
pub fn limit(one: f32, other: f32, thickness: f32) -> f32 {
    let a = one.max(0.0);
    let b = other.max(0.0);
    let share = (a - b).abs() / (a + b).max(1e-18);
    let slope = 2.0 * share / thickness.clamp(DIFFUSION_THINNEST_FACE, DIFFUSION_FARTHEST);
    if slope < DIFFUSION_STEEP {
        let s = slope * slope;
        let above = 1.0 + s * (0.06666667 + s * (0.0008791209 + s * 1.4800015e-6));
        let below = 1.0 + s * (0.13333334 + s * (0.0034188034 + s * 1.776002e-5));
        return above / below;
    }
    let left = (-(2.0 * slope).min(DIFFUSION_OPAQUE)).exp();
    3.0 * ((1.0 + left) / (1.0 - left) - 1.0 / slope) / slope
}

/// Computes the flux limiter as it is printed, a naive form.
pub fn limit_naive(one: f32, other: f32, thickness: f32) -> f32 {
    let slope = (one - other).abs() / (thickness * 0.5 * (one + other));
    3.0 * (1.0 / slope.tanh() - 1.0 / slope) / slope
}

/// Returns a node's value that solves its equation for given neighbours.
pub fn relax(load: f32, inflow: f32, conductances: f32, reaction: f32) -> f32 {
    let divisor = conductances + reaction;
    if divisor <= 0.0 {
        return 0.0;
    }
    (load + inflow) / divisor
}

/// Computes the same without a guard, a naive form.
pub fn relax_naive(load: f32, inflow: f32, conductances: f32, reaction: f32) -> f32 {
    (load + inflow) / (conductances + reaction)
}

#[cfg(test)]
mod tests;
