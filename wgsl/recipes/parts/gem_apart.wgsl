// gem_apart: two rays inside a stone that share no search, for geometries where sharing one gains nothing.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: own.
//
// A recipe adds: the part gem_shading, and what that part asks for but gem_hit_both.

// The next facets of two rays, each found by a search of its own.
fn gem_hit_both(
    place: ptr<function, GemPlace>, ray: GemRay, place_other: ptr<function, GemPlace>, other: GemRay
) -> GemHits {
    let first = gem_hit(place, ray);
    let second = gem_hit(place_other, other);
    return GemHits(first, second);
}

// Light that leaves the stone meets triangles of other bodies: only by the recipe gem_walk.
override EFFECT_AROUND: bool = false;
// Rays inside meet bodies that reach into the stone: only by the recipe gem_walk.
override EFFECT_NESTED: bool = false;

// Nothing is met.
fn beside_met(position: vec3f, direction: vec3f, within: f32) -> vec4f {
    return vec4f(0.0f, 0.0f, 0.0f, -1.0f);
}
