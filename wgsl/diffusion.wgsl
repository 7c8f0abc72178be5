// diffusion: light that diffuses in matter on a grid: equation, source, what the eye sees, what surface cells miss.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0
// Source: Stam, "Multiple Scattering as a Diffusion Process", 1995, for diffusion in graphics; Wang, Zhao,
//   Tong, Lin, Guo, Shum, "Modeling and Rendering of Heterogeneous Translucent Materials Using the
//   Diffusion Equation", ACM Trans. Graph. 27, 2008, for a grid; Davison, "Neutron Transport Theory", 1957,
//   for Milne's length; Jensen, Marschner, Levoy, Hanrahan, "A Practical Model for Subsurface Light
//   Transport", 2001, for a boundary's length; Chandrasekhar, "Radiative Transfer", 1960, for the law at the
//   surface; Levermore and Pomraning, "A Flux-Limited Diffusion Theory", Astrophys. J. 248, 1981, for the flux
//   limiter. The local part is derived in docs/diffusion.md.
//
// Lengths on the grid are in spacings. The equation of node i, times 3 sigma, is
//   sum of G (phi_j - phi_i) - (S / (rho t + z) + (kappa h)^2 rho V) phi_i + 3 sigma load = 0.
// Here G is by diffusion_face, S / (rho t + z) by diffusion_surface, and kappa = sqrt(3) gamma sigma.
// All functions take gamma = sqrt(1 - albedo), as half_space does, and H and the law as its functions return
// them.

// Milne's extrapolation length in mean free paths: that far outside of an index-matched surface the
// fluence would be 0 if it fell on straight.
const DIFFUSION_MILNE: f32 = 0.7104461f;
// The least density. The coefficient of diffusion is infinite for a density of 0.
const DIFFUSION_THINNEST: f32 = 1e-3f;
// The least depth of a node below the surface, in spacings.
const DIFFUSION_LEAST_DEPTH: f32 = 0.05f;
// The least distance of two nodes, in spacings.
const DIFFUSION_LEAST_DISTANCE: f32 = 0.25f;
// Added to all weights of corners, so that the weights of filled nodes never add up to 0.
const DIFFUSION_LEAST_WEIGHT: f32 = 1e-4f;
// The least variance of the nodes' depths, and the least distance of one from their mean, in spacings: what is
// less is rounding.
const DIFFUSION_LEAST_VARIANCE: f32 = 1e-4f;
const DIFFUSION_LEAST_STEP: f32 = 0.01f;
// By how much of itself a node's weight may change over the nodes' range of depths.
const DIFFUSION_STEEPEST: f32 = 3.0f;
// The largest relative index.
const DIFFUSION_DENSEST: f32 = 2.5f;
// Cosines below this count as it.
const DIFFUSION_GRAZING: f32 = 1e-9f;
// Light of a larger optical depth counts as light of this one, of which a float is hardly left.
const DIFFUSION_OPAQUE: f32 = 87.0f;
// The least and the largest extrapolation length in mean free paths.
const DIFFUSION_NEAREST: f32 = 0.5f;
const DIFFUSION_OUTERMOST: f32 = 20.0f;
// The least gamma of a slab: matter that absorbs less counts as this.
const DIFFUSION_LEAST_GAMMA: f32 = 1e-6f;
// The largest optical depth of a node.
const DIFFUSION_DEEPEST: f32 = 1e6f;
// The least optical distance of two nodes.
const DIFFUSION_THINNEST_FACE: f32 = 1e-9f;
// The slope of the fluence's logarithm per mean free path from which the flux limiter is a closed form.
const DIFFUSION_STEEP: f32 = 2.0f;
// The largest optical depth along a line.
const DIFFUSION_FARTHEST: f32 = 1e15f;

// Extrapolation length at a dielectric boundary: how far outside the fluence deep inside would fall to 0, of
// matter that absorbs nothing, if light comes from far below. A fit of the exact length, which Milne's problem
// has with light that Fresnel's reflectance throws back. Near an index of 1 it grows by half powers of n - 1,
// so that the fit is a polynomial of the root.
// Returns: length from 0.7104 for an index of 1 to 9.57 for 2.5; the fit is accurate to 1.4e-5.
// Units: mean free paths; `relative_index` is n_inside / n_outside.
// Domain: any relative_index, clamped to [1, 2.5].
// Outside: nothing.
// Accuracy: lavapipe 1.6e-5 rel; portable 1.8e-5 rel
fn diffusion_milne(relative_index: f32) -> f32 {
    let x = clamp(relative_index, 1.0f, DIFFUSION_DENSEST) - 1.0f;
    let s = sqrt(x);
    let far = 2.949771f + s * (s * 0.1045422f - 0.9277547f);
    let slope = 0.8625412f + s * (4.655942f + s * (1.148223f + s * (s * far - 2.400274f)));
    return DIFFUSION_MILNE * (1.0f + x * slope);
}

// Conductance between two nodes through the face of their cells. The coefficient of diffusion is 1 / density
// here; of two halves in series, the densities add.
// Returns: open / distance over the mean density.
// Units: `open` is the share of the face that matter fills, `distance` that of the nodes along the axis in
//   spacings; densities are relative.
// Domain: open in [0, 1]; distance up to 1e18, at least 0.25 counts; densities up to 1e18, at least 0.001
//   counts.
// Outside: finite for magnitudes up to 1e18.
// Accuracy: lavapipe 3 ulp; portable 12 ulp
fn diffusion_face(open: f32, distance: f32, densities: vec2f) -> f32 {
    let dense = max(densities, vec2f(DIFFUSION_THINNEST));
    return 2.0f * open / (max(distance, DIFFUSION_LEAST_DISTANCE) * (dense.x + dense.y));
}

// Conductance from a node through the surface in its cell: the matter between the two, and the
// extrapolation length, in series (Robin's condition).
// Returns: area over the optical distance to where the fluence would be 0.
// Units: area in squared spacings, `depth` of the node in spacings; `milne` is diffusion_milne over the
//   optical depth of a spacing at density 1.
// Domain: area in [0, 1e18]; depth up to 1e18, at least 0.05 counts; density up to 1e18, at least 0.001
//   counts; milne in [0, 1e18].
// Outside: finite for magnitudes up to 1e18, if milne is not negative.
// Accuracy: lavapipe 3 ulp; portable 7 ulp
fn diffusion_surface(area: f32, depth: f32, density: f32, milne: f32) -> f32 {
    let covered = max(density, DIFFUSION_THINNEST) * max(depth, DIFFUSION_LEAST_DEPTH);
    return area / (covered + milne);
}

// Fluence at a depth between the surface and a node, as a share of the node's: Robin's straight profile.
// The same factor weights the source, which makes the grid's nodes exact in a half space.
// Returns: (depth + milne) / (node_depth + milne) in [0, 1]; 1 from the node on.
// Units: all three in one.
// Domain: depth up to 1e18, negative ones count as 0; node_depth and milne 0 or in [1e-18, 1e18].
// Outside: in [0, 1.000001] for node_depth and milne in [0, 1e18].
// Accuracy: lavapipe 3 ulp; portable 8 ulp
fn diffusion_profile(depth: f32, node_depth: f32, milne: f32) -> f32 {
    let below = max(depth, 0.0f);
    // Also where both lengths are 0.
    if below >= node_depth {
        return 1.0f;
    }
    return (below + milne) / max(node_depth + milne, 1e-30f);
}

// What the exact law of a half space adds to diffusion's at an angle, for light from afar: H / (1 - kappa m) over
// diffusion's (milne + m) / (1 - (kappa m)^2), relative to the normal. A factor on light that enters, and on light
// that leaves.
// Returns: H(m) (1 + kappa m) / (milne + m) over the same at m = 1: from 1 along the normal to 0.82 or more grazing,
//   and at most 1.05 between them.
// Units: `h` is half_space_h at the cosine, `h_normal` at 1; `milne` in mean free paths.
// Domain: any cosine, clamped to [0, 1]; h and h_normal in [1, 3]; any gamma, clamped to [0, 1]; milne in [0.5, 20].
// Outside: finite for magnitudes up to 1e9, if h_normal is at least 1 and milne at least 0.01.
// Accuracy: lavapipe 8 ulp; portable 18 ulp
fn diffusion_angle(cosine: f32, h: f32, h_normal: f32, gamma: f32, milne: f32) -> f32 {
    let m = clamp(cosine, 0.0f, 1.0f);
    let kappa = 1.7320508f * clamp(gamma, 0.0f, 1.0f);
    return h * (1.0f + milne) * (1.0f + kappa * m) / (h_normal * (m + milne) * (1.0f + kappa));
}

// Means of transmittance over a line, weighted towards its start and towards its end. For thin lines both
// are the quotients that Pade's form of order 4 of exp(-x) leaves, in which the leading terms have
// cancelled on paper.
// Returns: integrals of (1 - u) e^(-x u) and u e^(-x u) over u in [0, 1]; 1/2 both for x = 0. Their sum is
//   (1 - e^-x) / x.
// Units: `thickness` is an optical depth.
// Domain: any thickness, clamped to [0, 1e15].
// Outside: nothing.
// Accuracy: lavapipe 15 ulp; portable 28 ulp
fn diffusion_ramps(thickness: f32) -> vec2f {
    let x = clamp(thickness, 0.0f, DIFFUSION_FARTHEST);
    if x < 1.0f {
        let square = x * x;
        let even = 0.5f + square * 0.011904762f;
        let odd = x * (0.083333336f + square * 0.0005952381f);
        let divisor = 1.0f + x * (0.5f + x * (0.10714286f + x * (0.011904762f + x * 0.0005952381f)));
        return vec2f(even + odd, even - odd) / divisor;
    }
    let left = exp(-min(x, DIFFUSION_OPAQUE));
    let mean = (1.0f - left) / x;
    return vec2f(1.0f - mean, mean - left) / x;
}

// Mean transmittance over optical depths from `near` to `far`: a difference of exponentials over the
// difference of their depths, which may be 0.
// Returns: mean of e^-t over t between both, in [0, 1]; e^-near if they are equal.
// Units: optical depths.
// Domain: any near and far, clamped to [0, 1e15].
// Outside: nothing.
// Accuracy: lavapipe 16 ulp + 4 backward; portable 24 ulp + 5 backward
fn diffusion_mean(near: f32, far: f32) -> f32 {
    let a = clamp(near, 0.0f, DIFFUSION_FARTHEST);
    let b = clamp(far, 0.0f, DIFFUSION_FARTHEST);
    let nearest = min(a, b);
    let means = diffusion_ramps(max(a, b) - nearest);
    return exp(-min(nearest, DIFFUSION_OPAQUE)) * (means.x + means.y);
}

// Share of light that collides in a layer below others.
// Returns: e^-depth (1 - e^-thickness), in [0, 1].
// Units: optical depths along the ray: `depth` of the layer's start.
// Domain: any depth, negative ones count as 0; any thickness, clamped to [0, 1e15].
// Outside: nothing.
// Accuracy: lavapipe 16 ulp + 4 backward; portable 24 ulp + 5 backward
fn diffusion_scattered(depth: f32, thickness: f32) -> f32 {
    let x = clamp(thickness, 0.0f, DIFFUSION_FARTHEST);
    let means = diffusion_ramps(x);
    // The minimum keeps a compiler from multiplying small factors first, whose product underflows.
    return exp(-clamp(depth, 0.0f, DIFFUSION_OPAQUE)) * min(x * (means.x + means.y), 1.0f);
}

// Light that a segment of a ray sends to its start, if what it scatters runs straight from one end to the
// other. Both weights are positive and add up to 1 - e^-thickness.
// Returns: integral of (start + (end - start) s / thickness) e^-s over s in [0, thickness].
// Units: those of `start` and `end`; `thickness` is an optical depth.
// Domain: start and end 0 or in [2^-20, 2^20]; any thickness, clamped to [0, 1e15].
// Outside: finite for start and end up to 1e18.
// Accuracy: lavapipe 28 ulp; portable 50 ulp
fn diffusion_segment(start: f32, end: f32, thickness: f32) -> f32 {
    let x = clamp(thickness, 0.0f, DIFFUSION_FARTHEST);
    let means = diffusion_ramps(x);
    return x * (start * means.x + end * means.y);
}

// Light that a segment of a ray sends to its start by single scattering, if the optical depth towards the
// light runs straight from `near` at the start to `far` at the end. The exponent may rise along the
// segment, stay, or fall.
// Returns: integral of e^(-s - near - (far - near) s / thickness) over s in [0, thickness].
// Units: optical depths.
// Domain: any thickness, clamped to [0, 1e6]; any near and far, clamped to [0, 87].
// Outside: nothing.
// Accuracy: lavapipe 18 ulp + 5 backward; portable 32 ulp + 6 backward
fn diffusion_unscattered(thickness: f32, near: f32, far: f32) -> f32 {
    let x = clamp(thickness, 0.0f, DIFFUSION_DEEPEST);
    let a = clamp(near, 0.0f, DIFFUSION_OPAQUE);
    let b = clamp(far, 0.0f, DIFFUSION_OPAQUE);
    let last = x + b;
    let nearest = min(a, last);
    let means = diffusion_ramps(max(a, last) - nearest);
    // Not x times diffusion_mean, which underflows first; the maximum keeps a compiler from it.
    return exp(-min(nearest, DIFFUSION_OPAQUE)) * max(x * (means.x + means.y), 0.0f);
}

// Fluence in a half space at a depth, lit by parallel light, by the exact solution of diffusion's equation
// with its exact source: a e^(-kappa t) + b e^(-t/m0). The pole of both factors at kappa m0 = 1 is removed.
// Returns: fluence of light that has collided, per perpendicular irradiance 1, in [0, 63]; 3 m0 (milne +
//   m0) deep inside matter that absorbs nothing.
// Units: none; `depth` is an optical depth along the normal, `milne` in mean free paths.
// Domain: any depth, clamped to [0, 1e6]; any cosine_light, clamped to [1e-9, 1]; any gamma, clamped to [0,
//   1]; any milne, clamped to [0.5, 20].
// Outside: nothing.
// Accuracy: lavapipe 26 ulp + 1e-30 abs + 4 backward; portable 36 ulp + 1e-30 abs + 6 backward
fn diffusion_fluence(depth: f32, cosine_light: f32, gamma: f32, milne: f32) -> f32 {
    let t = clamp(depth, 0.0f, DIFFUSION_DEEPEST);
    let c = clamp(cosine_light, DIFFUSION_GRAZING, 1.0f);
    let g = clamp(gamma, 0.0f, 1.0f);
    let z = clamp(milne, DIFFUSION_NEAREST, DIFFUSION_OUTERMOST);
    let kappa = 1.7320508f * g;
    let damped = kappa * t;
    let strength = 3.0f * (1.0f - g) * (1.0f + g) * c / (1.0f + kappa * c);
    let surface = z / (1.0f + kappa * z) * exp(-min(damped, DIFFUSION_OPAQUE));
    return strength * (surface + t * diffusion_mean(damped, t / c));
}

// Share of the light that comes through a slab, by diffusion. Light falls on the near side along the normal,
// and its first collisions count as one plane of sources at their mean depth, from which it diffuses to
// Robin's boundaries on both sides. What passes without a collision is left out: it goes on straight.
// Returns: flux through the far side, in [0, 0.4] for an index-matched surface; within 3 % of random walks
//   for an albedo of 0.99 or more up to 8 mean free paths, and 10 % for 0.9 up to 4.
// Units: none; `thickness` and `milne` in mean free paths.
// Domain: any thickness, clamped to [0, 1e6]; any gamma, clamped to [1e-6, 1]; any milne, clamped to [0.5, 20].
// Outside: nothing.
// Accuracy: lavapipe 40 ulp + 1e-30 abs + 10 backward; portable 64 ulp + 1e-30 abs + 12 backward
fn diffusion_slab(thickness: f32, gamma: f32, milne: f32) -> f32 {
    let x = clamp(thickness, 0.0f, DIFFUSION_DEEPEST);
    let g = clamp(gamma, DIFFUSION_LEAST_GAMMA, 1.0f);
    let z = clamp(milne, DIFFUSION_NEAREST, DIFFUSION_OUTERMOST);
    let kappa = 1.7320508f * g;
    let means = diffusion_ramps(x);
    let collided = x * (means.x + means.y);
    let place = x * (means.y / (means.x + means.y));
    // With u for kappa z, of sinh a + u cosh a over (1 + u^2) sinh b + 2 u cosh b the growing exponentials are
    // taken out; what is left are sums of positive terms.
    let u = kappa * z;
    let before = diffusion_scattered(0.0f, 2.0f * kappa * place);
    let all = diffusion_scattered(0.0f, 2.0f * kappa * x);
    let outward = (before + u * (2.0f - before)) / ((1.0f + u * u) * all + 2.0f * u * (2.0f - all));
    let passed = exp(-min(kappa * (x - place), DIFFUSION_OPAQUE));
    return (1.0f - g) * (1.0f + g) * collided * (outward * passed);
}

// What the eye sees of diffusion_fluence from a depth on: the integral of fluence(t) e^(-t/m) / m over t
// from there to infinity.
// Returns: that integral, in [0, 61.5].
// Units: none; `depth` is an optical depth along the normal, `milne` in mean free paths.
// Domain: any depth, clamped to [0, 1e6]; any cosines, clamped to [1e-9, 1]; any gamma, clamped to [0, 1];
//   any milne, clamped to [0.5, 20].
// Outside: nothing.
// Accuracy: lavapipe 26 ulp + 1e-30 abs + 4 backward; portable 62 ulp + 1e-30 abs + 8 backward
fn diffusion_tail(depth: f32, cosine_eye: f32, cosine_light: f32, gamma: f32, milne: f32) -> f32 {
    let t = clamp(depth, 0.0f, DIFFUSION_DEEPEST);
    let m = clamp(cosine_eye, DIFFUSION_GRAZING, 1.0f);
    let c = clamp(cosine_light, DIFFUSION_GRAZING, 1.0f);
    let g = clamp(gamma, 0.0f, 1.0f);
    let z = clamp(milne, DIFFUSION_NEAREST, DIFFUSION_OUTERMOST);
    let kappa = 1.7320508f * g;
    let damped = kappa * t;
    let strength = 3.0f * (1.0f - g) * (1.0f + g) * c / (1.0f + kappa * c);
    let left = exp(-min(damped, DIFFUSION_OPAQUE)) / (1.0f + kappa * m);
    let share = c / (m + c);
    let surface = (z / (1.0f + kappa * z) + share * m) * left;
    let seen = exp(-min(t / m, DIFFUSION_OPAQUE));
    return strength * seen * (surface + share * t * diffusion_mean(damped, t / c));
}

// What the grid, with nodes at the optical depths `depth` and `depth + gap`, does not show of a lit half space.
// Returns: law - albedo / (4 pi) (m0 / (m + m0) + angle shown), in [-7, 4]. Add it to what the grid shows times the
//   angles' factors, and to single scattering, times the light that reaches the surface.
// Units: 1/sr; `law` is the exact radiance per perpendicular irradiance 1, m0 times half_space_brdf; optical depths
//   along the normal; `milne` in mean free paths; `angle` is the product of diffusion_angle for eye and light.
// Domain: any, clamped: cosines to [1e-9, 1], law to [0, 4], gamma to [0, 1], milne to [0.5, 20], depth and gap to
//   [0, 1e6], angle to [0, 1.25].
// Outside: nothing.
// Accuracy: lavapipe 1.1e-5 abs; portable 2.1e-5 abs
fn diffusion_local(
    cosine_eye: f32, cosine_light: f32, law: f32, gamma: f32, milne: f32, depth: f32, gap: f32, angle: f32
) -> f32 {
    let m = clamp(cosine_eye, DIFFUSION_GRAZING, 1.0f);
    let c = clamp(cosine_light, DIFFUSION_GRAZING, 1.0f);
    let exact = clamp(law, 0.0f, 4.0f);
    let g = clamp(gamma, 0.0f, 1.0f);
    let z = clamp(milne, DIFFUSION_NEAREST, DIFFUSION_OUTERMOST);
    let node = clamp(depth, 0.0f, DIFFUSION_DEEPEST);
    let between = clamp(gap, 0.0f, DIFFUSION_DEEPEST);
    let end = node + between;
    let first = diffusion_fluence(node, c, g, z);
    let second = diffusion_fluence(end, c, g, z);
    let above = first * diffusion_segment(z / (node + z), 1.0f, node / m);
    let seen = exp(-min(node / m, DIFFUSION_OPAQUE));
    let below = seen * diffusion_segment(first, second, between / m);
    let shown = above + below + diffusion_tail(end, m, c, g, z);
    return exact - 0.07957747f * (1.0f - g) * (1.0f + g) * (c / (m + c) + clamp(angle, 0.0f, 1.25f) * shown);
}

// The same under light from all around, whose fluence relative to that outside is e^(-kappa t) / (1 + kappa milne).
// Returns: law - albedo angle shown, in [-1.25, 1]; 1 - angle for matter that absorbs nothing. Add it, times the
//   radiance that arrives, to what the grid shows times the eye's factor.
// Units: none; `law` is the exact radiance under a radiance of 1, half_space_directional; optical depths along the
//   normal; `milne` in mean free paths; `angle` is diffusion_angle for the eye.
// Domain: any, clamped: cosine to [1e-9, 1], law to [0, 1], gamma to [0, 1], milne to [0.5, 20], depth and gap to
//   [0, 1e6], angle to [0, 1.25].
// Outside: nothing.
// Accuracy: lavapipe 1.7e-6 abs; portable 2.8e-6 abs
fn diffusion_local_around(cosine_eye: f32, law: f32, gamma: f32, milne: f32, depth: f32, gap: f32, angle: f32) -> f32 {
    let m = clamp(cosine_eye, DIFFUSION_GRAZING, 1.0f);
    let exact = clamp(law, 0.0f, 1.0f);
    let g = clamp(gamma, 0.0f, 1.0f);
    let z = clamp(milne, DIFFUSION_NEAREST, DIFFUSION_OUTERMOST);
    let node = clamp(depth, 0.0f, DIFFUSION_DEEPEST);
    let between = clamp(gap, 0.0f, DIFFUSION_DEEPEST);
    let end = node + between;
    let kappa = 1.7320508f * g;
    let first = exp(-min(kappa * node, DIFFUSION_OPAQUE)) / (1.0f + kappa * z);
    let second = exp(-min(kappa * end, DIFFUSION_OPAQUE)) / (1.0f + kappa * z);
    // At the surface the grid shows the mean of the node's fluence and of that outside.
    let above = diffusion_segment((first * z + node) / (node + z), first, node / m);
    let below = exp(-min(node / m, DIFFUSION_OPAQUE)) * diffusion_segment(first, second, between / m);
    let shown = above + below + exp(-min(end / m, DIFFUSION_OPAQUE)) * second / (1.0f + kappa * m);
    return exact - (1.0f - g) * (1.0f + g) * clamp(angle, 0.0f, 1.25f) * shown;
}

// Weight of one of the eight nodes about a point, for the mean of what they hold: divide by the sum of the
// weights. Nodes without matter count nothing; the least weight keeps the sum from 0 where all filled
// ones are on the far side.
// Returns: (trilinear weight + 1e-4) volume.
// Units: `fraction` is the place between the voxels' centres; bits 0, 1 and 2 of `corner` are the corner's
//   x, y and z; `volume` is the node's filled share of its voxel.
// Domain: any fraction, clamped to [0, 1]; any corner, of which three bits count; volume in [0, 1e18].
// Outside: finite for volumes of magnitudes up to 1e18.
// Accuracy: lavapipe 7 ulp; portable 14 ulp
fn diffusion_weight(fraction: vec3f, corner: u32, volume: f32) -> f32 {
    let inside = clamp(fraction, vec3f(0.0f), vec3f(1.0f));
    let sides = vec3f(vec3u(corner & 1u, (corner >> 1u) & 1u, (corner >> 2u) & 1u));
    // Exact, since the sides are 0 or 1.
    let along = sides * inside + (vec3f(1.0f) - sides) * (vec3f(1.0f) - inside);
    return (along.x * along.y * along.z + DIFFUSION_LEAST_WEIGHT) * volume;
}

// How the nodes' weights change with their depth, so that their mean depth is that of the point looked up. A
// node at a distance `d` below the mean gets 1 + slope d times its weight, never below 0 nor over four times.
// Returns: missing / variance, from -1 / below to 1 / above, and at most 3 / (above + below) either way.
// Units: spacings: `missing` is the point's depth less the nodes' mean, `variance` that of their depths,
//   `above` and `below` are the distances from the mean to the shallowest and to the deepest.
// Domain: missing with a magnitude up to 1e18; variance up to 1e18, at least 1e-4 counts; above and below up to
//   1e18, at least 0.01 counts.
// Outside: in [-100.01, 100.01] for magnitudes up to 1e18.
// Accuracy: lavapipe 1.5 ulp; portable 4 ulp
fn diffusion_slope(missing: f32, variance: f32, above: f32, below: f32) -> f32 {
    let wanted = missing / max(variance, DIFFUSION_LEAST_VARIANCE);
    let steepest = DIFFUSION_STEEPEST / max(above + below, DIFFUSION_LEAST_STEP);
    let falling = min(1.0f / max(below, DIFFUSION_LEAST_STEP), steepest);
    let rising = min(1.0f / max(above, DIFFUSION_LEAST_STEP), steepest);
    return clamp(wanted, -falling, rising);
}

// Factor of a flux limiter on the conductance between two nodes, so that the flux is at most the fluence.
// It is 3 (coth R - 1/R) / R, with R the slope of the logarithm of the fluence per mean free path.
// Returns: 1 for equal fluences, 3 / R for large R, in [0, 1].
// Units: both fluences in one unit; `thickness` is the optical distance between the nodes.
// Domain: fluences 0 or in [1e-18, 1e18], negative ones count as 0; any thickness, clamped to [1e-9, 1e15].
// Outside: in [0, 1] for fluences of magnitudes up to 1e18.
// Accuracy: lavapipe 8 ulp; portable 28 ulp; order kept
fn diffusion_limit(one: f32, other: f32, thickness: f32) -> f32 {
    let a = max(one, 0.0f);
    let b = max(other, 0.0f);
    let share = abs(a - b) / max(a + b, 1e-18f);
    let slope = 2.0f * share / clamp(thickness, DIFFUSION_THINNEST_FACE, DIFFUSION_FARTHEST);
    if slope < DIFFUSION_STEEP {
        // Seven levels of the continued fraction 3 / (3 + R^2 / (5 + R^2 / (7 + ...))).
        let s = slope * slope;
        let above = 1.0f + s * (0.06666667f + s * (0.0008791209f + s * 1.4800015e-6f));
        let below = 1.0f + s * (0.13333334f + s * (0.0034188034f + s * 1.776002e-5f));
        return above / below;
    }
    let left = exp(-min(2.0f * slope, DIFFUSION_OPAQUE));
    return 3.0f * ((1.0f + left) / (1.0f - left) - 1.0f / slope) / slope;
}

// A node's value that solves its equation for given neighbours: a step of relaxation.
// Returns: (load + inflow) / (conductances + reaction); 0 for a node that exchanges and loses nothing.
// Units: `inflow` is the sum of conductances times the neighbours' values, `conductances` their sum with
//   the surface's; `reaction` is (kappa h)^2 rho V.
// Domain: load and inflow with magnitudes up to 1e18; conductances and reaction 0 or in [1e-18, 1e18].
// Outside: 0 if conductances and reaction are not positive.
// Accuracy: lavapipe 3 ulp; portable 7 ulp
fn diffusion_relax(load: f32, inflow: f32, conductances: f32, reaction: f32) -> f32 {
    let divisor = conductances + reaction;
    if divisor <= 0.0f {
        return 0.0f;
    }
    return (load + inflow) / divisor;
}
