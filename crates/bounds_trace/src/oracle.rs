//! The truth in f64, by other ways than the mirror's: a box by a search along the ray, a normal by
//! sorting, a ball by angles.

use glam::DVec3;

/// Distance of a ray that meets nothing.
const NONE: f64 = -1.0;

/// Searches for the place at which the point's largest coordinate comes down to 1. Along a line, that
/// coordinate is first falling and then rising, so the place lies between the start and its least
/// value.
pub fn cuboid(position: DVec3, direction: DVec3) -> f64 {
    let largest = |distance: f64| (position + distance * direction).abs().max_element();
    let (closest, least) = nearest(position, direction);
    if largest(0.0) <= 1.0 || closest <= 0.0 || least > 1.0 {
        return NONE;
    }
    let (mut before, mut within) = (0.0, closest);
    for _ in 0..200 {
        let middle = 0.5 * (before + within);
        if largest(middle) > 1.0 { before = middle } else { within = middle }
    }
    within
}

/// Returns the distance along a line, and the value, at which the point's largest coordinate is least:
/// where two coordinates are equally large, or one is 0.
pub fn nearest(position: DVec3, direction: DVec3) -> (f64, f64) {
    let mut best = (0.0, f64::INFINITY);
    for first in 0..3 {
        for second in 0..=first {
            for sign in [1.0, -1.0] {
                let slope = direction[first] + sign * direction[second];
                if slope == 0.0 {
                    continue;
                }
                let distance = -(position[first] + sign * position[second]) / slope;
                let largest = (position + distance * direction).abs().max_element();
                if largest < best.1 {
                    best = (distance, largest);
                }
            }
        }
    }
    best
}

/// Sorts the axes by the point's coordinates; the sort keeps the order of equal ones.
pub fn cuboid_normal(point: DVec3) -> DVec3 {
    let mut sides = [(point.x, DVec3::X), (point.y, DVec3::Y), (point.z, DVec3::Z)];
    sides.sort_by(|one, other| other.0.abs().total_cmp(&one.0.abs()));
    let (coordinate, axis) = sides[0];
    if coordinate < 0.0 { -axis } else { axis }
}

/// The triangle of the middle, the start and the place of entry, by the law of sines: its angle at the
/// start is that between the ray and the way to the middle, and the one outside of it at the entry has
/// a sine as many times as large as the start is far away.
pub fn ball(position: DVec3, direction: DVec3) -> f64 {
    let away = position.length();
    let at_start = position.cross(direction).length().atan2(-position.dot(direction));
    let sine = away * at_start.sin();
    if away <= 1.0 || at_start >= std::f64::consts::FRAC_PI_2 || sine > 1.0 {
        return NONE;
    }
    let at_entry = sine.asin();
    (away * at_start.cos() - at_entry.cos()) / direction.length()
}
