// optical_path: forms found elsewhere, kept to show where they fail. They follow the module and use its names.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0

// The cost of an edge as in the paper: the extinction, whatever the edge's length. The depth of a
// body thus depends on the grid.
// Returns: (extinction_a + extinction_b) / 2.
// Units: those of the extinctions.
// Domain: extinctions in [0, 1e15].
// Outside: finite while the sum is.
// Accuracy: naive
fn optical_path_edge_paper(extinction_a: f32, extinction_b: f32) -> f32 {
    return 0.5f * (extinction_a + extinction_b);
}

// optical_path_godunov by the quadratic formula in T itself, case by case, as usually written.
// Returns: optical_path_godunov(...).
// Units: none.
// Domain: least in [0, 2], slowness in [0.5, 2].
// Outside: the digits of the slowness cancel where costs are large beside it; not a number where
//   the radicand becomes negative, or for costs above 1e19.
// Accuracy: naive
fn optical_path_godunov_naive(least: vec3f, slowness: f32) -> f32 {
    let low = min(least.x, least.y);
    let high = max(least.x, least.y);
    let rest = max(low, least.z);
    let first = min(low, least.z);
    let second = min(rest, high);
    let third = max(rest, high);
    let one = first + slowness;
    if one <= second {
        return one;
    }
    let pair = first + second;
    let two = 0.5f * (pair + sqrt(pair * pair - 2.0f * (first * first + second * second - slowness * slowness)));
    if two <= third {
        return two;
    }
    let sum = pair + third;
    let squares = first * first + second * second + third * third;
    return (sum + sqrt(sum * sum - 3.0f * (squares - slowness * slowness))) / 3.0f;
}

// optical_path_seed as usually written.
// Returns: -ln(irradiance_share) + extinction offset.
// Units: as optical_path_seed.
// Domain: share in [0.01, 0.9], extinction and offset in [0, 10].
// Outside: infinite or not a number without light, and negative above 1, where atomicMin takes it
//   for the largest of costs.
// Accuracy: naive
fn optical_path_seed_naive(irradiance_share: f32, extinction: f32, offset: f32) -> f32 {
    return -log(irradiance_share) + extinction * offset;
}
