// light_views: what each light sees, a layer of a map for each of its views.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: own.
//
// A recipe adds: the module reflective_shadow_map. The maps are drawn by the recipe of that name
// and bound here.

struct LightView {
    view: ReflectiveShadowMapView,
    // Number of the light that it belongs to.
    light: u32,
}

// One view per layer of the maps.
@group(0) @binding(4) var<storage, read> views: array<LightView>;
@group(0) @binding(5) var maps: texture_2d_array<f32>;
