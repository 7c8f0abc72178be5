// fresnel: forms found elsewhere, kept to show where they fail. They follow the module and use its names.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0

// The reflectance of a dielectric as in textbooks and most shaders: quotients of cosines, with the
// cosine of the angle of refraction from Snell's law. Kept to show where it fails: for an index
// near 1 and near grazing incidence, its numerators are differences of nearly equal roots.
// Returns: reflectance; 0 / 0 for cosine = 0 with relative_index <= 1.
// Units: the same as for fresnel_dielectric.
// Domain: cosine in [0, 1], relative_index in [1/4, 4]; usable for |relative_index - 1| > 0.1 away
//   from the critical angle.
// Outside: as the formula gives.
// Accuracy: naive
fn fresnel_dielectric_textbook(cosine: f32, relative_index: f32) -> f32 {
    let eta = 1.0f / relative_index;
    // If the radicand is negative, no light is transmitted: with a cosine of 0 both quotients
    // are 1.
    let cosine_transmitted = sqrt(max(1.0f - eta * eta * (1.0f - cosine * cosine), 0.0f));
    let s = (cosine - relative_index * cosine_transmitted) / (cosine + relative_index * cosine_transmitted);
    let p = (relative_index * cosine - cosine_transmitted) / (relative_index * cosine + cosine_transmitted);
    return 0.5f * (s * s + p * p);
}
