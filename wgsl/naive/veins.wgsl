// veins: forms found elsewhere, kept to show where they fail. They follow the module and use its names.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0

// The cell by conversion to integers, as usually written. Kept to show where it fails: conversion
// truncates towards 0, so the cells around the origin are two wide and mirrored.
// Returns: VeinsCell.
// Units: cells.
// Domain: positions above 0, up to 1e6.
// Outside: offsets below 0 for negative positions.
// Accuracy: naive
fn veins_cell_naive(position: vec3f) -> VeinsCell {
    let corner = vec3i(position);
    return VeinsCell(corner, position - vec3f(corner));
}

// A vein by the absolute value, as in turbulence. Kept to show where it fails: it has a crease in
// the middle of the vein and is negative away from it.
// Returns: 1 - |value| / (2 width).
// Units: as for veins_fold.
// Domain: |value| at most 1, width in [0.1, 1].
// Outside: negative from twice the width on, so that no majorant bounds a density made of it.
// Accuracy: naive
fn veins_fold_naive(value: f32, width: f32) -> f32 {
    return 1.0f - abs(value) / (2.0f * width);
}
