// mesh_normals: a vertex normal of a mesh that is read from storage buffers.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: own.
//
// A recipe adds: the binding `normals`, array<f32>, three floats per vertex, since a vec3f would
// take up four.

fn mesh_normal(index: u32) -> vec3f {
    return vec3f(normals[3u * index], normals[3u * index + 1u], normals[3u * index + 2u]);
}
