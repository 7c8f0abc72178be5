// NAME: the difference of two squares; say here in one line what the technique computes.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0
// Source: name the paper, book or specification, with equation numbers.

// The difference of two squares, an example to be replaced: in two factors, since the difference of two nearby floats
// is exact and that of their squares is not.
// Returns: a^2 - b^2.
// Units: those of a and b, squared; they have the same.
// Domain: |a| and |b| from 2^-20 up to 2^60.
// Outside: finite below 2^62.
// Accuracy: lavapipe 4 ulp; portable 7 ulp
fn NAME_difference(a: f32, b: f32) -> f32 {
    return (a - b) * (a + b);
}
