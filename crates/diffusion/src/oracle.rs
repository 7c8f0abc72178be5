//! The oracle in f64. Integrals of transmittance are Gauss quadratures of what they integrate. The
//! fluence in a half space is the integral of its source with Green's function of Robin's condition. The
//! local parts are quadratures of the grid's straight lines and of the solution below them; the solution
//! there is the closed form with `exp_m1`, which the tests compare with Green's function. The extrapolation length is that of
//! Milne's problem with a boundary, by the H function. Conductances are sums of resistances.

use glam::{DVec2, DVec3};
use std::f64::consts::PI;
use std::sync::LazyLock;

/// The module's constants, repeated so that an error in them does not carry over to the oracle.
const THINNEST: f32 = 1e-3;
const LEAST_DEPTH: f32 = 0.05;
const LEAST_DISTANCE: f32 = 0.25;
const LEAST_WEIGHT: f32 = 1e-4;
const LEAST_VARIANCE: f32 = 1e-4;
const LEAST_STEP: f32 = 0.01;
const THINNEST_FACE: f32 = 1e-9;
const GRAZING: f32 = 1e-9;
const LENGTHS: (f64, f64) = (0.5, 20.0);

/// Milne's length, of a half space without a boundary.
const MILNE: f64 = 0.710_446_089_598_763;

/// Optical depth at which quadratures end: 3e-20 of the light is left.
const END: f64 = 45.0;

/// The five Gauss points on [-1, 1] and their weights.
const GAUSS: [(f64, f64); 5] = [
    (-0.906179845938664, 0.23692688505618908),
    (-0.5384693101056831, 0.47862867049936647),
    (0.0, 128.0 / 225.0),
    (0.5384693101056831, 0.47862867049936647),
    (0.906179845938664, 0.23692688505618908),
];

/// Points on [0, 1] and their weights: Gauss's in equal panels.
fn points(panels: u32) -> impl Iterator<Item = (f64, f64)> {
    let half = 0.5 / f64::from(panels);
    let middles = (0..panels).map(move |panel| half * (2.0 * f64::from(panel) + 1.0));
    middles.flat_map(move |middle| GAUSS.map(|(node, weight)| (middle + half * node, half * weight)))
}

/// Returns the integral of `f` over [low, high], in equal panels no wider than `panel`.
fn integral(low: f64, high: f64, panel: f64, f: impl Fn(f64) -> f64) -> f64 {
    let length = high - low;
    let count = (length / panel).ceil().max(1.0);
    length * points(count as u32).map(|(share, weight)| weight * f(low + share * length)).sum::<f64>()
}

/// Returns the integral of `f` over [0, high], in panels that begin with the width `scale` and double up to
/// a width of 1.
fn graded(high: f64, scale: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (mut start, mut width, mut sum) = (0.0, scale, 0.0);
    while start < high {
        width = f64::min(width, 1.0);
        let next = f64::min(start + width, high);
        sum += integral(start, next, 1.0, &f);
        start = next;
        width *= 2.0;
    }
    sum
}

/// Returns Fresnel's reflectance from inside.
fn reflected(cosine: f64, index: f64) -> f64 {
    let radicand = 1.0 - index * index * (1.0 - cosine) * (1.0 + cosine);
    if radicand <= 0.0 {
        return 1.0;
    }
    let outside = radicand.sqrt();
    let s = (index * cosine - outside) / (index * cosine + outside);
    let p = (cosine - index * outside) / (cosine + index * outside);
    0.5 * (s * s + p * p)
}

/// Returns Chandrasekhar's H function of matter that absorbs nothing, from the integral of its logarithm over
/// ln(1 - atan(x) / x), with x from 0 to infinity.
fn h(cosine: f64) -> f64 {
    static LOGARITHMS: LazyLock<Vec<(f64, f64)>> = LazyLock::new(|| {
        let of_point = |(u, weight): (f64, f64)| {
            // Steep at neither end, where the logarithm and x are.
            let share = u.powi(3) * (10.0 - 15.0 * u + 6.0 * u * u);
            let rest = (1.0 - u).powi(3) * (1.0 + 3.0 * u + 6.0 * u * u);
            let slope = 30.0 * (u * (1.0 - u)).powi(2);
            let x: f64 = share / rest;
            let square = x * x;
            let lost = if x < 0.01 { square * (1.0 / 3.0 - square * (0.2 - square / 7.0)) } else { 1.0 - x.atan() / x };
            (x, weight * slope / rest.powi(2) * lost.ln())
        };
        points(32).map(of_point).collect()
    });
    let sum: f64 = LOGARITHMS.iter().map(|(x, part)| part / (1.0 + (cosine * x).powi(2))).sum();
    (-cosine / PI * sum).exp()
}

/// Solves linear equations, each with its right side last, by elimination; the diagonal is the largest of each column.
fn solved(mut rows: Vec<Vec<f64>>) -> Vec<f64> {
    let count = rows.len();
    for pivot in 0..count {
        let top = rows[pivot].clone();
        for row in &mut rows[pivot + 1..] {
            let factor = row[pivot] / top[pivot];
            row[pivot..].iter_mut().zip(&top[pivot..]).for_each(|(part, above)| *part -= factor * above);
        }
    }
    let mut found = vec![0.0; count];
    for place in (0..count).rev() {
        let known: f64 = (place + 1..count).map(|other| rows[place][other] * found[other]).sum();
        found[place] = (rows[place][count] - known) / rows[place][place];
    }
    found
}

/// Solves for the light that comes to the boundary from inside: what a half space without a boundary sends out, and what
/// it sends back of the light that the boundary throws in. Each part of that adds to the fluence deep inside.
pub fn milne(relative_index: f64) -> f64 {
    let index = relative_index.clamp(1.0, 2.5);
    if index == 1.0 {
        return MILNE;
    }
    let critical = ((index - 1.0) * (index + 1.0)).sqrt() / index;
    // Grazing light changes fast, and so does Fresnel's reflectance beside the critical angle.
    let squared = |(u, weight): (f64, f64)| (u * u, 2.0 * u * weight);
    let below = points(3).map(squared).map(|(m, weight)| (critical * m, critical * weight));
    let above = points(3).map(squared);
    let above = above.map(|(m, weight)| (critical + (1.0 - critical) * m, (1.0 - critical) * weight));
    // Cosine, H, and the weight of what is thrown back.
    let of_point = |(m, weight): (f64, f64)| (m, h(m), weight * m * h(m) * reflected(m, index));
    let rays: Vec<(f64, f64, f64)> = below.chain(above).map(of_point).collect();
    let row = |(m, h, _): &(f64, f64, f64)| {
        let back = rays.iter().map(|(other, _, back)| -0.5 * h * back / (m + other));
        back.chain([h / 3f64.sqrt()]).collect::<Vec<f64>>()
    };
    let mut rows: Vec<Vec<f64>> = rays.iter().map(row).collect();
    (0..rows.len()).for_each(|number| rows[number][number] += 1.0);
    let light = solved(rows);
    MILNE + 0.75f64.sqrt() * rays.iter().zip(&light).map(|((.., back), light)| back * light).sum::<f64>()
}

/// Adds the resistances of two halves.
pub fn face(open: f64, distance: f64, densities: DVec2) -> f64 {
    let half = 0.5 * distance.max(f64::from(LEAST_DISTANCE));
    let resistance = |density: f64| half * density.max(f64::from(THINNEST));
    open / (resistance(densities.x) + resistance(densities.y))
}

/// Returns [`face`]: the naive form is the same function, computed badly.
pub fn face_naive(open: f64, distance: f64, densities: DVec2) -> f64 {
    face(open, distance, densities)
}

/// Adds the resistances of the matter and of the extrapolation length.
pub fn surface(area: f64, depth: f64, density: f64, milne: f64) -> f64 {
    if area == 0.0 {
        return 0.0;
    }
    let matter = density.max(f64::from(THINNEST)) * depth.max(f64::from(LEAST_DEPTH)) / area;
    (matter + milne / area).recip()
}

/// Returns [`surface`]: the naive form is the same function, computed badly.
pub fn surface_naive(area: f64, depth: f64, density: f64, milne: f64) -> f64 {
    surface(area, depth, density, milne)
}

/// Subtracts the share by which the profile has fallen below the node's.
pub fn profile(depth: f64, node_depth: f64, milne: f64) -> f64 {
    let missing = node_depth - depth.max(0.0);
    if missing <= 0.0 {
        return 1.0;
    }
    let whole = node_depth + milne;
    // Near 0 the difference would leave no digits.
    if missing > 0.5 * whole { (depth.max(0.0) + milne) / whole } else { 1.0 - missing / whole }
}

/// Returns [`profile`]: the naive form is the same function, computed badly.
pub fn profile_naive(depth: f64, node_depth: f64, milne: f64) -> f64 {
    profile(depth, node_depth, milne)
}

/// Divides the two laws of light that grows inwards as e^(κ t), each relative to its value along the normal:
/// H / (1 - κ m), and diffusion's (z + m) / (1 - (κ m)²).
pub fn angle(cosine: f64, h: f64, h_normal: f64, gamma: f64, milne: f64) -> f64 {
    let (m, kappa) = (cosine.clamp(0.0, 1.0), 3f64.sqrt() * gamma.clamp(0.0, 1.0));
    let of_diffusion = (milne + m) / (1.0 + kappa * m) * (1.0 + kappa) / (milne + 1.0);
    h / h_normal / of_diffusion
}

/// Returns the integral of `f`(u) e^(-x u) over u in [0, 1].
fn attenuated(x: f64, f: impl Fn(f64) -> f64) -> f64 {
    if x <= 1.0 {
        return integral(0.0, 1.0, 0.5, |u| f(u) * (-x * u).exp());
    }
    integral(0.0, x.min(END), 1.0, |s| f(s / x) * (-s).exp()) / x
}

fn clamped_thickness(thickness: f64) -> f64 {
    thickness.clamp(0.0, 1e15f32.into())
}

/// Integrates both weights.
pub fn ramps(thickness: f64) -> DVec2 {
    let x = clamped_thickness(thickness);
    DVec2::new(attenuated(x, |u| 1.0 - u), attenuated(x, |u| u))
}

/// Integrates the transmittance.
pub fn mean(near: f64, far: f64) -> f64 {
    let (a, b) = (clamped_thickness(near), clamped_thickness(far));
    (-a.min(b)).exp() * attenuated((b - a).abs(), |_| 1.0)
}

/// Returns [`mean`]: the naive form is the same function, computed badly.
pub fn mean_naive(near: f64, far: f64) -> f64 {
    mean(near, far)
}

/// Integrates the collisions.
pub fn scattered(depth: f64, thickness: f64) -> f64 {
    let x = clamped_thickness(thickness);
    (-depth.max(0.0)).exp() * x * attenuated(x, |_| 1.0)
}

/// Returns [`scattered`]: the naive form is the same function, computed badly.
pub fn scattered_naive(depth: f64, thickness: f64) -> f64 {
    scattered(depth, thickness)
}

/// Integrates the straight line.
pub fn segment(start: f64, end: f64, thickness: f64) -> f64 {
    let x = clamped_thickness(thickness);
    x * attenuated(x, |u| start * (1.0 - u) + end * u)
}

/// Returns [`segment`]: the naive form is the same function, computed badly.
pub fn segment_naive(start: f64, end: f64, thickness: f64) -> f64 {
    segment(start, end, thickness)
}

/// Integrates from the end with less matter before it.
pub fn unscattered(thickness: f64, near: f64, far: f64) -> f64 {
    let x = thickness.clamp(0.0, 1e6);
    let (first, last) = (near.clamp(0.0, 87.0), x + far.clamp(0.0, 87.0));
    (-first.min(last)).exp() * x * attenuated((last - first).abs(), |_| 1.0)
}

/// Returns [`unscattered`]: the naive form is the same function, computed badly.
pub fn unscattered_naive(thickness: f64, near: f64, far: f64) -> f64 {
    unscattered(thickness, near, far)
}

fn clamped_cosine(cosine: f64) -> f64 {
    cosine.clamp(f64::from(GRAZING), 1.0)
}

/// Returns (1 - e^-x) / x.
fn gradual(x: f64) -> f64 {
    if x < 1e-12 { 1.0 } else { -(-x).exp_m1() / x }
}

fn clamped_milne(milne: f64) -> f64 {
    milne.clamp(LENGTHS.0, LENGTHS.1)
}

/// Integrates the source with Green's function. With a zero at the distance z outside of the surface it is
/// e^(-κ max) (sinh(κ min) / κ + z cosh(κ min)) / (1 + κ z) of the two depths.
pub fn fluence(depth: f64, cosine_light: f64, gamma: f64, milne: f64) -> f64 {
    let (t, c, g) = (depth.clamp(0.0, 1e6), clamped_cosine(cosine_light), gamma.clamp(0.0, 1.0));
    let (z, kappa) = (clamped_milne(milne), 3f64.sqrt() * g);
    let product = kappa * c;
    if t * kappa.min(c.recip()) > 80.0 {
        return 0.0;
    }
    let inner =
        |s: f64| (s * gradual(2.0 * kappa * s) + 0.5 * z * (1.0 + (-2.0 * kappa * s).exp())) / (1.0 + kappa * z);
    // Sources above the depth, in mean free paths along the light; then those below, which decay alike.
    let last = if product < 1.0 { f64::min(t / c, 2.0 * END / (1.0 - product)) } else { t / c };
    let above = integral(0.0, last, 1.0, |v| inner(c * v) * (-kappa * (t - c * v) - v).exp());
    let below = inner(t) * (-t / c).exp() / (1.0 + product);
    3.0 * (1.0 - g) * (1.0 + g) * c * (above + below)
}

/// Returns the same in closed form, for quadratures; the arguments are not clamped.
pub(crate) fn emission(t: f64, c: f64, g: f64, z: f64) -> f64 {
    let kappa = 3f64.sqrt() * g;
    let surface = z / (1.0 + kappa * z) * (-kappa * t).exp();
    let rise = t * (-(kappa * t).min(t / c)).exp() * gradual((t / c - kappa * t).abs());
    3.0 * (1.0 - g) * (1.0 + g) * c / (1.0 + kappa * c) * (surface + rise)
}

/// Returns [`fluence`]: the naive form is the same function, computed badly.
pub fn fluence_naive(depth: f64, cosine_light: f64, gamma: f64, milne: f64) -> f64 {
    fluence(depth, cosine_light, gamma, milne)
}

/// Divides the hyperbolic functions, with the collisions and their mean depth by quadrature.
pub fn slab(thickness: f64, gamma: f64, milne: f64) -> f64 {
    let (x, g) = (thickness.clamp(0.0, 1e6), gamma.clamp(1e-6f32.into(), 1.0));
    let (kappa, mean) = (3f64.sqrt() * g, attenuated(x, |_| 1.0));
    let (place, u) = (x * attenuated(x, |s| s) / mean, kappa * clamped_milne(milne));
    let (a, b) = (kappa * place, kappa * x);
    // Beyond that both hyperbolic functions are the same exponential.
    let outward = if b > 300.0 {
        2.0 * (a.sinh() + u * a.cosh()) * (-b).exp() / (1.0 + u).powi(2)
    } else {
        (a.sinh() + u * a.cosh()) / ((1.0 + u * u) * b.sinh() + 2.0 * u * b.cosh())
    };
    (1.0 - g) * (1.0 + g) * x * mean * outward
}

/// Returns [`slab`]: the naive form is the same function, computed badly.
pub fn slab_naive(thickness: f64, gamma: f64, milne: f64) -> f64 {
    slab(thickness, gamma, milne)
}

/// Integrates the fluence along the ray.
pub fn tail(depth: f64, cosine_eye: f64, cosine_light: f64, gamma: f64, milne: f64) -> f64 {
    let (t, g, z) = (depth.clamp(0.0, 1e6), gamma.clamp(0.0, 1.0), clamped_milne(milne));
    let (m, c) = (clamped_cosine(cosine_eye), clamped_cosine(cosine_light));
    if t / m > 700.0 {
        return 0.0;
    }
    (-t / m).exp() * graded(END, c / m, |v| emission(t + m * v, c, g, z) * (-v).exp())
}

/// What a grid with nodes at two depths shows of a fluence in a half space, and what of it an eye sees:
/// straight lines between the nodes and up to `surface`, the fluence itself below.
fn shown(m: f64, (node, gap): (f64, f64), surface: f64, scale: f64, fluence_at: impl Fn(f64) -> f64) -> f64 {
    let (first, second) = (fluence_at(node), fluence_at(node + gap));
    let line = |from: f64, to: f64, length: f64| {
        graded(f64::min(length / m, END), 1.0, |v| (from + (to - from) * m * v / length) * (-v).exp())
    };
    let above = if node > 0.0 { line(surface, first, node) } else { 0.0 };
    if node / m >= END {
        return above;
    }
    let below = if gap > 0.0 { line(first, second, gap) } else { 0.0 };
    let rest = if gap / m < END {
        (-gap / m).exp() * graded(END, scale, |v| fluence_at(node + gap + m * v) * (-v).exp())
    } else {
        0.0
    };
    above + (-node / m).exp() * (below + rest)
}

/// Integrates what the grid shows along the ray.
#[expect(clippy::too_many_arguments, reason = "the shader's")]
pub fn local(
    cosine_eye: f64,
    cosine_light: f64,
    law: f64,
    gamma: f64,
    milne: f64,
    depth: f64,
    gap: f64,
    angle: f64,
) -> f64 {
    let (m, c, g) = (clamped_cosine(cosine_eye), clamped_cosine(cosine_light), gamma.clamp(0.0, 1.0));
    let (node, gap, z) = (depth.clamp(0.0, 1e6), gap.clamp(0.0, 1e6), clamped_milne(milne));
    let emission_at = |t: f64| emission(t, c, g, z);
    let shown = shown(m, (node, gap), emission_at(node) * z / (node + z), c / m, emission_at);
    let albedo = (1.0 - g) * (1.0 + g) / (4.0 * PI);
    law.clamp(0.0, 4.0) - albedo * c / (m + c) - albedo * angle.clamp(0.0, 1.25) * shown
}

/// Returns [`local`]: the naive form is the same function, computed badly.
#[expect(clippy::too_many_arguments, reason = "the shader's")]
pub fn local_naive(
    cosine_eye: f64,
    cosine_light: f64,
    law: f64,
    gamma: f64,
    milne: f64,
    depth: f64,
    gap: f64,
    angle: f64,
) -> f64 {
    local(cosine_eye, cosine_light, law, gamma, milne, depth, gap, angle)
}

/// Integrates what the grid shows along the ray. The profile between surface and node is the straight line
/// through the node whose extrapolation is the fluence outside, 1.
pub fn local_around(cosine_eye: f64, law: f64, gamma: f64, milne: f64, depth: f64, gap: f64, angle: f64) -> f64 {
    let (m, g, z) = (clamped_cosine(cosine_eye), gamma.clamp(0.0, 1.0), clamped_milne(milne));
    let (node, gap) = (depth.clamp(0.0, 1e6), gap.clamp(0.0, 1e6));
    let kappa = 3f64.sqrt() * g;
    let fluence_at = |t: f64| (-kappa * t).exp() / (1.0 + kappa * z);
    let surface = 1.0 + (fluence_at(node) - 1.0) * z / (node + z);
    let seen = angle.clamp(0.0, 1.25) * shown(m, (node, gap), surface, 1.0, fluence_at);
    law.clamp(0.0, 1.0) - (1.0 - g) * (1.0 + g) * seen
}

/// Multiplies the distances from the opposite corner.
pub fn weight(fraction: DVec3, corner: u32, volume: f64) -> f64 {
    let inside = fraction.clamp(DVec3::ZERO, DVec3::ONE).to_array();
    let along = |(axis, way): (usize, f64)| if corner & (1 << axis) == 0 { 1.0 - way } else { way };
    let trilinear: f64 = inside.into_iter().enumerate().map(along).product();
    volume * trilinear + volume * f64::from(LEAST_WEIGHT)
}

/// Compares the quotient's numerator with both limits, multiplied by the variance. The limits are given by the
/// distances at which a weight would be 0.
pub fn slope(missing: f64, variance: f64, above: f64, below: f64) -> f64 {
    let variance = variance.max(f64::from(LEAST_VARIANCE));
    let least = f64::from(LEAST_STEP);
    let reach = (above + below).max(least) / 3.0;
    let [above, below] = [above, below].map(|distance| distance.max(least).max(reach));
    if missing * above > variance {
        above.recip()
    } else if -missing * below > variance {
        -below.recip()
    } else {
        missing / variance
    }
}

/// Quadrature: light whose radiance at a cosine m is e^(m R) has the mean cosine coth R - 1/R. Beyond a slope of 30 the
/// closed form, in which nothing cancels any more.
pub fn limit(one: f64, other: f64, thickness: f64) -> f64 {
    let [a, b] = [one, other].map(|fluence| fluence.max(0.0));
    let difference = (a - b).abs();
    if difference == 0.0 {
        return 1.0;
    }
    let slope = 2.0 * difference / (a + b).max(1e-18) / thickness.clamp(f64::from(THINNEST_FACE), 1e15);
    if slope > 30.0 {
        return 3.0 * (1.0 - 1.0 / slope) / slope;
    }
    // By parts (coth R - 1/R) / R is the integral of (1 - m^2) / 2 times e^(m R), over that of e^(m R): nothing cancels.
    let (mut above, mut below) = (0.0, 0.0);
    let pieces = 64;
    for piece in 0..pieces {
        for (place, weight) in GAUSS {
            let cosine = (f64::from(piece) + 0.5 * (place + 1.0)) / f64::from(pieces) * 2.0 - 1.0;
            let radiance = weight * ((cosine - 1.0) * slope).exp();
            above += 0.5 * (1.0 - cosine * cosine) * radiance;
            below += radiance;
        }
    }
    3.0 * above / below
}

/// Returns [`limit`]: the naive form is the same function, computed badly.
pub fn limit_naive(one: f64, other: f64, thickness: f64) -> f64 {
    limit(one, other, thickness)
}

/// Adds the shares of load and inflow.
pub fn relax(load: f64, inflow: f64, conductances: f64, reaction: f64) -> f64 {
    let divisor = conductances + reaction;
    if divisor <= 0.0 { 0.0 } else { load / divisor + inflow / divisor }
}

/// Returns [`relax`]: the naive form is the same function, computed badly.
pub fn relax_naive(load: f64, inflow: f64, conductances: f64, reaction: f64) -> f64 {
    relax(load, inflow, conductances, reaction)
}
