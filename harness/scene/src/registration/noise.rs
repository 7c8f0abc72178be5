//! By how much the corners of a mesh may be off.

use crate::Mesh;
use crate::weld::TOLERANCE;

/// Smallest step of a lattice that is told from numbers without one, as a share of the extent: 17 bits.
const LEAST_STEP: f64 = 1.0 / (1 << 17) as f64;
/// Largest one: fewer than 8 bits are a shape's own proportions.
const MOST_STEP: f64 = 1.0 / (1 << 8) as f64;
/// Share of a step by which coordinates may lie beside the lattice.
const BESIDE: f64 = 0.1;
/// Number of different coordinates along an axis of which it is told whether they lie on a lattice.
const FEWEST: usize = 6;

/// Returns the distance by which the corners of a mesh may be off: half a step along each axis if they lie on a lattice, as
/// quantised ones do, and four roundings of the largest coordinate otherwise.
///
/// A lattice is found by the coordinates' greatest common divisor, along all three axes or not at all; that of a node which is
/// turned by other than right angles is not found.
#[must_use]
pub fn noise(mesh: &Mesh) -> f64 {
    let positions = mesh.indices.iter().filter_map(|&vertex| mesh.positions.get(vertex as usize));
    let positions: Vec<glam::DVec3> = positions.map(|position| position.as_dvec3()).collect();
    let largest = positions.iter().fold(0.0, |most: f64, position| most.max(position.abs().max_element()));
    let rounding = TOLERANCE * largest;
    let step = |axis: usize| {
        let mut along: Vec<f64> = positions.iter().map(|position| position[axis]).collect();
        along.sort_by(f64::total_cmp);
        along.dedup_by(|one, other| *one - *other <= rounding);
        step(&along, rounding)
    };
    let steps = (step(0), step(1), step(2));
    let (Some(x), Some(y), Some(z)) = steps else { return rounding };
    rounding.max(0.5 * glam::DVec3::new(x, y, z).length())
}

/// Returns the step of the lattice on which sorted numbers lie.
fn step(along: &[f64], rounding: f64) -> Option<f64> {
    let (first, last) = (along.first()?, along.last()?);
    let extent = last - first;
    let least = (LEAST_STEP * extent).max(rounding / BESIDE);
    if along.len() < FEWEST {
        return None;
    }
    let mut divisor = extent;
    for pair in along.windows(2) {
        divisor = common(divisor, pair[1] - pair[0], 0.5 * least);
        if divisor < least {
            return None;
        }
    }
    let step = extent / (extent / divisor).round();
    let on_lattice = |number: &f64| {
        let steps = (number - first) / step;
        (steps - steps.round()).abs() <= BESIDE
    };
    (step <= MOST_STEP * extent && along.iter().all(on_lattice)).then_some(step)
}

/// Returns the greatest common divisor of two lengths; what is left below `least` counts as nothing.
fn common(mut one: f64, mut other: f64, least: f64) -> f64 {
    while other > least {
        let rest = one - (one / other).round() * other;
        (one, other) = (other, rest.abs());
    }
    one
}
