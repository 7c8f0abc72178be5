// diffusion_shading: translucent stone: light scattered to the eye along its way inside, by diffusion, in one draw.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: own; Chandrasekhar, "Radiative Transfer", 1960, for what a cell cannot resolve.
// requires: environment, cdrf, diffusion, fresnel, half_space, microfacet, reflective_shadow_map, voxelization
// parts: mesh, mesh_normals, surroundings, lights, light_views, shadow, harmonics, reflection
// parts: diffusion_nodes, diffusion_packed
//
// Draw 3 vertices per triangle without a vertex buffer, in world space, after the recipes
// voxelize, diffusion_cells, draw_light_map, diffusion_source and diffusion_solve.

// Light through the body. If off, only light that falls on the surface itself is sent back. Called for
// by extras.lapidary.scattering and absorption.
override EFFECT_DIFFUSION: bool = true;
// Lamps stand inside the body, and their light is scattered on its way out. Called for by a lamp that the mesh
// encloses.
override EFFECT_LAMP_INSIDE: bool = false;
// The extinction varies from voxel to voxel. Called for by extras.lapidary.veins, or by a grid of
// densities.
override EFFECT_EXTINCTION_PER_VOXEL: bool = false;
// The density varies so much that ways of eye and light are followed from voxel to voxel; else that about a
// point counts for the way to the next. Needs EFFECT_EXTINCTION_PER_VOXEL.
override DIFFUSION_VARIED: bool = false;
// Diffuse light from all around, in addition to the lights. Called for by an environment.
override EFFECT_ENVIRONMENT: bool = true;
// The surface refracts light, and reflects it back inside. Called for by KHR_materials_ior above 1.
override EFFECT_DIELECTRIC: bool = false;

// The way inside is cut where its optical depth is 0, .4, 1.2, 2.5 and 5.
const DIFFUSION_PIECES: u32 = 4u;
const DIFFUSION_STEPS: vec4f = vec4f(0.4f, 0.8f, 1.3f, 2.5f);
// Voxels that a piece may pass where the density varies, and the largest number looked up towards a light.
const DIFFUSION_TURNS: u32 = 222u;
const DIFFUSION_TOWARDS: f32 = 16.0f;
// Voxel spacings over which the density counts as one.
const DIFFUSION_NEAR: f32 = 2.0f;

struct DiffusionView {
    clip_from_world: mat4x4f,
    eye: vec3f,
}

struct DiffusionBody {
    grid: VoxelizationGrid,
    // Extinction per voxel spacing where the density is 1, in each channel.
    extinction: vec3f,
    // Index of refraction, relative to the medium outside.
    index: f32,
    // The root of 1 - albedo, in each channel.
    gamma: vec3f,
    // Width of the distribution of microfacet slopes, the square of the roughness; 0 for a polished
    // surface.
    alpha: f32,
    // The irradiance that counts as 1.
    largest: vec3f,
    // Milne's length in mean free paths.
    milne: f32,
    // Chandrasekhar's H function along the normal, in each channel.
    h_normal: vec3f,
    // half_space_edge of the index.
    edge: f32,
    // half_space_gain, in each channel.
    gain: vec3f,
}

@group(0) @binding(0) var<uniform> view: DiffusionView;
// Bindings 1 to 5 belong to the parts.
@group(1) @binding(0) var<storage, read> body: DiffusionBody;
// Three floats per vertex.
@group(1) @binding(1) var<storage, read> positions: array<f32>;
@group(1) @binding(2) var<storage, read> indices: array<u32>;
@group(1) @binding(3) var<storage, read> normals: array<f32>;
@group(1) @binding(4) var<storage, read> packed: array<vec2u>;
@group(1) @binding(5) var<storage, read> density: array<f32>;
// For each light 1 if it is a lamp inside this body, else 0.
@group(1) @binding(6) var<storage, read> enclosed: array<u32>;

struct DiffusionVertex {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
}

@vertex
fn diffusion_vertex(@builtin(vertex_index) vertex: u32) -> DiffusionVertex {
    let index = indices[vertex];
    let position = mesh_position(index);
    return DiffusionVertex(view.clip_from_world * vec4f(position, 1.0f), position, mesh_normal(index));
}

// Chandrasekhar's H function in each channel.
fn diffusion_h(cosine: f32) -> vec3f {
    return vec3f(
        half_space_h(cosine, body.gamma.x),
        half_space_h(cosine, body.gamma.y),
        half_space_h(cosine, body.gamma.z)
    );
}

// What the nodes around a point hold.
struct DiffusionSample {
    fluence: vec3f,
    // Their mean depth in voxel spacings.
    depth: f32,
    // How fluence and depth vary together, and the variance of the depth.
    covariance: vec3f,
    variance: f32,
    // The least depth and the largest.
    shallowest: f32,
    deepest: f32,
    // Their mean density; 0 where there is no matter about the point.
    density: f32,
    // The filled share of the space about the point: about 1/2 at the surface of a thick part.
    filled: f32,
}

// The nodes' means around a point, given in voxel spacings from the grid's corner.
fn diffusion_sample(place: vec3f) -> DiffusionSample {
    let cells = body.grid.cells;
    let low = floor(place - 0.5f);
    let fraction = place - 0.5f - low;
    var found: DiffusionSample;
    found.shallowest = DIFFUSION_NODE_DEPTH;
    var products = vec3f(0.0f);
    var square = 0.0f;
    for (var corner = 0u; corner < 8u; corner++) {
        let step = vec3f(f32(corner & 1u), f32((corner >> 1u) & 1u), f32(corner >> 2u));
        let voxel = vec3u(clamp(low + step, vec3f(0.0f), vec3f(f32(cells - 1u))));
        let index = voxel.x + cells * (voxel.y + cells * voxel.z);
        let word = packed[index];
        let weight = diffusion_weight(fraction, corner, diffusion_packed_volume(word));
        let fluence = weight * diffusion_packed_fluence(word);
        let depth = diffusion_packed_depth(word);
        found.filled += weight;
        found.fluence += fluence;
        found.depth += weight * depth;
        products += fluence * depth;
        square += weight * depth * depth;
        found.shallowest = select(found.shallowest, min(found.shallowest, depth), weight > 0.0f);
        found.deepest = select(found.deepest, max(found.deepest, depth), weight > 0.0f);
        if (EFFECT_EXTINCTION_PER_VOXEL) {
            found.density += weight * density[index];
        }
    }
    let scale = select(0.0f, 1.0f / max(found.filled, 1e-12f), found.filled > 0.0f);
    if (!EFFECT_EXTINCTION_PER_VOXEL) {  //+extinction_per_voxel
        found.density = found.filled;
    }  //+extinction_per_voxel
    found.fluence *= scale;
    found.depth *= scale;
    found.covariance = scale * products - found.depth * found.fluence;
    found.variance = max(scale * square - found.depth * found.depth, 0.0f);
    // A density of 0 stands for no matter.
    found.density = select(0.0f, max(scale * found.density, DIFFUSION_THINNEST), found.filled > 0.0f);
    return found;
}

// The same nodes with weights that put their mean at a depth below the surface, as near as they can.
fn diffusion_at_depth(around: DiffusionSample, depth: f32) -> DiffusionSample {
    var found = around;
    let slope = diffusion_slope(
        depth - found.depth, found.variance, found.depth - found.shallowest, found.deepest - found.depth
    );
    found.fluence = max(found.fluence + slope * found.covariance, vec3f(0.0f));
    found.depth += slope * found.variance;
    return found;
}

// The fluence at a depth below the surface: between the nodes and Milne's length above the surface it falls
// linearly, to that outside.
fn diffusion_below(found: DiffusionSample, depth: f32, outside: vec3f) -> vec3f {
    let milne = body.milne / (body.extinction * max(found.density, DIFFUSION_THINNEST));
    let share = vec3f(
        diffusion_profile(depth, found.depth, milne.x),
        diffusion_profile(depth, found.depth, milne.y),
        diffusion_profile(depth, found.depth, milne.z),
    );
    var fluence = found.fluence * share;
    if (EFFECT_ENVIRONMENT) {
        fluence += outside * (1.0f - share);
    }
    return fluence;
}

// The index of refraction that light meets at the surface.
fn diffusion_index() -> f32 {
    if (EFFECT_DIELECTRIC) {
        return body.index;
    }
    return 1.0f;
}

// What light from all around is to the inside.
struct DiffusionAround {
    // Radiance inside, of light that comes alike from all around as much as falls on the surface.
    radiance: vec3f,
    // The fluence outside, of which `largest` counts as 1, in a medium of the body's index: at the point, and
    // where the eye's way may leave the body, which the surface faces about there.
    near: vec3f,
    far: vec3f,
    // Radiance that comes towards the eye from behind the body.
    behind: vec3f,
}

fn diffusion_around(normal: vec3f, toward_eye: vec3f) -> DiffusionAround {
    let weights = cdrf_harmonic_weights(0.0f);
    let squared = diffusion_index() * diffusion_index();
    let near = harmonics_irradiance(harmonics_around(normal), weights, weights, weights);
    let around = harmonics_around(-toward_eye);
    let far = harmonics_irradiance(around, weights, weights, weights);
    // The least of light that counts keeps a body that no light falls on from 0 / 0.
    let unit = 4.0f * squared / max(body.largest, vec3f(1.1754944e-38f));
    let behind = max(around.zeroth + around.first + around.second + around.fourth, vec3f(0.0f));
    return DiffusionAround(0.31830987f * squared * near, unit * near, unit * far, squared * behind);
}

// Radiance from all around that a rough surface mirrors, by the harmonics: microfacets of slope alpha leave
// exp(-(alpha l)^2) of those of degree l (Ramamoorthi and Hanrahan, "A Signal-Processing Framework for Inverse
// Rendering", 2001).
fn diffusion_around_mirrored(normal: vec3f, toward_eye: vec3f) -> vec3f {
    let around = harmonics_around(reflect(-toward_eye, normal));
    let squared = body.alpha * body.alpha;
    let first = exp(-squared) * around.first;
    let second = exp(-4.0f * squared) * around.second;
    let fourth = exp(-16.0f * squared) * around.fourth;
    return max(around.zeroth + first + second + fourth, vec3f(0.0f));
}

// Radiance towards the eye under a radiance of 1 from all around, by a half space. With a boundary it is that
// of diffusion.
fn diffusion_law_around(cosine: f32, gamma: f32) -> f32 {
    if (!EFFECT_DIELECTRIC) {  //+dielectric
        return half_space_directional(cosine, gamma);
    }  //+dielectric
    //+dielectric {
    let kappa = 1.7320508f * gamma;
    return (1.0f - gamma) * (1.0f + gamma) / ((1.0f + kappa * body.milne) * (1.0f + kappa * cosine));
    //+dielectric }
}

// Radiance of a half space per perpendicular irradiance 1, both inside: by the exact law.
fn diffusion_law(cosine_eye: f32, cosine_light: f32, gamma: f32, gain: f32) -> f32 {
    if (!EFFECT_DIELECTRIC) {  //+dielectric
        return cosine_light * half_space_brdf(cosine_eye, cosine_light, gamma);
    }  //+dielectric
    //+dielectric {
    return cosine_light * half_space_inside(cosine_eye, cosine_light, gamma, body.edge, gain);
    //+dielectric }
}

// What the exact law of a half space adds to diffusion's at an angle, in each channel. A boundary that throws
// light back makes it diffuse, and nothing is added.
fn diffusion_angles(cosine: f32) -> vec3f {
    if (EFFECT_DIELECTRIC) {
        return vec3f(1.0f);
    }
    let h = diffusion_h(cosine);
    return vec3f(
        diffusion_angle(cosine, h.x, body.h_normal.x, body.gamma.x, DIFFUSION_MILNE),
        diffusion_angle(cosine, h.y, body.h_normal.y, body.gamma.y, DIFFUSION_MILNE),
        diffusion_angle(cosine, h.z, body.h_normal.z, body.gamma.z, DIFFUSION_MILNE),
    );
}

// The way of the eye inside the body: where it is cut, and the light that is scattered there after it
// was scattered before.
struct DiffusionWay {
    // Length of the way up to each piece's end, in voxel spacings. In a vector, since an array whose index
    // varies is kept in memory.
    ends: vec4f,
    // Density at the surface, and at each piece's end: 0 where the way has left the body.
    surface: f32,
    densities: vec4f,
    // The mean of the density over each piece.
    means: vec4f,
    // Radiance towards the eye for an albedo of 4 pi.
    scattered: vec3f,
    // Radiance that comes straight through the body.
    straight: vec3f,
    // Mean depth of the nodes about the first point, in voxel spacings.
    depth: f32,
    // Share of the light along the way that collides before the way leaves the body: how much of a half space there is.
    covered: vec3f,
}

// What is known of the eye's way up to some point.
struct DiffusionEye {
    // In voxel spacings.
    way: f32,
    // Depth, density and filled share of the space there, and the largest of these shares so far.
    depth: f32,
    density: f32,
    filled: f32,
    fullest: f32,
    // The mean of the density over the piece up to there.
    mean: f32,
    // The fluence there, and the optical depth up to there.
    near: vec3f,
    gone: vec3f,
    scattered: vec3f,
}

//+extinction_per_voxel {
// The density of the voxel about a place, given in voxel spacings from the grid's corner; `otherwise` where
// there is no matter.
fn diffusion_density_about(place: vec3f, otherwise: f32) -> f32 {
    let voxel = vec3u(clamp(place, vec3f(0.0f), vec3f(f32(body.grid.cells - 1u))));
    let index = voxel.x + body.grid.cells * (voxel.y + body.grid.cells * voxel.z);
    return select(otherwise, max(density[index], DIFFUSION_THINNEST), diffusion_packed_volume(packed[index]) > 0.0f);
}

// Goes on from a place, about which the density is `dense`, until density times length is `wanted`, or beyond
// the matter.
// Returns: the length in voxel spacings, and the mean density.
fn diffusion_march(place: vec3f, along: vec3f, wanted: f32, dense: f32) -> vec2f {
    var way = min(wanted / dense, DIFFUSION_NEAR);
    var gone = way * dense;
    for (var turn = 0u; turn < DIFFUSION_TURNS && gone < 0.9999f * wanted; turn++) {
        // Next to the surface a voxel may hold no matter.
        let local = diffusion_density_about(place + (way + 0.5f) * along, select(-1.0f, dense, turn == 0u));
        if (local < 0.0f) {
            // Beyond the matter; the mean is that up to its end.
            return vec2f(way + 1.0f, gone / way);
        }
        let step = min((wanted - gone) / local, 1.0f);
        way += step;
        gone += step * local;
    }
    return vec2f(way, gone / way);
}

// The mean density along a way from a place, where it is `dense`.
fn diffusion_mean_density(place: vec3f, along: vec3f, way: f32, dense: f32) -> f32 {
    if (way <= DIFFUSION_NEAR) {
        return dense;
    }
    let count = u32(clamp(ceil(0.5f * way), 1.0f, DIFFUSION_TOWARDS));
    var sum = 0.0f;
    var local = dense;
    for (var step = 0u; step < count; step++) {
        local = diffusion_density_about(place + ((f32(step) + 0.5f) / f32(count) * way) * along, local);
        sum += local;
    }
    return sum / f32(count);
}
//+extinction_per_voxel }

// Adds a piece of the way, or begins it.
fn diffusion_piece(
    eye: ptr<function, DiffusionEye>,
    sample: DiffusionSample,
    before: f32,
    depth: f32,
    around: DiffusionAround,
    begins: bool
) {
    var below = depth;
    var outside = around.near;
    if (!begins) {
        // Towards the far side the fluence falls again, by about how much of the space is filled.
        let full = sample.filled / max((*eye).fullest, 1e-6f);
        let above = max(0.75f * (2.0f * full - 1.0f), 0.0f) / max(1.001f - full, 1e-3f);
        if (EFFECT_ENVIRONMENT) {
            outside = select(around.near, around.far, above < below);
        }
        below = min(below, above);
    }
    let found = diffusion_at_depth(sample, below);
    let far = diffusion_below(found, below, outside);
    if (!begins) {
        let thickness = body.extinction * ((*eye).mean * ((*eye).way - before));
        (*eye).scattered += exp(-(*eye).gone) * vec3f(
            diffusion_segment((*eye).near.x, far.x, thickness.x),
            diffusion_segment((*eye).near.y, far.y, thickness.y),
            diffusion_segment((*eye).near.z, far.z, thickness.z),
        );
        (*eye).gone += thickness;
    }
    (*eye).depth = found.depth;
    (*eye).density = found.density;
    (*eye).filled = found.filled;
    (*eye).near = far;
}

// The eye's way inside from a point of the surface; `toward_eye` and its cosine are those inside.
fn diffusion_inside(
    position: vec3f, toward_eye: vec3f, cosine_eye: f32, angles: vec3f, around: DiffusionAround
) -> DiffusionWay {
    // The same places for all channels.
    let most = max(body.extinction.x, max(body.extinction.y, body.extinction.z));
    // A channel that scatters nothing has nothing to integrate.
    let scattering = select(vec3f(most), body.extinction, body.gamma < vec3f(1.0f));
    let extinction = sqrt(min(scattering.x, min(scattering.y, scattering.z)) * most);
    let start = voxelization_local(body.grid, position);
    var inside: DiffusionWay;
    var eye: DiffusionEye;
    eye.density = 1.0f;
    var pieces = 0u;
    // The end before the one that lies outside, and how full the space is there.
    var left = false;
    var beyond = 0.0f;
    var before = 0.0f;
    for (var end = 0u; end <= DIFFUSION_PIECES; end++) {
        if (!left) {
            before = eye.way;
            if (end > 0u) {
                let wanted = DIFFUSION_STEPS[end - 1u] / extinction;
                eye.mean = max(eye.density, DIFFUSION_THINNEST);
                var length = wanted / eye.mean;
                //+extinction_per_voxel {
                if (EFFECT_EXTINCTION_PER_VOXEL && DIFFUSION_VARIED) {
                    let piece = diffusion_march(start - before * toward_eye, -toward_eye, wanted, eye.mean);
                    length = piece.x;
                    eye.mean = piece.y;
                }
                //+extinction_per_voxel }
                eye.way += length;
            }
            let found = diffusion_sample(start - eye.way * toward_eye);
            eye.fullest = max(eye.fullest, found.filled);
            left = end > 0u && found.filled < 0.5f * eye.fullest;
            if (left) {
                beyond = found.filled;
            } else {
                diffusion_piece(&eye, found, before, eye.way * cosine_eye, around, end == 0u);
            }
        }
        if (end == 0u) {
            inside.depth = eye.depth;
            inside.surface = eye.density;
        } else if (!left) {
            inside.ends[end - 1u] = eye.way;
            inside.densities[end - 1u] = eye.density;
            inside.means[end - 1u] = eye.mean;
            pieces = end;
        }
    }
    if (left) {
        // The way leaves the body about where the space is half as full as inside.
        let half_full = 0.5f * eye.fullest;
        let below = eye.way * cosine_eye;
        var inner = before;
        var outer = eye.way;
        // Between points much further apart than nodes, it is searched for first.
        for (var turn = 0u; turn < 6u && outer - inner > 3.0f; turn++) {
            let middle = diffusion_sample(start - 0.5f * (inner + outer) * toward_eye).filled;
            if (middle < half_full) {
                outer = 0.5f * (inner + outer);
                beyond = middle;
            } else {
                inner = 0.5f * (inner + outer);
                eye.filled = middle;
            }
        }
        let share = clamp((eye.filled - half_full) / max(eye.filled - beyond, 1e-6f), 0.0f, 1.0f);
        eye.way = mix(inner, outer, share);
        var found = diffusion_sample(start - eye.way * toward_eye);
        if (found.filled <= 0.0f) {
            // Where points are three spacings apart the guess may lie outside of all nodes.
            found = diffusion_sample(start - inner * toward_eye);
        }
        diffusion_piece(&eye, found, before, below, around, false);
        for (var end = 0u; end < DIFFUSION_PIECES; end++) {
            if (end >= pieces) {
                inside.ends[end] = eye.way;
                inside.densities[end] = 0.0f;
                inside.means[end] = eye.mean;
            }
        }
    } else {
        eye.scattered += exp(-eye.gone) * eye.near;
    }
    inside.scattered = body.largest * eye.scattered * angles;
    inside.straight = vec3f(0.0f);
    // The way is cut where it has passed all pieces, in the extinction that they count in; from there on there
    // is all of one.
    let passed = extinction * (eye.gone.x / body.extinction.x) / dot(DIFFUSION_STEPS, vec4f(1.0f));
    inside.covered = 1.0f - exp(-eye.gone / max(1.0f - passed, 1e-3f));
    if (EFFECT_ENVIRONMENT) {
        if (left) {
            // The angles' factor, since the local part is that of a half space, through which nothing comes.
            inside.straight = angles * exp(-eye.gone) * around.behind;
        }
    }
    return inside;
}

// The way of light from where it enters to a point inside, in voxel spacings, by the map of a view; 0
// outside the map. Of the four texels around, the shorter way lets more light through: a mean of
// 1 / (way + mean free path), so that an edge between texels leaks no streaks of the farther one.
fn diffusion_way(layer: u32, position: vec3f, toward_light: vec3f) -> f32 {
    let size = textureDimensions(maps).x;
    let clip = reflective_shadow_map_clip(views[layer].view, position);
    let place = reflective_shadow_map_texel(clip, f32(size));
    if (any(place < vec2f(0.0f)) || any(place > vec2f(f32(size)))) {
        return 0.0f;
    }
    let corner = floor(place - 0.5f);
    let weight = place - 0.5f - corner;
    let last = f32(size - 1u);
    var near = 0.0f;
    var whole = 0.0f;
    let free = 3.0f / (body.extinction.x + body.extinction.y + body.extinction.z);
    for (var index = 0u; index < 4u; index++) {
        let step = vec2f(f32(index & 1u), f32(index >> 1u));
        let texel = vec2u(clamp(corner + step, vec2f(0.0f), vec2f(last)));
        let seen = textureLoad(maps, texel, layer, 0);
        if (seen.w >= 0.0f) {
            let sides = step * weight + (1.0f - step) * (1.0f - weight);
            let share = sides.x * sides.y + 1e-4f;
            let way = max(dot(seen.xyz - position, toward_light), 0.0f) / body.grid.spacing;
            near += share / (way + free);
            whole += share;
        }
    }
    return max(whole / max(near, 1e-12f) - free, 0.0f);
}

// Light that is scattered towards the eye for the first time, summed piece by piece along the way of the eye inside.
struct DiffusionSingle {
    // Optical depth of the eye's way so far, and that towards the light at its end.
    gone: vec3f,
    near: vec3f,
    // Length of the way so far, and the density there.
    before: f32,
    last: f32,
}

// The end of a piece of the eye's way; number 0 is the surface.
struct DiffusionEnd {
    reached: f32,
    // 0 where the way has left the body.
    dense: f32,
    // The mean density over the piece before.
    mean: f32,
}

fn diffusion_end(inside: DiffusionWay, end: u32) -> DiffusionEnd {
    if (end == 0u) {
        return DiffusionEnd(0.0f, inside.surface, inside.surface);
    }
    return DiffusionEnd(inside.ends[end - 1u], inside.densities[end - 1u], inside.means[end - 1u]);
}

// The density on the way of light to an end, of which `start` and `toward_eye` tell the place. Where the eye's
// way leaves the body, light on its way to there goes through the matter before.
fn diffusion_density_towards(
    single: DiffusionSingle, place: DiffusionEnd, start: vec3f, toward_eye: vec3f, toward_light: vec3f, way: f32
) -> f32 {
    let dense = select(single.last, place.dense, place.dense > 0.0f);
    //+extinction_per_voxel {
    if (EFFECT_EXTINCTION_PER_VOXEL && DIFFUSION_VARIED) {
        return diffusion_mean_density(start - place.reached * toward_eye, toward_light, way, dense);
    }
    //+extinction_per_voxel }
    return dense;
}

// Goes on to an end with this optical depth towards the light, or begins there; returns what the piece sends,
// for an irradiance of 1.
fn diffusion_single_piece(
    single: ptr<function, DiffusionSingle>, place: DiffusionEnd, depth: vec3f, begins: bool
) -> vec3f {
    let far = min(depth, vec3f(30.0f));
    var sent = vec3f(0.0f);
    if (!begins) {
        let thickness = body.extinction * (place.mean * (place.reached - (*single).before));
        sent = exp(-(*single).gone) * vec3f(
            diffusion_unscattered(thickness.x, (*single).near.x, far.x),
            diffusion_unscattered(thickness.y, (*single).near.y, far.y),
            diffusion_unscattered(thickness.z, (*single).near.z, far.z),
        );
        (*single).gone += thickness;
    }
    (*single).near = far;
    (*single).before = place.reached;
    (*single).last = place.dense;
    return sent;
}

// Light that is scattered towards the eye for the first time, along the way inside from a point, away from
// `toward_eye`: radiance for an irradiance of 1 and an albedo of 4 pi. `cosines` are those of eye and light,
// `lit` is the share of the light that meets the first point.
fn diffusion_single(
    position: vec3f,
    toward_eye: vec3f,
    layer: u32,
    toward_light: vec3f,
    lit: f32,
    cosines: vec2f,
    inside: DiffusionWay
) -> vec3f {
    let start = voxelization_local(body.grid, position);
    var sum = vec3f(0.0f);
    var single: DiffusionSingle;
    single.last = inside.surface;
    for (var end = 0u; end <= DIFFUSION_PIECES; end++) {
        let place = diffusion_end(inside, end);
        // A texel spans much of the surface's height where light grazes it; a lit surface counts as flat there.
        let flat = place.reached * cosines.x / max(cosines.y, 0.02f);
        var flatness = lit * (1.0f - smoothstep(0.1f, 0.5f, cosines.y));
        if (EFFECT_DIELECTRIC) {
            // The map knows the way of light that is not refracted.
            flatness = lit;
        }
        // No way leads to where light arrives.
        flatness = select(flatness, lit, end == 0u);
        var way = flat;
        if (flatness < 1.0f) {
            let found = diffusion_way(layer, position - place.reached * body.grid.spacing * toward_eye, toward_light);
            way = mix(found, flat, flatness);
        }
        let depth = body.extinction
            * (diffusion_density_towards(single, place, start, toward_eye, toward_light, way) * way);
        sum += diffusion_single_piece(&single, place, depth, end == 0u);
    }
    return sum;
}

//+lamp_inside {
// Light of a lamp inside the body that is scattered towards the eye for the first time, along the way inside
// from a point: radiance for an albedo of 4 pi.
fn diffusion_single_of_lamp(light: Light, position: vec3f, toward_eye: vec3f, inside: DiffusionWay) -> vec3f {
    let spacing = body.grid.spacing;
    let start = voxelization_local(body.grid, position);
    var sum = vec3f(0.0f);
    var single: DiffusionSingle;
    single.last = inside.surface;
    for (var end = 0u; end <= DIFFUSION_PIECES; end++) {
        let place = diffusion_end(inside, end);
        let way = (light.place - (position - place.reached * spacing * toward_eye)) / spacing;
        // The grid knows nothing finer than half a spacing. Light falls off by the square of the distance as if by
        // an optical depth of its logarithm.
        let squared = max(dot(way, way), 0.25f);
        let toward_light = way * inverseSqrt(max(dot(way, way), 1e-12f));
        let dense = diffusion_density_towards(single, place, start, toward_eye, toward_light, sqrt(squared));
        let depth = body.extinction * (dense * sqrt(squared)) + log(4.0f * squared);
        let power = light_power(light, toward_light);
        sum += power * diffusion_single_piece(&single, place, depth, end == 0u);
    }
    return 4.0f / (spacing * spacing) * sum;
}
//+lamp_inside }

@fragment
fn diffusion_fragment(input: DiffusionVertex) -> @location(0) vec4f {
    let toward_eye = normalize(view.eye - input.position);
    let squared = dot(input.normal, input.normal);
    let normal = select(toward_eye, input.normal * inverseSqrt(max(squared, 1e-12f)), squared > 1e-12f);
    let cosine_outside = clamp(
        mesh_cosine_to_eye(normal, toward_eye, dpdx(input.position), dpdy(input.position)), 0.02f, 1.0f
    );
    let albedo = (1.0f - body.gamma) * (1.0f + body.gamma);
    // Inside of the surface.
    var cosine_eye = cosine_outside;
    var back = toward_eye;
    if (EFFECT_DIELECTRIC) {
        cosine_eye = half_space_refract(cosine_outside, body.index);
        back = normalize(toward_eye / body.index + (cosine_eye - cosine_outside / body.index) * normal);
    }
    var around: DiffusionAround;
    if (EFFECT_ENVIRONMENT) {
        around = diffusion_around(normal, back);
    }

    var sent = vec3f(0.0f);
    //+diffusion {
    var inside: DiffusionWay;
    var node = vec3f(0.0f);
    var gap = vec3f(0.0f);
    let angles = diffusion_angles(cosine_eye);
    if (EFFECT_DIFFUSION) {
        inside = diffusion_inside(input.position, back, cosine_eye, angles, around);
        sent = 0.07957747f * albedo * inside.scattered + inside.straight;
        // The two nodes below the point, of whose distances the local part is made.
        let start = voxelization_local(body.grid, input.position);
        let behind = diffusion_sample(start - normal * (inside.depth + 1.0f));
        let optical = body.extinction * inside.surface;
        node = optical * max(inside.depth, 1e-3f);
        gap = optical * clamp(behind.depth - inside.depth, 0.0f, 1.0f);
    }
    //+diffusion }
    var highlights = vec3f(0.0f);  //+microfacet
    // The views of a light are consecutive. At a seam between two views both see the point, but it
    // counts once.
    var counted = arrayLength(&lights);
    for (var layer = 0u; layer < arrayLength(&views); layer++) {
        let light = views[layer].light;
        let arrival = light_arrival(lights[light], input.position);
        let cosine = reflective_shadow_map_cosine(normal, arrival.direction);
        if (light == counted) {
            continue;
        }
        if (EFFECT_LAMP_INSIDE) {
            if (enclosed[light] != 0u) {
                continue;
            }
        }
        let visible = shadow_in_view(layer, input.position, normal);
        if (visible < 0.0f) {
            continue;
        }
        counted = light;
        let lit = select(0.0f, visible, cosine > 0.0f);
        // Behind the surface: the cosine, and the irradiance perpendicular to the light. Light that comes out
        // from the far side has entered there, at some angle.
        var cosine_light = cosine;
        var entered = arrival.irradiance;
        if (EFFECT_DIELECTRIC) {
            let met = select(1.0f, cosine, lit > 0.0f);
            cosine_light = half_space_refract(met, body.index);
            entered *= (1.0f - fresnel_dielectric(met, body.index)) * met / cosine_light;
        }
        if (EFFECT_DIFFUSION) {
            sent += 0.07957747f * albedo * entered * diffusion_single(
                input.position, back, layer, arrival.direction, lit, vec2f(cosine_eye, cosine_light), inside
            );
        }
        if (lit > 0.0f) {
            let law = vec3f(
                diffusion_law(cosine_eye, cosine_light, body.gamma.x, body.gain.x),
                diffusion_law(cosine_eye, cosine_light, body.gamma.y, body.gain.y),
                diffusion_law(cosine_eye, cosine_light, body.gamma.z, body.gain.z),
            );
            if (EFFECT_DIFFUSION) {
                let both = angles * diffusion_angles(cosine_light);
                sent += lit * entered * inside.covered * vec3f(
                    diffusion_local(cosine_eye, cosine_light, law.x, body.gamma.x, body.milne, node.x, gap.x, both.x),
                    diffusion_local(cosine_eye, cosine_light, law.y, body.gamma.y, body.milne, node.y, gap.y, both.y),
                    diffusion_local(cosine_eye, cosine_light, law.z, body.gamma.z, body.milne, node.z, gap.z, both.z),
                );
            }
            if (!EFFECT_DIFFUSION) {  //+diffusion
                sent += lit * entered * law;
            }  //+diffusion
            if (EFFECT_MICROFACET) {
                highlights += lit * reflection_highlight(arrival, normal, toward_eye, body.index, body.alpha);
            }
        }
    }
    //+diffusion {
    if (EFFECT_DIFFUSION) {
        //+lamp_inside {
        if (EFFECT_LAMP_INSIDE) {
            for (var light = 0u; light < arrayLength(&lights); light++) {
                if (enclosed[light] != 0u) {
                    sent += 0.07957747f * albedo * diffusion_single_of_lamp(
                        lights[light], input.position, back, inside
                    );
                }
            }
        }
        //+lamp_inside }
    }
    //+diffusion }
    if (EFFECT_ENVIRONMENT) {
        let law = vec3f(
            diffusion_law_around(cosine_eye, body.gamma.x),
            diffusion_law_around(cosine_eye, body.gamma.y),
            diffusion_law_around(cosine_eye, body.gamma.z),
        );
        if (EFFECT_DIFFUSION) {
            sent += around.radiance * vec3f(
                diffusion_local_around(cosine_eye, law.x, body.gamma.x, body.milne, node.x, gap.x, angles.x),
                diffusion_local_around(cosine_eye, law.y, body.gamma.y, body.milne, node.y, gap.y, angles.y),
                diffusion_local_around(cosine_eye, law.z, body.gamma.z, body.milne, node.z, gap.z, angles.z),
            );
        }
        if (!EFFECT_DIFFUSION) {  //+diffusion
            sent += around.radiance * law;
        }  //+diffusion
    }
    if (EFFECT_DIELECTRIC) {
        var passing = 1.0f - fresnel_dielectric(cosine_outside, body.index);
        if (EFFECT_REFLECTION) {
            // A polished surface's share is taken where its reflection is added.
            passing = select(passing, 1.0f, body.alpha == 0.0f);
        }
        sent *= passing / (body.index * body.index);
        if (EFFECT_ENVIRONMENT) {
            if (body.alpha > 0.0f) {
                sent += (1.0f - passing) * diffusion_around_mirrored(normal, toward_eye);
            }
        }
    }
    var radiance = sent;
    if (EFFECT_REFLECTION) {
        radiance = reflection_over(sent, normal, toward_eye, body.index, body.alpha);
    }
    if (EFFECT_MICROFACET) {
        if (body.alpha > 0.0f) {
            radiance += highlights;
        }
    }
    return vec4f(radiance, 1.0f);
}
