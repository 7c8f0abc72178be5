// curvature: mean, Gaussian and normal curvature of a surface from screen-space derivatives of its position and normal.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0
// Source: do Carmo, Differential Geometry of Curves and Surfaces, sections 3-2 and 3-3: first and
//   second fundamental form, Euler's formula; section 3-5, exercise 11: the area of a parallel
//   surface. The usual form: Penner, "Pre-Integrated Skin Shading", GPU Pro 2, 2011.
//
// `position_x` stands for dpdx(position), `normal_y` for dpdy(normal), and so on; the fragment
// shader takes them before any branch. Positions and normals must be in the same space, preferably
// relative to the eye, where positions keep the most digits. Under a non-uniform scale use world or
// view space, with normals transformed by the inverse transpose and renormalised. Curvature is
// positive where the surface bends away from its normal, as a sphere bends away from its outward
// normal.

// Position derivatives whose largest component is below this, 2^-50, count as degenerate: the
// curvature fades to 0 with them. For smaller ones a change of the normal between two pixels, at
// most 2, would give a curvature whose square f32 cannot hold.
const CURVATURE_SMALLEST: f32 = 8.881784197001252e-16f;

// Squared sine of the angle between the position derivatives at which a pixel counts as seen
// edge-on, (2^-10)^2. Positions are rounded by 2^-24 of their distance and a pixel is about 2^-10
// of it, so the derivatives are off by 2^-14 of their length. At this sine the error is 1/16 of the
// span of the derivatives; below it they soon span nothing but rounding.
const CURVATURE_EDGE_ON: f32 = 9.5367431640625e-7f;

// Squared sine of the angle between light and normal below which the light has no direction along
// the surface, (2^-10)^2.
const CURVATURE_ZENITH: f32 = 9.5367431640625e-7f;

// Power of two that brings the largest component of a derivative to [1, 2). Scaling the derivatives
// of position and normal along one screen axis by the same factor is a change of the pixel's width:
// it does not change the curvature and rounds nothing.
// Returns: 2^-k for a largest component in [2^k, 2^(k+1)); at most 1 / CURVATURE_SMALLEST.
// Units: the inverse of the derivative's unit.
// Domain: largest component 0 or in [1e-38, 1e38].
// Outside: 0 from 2^127 on, which makes the pixel degenerate.
// Accuracy: lavapipe 0 ulp; portable 0 ulp
fn curvature_scale(derivative: vec3f) -> f32 {
    let magnitude = abs(derivative);
    let size = max(max(magnitude.x, magnitude.y), max(magnitude.z, CURVATURE_SMALLEST));
    return bitcast<f32>(0x7f000000u - (bitcast<u32>(size) & 0x7f800000u));
}

// Derivative of the unit normal from the derivative of a normal that is not yet normalised, such as
// one that was interpolated over a triangle or transformed. Differencing normals after
// normalisation loses the digits that two neighbours share; this does not.
// Returns: (I - n n^T) derivative / |normal| with n = normal / |normal|; 0 for the zero vector.
// Units: the inverse of the screen's unit; independent of the normal's length.
// Domain: |normal| in [1e-15, 1e15], |derivative| at most 2^20 |normal|.
// Outside: fades to 0 for shorter normals; finite while |derivative| < 1e10.
// Accuracy: lavapipe 4 ulp + 3 backward; portable 13 ulp + 6.5 backward
fn curvature_normal_derivative(normal: vec3f, derivative: vec3f) -> vec3f {
    let scale = curvature_scale(normal);
    let scaled = scale * normal;
    let squared = max(dot(scaled, scaled), 1.0f);
    return cross(cross(scaled, scale * derivative), scaled) / (squared * sqrt(squared));
}

// Derivatives of a pixel, scaled along each screen axis so that those of the position are about 1
// long.
struct CurvaturePixel {
    // Derivative of the position along the screen's x axis.
    p_x: vec3f,
    // Derivative of the position along the screen's y axis.
    p_y: vec3f,
    // Derivative of the normal along the screen's x axis.
    n_x: vec3f,
    // Derivative of the normal along the screen's y axis.
    n_y: vec3f,
}

// Scales the derivatives of position and normal along each axis by curvature_scale of the
// position's.
// Returns: position derivatives with largest components in [1, 2), less if they are degenerate.
// Units: none for the position derivatives; the inverse of the position's unit for the normal
//   derivatives.
// Domain: position derivatives 0 or with a largest component in [1e-22, 1e22]; normal derivatives
//   of unit normals.
// Outside: as curvature_scale.
// Accuracy: lavapipe p_x 0 ulp, p_y 0 ulp, n_x 0 ulp, n_y 0 ulp; portable p_x 0 ulp, p_y 0 ulp, n_x 0 ulp, n_y 0 ulp
fn curvature_pixel(position_x: vec3f, position_y: vec3f, normal_x: vec3f, normal_y: vec3f) -> CurvaturePixel {
    let scale_x = curvature_scale(position_x);
    let scale_y = curvature_scale(position_y);
    return CurvaturePixel(scale_x * position_x, scale_y * position_y, scale_x * normal_x, scale_y * normal_y);
}

// Position derivatives of a pixel in an orthonormal frame of the tangent plane: p_x = width first,
// p_y = lean first + rise second.
struct CurvatureFrame {
    // Unit vector along p_x; 0 if p_x is 0.
    first: vec3f,
    // Unit vector perpendicular to `first`, on the side of p_y; shorter if `rise` is below 2^-50, 0
    // if `rise` is 0.
    second: vec3f,
    // Vector of length `rise` perpendicular to both; `width` times it is p_x x p_y.
    normal: vec3f,
    // Length of p_x.
    width: f32,
    // Component of p_y along `first`.
    lean: f32,
    // Component of p_y along `second`, at least 0.
    rise: f32,
    // Square of the area that p_x and p_y span, width rise; never below the square at which a pixel
    // counts as edge-on.
    bounded: f32,
}

// Computes the frame by Gram-Schmidt: all results belong to one p_y, a few ulp off if p_x and p_y are nearly parallel.
// Returns: frame of p_x and p_y.
// Units: none for the unit vectors; otherwise that of the derivatives.
// Domain: p_x and p_y of curvature_pixel: with a largest component in [1, 2), or degenerate in [1e-7, 1), or 0.
// Outside: `first` and `second` shrink for shorter ones.
// Accuracy: lavapipe first 4 ulp, second 10 ulp + 4 backward, normal 7 ulp + 1e-9 abs + 4 backward, width 3 ulp,
//   lean 4 ulp + 4 backward, rise 7 ulp + 1e-9 abs + 4 backward, bounded 20 ulp + 4 backward;
//   portable first 17 ulp, second 42 ulp + 8 backward, normal 31 ulp + 1e-9 abs + 8 backward, width 12 ulp,
//   lean 18 ulp + 8 backward, rise 31 ulp + 1e-9 abs + 8 backward, bounded 90 ulp + 8 backward
fn curvature_frame(p_x: vec3f, p_y: vec3f) -> CurvatureFrame {
    let squared_x = dot(p_x, p_x);
    let width = sqrt(squared_x);
    // 2^-50 replaces 0, here and below.
    let first = p_x / max(width, CURVATURE_SMALLEST);
    let crossed = cross(p_x, p_y) / max(width, CURVATURE_SMALLEST);
    // Rounding tilts the product of nearly parallel vectors towards them, so it is made
    // perpendicular once more.
    let normal = crossed - dot(crossed, first) * first;
    let rise = length(normal);
    let second = cross(normal, first) / max(rise, CURVATURE_SMALLEST);
    let area = width * rise;
    let least = CURVATURE_EDGE_ON * max(squared_x, 1.0f) * max(dot(p_y, p_y), 1.0f);
    return CurvatureFrame(first, second, normal, width, dot(p_y, first), rise, max(area * area, least));
}

// Mean curvature, half the sum of the principal curvatures. With a = p_x x p_y it is a . (n_x x p_y + p_x x n_y) /
// (2 |a|^2), which does not cancel if the pixel is seen edge-on.
// Returns: mean curvature: 1 / R on a sphere, 1 / 2R on a cylinder; 0 if a position derivative is 0. Below
//   CURVATURE_EDGE_ON it fades to 0 in proportion to the squared sine, and is at most 2^9 (|n_x| / |p_x| + |n_y| /
//   |p_y|).
// Units: the inverse of the position's unit.
// Domain: position derivatives 0 or with a largest component in [1e-22, 1e22]; normal derivatives of unit normals.
// Outside: finite for |normal_x|, |normal_y| <= 2.
// Accuracy: lavapipe 4 ulp + 1e-31 abs + 4 backward; portable 10 ulp + 1e-31 abs + 8 backward
fn curvature_mean(position_x: vec3f, position_y: vec3f, normal_x: vec3f, normal_y: vec3f) -> f32 {
    let pixel = curvature_pixel(position_x, position_y, normal_x, normal_y);
    let area = cross(pixel.p_x, pixel.p_y);
    let growth = cross(pixel.n_x, pixel.p_y) + cross(pixel.p_x, pixel.n_y);
    let least = CURVATURE_EDGE_ON * max(dot(pixel.p_x, pixel.p_x), 1.0f) * max(dot(pixel.p_y, pixel.p_y), 1.0f);
    return 0.5f * dot(area, growth) / max(dot(area, area), least);
}

// Gaussian curvature, the product of the principal curvatures: a . (n_x x n_y) less the square of (p_x . n_y -
// p_y . n_x) / 2, over |a|^2 with a = p_x x p_y. The square is 0 on a smooth surface, and keeps K at most H^2.
// Returns: Gaussian curvature: 1 / R^2 on a sphere, 0 on a cylinder, negative on a saddle; 0 if a position
//   derivative is 0. Below CURVATURE_EDGE_ON it fades to 0 as the square of curvature_mean does.
// Units: the inverse of the position's unit, squared.
// Domain: as for curvature_mean; normal derivatives perpendicular to the surface's normal up to 0.4 of their
//   length.
// Outside: finite for |normal_x|, |normal_y| <= 2.
// Accuracy: lavapipe 5 ulp + 1e-31 abs + 6 backward; portable 12 ulp + 1e-31 abs + 12 backward; order kept
fn curvature_gaussian(position_x: vec3f, position_y: vec3f, normal_x: vec3f, normal_y: vec3f) -> f32 {
    let pixel = curvature_pixel(position_x, position_y, normal_x, normal_y);
    let frame = curvature_frame(pixel.p_x, pixel.p_y);
    let area = frame.width * frame.rise;
    let twist = 0.5f * (dot(pixel.p_x, pixel.n_y) - dot(pixel.p_y, pixel.n_x));
    let determinant = frame.width * dot(frame.normal, cross(pixel.n_x, pixel.n_y)) - twist * twist;
    // Keep this order: the square of the area may underflow.
    return determinant / frame.bounded * area * (area / frame.bounded);
}

// Normal curvature along the light, that of the curve on the surface that runs towards the light's foot: II(t,
// t) / I(t, t), with t the component of `light` along the surface. At the zenith t loses its direction.
// Returns: curvature between the principal curvatures; the mean curvature for a light along the normal. It
//   fades to 0 edge-on as curvature_mean does.
// Units: the inverse of the position's unit.
// Domain: as for curvature_gaussian; |light| = 1.
// Outside: finite for |normal_x|, |normal_y| <= 2 and |light| <= 2.
// Accuracy: lavapipe 6 ulp + 1e-31 abs + 6 backward; portable 28 ulp + 2e-28 abs + 16 backward; order kept
fn curvature_towards(
    position_x: vec3f,
    position_y: vec3f,
    normal_x: vec3f,
    normal_y: vec3f,
    light: vec3f,
) -> f32 {
    let pixel = curvature_pixel(position_x, position_y, normal_x, normal_y);
    let frame = curvature_frame(pixel.p_x, pixel.p_y);
    let x = dot(light, frame.first);
    let y = dot(light, frame.second);
    let tangent = x * frame.first + y * frame.second;
    let change = (frame.rise * x - frame.lean * y) * pixel.n_x + (frame.width * y) * pixel.n_y;
    let across = frame.rise * frame.first - frame.lean * frame.second;
    let mean = 0.5f * (dot(across, pixel.n_x) + frame.width * dot(frame.second, pixel.n_y));
    let area = frame.width * frame.rise;
    let share = area / frame.bounded;
    let fade = area * share;
    let total = fade * (x * x + y * y) + CURVATURE_ZENITH;
    // Weights first: products with a change of 1e-30 would underflow.
    return share * (fade / total * dot(tangent, change) + CURVATURE_ZENITH / total * mean);
}
