// reflective_shadow_map: where a light's view puts a point, how much light the surface takes there, and whether something stands before it.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0, hash a4969541cb6ec6e3
// Source: Dachsbacher and Stamminger, "Reflective Shadow Maps", 2005, section 3; Ozawa, Okamoto and Morishima, "Real-time Rendering of
//   Translucent Material using Dynamic Programming", section 3.1, for the four channels: world position and N.L;
//   Duff et al., "Building an Orthonormal Basis, Revisited", 2017, listing 3, for the map's axes.
//
// A texel of the map holds the world position that the light sees there, and N.L. A texel that sees a surface from behind has an N.L of
// 0; one that sees nothing has REFLECTIVE_SHADOW_MAP_NOTHING in its place.

// N.L of a texel that sees nothing.
const REFLECTIVE_SHADOW_MAP_NOTHING: f32 = -1.0f;

// What a map sees. A light at any place may need several, as a cube has six faces.
struct ReflectiveShadowMapView {
    // The middle of what a sun's map covers, or where a lamp stands; in world units.
    origin: vec3f,
    // 0 for a sun, whose rays are parallel, 1 for a lamp.
    lamp: u32,
    // The way that light goes in the map's middle, unit.
    axis: vec3f,
    // Half the map's width: for a sun in world units, for a lamp the tangent of half its angle. Above 0.
    extent: f32,
    // The least and the greatest depth along the axis, from the origin, in world units: near < far, for a lamp 0 < near.
    near: f32,
    far: f32,
}

// Two unit vectors, at right angles to an axis and to one another.
struct ReflectiveShadowMapBasis {
    right: vec3f,
    up: vec3f,
}

// The map's axes. right x up = axis. They turn with the axis everywhere but from +z to -z, where they must jump somewhere: no field of
// tangents on the sphere is continuous. Neighbouring axes have neighbouring maps on either side of z = 0.
// Returns: two unit vectors.
// Units: none.
// Domain: |axis| = 1.
// Outside: finite for a length up to 1e18; the vectors are neither unit nor square.
// Accuracy: lavapipe right 4 ulp + 4 backward, up 4 ulp + 4 backward; portable right 16 ulp + 8 backward, up 16 ulp + 8 backward
fn reflective_shadow_map_basis(axis: vec3f) -> ReflectiveShadowMapBasis {
    let side = select(-1.0f, 1.0f, axis.z >= 0.0f);
    let a = -1.0f / (side + axis.z);
    let b = axis.x * axis.y * a;
    let right = vec3f(1.0f + side * axis.x * axis.x * a, side * b, -side * axis.x);
    let up = vec3f(b, side + axis.y * axis.y * a, -axis.y);
    return ReflectiveShadowMapBasis(right, up);
}

// Where a point appears in a map: clip coordinates as WebGPU has them. The point goes by its difference from the view's origin, so that a
// scene far from the world's has the same map; a matrix with the translation in it would have subtracted products of large numbers.
// Returns: x, y in [-w, w] and z in [0, w] for what the map covers; w is 1 for a sun, the depth for a lamp.
// Units: world units and their quotients.
// Domain: a view as ReflectiveShadowMapView says, extent in [1e-4, 1e4] and far - near at least 1e-4 far; coordinates up to 1e6.
// Outside: finite as long as products of coordinates and 1 / extent are.
// Accuracy: lavapipe 16 ulp + 2 backward; portable 40 ulp + 4 backward
fn reflective_shadow_map_clip(view: ReflectiveShadowMapView, position: vec3f) -> vec4f {
    // Seen against the axis: so fronts are fronts.
    let basis = reflective_shadow_map_basis(-view.axis);
    let way = position - view.origin;
    let depth = dot(way, view.axis);
    let across = vec2f(dot(way, basis.right), dot(way, basis.up)) / view.extent;
    if (view.lamp == 0u) {
        return vec4f(across, (depth - view.near) / (view.far - view.near), 1.0f);
    }
    return vec4f(across, (depth - view.near) * view.far / (view.far - view.near), depth);
}

// The texel of a point's clip coordinates, in texels from the upper left corner: texel i has its centre at i + 1/2.
// Returns: both in [0, size] for what the map covers; (-1, -1) for what is behind a lamp, which no map covers.
// Units: texels.
// Domain: any clip coordinates of which x / w and y / w are finite, size in [1, 16384].
// Outside: beside the map for what the map does not cover.
// Accuracy: lavapipe 3 ulp + 2 backward; portable 8 ulp + 4 backward
fn reflective_shadow_map_texel(clip: vec4f, size: f32) -> vec2f {
    if (clip.w <= 0.0f) {
        return vec2f(-1.0f);
    }
    return (vec2f(0.5f) + vec2f(0.5f, -0.5f) * (clip.xy / clip.w)) * size;
}

// N.L, the map's fourth channel: the share that a surface takes of the light that a surface square to it would. A normal that was interpolated
// is shorter than 1, and is none where opposite ones meet: nothing arrives there.
// Returns: in [0, 1].
// Units: none.
// Domain: normal of any length in [1e-12, 1e12], or 0; |toward_light| = 1.
// Outside: finite as long as the squared length of the normal is.
// Accuracy: lavapipe 6 ulp + 1.5 backward; portable 12 ulp + 2 backward
fn reflective_shadow_map_cosine(normal: vec3f, toward_light: vec3f) -> f32 {
    let unit = normal * inverseSqrt(max(dot(normal, normal), 1e-30f));
    return clamp(dot(unit, toward_light), 0.0f, 1.0f);
}

// How far what the light sees at a point's texel stands out of the plane that touches the surface at the point. What is higher than a texel
// is wide casts a shadow on the point; the rest is the surface itself, met beside the point. On a convex surface all of that lies below the
// plane, and on a plane in it, however slantingly the light falls.
// Returns: height over the plane, negative below; 0 for a normal of 0.
// Units: world units.
// Domain: coordinates up to 1e6; normal of any length in [1e-12, 1e12], or 0.
// Outside: finite as long as the squared length of the normal is.
// Accuracy: lavapipe 8 ulp + 2 backward; portable 16 ulp + 4 backward
fn reflective_shadow_map_height(seen: vec3f, position: vec3f, normal: vec3f) -> f32 {
    let unit = normal * inverseSqrt(max(dot(normal, normal), 1e-30f));
    return dot(seen - position, unit);
}
