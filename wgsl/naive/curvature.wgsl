// curvature: forms found elsewhere, kept to show where they fail. They follow the module and use its names.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0

// The result of dpdx(normalize(normal)): the difference of two neighbours' unit normals.
// Returns: n(x + 1) - n(x).
// Units: the inverse of the screen's unit.
// Domain: |normal| in [1e-3, 1e3], neighbours at an angle of 0.1 rad or more.
// Outside: loses digits as 2^-24 / angle; 0 / 0 for the zero vector.
// Accuracy: naive
fn curvature_normal_derivative_naive(normal: vec3f, derivative: vec3f) -> vec3f {
    return normalize(normal + derivative) - normalize(normal);
}

// The mean curvature in its textbook form. Kept to show where it fails.
// Returns: (eG - 2fF + gE) / (2 (EG - F^2)).
// Units: the inverse of the position's unit.
// Domain: position derivatives of length 1e-4 to 1e4, at an angle with a sine of 0.3 or more.
// Outside: EG - F^2 is rounding noise at sines below 2^-11; 0 / 0 where it is 0 or underflows,
//   infinity over infinity above 1e9.
// Accuracy: naive
fn curvature_mean_textbook(position_x: vec3f, position_y: vec3f, normal_x: vec3f, normal_y: vec3f) -> f32 {
    let first = vec3f(dot(position_x, position_x), dot(position_x, position_y), dot(position_y, position_y));
    let mixed = 0.5f * (dot(position_x, normal_y) + dot(position_y, normal_x));
    let second = vec3f(dot(position_x, normal_x), mixed, dot(position_y, normal_y));
    let determinant = first.x * first.z - first.y * first.y;
    return 0.5f * (second.x * first.z - 2.0f * second.y * first.y + second.z * first.x) / determinant;
}

// The Gaussian curvature in its textbook form. Kept to show where it fails.
// Returns: (eg - f^2) / (EG - F^2).
// Units: the inverse of the position's unit, squared.
// Domain: as for curvature_mean_textbook.
// Outside: as curvature_mean_textbook.
// Accuracy: naive
fn curvature_gaussian_textbook(position_x: vec3f, position_y: vec3f, normal_x: vec3f, normal_y: vec3f) -> f32 {
    let first = vec3f(dot(position_x, position_x), dot(position_x, position_y), dot(position_y, position_y));
    let mixed = 0.5f * (dot(position_x, normal_y) + dot(position_y, normal_x));
    let second = vec3f(dot(position_x, normal_x), mixed, dot(position_y, normal_y));
    return (second.x * second.z - second.y * second.y) / (first.x * first.z - first.y * first.y);
}

// The normal curvature along the light from the normal equations of t = alpha p_x + beta p_y, whose
// determinant cancels in the quotient. Kept to show where it fails.
// Returns: (alpha^2 e + 2 alpha beta f + beta^2 g) / (alpha^2 E + 2 alpha beta F + beta^2 G).
// Units: the inverse of the position's unit.
// Domain: as for curvature_mean_textbook, with a light at 0.1 rad or more from the normal.
// Outside: 0 / 0 for a light along the normal; otherwise as curvature_mean_textbook.
// Accuracy: naive
fn curvature_towards_textbook(
    position_x: vec3f,
    position_y: vec3f,
    normal_x: vec3f,
    normal_y: vec3f,
    light: vec3f,
) -> f32 {
    let first = vec3f(dot(position_x, position_x), dot(position_x, position_y), dot(position_y, position_y));
    let mixed = 0.5f * (dot(position_x, normal_y) + dot(position_y, normal_x));
    let second = vec3f(dot(position_x, normal_x), mixed, dot(position_y, normal_y));
    let light_x = dot(light, position_x);
    let light_y = dot(light, position_y);
    let alpha = first.z * light_x - first.y * light_y;
    let beta = first.x * light_y - first.y * light_x;
    let weight = vec3f(alpha * alpha, 2.0f * alpha * beta, beta * beta);
    return dot(weight, second) / dot(weight, first);
}

// The usual rung, |dN| / |dP|: length(fwidth(normal)) / length(fwidth(position)). It is right on a
// sphere. Elsewhere it depends on the view, on the screen's axes and, through fwidth, even on the
// orientation of the world's axes. It has no sign, and on a saddle it never vanishes.
// Returns: some mean of the magnitudes of the principal curvatures.
// Units: the inverse of the position's unit.
// Domain: position derivatives of length 1e-4 to 1e4.
// Outside: 0 / 0 where both position derivatives are 0.
// Accuracy: naive
fn curvature_naive(position_x: vec3f, position_y: vec3f, normal_x: vec3f, normal_y: vec3f) -> f32 {
    return length(abs(normal_x) + abs(normal_y)) / length(abs(position_x) + abs(position_y));
}
