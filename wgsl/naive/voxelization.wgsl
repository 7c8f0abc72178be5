// voxelization: forms found elsewhere, kept to show where they fail. They follow the module and use its names.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0

// voxelization_column in floats, as usually written: each triangle counts the columns on its edges,
// and rounding decides which columns these are.
// Returns: VoxelizationColumn.
// Units: as voxelization_column.
// Domain: triangles with an area as seen along x.
// Outside: columns on a shared edge count for both triangles; seen edge-on, depth is 0/0.
// Accuracy: naive
fn voxelization_column_naive(a: vec3f, b: vec3f, c: vec3f, column: vec2f) -> VoxelizationColumn {
    let p = a.yz - column;
    let q = b.yz - column;
    let r = c.yz - column;
    let weights = vec3f(q.x * r.y - q.y * r.x, r.x * p.y - r.y * p.x, p.x * q.y - p.y * q.x);
    if all(weights >= vec3f(0.0f)) || all(weights <= vec3f(0.0f)) {
        return VoxelizationColumn(true, dot(weights, vec3f(a.x, b.x, c.x)) / (weights.x + weights.y + weights.z));
    }
    return VoxelizationColumn(false, 0.0f);
}
