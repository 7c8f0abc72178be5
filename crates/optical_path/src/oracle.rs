//! Exact results in f64. Godunov's update comes from a bisection of its defining equation, the bits
//! of a cost from its exponent and mantissa. Shortest paths come from Dijkstra's algorithm with a
//! heap, in any precision; on the ball, from a search over the points where light may enter.

use crate::kernels::Body;
use glam::DVec3;
use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

const UNREACHED: f64 = crate::OPTICAL_PATH_UNREACHED as f64;

/// Integrates the extinction along the edge by the trapezoidal rule.
pub fn edge(extinction_a: f64, extinction_b: f64, length: f64) -> f64 {
    extinction_a * length / 2.0 + extinction_b * length / 2.0
}

/// Returns the mean of the extinctions.
pub fn edge_paper(extinction_a: f64, extinction_b: f64) -> f64 {
    extinction_a / 2.0 + extinction_b / 2.0
}

/// Returns the least possible cost.
pub fn relax(cost: f64, neighbour: f64, edge: f64) -> f64 {
    let offers = [cost, if neighbour < UNREACHED { neighbour + edge } else { UNREACHED }];
    offers.into_iter().fold(f64::INFINITY, f64::min)
}

/// Adds the root of Σ max(w - rise, 0)² = slowness², found by bisection, to the least cost.
pub fn godunov(least: DVec3, slowness: f64) -> f64 {
    let first = least.min_element();
    let rises = least - first;
    let (mut low, mut high) = (0.0, slowness);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        // In units of the slowness, so that no square leaves the range of f64.
        let sum = rises.map(|rise| ((middle - rise) / slowness).max(0.0).powi(2)).element_sum();
        if sum < 1.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    (first + high).min(UNREACHED)
}

/// Combines the exponent and the mantissa.
pub fn encode(cost: f64) -> u32 {
    if cost.is_nan() || cost >= UNREACHED {
        return encode(UNREACHED.next_down());
    }
    if cost <= 0.0 {
        return 0;
    }
    let mut exponent = -126;
    while cost >= 2f64.powi(exponent + 1) {
        exponent += 1;
    }
    // Below 2⁻¹²⁶ the exponent bits are 0, and so is the leading bit of the mantissa.
    ((exponent + 126) << 23) as u32 + (cost / 2f64.powi(exponent - 23)).round() as u32
}

/// Returns the number that the bits represent.
pub fn decode(bits: u32) -> f64 {
    let cost = f64::from(f32::from_bits(bits));
    if cost.is_sign_negative() { UNREACHED } else { cost.min(UNREACHED) }
}

/// Returns -ln of the share plus the optical depth of the path.
pub fn seed(irradiance_share: f64, extinction: f64, offset: f64) -> f64 {
    if irradiance_share < f64::from(f32::MIN_POSITIVE) {
        return UNREACHED;
    }
    // The logarithm is computed in two halves, and near 1 from the difference to 1, so that no
    // digit is lost.
    let root = irradiance_share.min(1.0).sqrt();
    let half = if root > 0.5 { (root - 1.0).ln_1p() } else { root.ln() };
    extinction * offset - 2.0 * half
}

/// Returns the sum, at most unreached.
pub fn through(cost: f64, extinction: f64, offset: f64) -> f64 {
    if cost >= UNREACHED { UNREACHED } else { (cost + extinction * offset).min(UNREACHED) }
}

/// Computes the exponential in equal layers.
pub fn luminance(cost: f64) -> f64 {
    if cost >= f64::from(crate::OPTICAL_PATH_DEEPEST) {
        return 0.0;
    }
    (-cost.max(0.0) / 128.0).exp().powi(128)
}

/// A number type in which the costs of paths are summed.
pub trait Number: Copy + PartialOrd {
    /// Returns the cost of a node that no path reaches.
    fn unreached() -> Self;
    /// Returns the cost after an edge of this `length` between nodes of these extinctions.
    fn after(self, extinctions: [f32; 2], length: f32) -> Self;
}

impl Number for f32 {
    fn unreached() -> Self {
        crate::OPTICAL_PATH_UNREACHED
    }
    fn after(self, [a, b]: [f32; 2], length: f32) -> Self {
        self + 0.5 * (a + b) * length
    }
}

impl Number for f64 {
    fn unreached() -> Self {
        UNREACHED
    }
    fn after(self, extinctions: [f32; 2], length: f32) -> Self {
        let [a, b] = extinctions.map(f64::from);
        self + edge(a, b, f64::from(length))
    }
}

/// A cost in the heap, never a NaN.
struct Ordered<N>(N, usize);

impl<N: PartialOrd> PartialEq for Ordered<N> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}
impl<N: PartialOrd> Eq for Ordered<N> {}
impl<N: PartialOrd> PartialOrd for Ordered<N> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl<N: PartialOrd> Ord for Ordered<N> {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.partial_cmp(&other.0).unwrap_or(Ordering::Equal)
    }
}

/// Runs Dijkstra's algorithm on the graph of a body: returns the least cost of every voxel, from
/// its seeds, along edges of the stencil.
pub fn dijkstra<N: Number>(body: &Body<'_>, stencil: u32, seeds: &[N]) -> Vec<N> {
    let mut costs: Vec<N> = vec![N::unreached(); seeds.len()];
    let mut heap = BinaryHeap::new();
    for (index, seed) in seeds.iter().enumerate() {
        if body.matter[index] && *seed < N::unreached() {
            costs[index] = *seed;
            heap.push(Reverse(Ordered(*seed, index)));
        }
    }
    while let Some(Reverse(Ordered(cost, index))) = heap.pop() {
        if costs[index] < cost {
            continue;
        }
        for (neighbour, length) in body.neighbours(index, stencil) {
            let through = cost.after([body.extinction[index], body.extinction[neighbour]], length);
            if through < costs[neighbour] {
                costs[neighbour] = through;
                heap.push(Reverse(Ordered(through, neighbour)));
            }
        }
    }
    costs
}

/// Returns the least cost at a point of a homogeneous ball of optical radius `radius` under
/// parallel light, `distance` optical depths from the centre and at the angle `angle` in radians
/// from the light. Light enters at the angle α, at the cost -ln cos α.
pub fn ball(radius: f64, distance: f64, angle: f64) -> f64 {
    let cost = |alpha: f64| {
        let chord = (radius - distance).hypot(2.0 * (radius * distance).sqrt() * (0.5 * (angle - alpha)).sin());
        chord - alpha.cos().ln()
    };
    // Tries a thousand places, then refines the best of them, because the function may have two
    // minima.
    let end = std::f64::consts::FRAC_PI_2;
    let step = end / 512.0;
    let places = (0..1024).map(|place| -end + step * (f64::from(place) + 0.5));
    let best = places.min_by(|one, other| cost(*one).total_cmp(&cost(*other))).unwrap_or(0.0);
    let (mut low, mut high) = (best - step, best + step);
    for _ in 0..60 {
        let (left, right) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        // Beyond the terminator the logarithm has no value, and such a place is not taken.
        if cost(left) < cost(right) || cost(right).is_nan() { high = right } else { low = left }
    }
    cost(0.5 * (low + high)).min(cost(best))
}
