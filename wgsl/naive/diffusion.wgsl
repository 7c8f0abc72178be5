// diffusion: forms found elsewhere, kept to show where they fail. They follow the module and use its names.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0

// The face's conductance with the harmonic mean of the coefficients.
// Returns: 2 open / distance / (1 / D + 1 / D') with D = 1 / density.
// Units: as diffusion_face.
// Domain: open in [0, 1], distance in [0.25, 2], densities in [0.01, 10].
// Outside: infinite where both densities are 0.
// Accuracy: naive
fn diffusion_face_naive(open: f32, distance: f32, densities: vec2f) -> f32 {
    let diffusions = vec2f(1.0f) / densities;
    return open / distance * 2.0f / (1.0f / diffusions.x + 1.0f / diffusions.y);
}

// The surface's conductance with a coefficient of diffusion and a length of its own.
// Returns: area D / (depth + milne D) with D = 1 / density.
// Units: as diffusion_surface.
// Domain: area in [0, 2], depth in [0.05, 2], density in [0.01, 10], milne in [0.1, 10].
// Outside: infinite over infinite for a density of 0.
// Accuracy: naive
fn diffusion_surface_naive(area: f32, depth: f32, density: f32, milne: f32) -> f32 {
    let diffusion = 1.0f / density;
    return area * diffusion / (depth + milne * diffusion);
}

// The profile without a guard.
// Returns: (min(depth, node_depth) + milne) / (node_depth + milne).
// Units: as diffusion_profile.
// Domain: all in [0.01, 10].
// Outside: 0 / 0 if both lengths are 0.
// Accuracy: naive
fn diffusion_profile_naive(depth: f32, node_depth: f32, milne: f32) -> f32 {
    return (min(depth, node_depth) + milne) / (node_depth + milne);
}

// The mean transmittance as the difference over the difference.
// Returns: (e^-near - e^-far) / (far - near).
// Units: as diffusion_mean.
// Domain: near in [0, 1], far in [2, 4].
// Outside: 0 / 0 if both are equal; few digits where they are close.
// Accuracy: naive
fn diffusion_mean_naive(near: f32, far: f32) -> f32 {
    return (exp(-near) - exp(-far)) / (far - near);
}

// The share of collisions as a difference.
// Returns: e^-depth - e^-(depth + thickness).
// Units: as diffusion_scattered.
// Domain: depth in [0, 4], thickness in [1, 4].
// Outside: few digits, then 0, for thin layers.
// Accuracy: naive
fn diffusion_scattered_naive(depth: f32, thickness: f32) -> f32 {
    return exp(-depth) - exp(-(depth + thickness));
}

// The segment's integral as it is printed.
// Returns: start (1 - q) + (end - start) (1 - q - thickness q) / thickness with q = e^-thickness.
// Units: as diffusion_segment.
// Domain: start and end in [0.5, 1], thickness in [1, 4].
// Outside: few digits for thin segments; 0 / 0 for a thickness of 0.
// Accuracy: naive
fn diffusion_segment_naive(start: f32, end: f32, thickness: f32) -> f32 {
    let q = exp(-thickness);
    return start * (1.0f - q) + (end - start) * (1.0f - q - thickness * q) / thickness;
}

// Single scattering as it is printed.
// Returns: e^-near thickness (1 - e^-a) / a with a = thickness + far - near.
// Units: as diffusion_unscattered.
// Domain: thickness in [1, 4], near in [0, 1], far in [1, 4].
// Outside: 0 / 0 where the depth towards the light falls as that towards the eye rises.
// Accuracy: naive
fn diffusion_unscattered_naive(thickness: f32, near: f32, far: f32) -> f32 {
    let a = thickness + far - near;
    return exp(-near) * thickness * (1.0f - exp(-a)) / a;
}

// The half space's solution as it is printed.
// Returns: a e^(-kappa t) + b e^(-t/m0).
// Units: as diffusion_fluence.
// Domain: depth in [0, 3], cosine_light in [0.2, 1], gamma in [0, 0.4], milne in [0.7, 4].
// Outside: infinite factors where kappa m0 = 1, few digits about it; 0 / 0 for a cosine of 0.
// Accuracy: naive
fn diffusion_fluence_naive(depth: f32, cosine_light: f32, gamma: f32, milne: f32) -> f32 {
    let kappa = 1.7320508f * gamma;
    let m0 = cosine_light;
    let b = -3.0f * (1.0f - gamma * gamma) * m0 * m0 / (1.0f - kappa * kappa * m0 * m0);
    let a = -b * (1.0f + milne / m0) / (1.0f + kappa * milne);
    return a * exp(-kappa * depth) + b * exp(-depth / m0);
}

// Share of the light that comes through a slab, as it is printed.
// Returns: albedo (1 - e^-x) (sinh a + u cosh a) / ((1 + u^2) sinh b + 2 u cosh b) with u = kappa milne.
// Units: as diffusion_slab.
// Domain: thickness in [0.5, 8], gamma in [0.1, 0.5], milne in [0.7, 4].
// Outside: infinity over infinity for a thick slab; 0 / 0 for a thickness or a gamma of 0, few digits about it.
// Accuracy: naive
fn diffusion_slab_naive(thickness: f32, gamma: f32, milne: f32) -> f32 {
    let kappa = 1.7320508f * gamma;
    let left = exp(-thickness);
    let collided = 1.0f - left;
    let place = 1.0f - thickness * left / collided;
    let u = kappa * milne;
    let a = kappa * place;
    let b = kappa * thickness;
    let outward = (sinh(a) + u * cosh(a)) / ((1.0f + u * u) * sinh(b) + 2.0f * u * cosh(b));
    return (1.0f - gamma * gamma) * collided * outward;
}

// The local part with closed forms of what the grid shows above its first node, between its nodes, and below
// them.
// Returns: law - albedo / (4 pi) (m0 / (m + m0) + angle (above + below + rest)).
// Units: as diffusion_local.
// Domain: cosines in [0.2, 1], law in [0, 1], gamma in [0.1, 0.4], milne in [0.7, 4], depth in [0.5, 4], gap in
//   [0.3, 2], angle in [0.8, 1.1].
// Outside: infinite factors where kappa m0 = 1; 0 / 0 for a gap or a cosine of 0.
// Accuracy: naive
fn diffusion_local_naive(
    cosine_eye: f32, cosine_light: f32, law: f32, gamma: f32, milne: f32, depth: f32, gap: f32, angle: f32
) -> f32 {
    let m = cosine_eye;
    let m0 = cosine_light;
    let z = milne;
    let albedo = 1.0f - gamma * gamma;
    let kappa = 1.7320508f * gamma;
    let b = -3.0f * albedo * m0 * m0 / (1.0f - kappa * kappa * m0 * m0);
    let a = -b * (1.0f + z / m0) / (1.0f + kappa * z);
    let end = depth + gap;
    let q = exp(-depth / m);
    let q_end = exp(-end / m);
    let deep_end = exp(-kappa * end);
    let lit_end = exp(-end / m0);
    let first = a * exp(-kappa * depth) + b * exp(-depth / m0);
    let second = a * deep_end + b * lit_end;
    let above = first / (depth + z) * (z + m - (depth + z + m) * q);
    let below = first * (q - q_end) + (second - first) / gap * (m * q - (gap + m) * q_end);
    let rest = (a * deep_end / (1.0f + kappa * m) + b * lit_end / (1.0f + m / m0)) * q_end;
    return law - 0.07957747f * albedo * (m0 / (m + m0) + angle * (above + below + rest));
}

// The flux limiter as it is printed.
// Returns: 3 (coth R - 1/R) / R with R = |one - other| / (thickness mean).
// Units: as diffusion_limit.
// Domain: one in [0.1, 0.4], other in [0.5, 1], thickness in [0.5, 2].
// Outside: few digits for a gentle slope; 0 / 0 for equal fluences or none.
// Accuracy: naive
fn diffusion_limit_naive(one: f32, other: f32, thickness: f32) -> f32 {
    let slope = abs(one - other) / (thickness * 0.5f * (one + other));
    return 3.0f * (1.0f / tanh(slope) - 1.0f / slope) / slope;
}

// The step of relaxation without a guard.
// Returns: (load + inflow) / (conductances + reaction).
// Units: as diffusion_relax.
// Domain: load and inflow in [0.1, 1], conductances in [0.1, 6], reaction in [0, 1].
// Outside: 0 / 0 for an isolated node.
// Accuracy: naive
fn diffusion_relax_naive(load: f32, inflow: f32, conductances: f32, reaction: f32) -> f32 {
    return (load + inflow) / (conductances + reaction);
}
