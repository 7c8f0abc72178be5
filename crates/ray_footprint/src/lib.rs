//! Mirror of `wgsl/ray_footprint.wgsl`: which part of a pixel shows what lies beyond the edge of a
//! facet inside a stone, and which neighbours show the same. After Igehy, "Tracing Ray
//! Differentials", and Persson, "Geometry Buffer Anti-Aliasing".
//!
//! The WGSL file states the units, domain and accuracy of each function. This file follows it line
//! by line.
//!
//! ```
//! use glam::{Vec4, vec3};
//! use lapidary_ray_footprint::{neighbours, share};
//!
//! // An edge a quarter of a pixel to the right of the middle: a quarter of the pixel lies beyond it.
//! let edge = vec3(0.25, 1.0, 0.0);
//! assert_eq!(share(edge), 0.25);
//! assert_eq!(neighbours(edge, share(edge)), Vec4::new(0.25, 0.0, 0.0, 0.0));
//! ```

#[cfg(feature = "formulas")]
pub mod formulas;
pub mod oracle;

use glam::{Vec2, Vec3, Vec4, vec3, vec4};

/// Returns how much wider an offset is after a way inside than on the facet that the eye sees.
pub fn growth(distance: f32, travelled: f32, relative_index: f32) -> f32 {
    1.0 + travelled / (relative_index * distance)
}

/// Returns the edge at which the plane that a ray meets gives way to the runner-up, as a line in the
/// pixel: (f, gx, gy).
pub fn edge(direction: Vec3, right: Vec3, down: Vec3, nearest: Vec3, runner_up: Vec3, gap: f32) -> Vec3 {
    let slope = nearest.dot(direction);
    let slope_runner_up = runner_up.dot(direction);
    // Perpendicular to the ray, so that parts of the offsets along it drop out: slope * runner_up -
    // slope_runner_up * nearest, which would cancel where the planes are nearly one.
    let across = direction.cross((runner_up - nearest).cross(nearest));
    vec3(gap * slope * slope_runner_up, across.dot(right), across.dot(down))
}

/// Returns the same from the offsets on the two planes.
pub fn edge_naive(direction: Vec3, right: Vec3, down: Vec3, nearest: Vec3, runner_up: Vec3, gap: f32) -> Vec3 {
    let slope = nearest.dot(direction);
    let slope_runner_up = runner_up.dot(direction);
    let sooner = Vec2::new(nearest.dot(right), nearest.dot(down)) / slope;
    let later = Vec2::new(runner_up.dot(right), runner_up.dot(down)) / slope_runner_up;
    slope * slope_runner_up * vec3(gap, later.x - sooner.x, later.y - sooner.y)
}

/// Returns the share of a pixel beyond a line.
pub fn share(edge: Vec3) -> f32 {
    let f = edge.x.abs();
    let longer = edge.y.abs().max(edge.z.abs());
    let shorter = edge.y.abs().min(edge.z.abs());
    // The line leaves the square at a corner.
    let reach = 0.5 * (longer + shorter);
    if f >= reach {
        return 0.0;
    }
    // Between two opposite sides, it cuts off a trapezoid.
    if f <= 0.5 * (longer - shorter) {
        return 0.5 - f / longer;
    }
    // Between two sides that meet, a triangle.
    let height = reach - f;
    (height / longer) * (height / (2.0 * shorter))
}

/// Returns the shares of the neighbours to the right, left, below and above, which add up to `share`.
pub fn neighbours(edge: Vec3, share: f32) -> Vec4 {
    let f = edge.x.max(0.0);
    let beyond = (vec4(edge.y, -edge.y, edge.z, -edge.z) - f).max(Vec4::ZERO);
    let sum = beyond.x + beyond.y + beyond.z + beyond.w;
    if sum == 0.0 {
        return Vec4::ZERO;
    }
    beyond * (share / sum)
}

/// Returns a pixel with its neighbours' shares mixed in.
pub fn mix(own: Vec4, right: Vec4, left: Vec4, below: Vec4, above: Vec4, shares: Vec4) -> Vec4 {
    let rest = 1.0 - (shares.x + shares.y + shares.z + shares.w);
    rest * own + shares.x * right + shares.y * left + shares.z * below + shares.w * above
}
