//! The oracle in f64: the shape operator in an orthonormal frame of the tangent plane, its
//! eigenvalues by a Jacobi rotation, and Euler's formula for the curvature in a direction. The
//! mirror computes no eigenvalue.

use glam::{DVec2, DVec3};

// The constants of the module, written out again so that an error in the module does not carry over
// to the oracle.
const SMALLEST: f64 = 1.0 / (1u64 << 50) as f64;
const SINE: f64 = 1.0 / 1024.0;

/// Returns a power of two by its logarithm.
pub fn scale(derivative: DVec3) -> f64 {
    let size = derivative.to_array().into_iter().map(f64::abs).fold(SMALLEST, f64::max);
    (-size.log2().floor()).exp2()
}

/// Derivatives of a pixel, scaled along each axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvaturePixel {
    /// Derivative of the position along the screen's x axis.
    pub p_x: DVec3,
    /// Derivative of the position along the screen's y axis.
    pub p_y: DVec3,
    /// Derivative of the normal along the screen's x axis.
    pub n_x: DVec3,
    /// Derivative of the normal along the screen's y axis.
    pub n_y: DVec3,
}

/// Divides each axis by the power of two in the largest component of its position derivative.
pub fn pixel(position_x: DVec3, position_y: DVec3, normal_x: DVec3, normal_y: DVec3) -> CurvaturePixel {
    let [width, height] = [position_x, position_y].map(|derivative| 1.0 / scale(derivative));
    CurvaturePixel { p_x: position_x / width, p_y: position_y / height, n_x: normal_x / width, n_y: normal_y / height }
}

/// Returns the derivative at 0 of the direction of `normal + t derivative`: the projection onto the
/// plane perpendicular to the normal. Normals shorter than the smallest fade as the cube of their
/// length.
pub fn normal_derivative(normal: DVec3, derivative: DVec3) -> DVec3 {
    if normal == DVec3::ZERO {
        return DVec3::ZERO;
    }
    let unit = normal.normalize();
    let across = derivative - derivative.dot(unit) * unit;
    // A second projection removes the rounding of the first along the normal.
    let fade = (normal.length() / SMALLEST).min(1.0).powi(3);
    fade * (across - across.dot(unit) * unit) / normal.length()
}

/// Returns the chord between two unit vectors: 2 sin(angle / 2) long, perpendicular to their sum.
pub fn normal_derivative_naive(normal: DVec3, derivative: DVec3) -> DVec3 {
    let [from, to] = [normal, normal + derivative].map(|vector| vector / vector.length());
    let middle = (from + to).normalize();
    let angle = from.cross(to).length().atan2(from.dot(to));
    let direction = (derivative - derivative.dot(middle) * middle).normalize_or_zero();
    2.0 * (0.5 * angle).sin() * direction
}

/// Position derivatives in an orthonormal frame of the tangent plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvatureFrame {
    /// Unit vector along p_x.
    pub first: DVec3,
    /// Unit vector perpendicular to `first`, on the side of p_y.
    pub second: DVec3,
    /// Vector of length `rise` perpendicular to both.
    pub normal: DVec3,
    /// Length of p_x.
    pub width: f64,
    /// Component of p_y along `first`.
    pub lean: f64,
    /// Component of p_y along `second`.
    pub rise: f64,
    /// Square of the area that p_x and p_y span, limited from below.
    pub bounded: f64,
}

/// Computes the frame from the angle between the two derivatives.
pub fn frame(p_x: DVec3, p_y: DVec3) -> CurvatureFrame {
    let (width, height) = (p_x.length(), p_y.length());
    let across = p_x.cross(p_y);
    let angle = across.length().atan2(p_x.dot(p_y));
    let (lean, rise) = if p_x == DVec3::ZERO { (0.0, 0.0) } else { (height * angle.cos(), height * angle.sin()) };
    let second = if across == DVec3::ZERO { DVec3::ZERO } else { across.cross(p_x).normalize() };
    let rise = if across == DVec3::ZERO { 0.0 } else { rise };
    let bounded = (width * rise).max(SINE * width.max(1.0) * height.max(1.0)).powi(2);
    let normal = rise * across.normalize_or_zero();
    CurvatureFrame { first: p_x.normalize_or_zero(), second, normal, width, lean, rise, bounded }
}

/// A surface at a pixel: principal curvatures, frame of the tangent plane, and the share of the
/// result that remains edge-on.
struct Surface {
    principal: [f64; 2],
    /// Angle of the first principal direction, from the frame's first vector towards its second.
    angle: f64,
    frame: [DVec3; 2],
    fade: f64,
}

/// Returns the surface; `None` if the derivatives do not span a plane.
fn surface(position_x: DVec3, position_y: DVec3, normal_x: DVec3, normal_y: DVec3) -> Option<Surface> {
    // Exact to the last bit of f64 for parallel vectors of f32: their products have 48 bits.
    let area = position_x.cross(position_y);
    if area == DVec3::ZERO {
        return None;
    }
    let (width, height) = (position_x.length(), position_y.length());
    let first = position_x / width;
    let second = area.cross(position_x).normalize();
    // position_y = lean * first + rise * second.
    let (lean, rise) = (position_y.dot(first), area.length() / width);
    let along_first = normal_x / width;
    let along_second = (normal_y - lean * along_first) / rise;
    let (aa, bb) = (first.dot(along_first), second.dot(along_second));
    let ab = 0.5 * (first.dot(along_second) + second.dot(along_first));
    // Jacobi: the tangent of the angle that brings the mixed entry to 0.
    let tangent = if ab == 0.0 {
        0.0
    } else {
        let ratio = (bb - aa) / (2.0 * ab);
        1f64.copysign(ratio) / (ratio.abs() + ratio.hypot(1.0))
    };
    let tiny = |length: f64| (SMALLEST / length).max(1.0).powi(2);
    let squared_sine = (area.length() / (width * height)).powi(2);
    let fade = squared_sine / squared_sine.max(SINE * SINE * tiny(width) * tiny(height));
    Some(Surface {
        principal: [aa - tangent * ab, bb + tangent * ab],
        angle: -tangent.atan(),
        frame: [first, second],
        fade,
    })
}

/// Returns half the sum of the eigenvalues.
pub fn mean(position_x: DVec3, position_y: DVec3, normal_x: DVec3, normal_y: DVec3) -> f64 {
    surface(position_x, position_y, normal_x, normal_y)
        .map_or(0.0, |surface| surface.fade * 0.5 * (surface.principal[0] + surface.principal[1]))
}

/// Returns [`mean`]: the same function, computed badly by the mirror.
pub fn mean_textbook(position_x: DVec3, position_y: DVec3, normal_x: DVec3, normal_y: DVec3) -> f64 {
    mean(position_x, position_y, normal_x, normal_y)
}

/// Returns the product of the eigenvalues.
pub fn gaussian(position_x: DVec3, position_y: DVec3, normal_x: DVec3, normal_y: DVec3) -> f64 {
    surface(position_x, position_y, normal_x, normal_y)
        .map_or(0.0, |surface| surface.fade.powi(2) * surface.principal[0] * surface.principal[1])
}

/// Returns [`gaussian`]: the same function, computed badly by the mirror.
pub fn gaussian_textbook(position_x: DVec3, position_y: DVec3, normal_x: DVec3, normal_y: DVec3) -> f64 {
    gaussian(position_x, position_y, normal_x, normal_y)
}

/// Returns the curvature by Euler's formula κ₁ cos² φ + κ₂ sin² φ, with φ the azimuth of the light
/// from the first principal direction; near the zenith it is mixed with the mean curvature.
pub fn towards(position_x: DVec3, position_y: DVec3, normal_x: DVec3, normal_y: DVec3, light: DVec3) -> f64 {
    let Some(surface) = surface(position_x, position_y, normal_x, normal_y) else { return 0.0 };
    let flat = DVec2::new(light.dot(surface.frame[0]), light.dot(surface.frame[1]));
    let azimuth = flat.y.atan2(flat.x) - surface.angle;
    let [one, two] = surface.principal;
    let normal_curvature = one * azimuth.cos().powi(2) + two * azimuth.sin().powi(2);
    let sure = surface.fade * flat.length_squared();
    surface.fade * (sure * normal_curvature + SINE * SINE * 0.5 * (one + two)) / (sure + SINE * SINE)
}

/// Returns the curvature by Euler's formula alone; it differs from [`towards`] near the zenith and
/// edge-on.
pub fn towards_textbook(position_x: DVec3, position_y: DVec3, normal_x: DVec3, normal_y: DVec3, light: DVec3) -> f64 {
    let Some(surface) = surface(position_x, position_y, normal_x, normal_y) else { return 0.0 };
    let azimuth = light.dot(surface.frame[1]).atan2(light.dot(surface.frame[0])) - surface.angle;
    surface.principal[0] * azimuth.cos().powi(2) + surface.principal[1] * azimuth.sin().powi(2)
}

/// Returns |dN| / |dP|. For each axis, the larger of the magnitudes of sum and difference is the
/// sum of the magnitudes.
pub fn naive(position_x: DVec3, position_y: DVec3, normal_x: DVec3, normal_y: DVec3) -> f64 {
    let size = |x: DVec3, y: DVec3| {
        let widths = (x + y).abs().max((x - y).abs());
        widths.x.hypot(widths.y).hypot(widths.z)
    };
    size(normal_x, normal_y) / size(position_x, position_y)
}
