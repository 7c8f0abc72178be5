//! Rust mirror of `wgsl/optical_path.wgsl`, line by line: the path of least optical depth from the light to every voxel of a
//! body. Units, domain and accuracy stand above the WGSL functions.
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
/// Shares below this count as none.
pub const OPTICAL_PATH_DARKEST: f32 = 1.1754943508222875e-38;
/// From this cost on luminance is 0.
pub const OPTICAL_PATH_DEEPEST: f32 = 87.3;

/// Cost of the edge between two nodes: the mean of their extinctions times its length.
pub fn edge(extinction_a: f32, extinction_b: f32, length: f32) -> f32 {
    0.5 * (extinction_a + extinction_b) * length
}

/// Cost of an edge as it stands in the paper: the extinction, whatever the edge's length.
pub fn edge_paper(extinction_a: f32, extinction_b: f32) -> f32 {
    0.5 * (extinction_a + extinction_b)
}

/// Cost of a node once the way through one neighbour is known.
pub fn relax(cost: f32, neighbour: f32, edge: f32) -> f32 {
    let through = if neighbour < OPTICAL_PATH_UNREACHED { neighbour + edge } else { OPTICAL_PATH_UNREACHED };
    if through < cost { through } else { cost }
}

/// Cost of a node as the Eikonal equation has it, by Godunov's upwind differences.
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

/// The same by the quadratic formula in T itself, case by case.
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

/// A cost as bits that are ordered as costs are.
pub fn encode(cost: f32) -> u32 {
    let bits = cost.to_bits();
    let reached = bits.min(0x7149_f2ca);
    let negative = bits > 0x7fff_ffff && bits <= 0xff80_0000;
    if negative { 0 } else { reached }
}

/// The cost that was encoded.
pub fn decode(bits: u32) -> f32 {
    f32::from_bits(bits.min(0x7149_f2ca))
}

/// Cost of a node that light enters near.
pub fn seed(irradiance_share: f32, extinction: f32, offset: f32) -> f32 {
    if irradiance_share < OPTICAL_PATH_DARKEST {
        return OPTICAL_PATH_UNREACHED;
    }
    (-irradiance_share.ln()).max(0.0) + extinction * offset
}

/// The same as one writes it.
pub fn seed_naive(irradiance_share: f32, extinction: f32, offset: f32) -> f32 {
    -irradiance_share.ln() + extinction * offset
}

/// Cost of a point by way of a node.
pub fn through(cost: f32, extinction: f32, offset: f32) -> f32 {
    (cost.min(OPTICAL_PATH_UNREACHED) + extinction * offset).min(OPTICAL_PATH_UNREACHED)
}

/// Light that comes along the path, as a share of the largest irradiance.
pub fn luminance(cost: f32) -> f32 {
    if cost <= 0.0 {
        return 1.0;
    }
    if cost >= OPTICAL_PATH_DEEPEST { 0.0 } else { (-cost).exp().min(1.0) }
}

#[cfg(test)]
mod tests;
