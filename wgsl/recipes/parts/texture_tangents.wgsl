// texture_tangents: the directions in which texture coordinates grow over a surface.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: Mikkelsen, "Surface Gradient-Based Bump Mapping Framework", JCGT 9 (2020).
//
// A recipe adds: nothing.

// Unit vectors along which u and v grow over the surface; 0 where the coordinates do not change.
struct TextureTangents {
    u: vec3f,
    v: vec3f,
}

// From the changes of position and coordinates along two directions, such as the screen's axes or two edges of a
// triangle, and the unit normal.
fn texture_tangents(normal: vec3f, position_x: vec3f, position_y: vec3f, uv_x: vec2f, uv_y: vec2f) -> TextureTangents {
    let across_x = cross(position_y, normal);
    let across_y = cross(normal, position_x);
    // Which way the two directions turn about the normal depends on where the second points.
    let turn = sign(dot(position_x, across_x));
    let u = turn * (across_x * uv_x.x + across_y * uv_y.x);
    let v = turn * (across_x * uv_x.y + across_y * uv_y.y);
    // Squares of tiny lengths underflow.
    return TextureTangents(u * inverseSqrt(max(dot(u, u), 1e-30f)), v * inverseSqrt(max(dot(v, v), 1e-30f)));
}
