// NAME: half of a number; say here in one line what the technique computes.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: name the paper, book or specification, with equation numbers.

// Half of a number: an example, to be replaced.
// Returns: x / 2.
// Units: those of x.
// Domain: |x| up to 2^126.
// Outside: exact for every finite x.
// Accuracy: lavapipe 0 ulp; portable 0 ulp
fn NAME_half(x: f32) -> f32 {
    return 0.5f * x;
}
