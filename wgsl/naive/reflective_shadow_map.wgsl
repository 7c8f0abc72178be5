// reflective_shadow_map: forms found elsewhere, kept to show where they fail. They follow the module and use its names.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0

// The axes in their usual form, by a cross product with the vertical. Kept to show where it fails:
// for a light from straight above, the most common one, the cross product is 0.
// Returns: two unit vectors.
// Units: none.
// Domain: |axis| = 1, away from +y and -y.
// Outside: 0 / 0 for a vertical axis.
// Accuracy: naive
fn reflective_shadow_map_basis_naive(axis: vec3f) -> ReflectiveShadowMapBasis {
    let right = normalize(cross(vec3f(0.0f, 1.0f, 0.0f), axis));
    return ReflectiveShadowMapBasis(right, cross(axis, right));
}

// The usual test: the distance along the light by which the seen point is closer to the light than
// the point itself. Kept to show where it fails: on a plane at grazing incidence, the neighbouring
// texel is closer by almost its own width. So no single bias works for both the plane and the
// shadow of a thin body.
// Returns: distance along the light.
// Units: world units.
// Domain: coordinates up to 1e6, |toward_light| = 1.
// Outside: as the formula gives.
// Accuracy: naive
fn reflective_shadow_map_height_naive(seen: vec3f, position: vec3f, toward_light: vec3f) -> f32 {
    return dot(seen, toward_light) - dot(position, toward_light);
}
