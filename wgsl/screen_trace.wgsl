// screen_trace: where a ray meets what a depth buffer shows, by steps on the screen that are all equally long.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0
// Source: McGuire and Mara, "Efficient GPU Screen-Space Ray Tracing", JCGT 3(4), 2014. The end in view:
//   Blinn and Newell, "Clipping Using Homogeneous Coordinates", SIGGRAPH 1978. The crossing: own.
//
// A ray is a line in clip coordinates, its start and what a unit of length adds:
//
//   let start = clip_from_world * vec4f(position, 1.0f);
//   let step = clip_from_world * vec4f(direction, 0.0f);
//   let reach = screen_trace_reach(start, step);
//   let end_w = start.w + reach * step.w;
//
// Equal fractions of the way on the screen are not equal distances: screen_trace_distance has the
// distance at each. There, with before and here for 1 / w of the ray at the last fraction and at this
// one, and surface for screen_trace_inverse_w of the texel's depth:
//
//   if (screen_trace_meets(before, here, surface, thickness)) { ... }
//
// What is linear on the screen is 1 / w, of a ray and of a flat surface alike. So one linear step,
// screen_trace_crossing, finds where a ray meets a flat surface between two fractions, exactly.
// A depth buffer knows nothing behind its surfaces: `thickness` is a guess.

// Distance of the end of a ray that never leaves the view.
const SCREEN_TRACE_FAR: f32 = 1e18f;
// Rate below which a ray does not come nearer to a side of the view.
const SCREEN_TRACE_PARALLEL: f32 = 1e-18f;

// The distance at which a ray leaves the view, -w <= x <= w, -w <= y <= w and 0 <= z <= w. In clip
// coordinates, before the division by w: a ray that passes the eye has points with w < 0, which a
// division would throw to the other side of the screen.
// Returns: distance in units of the length of the direction; 0 from a start out of view,
//   SCREEN_TRACE_FAR for a ray that stays in view.
// Units: clip coordinates; `step` is what a unit of length adds to them.
// Domain: coordinates 0 or of a magnitude in [1e-6, 1e4], start.w at least 1e-6.
// Outside: finite for coordinates up to 1e18; a start at the edge is in view.
// Accuracy: lavapipe 2 ulp + 4 backward; portable 5 ulp + 4 backward
fn screen_trace_reach(start: vec4f, step: vec4f) -> f32 {
    let lower = vec3f(start.w + start.x, start.w + start.y, start.z);
    let upper = vec3f(start.w - start.x, start.w - start.y, start.w - start.z);
    let least = min(lower, upper);
    if (min(min(least.x, least.y), least.z) < 0.0f) {
        return 0.0f;
    }
    let lower_rate = -vec3f(step.w + step.x, step.w + step.y, step.z);
    let upper_rate = -vec3f(step.w - step.x, step.w - step.y, step.w - step.z);
    let distance = min(screen_trace_sides(lower, lower_rate), screen_trace_sides(upper, upper_rate));
    return min(min(distance.x, distance.y), distance.z);
}

// The distances at which a ray meets three sides of the view.
// Returns: distances; SCREEN_TRACE_FAR for a side that the ray does not come nearer to.
// Units: `height` over each side is a clip coordinate, `rate` its loss per unit of length.
// Domain: heights 0 or in [1e-6, 1e4], rates 0 or of a magnitude in [1e-6, 1e4].
// Outside: finite for heights up to 1e18.
// Accuracy: lavapipe 1 ulp; portable 3 ulp
fn screen_trace_sides(height: vec3f, rate: vec3f) -> vec3f {
    let distance = height / max(rate, vec3f(SCREEN_TRACE_PARALLEL));
    return select(vec3f(SCREEN_TRACE_FAR), distance, rate > vec3f(SCREEN_TRACE_PARALLEL));
}

// The distance along a ray at a fraction of its way on the screen.
// Returns: distance in [0, reach], but for rounding.
// Units: that of `reach`, the distance of the end; `start_w` and `end_w` are clip coordinates.
// Domain: both w in [1e-6, 1e6], reach 0 or in [1e-6, 1e6], fraction in [0, 1].
// Outside: finite for w from 1e-18 up to 1e18, reach up to 1e18 and fractions in [0, 1].
// Accuracy: lavapipe 7 ulp; portable 14 ulp
fn screen_trace_distance(start_w: f32, end_w: f32, reach: f32, fraction: f32) -> f32 {
    let near = fraction * start_w;
    return reach * (near / ((1.0f - fraction) * end_w + near));
}

// 1 / w of the surface that a depth buffer shows. With row for the rows of the projection and of
// clip_from_world alike, z = scale w + offset holds for all points: scale and offset are 1 and -near
// for a far plane at infinity, and 0 and near if its depth is reversed.
// Returns: 1 / w; 0 at infinity.
// Units: per unit of w; `offset` is in units of w.
// Domain: depth in [0, 1], |offset| in [1e-4, 1e4], scale in [-1, 2]; depth 0 or at least 1e-6.
// Outside: finite for a depth and a scale up to 1e6 and an offset from 1e-9 on.
// Accuracy: lavapipe 2 ulp + 1 backward; portable 4 ulp + 1 backward
fn screen_trace_inverse_w(depth: f32, scale: f32, offset: f32) -> f32 {
    return (depth - scale) / offset;
}

// Whether a ray has met a surface on a step: whether it ends behind the front that the depth buffer
// shows there, and any part of the step lies before the body's back. Nothing is divided, so that
// infinity, an inverse of 0, is no case of its own.
// Returns: whether it does.
// Units: `before`, `here` and `surface` are 1 / w of the ray at the step's two ends and of the surface
//   at its end; `thickness` of the body is in units of w.
// Domain: inverses 0 or in [1e-6, 1e6], thickness 0 or in [1e-6, 1e6].
// Outside: with a thickness below 0, a body thinner than its own front, which a ray may miss.
// Accuracy: lavapipe 3 backward; portable 6 backward
fn screen_trace_meets(before: f32, here: f32, surface: f32, thickness: f32) -> bool {
    let nearest = max(before, here);
    return here <= surface && surface <= nearest * (1.0f + thickness * surface);
}

// Where on a step a ray goes through a surface that is flat between the step's two ends.
// Returns: fraction of the step in [0, 1]; 1 if the ray was not in front of the surface at the step's
//   beginning, or is in front of it at its end.
// Units: inverses, 1 / w, of the ray and the surface at the step's beginning and at its end.
// Domain: inverses 0 or in [1e-6, 1e6]; those of the beginning differ by 2^-10 of the larger at least,
//   or the surface is nearer.
// Outside: finite for inverses in [0, 1e18]; a ray that begins on the surface counts as behind it.
// Accuracy: lavapipe 3 ulp + 2 backward; portable 12 ulp + 2 backward
fn screen_trace_crossing(before: f32, surface_before: f32, here: f32, surface: f32) -> f32 {
    let front = before - surface_before;
    let behind = surface - here;
    if (front <= 0.0f || behind <= 0.0f) {
        return 1.0f;
    }
    // front / (front + behind) would be a sum of four terms, of which a compiler that takes before
    // + surface first keeps less than either difference has. Of a quotient it can't.
    let ratio = min(front, behind) / max(front, behind);
    return select(ratio, 1.0f, front >= behind) / (1.0f + ratio);
}
