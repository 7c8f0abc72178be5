// mesh_normals: the vertex normals of a mesh that is read from storage buffers, and how they face the eye.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: own.
//
// A recipe adds: the binding `normals`, array<f32>, three floats per vertex, since a vec3f would
// take up four.

fn mesh_normal(index: u32) -> vec3f {
    return vec3f(normals[3u * index], normals[3u * index + 1u], normals[3u * index + 2u]);
}

// The cosine of a unit normal to the unit direction of the eye, for laws that vanish at grazing angles. Between a
// silhouette and the triangle's far edge interpolated normals face away from an eye that sees the triangle. There
// it is half the triangle's own cosine, by the derivatives of the position along the picture's axes. On fine meshes
// the normal's is the larger one.
fn mesh_cosine_to_eye(normal: vec3f, toward_eye: vec3f, position_x: vec3f, position_y: vec3f) -> f32 {
    let across = cross(position_x, position_y);
    let flat = abs(dot(across, toward_eye)) * inverseSqrt(max(dot(across, across), 1e-30f));
    return max(dot(normal, toward_eye), 0.5f * flat);
}
