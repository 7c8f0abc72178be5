// translucent_shadow: shadows on scattering matter: their edges, blurred for each colour, and how far
//   light has come through the body behind them, by the lights' maps.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: Dachsbacher and Stamminger, "Translucent Shadow Maps", 2003, for the way through the body by
//   the light's map and for a filter of the light that enters; own: both by one filter, of each
//   colour's width.
//
// A recipe adds: the module reflective_shadow_map and the parts light_views and shadow. The maps hold N.L of
// the bodies that light enters.

// Light that has spread inside softens the edges of shadows, and comes through thin parts. Called for by a shadow on a
// body that scatters.
override EFFECT_TRANSLUCENT_SHADOW: bool = false;

// Edges of one width for all colours, edges of each colour's width, or these and the light that comes through the body.
override SHADOW_FORM: u32 = 2u;
const SHADOW_FORM_SOFT: u32 = 0u;
const SHADOW_FORM_THROUGH: u32 = 2u;

// Width of the filter's Gaussian in mean free paths.
const TRANSLUCENT_SHADOW_WIDTH: f32 = 0.5f;
// The least width of a colour, of the largest one: the taps of the largest have to serve it.
const TRANSLUCENT_SHADOW_NARROWEST: f32 = 0.667f;
// The largest width, of the map's. Matter without extinction would blur over all of it.
const TRANSLUCENT_SHADOW_WIDEST: f32 = 0.03125f;
// Distance of the filter's taps in largest widths. They lie on a lattice that is fixed to the map of a sun, so
// that weights change from point to point and taps do not. Taps about the point show as bands, and a lattice
// for each colour as fringes. At 1.25 widths, ripples are below 1 % for the narrowest colour, and a tap comes
// in at three widths, with 1 % of the largest weight.
const TRANSLUCENT_SHADOW_SPACING: f32 = 1.25f;
// What is seen by this much of its distance across the light above the tangent plane is the same bent surface.
const TRANSLUCENT_SHADOW_SLOPE: f32 = 0.7f;

// What a light's map says of a point, filtered for each colour.
struct TranslucentShadow {
    // Share of the places around from which the light is seen.
    visible: vec3f,
    // Share of the places around from which the light has not come farther than the reach; from one to two
    // reaches it falls to 0.
    near: vec3f,
    // Way of the light from where it enters to the point, in units of length.
    way: vec3f,
    // N.L where it enters, 0 on bodies that no light enters.
    cosine: vec3f,
}

// The same in one view, at a place of the map in texels of this size.
fn translucent_shadow_in_view(
    layer: u32,
    place: vec2f,
    texel: f32,
    position: vec3f,
    normal: vec3f,
    toward_light: vec3f,
    free_path: vec3f,
    reach: vec3f
) -> TranslucentShadow {
    let size = f32(textureDimensions(maps).x);
    let path = TRANSLUCENT_SHADOW_WIDTH * max(free_path.x, max(free_path.y, free_path.z));
    // Taps are more than a texel apart.
    let widest = clamp(path, texel, TRANSLUCENT_SHADOW_WIDEST * size * texel);
    var widths = clamp(
        TRANSLUCENT_SHADOW_WIDTH * free_path, vec3f(TRANSLUCENT_SHADOW_NARROWEST * widest), vec3f(widest)
    );
    if (SHADOW_FORM == SHADOW_FORM_SOFT) {
        widths = vec3f((widths.x + widths.y + widths.z) / 3.0f);
    }
    let spacing = TRANSLUCENT_SHADOW_SPACING * widest / texel;
    let middle = vec2f(0.5f * size);
    let nearest = round((place - middle) / spacing);
    var weights = vec3f(0.0f);
    var sum = TranslucentShadow(vec3f(0.0f), vec3f(0.0f), vec3f(0.0f), vec3f(0.0f));
    for (var tap = 0i; tap < 25i; tap++) {
        let at = middle + spacing * (nearest + vec2f(f32(tap % 5i - 2i), f32(tap / 5i - 2i)));
        if (any(at < vec2f(0.0f)) || any(at >= vec2f(size))) {
            continue;
        }
        let seen = textureLoad(maps, vec2i(at), layer, 0);
        if (seen.w >= 0.0f) {
            let across = (at - place) * texel;
            let height = reflective_shadow_map_height(seen.xyz, position, normal);
            let way = dot(seen.xyz - position, toward_light);
            let weight = exp(-0.5f * dot(across, across) / (widths * widths));
            weights += weight;
            sum.visible += weight * select(0.0f, 1.0f, height <= texel + TRANSLUCENT_SHADOW_SLOPE * length(across));
            sum.near += weight * clamp(vec3f(2.0f) - way / reach, vec3f(0.0f), vec3f(1.0f));
            // By the light that enters, of which none does on other matter.
            sum.way += weight * seen.w * max(way, 0.0f);
            sum.cosine += weight * seen.w;
        }
    }
    if (min(weights.x, min(weights.y, weights.z)) < 1e-6f) {
        return TranslucentShadow(
            vec3f(max(shadow_in_view(layer, position, normal), 0.0f)),
            vec3f(1.0f),
            vec3f(0.0f),
            vec3f(0.0f)
        );
    }
    return TranslucentShadow(
        sum.visible / weights,
        sum.near / weights,
        sum.way / max(sum.cosine, vec3f(1e-6f)),
        sum.cosine / weights
    );
}

// The same in the view of the light that contains the point; all is lit if none does.
fn translucent_shadow_of_light(
    light: u32, position: vec3f, normal: vec3f, toward_light: vec3f, free_path: vec3f, reach: vec3f
) -> TranslucentShadow {
    let size = f32(textureDimensions(maps).x);
    for (var layer = 0u; layer < arrayLength(&views); layer++) {
        if (views[layer].light != light) {
            continue;
        }
        let clip = reflective_shadow_map_clip(views[layer].view, position);
        let place = reflective_shadow_map_texel(clip, size);
        if (any(place < vec2f(0.0f)) || any(place > vec2f(size))) {
            continue;
        }
        // As wide as at the depth of the point: clip.w is the depth in a lamp's map and 1 in a sun's.
        let texel = 2.0f * views[layer].view.extent * clip.w / size;
        return translucent_shadow_in_view(layer, place, texel, position, normal, toward_light, free_path, reach);
    }
    return TranslucentShadow(vec3f(1.0f), vec3f(1.0f), vec3f(0.0f), vec3f(0.0f));
}
