//! The truth in f64, by other ways than the mirror's: searches along the ray.

use glam::{DVec3, DVec4};

const FAR: f64 = 1e18;

/// Returns the largest number in [0, most] for which `holds`, which is true up to some number and
/// false from there on; 0 if it never is. Bisects the bits of the number.
fn last(most: f64, holds: impl Fn(f64) -> bool) -> f64 {
    if holds(most) {
        return most;
    }
    let (mut within, mut beyond) = (0, most.to_bits());
    while beyond - within > 1 {
        let middle = within + (beyond - within) / 2;
        if holds(f64::from_bits(middle)) {
            within = middle;
        } else {
            beyond = middle;
        }
    }
    f64::from_bits(within)
}

/// A search for the last point in view.
pub fn reach(start: DVec4, step: DVec4) -> f64 {
    let in_view = |distance: f64| {
        let side = |place: f64, rate: f64| place + distance * rate >= 0.0;
        let pair = |place: f64, rate: f64| side(start.w + place, step.w + rate) && side(start.w - place, step.w - rate);
        let depth = side(start.z, step.z) && side(start.w - start.z, step.w - step.z);
        pair(start.x, step.x) && pair(start.y, step.y) && depth
    };
    if in_view(0.0) { last(FAR, in_view) } else { 0.0 }
}

/// A search for the last point above each side.
pub fn sides(height: DVec3, rate: DVec3) -> DVec3 {
    let one = |height: f64, rate: f64| last(FAR, |distance| distance * rate <= height);
    DVec3::new(one(height.x, rate.x), one(height.y, rate.y), one(height.z, rate.z))
}

/// A search for the point whose place on the screen is that part of the way.
pub fn distance(start_w: f64, end_w: f64, reach: f64, fraction: f64) -> f64 {
    // A ray from the middle of the screen to the side.
    let place = |part: f64| part / (start_w + part * (end_w - start_w));
    reach * last(1.0, |part| place(part) <= fraction * place(1.0))
}

/// What the depth says of 1 / w, backwards: depth = scale + offset / w.
pub fn inverse_w(depth: f64, scale: f64, offset: f64) -> f64 {
    depth / offset - scale / offset
}

/// The two ranges of w themselves.
pub fn meets(before: f64, here: f64, surface: f64, thickness: f64) -> bool {
    let [before, here, front] =
        [before, here, surface].map(|inverse| if inverse > 0.0 { inverse.recip() } else { f64::INFINITY });
    here >= front && before.min(here) <= front + thickness
}

/// A search for the last fraction at which the ray is in front of the surface.
pub fn crossing(before: f64, surface_before: f64, here: f64, surface: f64) -> f64 {
    if before <= surface_before || surface <= here {
        return 1.0;
    }
    last(1.0, |part| {
        let ray = (1.0 - part) * before + part * here;
        ray >= (1.0 - part) * surface_before + part * surface
    })
}
