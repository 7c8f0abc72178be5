// reflective_shadow_map: a point in a light's view: its place, the light it takes, and whether something hides it.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0
// Source: Dachsbacher and Stamminger, "Reflective Shadow Maps", 2005, section 3; Ozawa, Okamoto and
//   Morishima, "Real-time Rendering of Translucent Material using Dynamic Programming", section
//   3.1, for the four channels: world position and N.L; Duff et al., "Building an Orthonormal
//   Basis, Revisited", 2017, listing 3, for the map's axes.
//
// Each texel of the map holds the world position that the light sees there, and N.L. For a surface
// seen from behind, N.L is 0. For a texel that sees nothing, it is REFLECTIVE_SHADOW_MAP_NOTHING.

// N.L of a texel that sees nothing.
const REFLECTIVE_SHADOW_MAP_NOTHING: f32 = -1.0f;

// The view of one map. A light in an arbitrary place may need several, like the six faces of a
// cube.
struct ReflectiveShadowMapView {
    // The centre of a sun's map or the position of a lamp, in world units.
    origin: vec3f,
    // 0 for a sun (parallel rays), 1 for a lamp.
    lamp: u32,
    // The unit direction of the light in the middle of the map.
    axis: vec3f,
    // Half the map's width, above 0: in world units for a sun, the tangent of half the angle for a
    // lamp.
    extent: f32,
    // The smallest and the largest depth along the axis from the origin, in world units:
    // near < far, and 0 < near for a lamp.
    near: f32,
    far: f32,
}

// Two unit vectors, perpendicular to an axis and to each other.
struct ReflectiveShadowMapBasis {
    right: vec3f,
    up: vec3f,
}

// The map's axes, with right x up = axis. They vary continuously with the axis except across the
// boundary between +z and -z. A jump somewhere is unavoidable, because no field of tangents on the
// sphere is continuous. On either side of z = 0, neighbouring axes have neighbouring maps.
// Returns: two unit vectors.
// Units: none.
// Domain: |axis| = 1.
// Outside: finite for a length up to 1e18; the vectors are neither unit nor square.
// Accuracy: lavapipe right 4 ulp + 4 backward, up 4 ulp + 4 backward;
//   portable right 16 ulp + 8 backward, up 16 ulp + 8 backward
fn reflective_shadow_map_basis(axis: vec3f) -> ReflectiveShadowMapBasis {
    let side = select(-1.0f, 1.0f, axis.z >= 0.0f);
    let a = -1.0f / (side + axis.z);
    let b = axis.x * axis.y * a;
    let right = vec3f(1.0f + side * axis.x * axis.x * a, side * b, -side * axis.x);
    let up = vec3f(b, side + axis.y * axis.y * a, -axis.y);
    return ReflectiveShadowMapBasis(right, up);
}

// The position of a point in a map, in WebGPU's clip coordinates, from its difference from the view's
// origin: a matrix that includes the translation would subtract products of large numbers.
// Returns: x, y in [-w, w] and z in [0, w] for points that the map covers; w is 1 for a sun and the
//   depth for a lamp.
// Units: world units and their quotients.
// Domain: a view as documented at ReflectiveShadowMapView, extent in [1e-4, 1e4], far - near at least
//   1e-4 far; coordinates up to 1e6.
// Outside: finite as long as products of coordinates and 1 / extent are.
// Accuracy: lavapipe 16 ulp + 2 backward; portable 40 ulp + 4 backward
fn reflective_shadow_map_clip(view: ReflectiveShadowMapView, position: vec3f) -> vec4f {
    // The basis of the reversed axis, so that front faces remain front faces.
    let basis = reflective_shadow_map_basis(-view.axis);
    let way = position - view.origin;
    let depth = dot(way, view.axis);
    let across = vec2f(dot(way, basis.right), dot(way, basis.up)) / view.extent;
    if (view.lamp == 0u) {
        return vec4f(across, (depth - view.near) / (view.far - view.near), 1.0f);
    }
    return vec4f(across, (depth - view.near) * view.far / (view.far - view.near), depth);
}

// The position of a point in the map, in texels from the upper left corner, from its clip
// coordinates. The centre of texel i is at i + 1/2.
// Returns: both in [0, size] for points that the map covers; (-1, -1) for points behind a lamp,
//   which no map covers.
// Units: texels.
// Domain: any clip coordinates with finite x / w and y / w; size in [1, 16384].
// Outside: beside the map for points that the map does not cover.
// Accuracy: lavapipe 3 ulp + 2 backward; portable 8 ulp + 4 backward
fn reflective_shadow_map_texel(clip: vec4f, size: f32) -> vec2f {
    if (clip.w <= 0.0f) {
        return vec2f(-1.0f);
    }
    return (vec2f(0.5f) + vec2f(0.5f, -0.5f) * (clip.xy / clip.w)) * size;
}

// N.L, the map's fourth channel: the light that a surface receives, relative to a surface
// perpendicular to the light. An interpolated normal is shorter than 1, and 0 where opposite
// normals meet; no light is received there.
// Returns: a value in [0, 1].
// Units: none.
// Domain: normal of any length in [1e-12, 1e12], or 0; |toward_light| = 1.
// Outside: finite as long as the squared length of the normal is.
// Accuracy: lavapipe 6 ulp + 1.5 backward; portable 12 ulp + 2 backward
fn reflective_shadow_map_cosine(normal: vec3f, toward_light: vec3f) -> f32 {
    let unit = normal * inverseSqrt(max(dot(normal, normal), 1e-30f));
    return clamp(dot(unit, toward_light), 0.0f, 1.0f);
}

// The height of the position that the light sees at a point's texel, over the tangent plane of the
// surface at the point. If the height is greater than the width of a texel, there is an occluder
// that casts a shadow on the point. Otherwise the light sees the surface itself, beside the point:
// a convex surface lies below its tangent plane and a plane lies in it, however oblique the light.
// Returns: height over the plane, negative below it; 0 for a normal of 0.
// Units: world units.
// Domain: coordinates up to 1e6; normal of any length in [1e-12, 1e12], or 0.
// Outside: finite as long as the squared length of the normal is.
// Accuracy: lavapipe 8 ulp + 2 backward; portable 16 ulp + 4 backward
fn reflective_shadow_map_height(seen: vec3f, position: vec3f, normal: vec3f) -> f32 {
    let unit = normal * inverseSqrt(max(dot(normal, normal), 1e-30f));
    return dot(seen - position, unit);
}
