//! Mirror of `wgsl/screen_trace.wgsl`: where a ray meets what a depth buffer shows. After McGuire and
//! Mara, "Efficient GPU Screen-Space Ray Tracing".
//!
//! The WGSL file states the units, domain and accuracy of each function. This file follows it line
//! by line.
//!
//! ```
//! use lapidary_screen_trace::{crossing, distance};
//!
//! // Halfway on the screen, a ray from w = 1 to w = 3 has gone a quarter of its way.
//! assert_eq!(distance(1.0, 3.0, 8.0, 0.5), 2.0);
//! // It begins 1 / w = .5 in front of a surface, and ends .25 behind it.
//! assert!((crossing(1.0, 0.5, 0.25, 0.5) - 2.0 / 3.0).abs() < 1e-6);
//! ```

#[cfg(feature = "formulas")]
pub mod formulas;
pub mod oracle;

use glam::{Vec3, Vec4, vec3};

/// Distance of the end of a ray that never leaves the view.
pub const SCREEN_TRACE_FAR: f32 = 1e18;
/// Rate below which a ray does not come nearer to a side of the view.
pub const SCREEN_TRACE_PARALLEL: f32 = 1e-18;

/// Returns the distance at which a ray leaves the view.
pub fn reach(start: Vec4, step: Vec4) -> f32 {
    let lower = vec3(start.w + start.x, start.w + start.y, start.z);
    let upper = vec3(start.w - start.x, start.w - start.y, start.w - start.z);
    let least = lower.min(upper);
    if least.x.min(least.y).min(least.z) < 0.0 {
        return 0.0;
    }
    let lower_rate = -vec3(step.w + step.x, step.w + step.y, step.z);
    let upper_rate = -vec3(step.w - step.x, step.w - step.y, step.w - step.z);
    let distance = sides(lower, lower_rate).min(sides(upper, upper_rate));
    distance.x.min(distance.y).min(distance.z)
}

/// Returns the distances at which a ray meets three sides of the view.
pub fn sides(height: Vec3, rate: Vec3) -> Vec3 {
    let distance = height / rate.max(Vec3::splat(SCREEN_TRACE_PARALLEL));
    Vec3::select(rate.cmpgt(Vec3::splat(SCREEN_TRACE_PARALLEL)), distance, Vec3::splat(SCREEN_TRACE_FAR))
}

/// Returns the distance along a ray at a fraction of its way on the screen.
pub fn distance(start_w: f32, end_w: f32, reach: f32, fraction: f32) -> f32 {
    let near = fraction * start_w;
    reach * (near / ((1.0 - fraction) * end_w + near))
}

/// The same by equal distances.
pub fn distance_naive(_start_w: f32, _end_w: f32, reach: f32, fraction: f32) -> f32 {
    fraction * reach
}

/// Returns 1 / w of the surface that a depth buffer shows.
pub fn inverse_w(depth: f32, scale: f32, offset: f32) -> f32 {
    (depth - scale) / offset
}

/// Returns whether a ray has met a surface on a step.
pub fn meets(before: f32, here: f32, surface: f32, thickness: f32) -> bool {
    let nearest = before.max(here);
    here <= surface && surface <= nearest * (1.0 + thickness * surface)
}

/// Returns where on a step a ray goes through a surface.
pub fn crossing(before: f32, surface_before: f32, here: f32, surface: f32) -> f32 {
    let front = before - surface_before;
    let behind = surface - here;
    if front <= 0.0 || behind <= 0.0 {
        return 1.0;
    }
    // front / (front + behind) would be a sum of four terms, of which a compiler that takes before
    // + surface first keeps less than either difference has. Of a quotient it can't.
    let ratio = front.min(behind) / front.max(behind);
    (if front >= behind { 1.0 } else { ratio }) / (1.0 + ratio)
}
