// mesh: a vertex of a mesh that is read from storage buffers.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: own.
//
// A recipe adds: the binding `positions`, array<f32>, three floats per vertex, since a vec3f would
// take up four.

fn mesh_position(index: u32) -> vec3f {
    return vec3f(positions[3u * index], positions[3u * index + 1u], positions[3u * index + 2u]);
}
