// diffusion_source: where light is first scattered: texels of the lights' maps send their light straight into the body.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: own; light that is not yet scattered as the source of diffusion as in Ishimaru, "Wave
//   Propagation and Scattering in Random Media", 1978, chapter 9.
// requires: diffusion, fresnel, half_space, reflective_shadow_map, voxelization
// parts: lights, light_views, diffusion_nodes, tiles
//
// Clear `loads`, then dispatch diffusion_source_texel with an invocation for each texel of each map. For lamps
// inside, dispatch diffusion_source_lamp with 2 cells^2 invocations for each light. Then dispatch
// diffusion_source_finish with a workgroup for each of the `tiles`, as the recipe diffusion_cells lists them.

// The extinction varies from voxel to voxel. Called for by extras.lapidary.veins, or by a grid of
// densities.
override EFFECT_EXTINCTION_PER_VOXEL: bool = false;
// Light from all around, which the recipe diffusion_cells has let in. Called for by an environment.
override EFFECT_ENVIRONMENT: bool = true;
// The surface refracts light, and reflects it back inside. Called for by KHR_materials_ior above 1.
override EFFECT_DIELECTRIC: bool = false;
// Lamps stand inside the body, and send their light through it from there. Called for by a lamp that the mesh encloses.
override EFFECT_LAMP_INSIDE: bool = false;

// Light that fills one voxel's face, as a number of units. Light is added up in whole numbers, so that
// its order makes no difference; sixteen times as much on every side of a voxel still fits.
const DIFFUSION_LIGHT: f32 = 16777216.0f;
// What is left of the light at this optical depth, 7e-3 of it, collides there.
const DIFFUSION_RAY_DEPTH: f32 = 5.0f;

struct DiffusionSource {
    grid: VoxelizationGrid,
    // Extinction per voxel spacing where the density is 1, in each channel.
    extinction: vec3f,
    // Milne's length in voxel spacings where the density is 1, in each channel.
    milne: vec3f,
    // The root of 1 - albedo, in each channel.
    gamma: vec3f,
    // The irradiance that counts as 1: at least the greatest that arrives at the body, and as much that the
    // light of all lamps inside fills a voxel's face sixteen times.
    largest: vec3f,
    // Index of refraction, relative to the medium outside.
    index: f32,
}

@group(0) @binding(0) var<uniform> source: DiffusionSource;
// Bindings 2, 4 and 5 belong to the parts.
@group(1) @binding(0) var<storage, read_write> loads: array<atomic<u32>>;
@group(1) @binding(1) var<storage, read> nodes: array<u32>;
// The grid of half the spacing, a bit for each voxel, in rows along x.
@group(1) @binding(2) var<storage, read> fine: array<u32>;
@group(1) @binding(3) var<storage, read> density: array<f32>;
// The right side of the equations, a number for each channel.
@group(1) @binding(4) var<storage, read_write> right: array<vec4f>;
// What the light from all around adds to it, three numbers for each voxel, as bits.
@group(1) @binding(5) var<storage, read> entering: array<u32>;
// Tiles of 4 x 4 x 4 voxels that hold matter.
@group(1) @binding(6) var<storage, read> tiles: array<u32>;
// For each light 1 if it is a lamp inside this body, else 0.
@group(1) @binding(7) var<storage, read> enclosed: array<u32>;

// The eight nodes around a point, and their shares in what lies between them.
struct DiffusionAround {
    // The number of each node's voxel.
    voxels: array<u32, 8>,
    // Weights that add up to 1; all 0 where there is no matter about the point.
    weights: array<f32, 8>,
    // The nodes' mean depth, in voxel spacings.
    depth: f32,
}

// The nodes around a point, given in voxel spacings from the grid's corner, and by its depth below the surface;
// a negative depth says that the nodes know it best.
fn diffusion_around(place: vec3f, below: f32, cells: u32) -> DiffusionAround {
    let last = f32(cells - 1u);
    let low = floor(place - 0.5f);
    let fraction = place - 0.5f - low;
    var around: DiffusionAround;
    var depths: array<f32, 8>;
    var whole = 0.0f;
    var depth = 0.0f;
    var square = 0.0f;
    var shallowest = DIFFUSION_NODE_DEPTH;
    var deepest = 0.0f;
    for (var corner = 0u; corner < 8u; corner++) {
        let step = vec3u(corner & 1u, (corner >> 1u) & 1u, corner >> 2u);
        let voxel = vec3u(clamp(low + vec3f(step), vec3f(0.0f), vec3f(last)));
        let index = voxel.x + cells * (voxel.y + cells * voxel.z);
        let word = nodes[index];
        let weight = diffusion_weight(fraction, corner, diffusion_volume(word));
        around.voxels[corner] = index;
        around.weights[corner] = weight;
        let of_node = diffusion_depth(word);
        depths[corner] = of_node;
        whole += weight;
        depth += weight * of_node;
        square += weight * of_node * of_node;
        if (weight > 0.0f) {
            shallowest = min(shallowest, of_node);
            deepest = max(deepest, of_node);
        }
    }
    let scale = select(0.0f, 1.0f / max(whole, 1e-12f), whole > 0.0f);
    depth *= scale;
    let variance = max(square * scale - depth * depth, 0.0f);
    var further = below - depth;
    if (EFFECT_LAMP_INSIDE) {
        further = select(further, 0.0f, below < 0.0f);
    }
    let slope = diffusion_slope(further, variance, depth - shallowest, deepest - depth);
    for (var corner = 0u; corner < 8u; corner++) {
        around.weights[corner] *= scale * max(1.0f + slope * (depths[corner] - depth), 0.0f);
    }
    around.depth = depth + slope * variance;
    return around;
}

// Whether the finer voxel around a place is filled.
fn diffusion_filled(place: vec3f) -> bool {
    let count = 2u * source.grid.cells;
    let voxel = vec3u(clamp(2.0f * place, vec3f(0.0f), vec3f(f32(count - 1u))));
    let words = (count + 31u) / 32u;
    return ((fine[words * (voxel.y + count * voxel.z) + voxel.x / 32u] >> (voxel.x % 32u)) & 1u) != 0u;
}

//+extinction_per_voxel {
// The density about a place; `otherwise` where there is no matter.
fn diffusion_density(place: vec3f, otherwise: f32) -> f32 {
    let cells = source.grid.cells;
    let voxel = vec3u(clamp(place, vec3f(0.0f), vec3f(f32(cells - 1u))));
    let index = voxel.x + cells * (voxel.y + cells * voxel.z);
    return select(otherwise, density[index], nodes[index] != 0u);
}
//+extinction_per_voxel }

// A difference of positions along the map, to the nearer of the two texels beside one.
fn diffusion_beside(texel: vec3u, step: vec2i, position: vec3f) -> vec3f {
    let last = vec2i(i32(textureDimensions(maps).x) - 1i);
    let after = textureLoad(maps, clamp(vec2i(texel.xy) + step, vec2i(0i), last), texel.z, 0);
    let before = textureLoad(maps, clamp(vec2i(texel.xy) - step, vec2i(0i), last), texel.z, 0);
    let forth = after.xyz - position;
    let back = position - before.xyz;
    let nearer = dot(forth, forth) < dot(back, back);
    return select(back, forth, select(after.w >= 0.0f, nearer, before.w >= 0.0f && after.w >= 0.0f));
}

// Where light goes on behind the surface: refracted at the plane through texels beside this one.
fn diffusion_entering(texel: vec3u, position: vec3f, toward_light: vec3f) -> vec3f {
    let across = cross(
        diffusion_beside(texel, vec2i(1i, 0i), position),
        diffusion_beside(texel, vec2i(0i, 1i), position),
    );
    let squared = dot(across, across);
    if (squared <= 0.0f) {
        return toward_light;
    }
    var normal = across * inverseSqrt(squared);
    normal = select(-normal, normal, dot(normal, toward_light) > 0.0f);
    let cosine = dot(normal, toward_light);
    let inside = half_space_refract(cosine, source.index);
    return normalize(toward_light / source.index + (inside - cosine / source.index) * normal);
}

// Sends light straight on into the body from a place on its surface, in voxel spacings from the grid's corner,
// or from one inside, and adds what is scattered to the nodes along the way. `back` points against the way,
// `cosine` is its cosine with the surface's normal, -1 from inside; `energy` is what all scattering makes of
// the light, in units of one that fills a voxel's face.
fn diffusion_march(entry: vec3f, back: vec3f, cosine: f32, energy: vec3f) {
    let cells = source.grid.cells;
    var gone = vec3f(0.0f);
    var way = 0.0f;
    var entered = false;
    var local = 1.0f;
    for (var step = 0u; step < 1024u; step++) {
        if (EFFECT_EXTINCTION_PER_VOXEL) {
            // The surface may pass a voxel that holds no matter, and so no density: then that of the next counts.
            let next = diffusion_density(entry - (way + 0.5f) * back, local);
            local = diffusion_density(entry - (way + 1e-3f) * back, next);
        }
        // Steps are an optical depth long, in the densest channel of which anything is left.
        let left = select(vec3f(0.0f), source.extinction, gone < vec3f(DIFFUSION_RAY_DEPTH));
        let densest = max(left.x, max(left.y, left.z));
        let length = min(0.75f, 1.0f / max(densest * local, 1e-6f));
        // Where the mean of what is scattered along the step lies.
        let middle = way + length * (0.5f - 0.083f * densest * local * length);
        let place = entry - middle * back;
        let inside = diffusion_filled(place);
        entered = entered || inside;
        // The surface cuts voxels, so that a ray may begin beside the first filled one.
        if ((!inside && (entered || middle > 1.2f)) || min(gone.x, min(gone.y, gone.z)) >= DIFFUSION_RAY_DEPTH) {
            break;
        }
        var thickness = source.extinction * (local * length);
        thickness = select(thickness, vec3f(2.0f * DIFFUSION_OPAQUE), gone + thickness >= vec3f(DIFFUSION_RAY_DEPTH));
        var below = middle * cosine;
        if (EFFECT_LAMP_INSIDE) {
            below = select(below, -1.0f, cosine < 0.0f);
        }
        let around = diffusion_around(place, below, cells);
        var depth = below;
        if (EFFECT_LAMP_INSIDE) {
            depth = select(below, around.depth, below < 0.0f);
        }
        var given = vec3f(0.0f);
        for (var channel = 0u; channel < 3u; channel++) {
            given[channel] = energy[channel] * diffusion_scattered(gone[channel], thickness[channel])
                * diffusion_profile(depth, around.depth, source.milne[channel] / max(local, DIFFUSION_THINNEST));
        }
        for (var corner = 0u; corner < 8u; corner++) {
            let node = around.voxels[corner];
            for (var channel = 0u; channel < 3u; channel++) {
                let units = u32(given[channel] * around.weights[corner] * DIFFUSION_LIGHT + 0.5f);
                if (units > 0u) {
                    atomicAdd(&loads[3u * node + channel], units);
                }
            }
        }
        gone += thickness;
        way += length;
    }
}

@compute @workgroup_size(8, 8)
fn diffusion_source_texel(@builtin(global_invocation_id) texel: vec3u) {
    let size = textureDimensions(maps).x;
    if (any(texel.xy >= vec2u(size))) {
        return;
    }
    let seen = textureLoad(maps, texel.xy, texel.z, 0);
    if (seen.w <= 0.0f) {
        return;
    }
    // The map also shows other bodies.
    let entry = voxelization_local(source.grid, seen.xyz);
    if (any(entry < vec3f(0.0f)) || any(entry > vec3f(f32(source.grid.cells)))) {
        return;
    }
    if (EFFECT_LAMP_INSIDE) {
        // What it sees through a hole, or of another body, is beyond the walls.
        if (enclosed[views[texel.z].light] != 0u) {
            return;
        }
    }
    let view = views[texel.z].view;
    let arrival = light_arrival(lights[views[texel.z].light], seen.xyz);
    let depth = select(1.0f, dot(seen.xyz - view.origin, view.axis), view.lamp == 1u);
    // The texel's width where the light meets the body, in voxel spacings. Of finer texels, only those
    // half a spacing apart send light, each for its neighbours too.
    let width = 2.0f * view.extent * depth / (f32(size) * source.grid.spacing);
    let stride = u32(clamp(floor(0.5f / max(width, 1e-6f)), 1.0f, 64.0f));
    if (any(texel.xy % vec2u(stride) != vec2u(stride / 2u))) {
        return;
    }
    // Coarser texels than the grid stand for what they hit alone, and the sums stay within their words.
    let side = min(width * f32(stride), 3.0f);
    let slant = select(1.0f, abs(dot(arrival.direction, view.axis)), view.lamp == 1u);
    let share = arrival.irradiance / source.largest * (side * side * slant);
    var cosine = seen.w;
    // Against the light's way inside.
    var back = arrival.direction;
    var energy = share * (1.0f - source.gamma) * (1.0f + source.gamma);
    if (EFFECT_DIELECTRIC) {  //+dielectric
        //+dielectric {
        energy *= 1.0f - fresnel_dielectric(cosine, source.index);
        back = diffusion_entering(texel, seen.xyz, arrival.direction);
        cosine = half_space_refract(cosine, source.index);
        //+dielectric }
    } else {  //+dielectric
        for (var channel = 0u; channel < 3u; channel++) {
            let gamma = source.gamma[channel];
            energy[channel] *= diffusion_angle(
                cosine, half_space_h(cosine, gamma), half_space_h(1.0f, gamma), gamma, DIFFUSION_MILNE
            );
        }
    }  //+dielectric
    diffusion_march(entry, back, cosine, energy);
}

//+lamp_inside {
// Unit vectors of a spiral over a lamp's sphere or a spot light's cone, as evenly spread as their number allows.
fn diffusion_ray(index: u32, count: u32, light: Light) -> vec3f {
    // 1 less the cosine from the axis, of which little is left where the cone is narrow.
    let below = (1.0f - light.edge) * ((f32(index) + 0.5f) / f32(count));
    // The golden angle as a share of 2^32; the product keeps the share of a whole turn.
    let turn = 6.2831853f * (f32((index * 2654435769u) >> 8u) / 16777216.0f);
    let across = sqrt(max(below * (2.0f - below), 0.0f)) * vec2f(cos(turn), sin(turn));
    // An orthonormal basis about the axis; a lamp has none.
    let axis = select(vec3f(0.0f, 0.0f, 1.0f), light.axis, any(light.axis != vec3f(0.0f)));
    let side = select(-1.0f, 1.0f, axis.z >= 0.0f);
    let a = -1.0f / (side + axis.z);
    let first = vec3f(1.0f + side * axis.x * axis.x * a, side * axis.x * axis.y * a, -side * axis.x);
    let second = vec3f(axis.x * axis.y * a, side + axis.y * axis.y * a, -axis.y);
    return across.x * first + across.y * second + (1.0f - below) * axis;
}
//+lamp_inside }

@compute @workgroup_size(64)
fn diffusion_source_lamp(@builtin(global_invocation_id) ray: vec3u) {
    //+lamp_inside {
    if (EFFECT_LAMP_INSIDE) {
        let count = 2u * source.grid.cells * source.grid.cells;
        if (ray.x < count && enclosed[ray.y] != 0u) {
            let lamp = lights[ray.y];
            let back = -diffusion_ray(ray.x, count, lamp);
            let spacing = source.grid.spacing;
            // The solid angle of a ray.
            let apart = 6.2831853f * (1.0f - lamp.edge) / f32(count);
            let share = light_power(lamp, back) * (apart / (spacing * spacing)) / source.largest;
            let energy = share * (1.0f - source.gamma) * (1.0f + source.gamma);
            diffusion_march(voxelization_local(source.grid, lamp.place), back, -1.0f, energy);
        }
    }
    //+lamp_inside }
}

@compute @workgroup_size(64)
fn diffusion_source_finish(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let cells = source.grid.cells;
    let place = tile_corner(tiles[group.x], cells) + tile_cell(lane);
    if (any(place >= vec3u(cells))) {
        return;
    }
    let voxel = place.x + cells * (place.y + cells * place.z);
    if (nodes[voxel] == 0u) {
        return;
    }
    let load = vec3f(vec3u(
        atomicLoad(&loads[3u * voxel]),
        atomicLoad(&loads[3u * voxel + 1u]),
        atomicLoad(&loads[3u * voxel + 2u]),
    ));
    var all = 3.0f * source.extinction * load / DIFFUSION_LIGHT;
    if (EFFECT_ENVIRONMENT) {
        all += bitcast<vec3f>(vec3u(entering[3u * voxel], entering[3u * voxel + 1u], entering[3u * voxel + 2u]));
    }
    right[voxel] = vec4f(all, 0.0f);
}
