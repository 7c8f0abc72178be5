//! Mirror of `wgsl/optical_path.wgsl`: the path of least optical depth from the light to every
//! voxel of a body. The WGSL file states the units, domain and accuracy of each function. This file
//! follows it line by line.
//!
//! ```
//! use glam::Vec3;
//! use lapidary_optical_path::{edge, godunov};
//!
//! // A step of 2 mm through matter of 500 and 700 per metre: an optical depth of 1.2.
//! assert!((edge(500.0, 700.0, 0.002) - 1.2).abs() < 1e-6);
//! // A front that runs along x alone costs one step more than its neighbour.
//! assert_eq!(godunov(Vec3::new(1.0, 1e30, 1e30), 0.5), 1.5);
//! ```

#[cfg(feature = "formulas")]
pub mod formulas;
pub mod kernels;
pub mod oracle;

use glam::Vec3;

/// Cost of a node that no light has reached.
pub const OPTICAL_PATH_UNREACHED: f32 = 1e30;
/// Least share of irradiance; smaller ones count as 0.
pub const OPTICAL_PATH_DARKEST: f32 = 1.1754943508222875e-38;
/// Cost from which luminance is 0.
pub const OPTICAL_PATH_DEEPEST: f32 = 87.3;

/// Returns the cost of the edge between two nodes: the mean of their extinctions times its length.
pub fn edge(extinction_a: f32, extinction_b: f32, length: f32) -> f32 {
    0.5 * (extinction_a + extinction_b) * length
}

/// Returns the cost of an edge as in the paper: the extinction, whatever the edge's length.
pub fn edge_paper(extinction_a: f32, extinction_b: f32) -> f32 {
    0.5 * (extinction_a + extinction_b)
}

/// Returns the cost of a node once the path through one neighbour is known.
pub fn relax(cost: f32, neighbour: f32, edge: f32) -> f32 {
    let through = if neighbour < OPTICAL_PATH_UNREACHED { neighbour + edge } else { OPTICAL_PATH_UNREACHED };
    if through < cost { through } else { cost }
}

/// Returns the cost of a node by the Eikonal equation, with Godunov's upwind differences.
pub fn godunov(least: Vec3, slowness: f32) -> f32 {
    let low = least.x.min(least.y);
    let high = least.x.max(least.y);
    let rest = low.max(least.z);
    let first = low.min(least.z);
    let divisor = slowness.max(OPTICAL_PATH_DARKEST);
    let second = (rest.min(high) - first).min(slowness) / divisor;
    let third = (rest.max(high) - first).min(slowness) / divisor;
    let two = 0.5 * (second + (2.0 - second * second).sqrt());
    let last = third.min(two);
    let radicand = 3.0 - 2.0 * (second * second - second * last + last * last);
    let three = 0.33333334 * (second + last + radicand.sqrt());
    (first + slowness * three).min(OPTICAL_PATH_UNREACHED)
}

/// Computes the same by the quadratic formula in T itself, case by case.
pub fn godunov_naive(least: Vec3, slowness: f32) -> f32 {
    let low = least.x.min(least.y);
    let high = least.x.max(least.y);
    let rest = low.max(least.z);
    let first = low.min(least.z);
    let second = rest.min(high);
    let third = rest.max(high);
    let one = first + slowness;
    if one <= second {
        return one;
    }
    let pair = first + second;
    let two = 0.5 * (pair + (pair * pair - 2.0 * (first * first + second * second - slowness * slowness)).sqrt());
    if two <= third {
        return two;
    }
    let sum = pair + third;
    let squares = first * first + second * second + third * third;
    (sum + (sum * sum - 3.0 * (squares - slowness * slowness)).sqrt()) / 3.0
}

/// Returns a cost as bits that are ordered as costs are.
pub fn encode(cost: f32) -> u32 {
    let bits = cost.to_bits();
    let reached = bits.min(0x7149_f2ca);
    let negative = bits > 0x7fff_ffff && bits <= 0xff80_0000;
    if negative { 0 } else { reached }
}

/// Returns the cost that was encoded.
pub fn decode(bits: u32) -> f32 {
    f32::from_bits(bits.min(0x7149_f2ca))
}

/// Returns the cost of a node near which light enters.
pub fn seed(irradiance_share: f32, extinction: f32, offset: f32) -> f32 {
    if irradiance_share < OPTICAL_PATH_DARKEST {
        return OPTICAL_PATH_UNREACHED;
    }
    (-irradiance_share.ln()).max(0.0) + extinction * offset
}

/// Computes the same as usually written.
pub fn seed_naive(irradiance_share: f32, extinction: f32, offset: f32) -> f32 {
    -irradiance_share.ln() + extinction * offset
}

/// Returns the cost of a point reached through a node.
pub fn through(cost: f32, extinction: f32, offset: f32) -> f32 {
    (cost.min(OPTICAL_PATH_UNREACHED) + extinction * offset).min(OPTICAL_PATH_UNREACHED)
}

/// Returns the light that arrives along the path, as a share of the largest irradiance.
pub fn luminance(cost: f32) -> f32 {
    if cost <= 0.0 {
        return 1.0;
    }
    if cost >= OPTICAL_PATH_DEEPEST { 0.0 } else { (-cost).exp().min(1.0) }
}

#[cfg(test)]
mod tests;
