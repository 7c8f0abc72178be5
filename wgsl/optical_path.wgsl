// optical_path: paths of least optical depth from the light to every voxel of a body, and the light along them.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0
// Source: Ozawa, Okamoto and Morishima, "Real-time rendering of translucent material using Dynamic
//   Programming", sections 2 and 3; Godunov's update: Rouy and Tourin, SIAM J. Numer. Anal. 29
//   (1992), eq. (3.5); Jeong and Whitaker, "A Fast Iterative Method for Eikonal Equations", SIAM J.
//   Sci. Comput. 30 (2008).
//
// A cost is the optical depth of a path plus -ln of the light that enters it. Costs are at least 0,
// because irradiance is expressed as a share of the largest that any node may have. Luminance is
// e^-cost, so the greatest contribution has the least cost.

// The cost of a node that no light has reached. A cost that grows to this value also counts as
// unreached. It is finite because WGSL may assume that there are no infinities.
const OPTICAL_PATH_UNREACHED: f32 = 1e30f;
// The least share of irradiance; smaller ones count as none. 2^-126 is the smallest number that an
// implementation may not flush to zero.
const OPTICAL_PATH_DARKEST: f32 = 1.1754943508222875e-38f;
// The cost from which luminance is 0: e^-87.3 is 1.2e-38, close to the smallest number that f32
// holds with full precision.
const OPTICAL_PATH_DEEPEST: f32 = 87.3f;

// The cost of the edge between two nodes: the mean of their extinctions times its length. Exactly
// symmetric.
// Returns: (extinction_a + extinction_b) length / 2; 0 where nothing is scattered or absorbed.
// Units: none; extinctions in the inverse of the length's unit.
// Domain: extinctions in [0, 1e15], length in [0, 1e14].
// Outside: finite while products stay below 3e38.
// Accuracy: lavapipe 2 ulp; portable 3 ulp
fn optical_path_edge(extinction_a: f32, extinction_b: f32, length: f32) -> f32 {
    return 0.5f * (extinction_a + extinction_b) * length;
}

// The cost of a node once the path through one neighbour is known: the step that every solver on a
// graph repeats.
// Returns: the lesser of `cost` and neighbour + edge; if the neighbour is unreached, the lesser of
//   `cost` and unreached.
// Units: none.
// Domain: cost and neighbour in [0, 3e38], edge in [0, 1e30].
// Outside: finite while the sum is.
// Accuracy: lavapipe 1 ulp; portable 1 ulp
fn optical_path_relax(cost: f32, neighbour: f32, edge: f32) -> f32 {
    let through = select(OPTICAL_PATH_UNREACHED, neighbour + edge, neighbour < OPTICAL_PATH_UNREACHED);
    return select(cost, through, through < cost);
}

// The cost of a node by the Eikonal equation |grad T| = extinction, with Godunov's upwind differences: the
// T with sum over the axes of max(T - least, 0)^2 = slowness^2. Measured from the least of the three costs,
// in units of the slowness, the radicands lie between 1 and 3: nothing cancels or overflows.
// Returns: T, at most least + slowness and at most unreached; unreached if all neighbours are.
// Units: none.
// Domain: least, the lesser cost of the two neighbours on each axis, in [0, 1e30]; slowness, extinction
//   times spacing, 0 or in [1e-30, 1e15].
// Outside: a slowness below 2^-126 counts as 0 or as itself.
// Accuracy: lavapipe 4 ulp; portable 13 ulp; order kept
fn optical_path_godunov(least: vec3f, slowness: f32) -> f32 {
    let low = min(least.x, least.y);
    let high = max(least.x, least.y);
    let rest = max(low, least.z);
    let first = min(low, least.z);
    let divisor = max(slowness, OPTICAL_PATH_DARKEST);
    let second = min(min(rest, high) - first, slowness) / divisor;
    let third = min(max(rest, high) - first, slowness) / divisor;
    // The solution with two axes; 1 if the second was moved.
    let two = 0.5f * (second + sqrt(2.0f - second * second));
    let last = min(third, two);
    let radicand = 3.0f - 2.0f * (second * second - second * last + last * last);
    let three = 0.33333334f * (second + last + sqrt(radicand));
    return min(first + slowness * three, OPTICAL_PATH_UNREACHED);
}

// A cost as bits that are ordered as costs are, for atomicMin, which WGSL has only for integers.
// Returns: the bits of `cost`; those of +0 for negative numbers and -0; those of unreached for
//   larger costs, for infinity and for every NaN.
// Units: none.
// Domain: any bits.
// Outside: nothing.
// Accuracy: lavapipe 0 ulp; portable 0 ulp
fn optical_path_encode(cost: f32) -> u32 {
    let bits = bitcast<u32>(cost);
    // 0x7149f2ca is the bit pattern of 1e30. As integers, NaNs lie above it and negative numbers
    // above those.
    let reached = min(bits, 0x7149f2cau);
    let negative = bits > 0x7fffffffu && bits <= 0xff800000u;
    return select(reached, 0u, negative);
}

// The cost that was encoded.
// Returns: cost in [0, 1e30].
// Units: none.
// Domain: any bits; bits that encode no cost give unreached.
// Outside: nothing.
// Accuracy: lavapipe 0 ulp; portable 0 ulp
fn optical_path_decode(bits: u32) -> f32 {
    return bitcast<f32>(min(bits, 0x7149f2cau));
}

// The cost of a node near which light enters: the loss at the surface plus the optical depth from
// the lit point to the node.
// Returns: -ln(irradiance_share) + extinction offset, at least 0; unreached if there is no light.
// Units: none; `irradiance_share` is E N.L over the largest that any node may have; extinction in
//   the inverse of the offset's unit.
// Domain: share in [0, 1], larger ones count as 1; extinction in [0, 1e15]; offset, the distance
//   from the lit point to the node, in [0, 1e14].
// Outside: a negative share is no light.
// Accuracy: lavapipe 5 ulp + 7e-7 abs; portable 5 ulp + 6e-7 abs
fn optical_path_seed(irradiance_share: f32, extinction: f32, offset: f32) -> f32 {
    if irradiance_share < OPTICAL_PATH_DARKEST {
        return OPTICAL_PATH_UNREACHED;
    }
    return max(-log(irradiance_share), 0.0f) + extinction * offset;
}

// The cost of a point reached through a node. A shaded point takes the least cost through all nodes
// around it, and its own if it is lit.
// Returns: cost + extinction offset, at most unreached; unreached if the node is.
// Units: none; extinction in the inverse of the offset's unit.
// Domain: cost in [0, 3e38]; extinction in [0, 1e15]; offset, the distance between point and node,
//   in [0, 1e14].
// Outside: finite while the product is.
// Accuracy: lavapipe 1 ulp; portable 2 ulp
fn optical_path_through(cost: f32, extinction: f32, offset: f32) -> f32 {
    return min(min(cost, OPTICAL_PATH_UNREACHED) + extinction * offset, OPTICAL_PATH_UNREACHED);
}

// The light that arrives along the path, as a share of the largest irradiance.
// Returns: e^-cost in [0, 1]; exactly 1 for a cost of 0; 0 from a cost of 87.3 on, and so for
//   unreached.
// Units: none.
// Domain: cost in [0, 3e38].
// Outside: 1 for a negative cost.
// Accuracy: lavapipe 5.5 ulp + 4.5 backward; portable 5 ulp + 4 backward
fn optical_path_luminance(cost: f32) -> f32 {
    if cost <= 0.0f {
        return 1.0f;
    }
    return select(min(exp(-cost), 1.0f), 0.0f, cost >= OPTICAL_PATH_DEEPEST);
}
