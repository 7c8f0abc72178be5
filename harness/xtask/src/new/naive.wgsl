// NAME: the forms that one finds elsewhere, kept to show where they fail.
// They follow wgsl/NAME.wgsl, and use its structs and functions.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0

// NAME_difference as the formula is printed.
// Returns: a^2 - b^2.
// Units: as NAME_difference.
// Domain: a in [2, 4], b in [0, 1].
// Outside: as the formula gives.
// Accuracy: naive
fn NAME_difference_naive(a: f32, b: f32) -> f32 {
    return a * a - b * b;
}
