//! Mirror of `wgsl/curvature.wgsl`: mean, Gaussian and normal curvature of a surface from
//! screen-space derivatives of its position and normal. do Carmo, "Differential Geometry of Curves
//! and Surfaces", sections 3-2, 3-3, 3-5.
//!
//! The WGSL file states the units, domain and accuracy of each function. This file follows it line
//! by line. `position_x` stands for the derivative of the position along the screen's x axis, and
//! so on.
//!
//! ```
//! use glam::Vec3;
//! use lapidary_curvature::mean;
//!
//! // A sphere of radius 2, a pixel along x and along y: the normal turns by half of what the position moves.
//! let [x, y] = [Vec3::new(0.01, 0.0, 0.0), Vec3::new(0.0, 0.01, 0.0)];
//! assert!((mean(x, y, 0.5 * x, 0.5 * y) - 0.5).abs() < 1e-6);
//! ```

#[cfg(feature = "formulas")]
pub mod formulas;
pub mod oracle;
#[cfg(test)]
mod tests;

use glam::Vec3;

/// Position derivatives whose largest component is below this, 2⁻⁵⁰, count as degenerate.
pub const CURVATURE_SMALLEST: f32 = 8.881784197001252e-16;

/// Squared sine of the angle between the position derivatives at which a pixel counts as seen
/// edge-on, 2⁻²⁰.
pub const CURVATURE_EDGE_ON: f32 = 9.5367431640625e-7;

/// Squared sine of the angle between light and normal below which the light has no direction along
/// the surface, 2⁻²⁰.
pub const CURVATURE_ZENITH: f32 = 9.5367431640625e-7;

/// Returns the power of two that brings the largest component of a derivative to [1, 2).
pub fn scale(derivative: Vec3) -> f32 {
    let magnitude = derivative.abs();
    let size = magnitude.x.max(magnitude.y).max(magnitude.z.max(CURVATURE_SMALLEST));
    f32::from_bits(0x7f00_0000 - (size.to_bits() & 0x7f80_0000))
}

/// Returns the derivative of the unit normal from the derivative of a normal that is not yet
/// normalised.
pub fn normal_derivative(normal: Vec3, derivative: Vec3) -> Vec3 {
    let scale = scale(normal);
    let scaled = scale * normal;
    let squared = scaled.dot(scaled).max(1.0);
    scaled.cross(scale * derivative).cross(scaled) / (squared * squared.sqrt())
}

/// Returns the result of `dpdx(normalize(normal))`: the difference of two neighbours' unit normals.
pub fn normal_derivative_naive(normal: Vec3, derivative: Vec3) -> Vec3 {
    (normal + derivative).normalize() - normal.normalize()
}

/// Derivatives of a pixel, scaled along each screen axis so that those of the position are about 1
/// long.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvaturePixel {
    /// Derivative of the position along the screen's x axis.
    pub p_x: Vec3,
    /// Derivative of the position along the screen's y axis.
    pub p_y: Vec3,
    /// Derivative of the normal along the screen's x axis.
    pub n_x: Vec3,
    /// Derivative of the normal along the screen's y axis.
    pub n_y: Vec3,
}

/// Scales the derivatives of position and normal along each axis by [`scale`] of the position's.
pub fn pixel(position_x: Vec3, position_y: Vec3, normal_x: Vec3, normal_y: Vec3) -> CurvaturePixel {
    let scale_x = scale(position_x);
    let scale_y = scale(position_y);
    CurvaturePixel {
        p_x: scale_x * position_x,
        p_y: scale_y * position_y,
        n_x: scale_x * normal_x,
        n_y: scale_y * normal_y,
    }
}

/// Position derivatives of a pixel in an orthonormal frame of the tangent plane: p_x = width first,
/// p_y = lean first + rise second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvatureFrame {
    /// Unit vector along p_x; 0 if p_x is 0.
    pub first: Vec3,
    /// Unit vector perpendicular to `first`, on the side of p_y; shorter if `rise` is below 2⁻⁵⁰, 0
    /// if `rise` is 0.
    pub second: Vec3,
    /// Vector of length `rise` perpendicular to both; `width` times it is p_x × p_y.
    pub normal: Vec3,
    /// Length of p_x.
    pub width: f32,
    /// Component of p_y along `first`.
    pub lean: f32,
    /// Component of p_y along `second`, at least 0.
    pub rise: f32,
    /// Square of the area that p_x and p_y span, width rise; never below the square at which a
    /// pixel counts as edge-on.
    pub bounded: f32,
}

/// Computes the frame by Gram-Schmidt, for the derivatives of [`pixel`].
pub fn frame(p_x: Vec3, p_y: Vec3) -> CurvatureFrame {
    let squared_x = p_x.dot(p_x);
    let width = squared_x.sqrt();
    // 2⁻⁵⁰ replaces 0, here and below.
    let first = p_x / width.max(CURVATURE_SMALLEST);
    let crossed = p_x.cross(p_y) / width.max(CURVATURE_SMALLEST);
    // Rounding tilts the product of nearly parallel vectors towards them, so it is made
    // perpendicular once more.
    let normal = crossed - crossed.dot(first) * first;
    let rise = normal.length();
    let second = normal.cross(first) / rise.max(CURVATURE_SMALLEST);
    let area = width * rise;
    let least = CURVATURE_EDGE_ON * squared_x.max(1.0) * p_y.dot(p_y).max(1.0);
    CurvatureFrame { first, second, normal, width, lean: p_y.dot(first), rise, bounded: (area * area).max(least) }
}

/// Returns the mean curvature, half the sum of the principal curvatures.
pub fn mean(position_x: Vec3, position_y: Vec3, normal_x: Vec3, normal_y: Vec3) -> f32 {
    let pixel = pixel(position_x, position_y, normal_x, normal_y);
    let area = pixel.p_x.cross(pixel.p_y);
    let growth = pixel.n_x.cross(pixel.p_y) + pixel.p_x.cross(pixel.n_y);
    let least = CURVATURE_EDGE_ON * pixel.p_x.dot(pixel.p_x).max(1.0) * pixel.p_y.dot(pixel.p_y).max(1.0);
    0.5 * area.dot(growth) / area.dot(area).max(least)
}

/// Returns the mean curvature in its textbook form, from the two fundamental forms.
pub fn mean_textbook(position_x: Vec3, position_y: Vec3, normal_x: Vec3, normal_y: Vec3) -> f32 {
    let first = Vec3::new(position_x.dot(position_x), position_x.dot(position_y), position_y.dot(position_y));
    let mixed = 0.5 * (position_x.dot(normal_y) + position_y.dot(normal_x));
    let second = Vec3::new(position_x.dot(normal_x), mixed, position_y.dot(normal_y));
    let determinant = first.x * first.z - first.y * first.y;
    0.5 * (second.x * first.z - 2.0 * second.y * first.y + second.z * first.x) / determinant
}

/// Returns the Gaussian curvature, the product of the principal curvatures.
pub fn gaussian(position_x: Vec3, position_y: Vec3, normal_x: Vec3, normal_y: Vec3) -> f32 {
    let pixel = pixel(position_x, position_y, normal_x, normal_y);
    let frame = frame(pixel.p_x, pixel.p_y);
    let area = frame.width * frame.rise;
    let twist = 0.5 * (pixel.p_x.dot(pixel.n_y) - pixel.p_y.dot(pixel.n_x));
    let determinant = frame.width * frame.normal.dot(pixel.n_x.cross(pixel.n_y)) - twist * twist;
    // Keep this order: the square of the area may underflow.
    determinant / frame.bounded * area * (area / frame.bounded)
}

/// Returns the Gaussian curvature in its textbook form.
pub fn gaussian_textbook(position_x: Vec3, position_y: Vec3, normal_x: Vec3, normal_y: Vec3) -> f32 {
    let first = Vec3::new(position_x.dot(position_x), position_x.dot(position_y), position_y.dot(position_y));
    let mixed = 0.5 * (position_x.dot(normal_y) + position_y.dot(normal_x));
    let second = Vec3::new(position_x.dot(normal_x), mixed, position_y.dot(normal_y));
    (second.x * second.z - second.y * second.y) / (first.x * first.z - first.y * first.y)
}

/// Returns the normal curvature in the direction of the component of `light` along the surface; the
/// mean curvature for a light along the normal.
pub fn towards(position_x: Vec3, position_y: Vec3, normal_x: Vec3, normal_y: Vec3, light: Vec3) -> f32 {
    let pixel = pixel(position_x, position_y, normal_x, normal_y);
    let frame = frame(pixel.p_x, pixel.p_y);
    let x = light.dot(frame.first);
    let y = light.dot(frame.second);
    let tangent = x * frame.first + y * frame.second;
    let change = (frame.rise * x - frame.lean * y) * pixel.n_x + (frame.width * y) * pixel.n_y;
    let across = frame.rise * frame.first - frame.lean * frame.second;
    let mean = 0.5 * (across.dot(pixel.n_x) + frame.width * frame.second.dot(pixel.n_y));
    let area = frame.width * frame.rise;
    let share = area / frame.bounded;
    let fade = area * share;
    let total = fade * (x * x + y * y) + CURVATURE_ZENITH;
    // Weights first: products with a change of 1e-30 would underflow.
    share * (fade / total * tangent.dot(change) + CURVATURE_ZENITH / total * mean)
}

/// Returns the normal curvature along the light from the normal equations of its component along
/// the surface.
pub fn towards_textbook(position_x: Vec3, position_y: Vec3, normal_x: Vec3, normal_y: Vec3, light: Vec3) -> f32 {
    let first = Vec3::new(position_x.dot(position_x), position_x.dot(position_y), position_y.dot(position_y));
    let mixed = 0.5 * (position_x.dot(normal_y) + position_y.dot(normal_x));
    let second = Vec3::new(position_x.dot(normal_x), mixed, position_y.dot(normal_y));
    let light_x = light.dot(position_x);
    let light_y = light.dot(position_y);
    let alpha = first.z * light_x - first.y * light_y;
    let beta = first.x * light_y - first.y * light_x;
    let weight = Vec3::new(alpha * alpha, 2.0 * alpha * beta, beta * beta);
    weight.dot(second) / weight.dot(first)
}

/// Returns the usual rung, |dN| / |dP|: `length(fwidth(normal)) / length(fwidth(position))`.
pub fn naive(position_x: Vec3, position_y: Vec3, normal_x: Vec3, normal_y: Vec3) -> f32 {
    (normal_x.abs() + normal_y.abs()).length() / (position_x.abs() + position_y.abs()).length()
}
