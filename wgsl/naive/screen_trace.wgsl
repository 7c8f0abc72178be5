// screen_trace: forms found elsewhere, kept to show where they fail. They follow the module and use its names.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0

// screen_trace_distance by equal distances: what a loop with a constant step along the ray takes.
// Returns: as screen_trace_distance.
// Units: as screen_trace_distance.
// Domain: start_w = end_w in [1, 1000], reach in [1, 1000], fraction in [0, 1].
// Outside: as the formula gives.
// Accuracy: naive
fn screen_trace_distance_naive(start_w: f32, end_w: f32, reach: f32, fraction: f32) -> f32 {
    return fraction * reach;
}
