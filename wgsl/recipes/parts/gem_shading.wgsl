// gem_shading: the shading that every gem recipe shares, so that the recipes differ in geometry alone.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: Imagire, "Proxy Geometry Gem Rendering", sections 3 and 4; Beer-Lambert; exact Fresnel.
// compares: dispersion
//
// A geometry recipe adds: the parts surroundings, bodies, beside, lights, glints and screen, and mesh if it
// reads one; struct GemVertex, whose members include `position`, `face_normal` and, with instances, `instance`;
// the entry point gem_vertex; struct GemPlace (the place of a ray inside the stone); gem_enter (the place of a
// ray that enters); gem_hit (the next facet); and gem_hit_both (the next facets of two rays that may share a
// search).

// A wall without an interior: the environment behind it shows undeflected below the reflection.
// Called for by KHR_materials_transmission without a thickness from KHR_materials_volume.
override EFFECT_THIN_WALL: bool = false;
// Light is absorbed on its way through the inside. Called for by KHR_materials_volume with an
// attenuation colour below white.
override EFFECT_ABSORPTION: bool = false;
// The refractive index depends on the wavelength. Called for by KHR_materials_dispersion above 0.
override EFFECT_DISPERSION: bool = false;
// The stone is drawn many times in one draw call, at places and in colours of their own. Called for
// by EXT_mesh_gpu_instancing.
override EFFECT_INSTANCES: bool = false;
// How dispersion is traced: 0 the paper's tracker, 1 the exact first-order tracker, 2 one ray per
// wavelength, 3 a ray for blue and one for green, from which red is tracked.
override DISPERSION_FORM: u32 = 1u;
// Number of entries of `wavelengths` that form 2 traces.
override WAVELENGTHS: u32 = 3u;
// Number of internal hits that are followed.
override BOUNCES: u32 = 1u;
// The light that a ray still carries when it ends is taken from the environment along the ray, which
// keeps the energy and guesses the direction. A ray ends at the last bounce, at the distance limit, or
// where it meets no facet. If false, that light is dropped, which darkens the stone.
override REST_FROM_ENVIRONMENT: bool = true;
// A ray also ends where any of its light can leave: all of it then leaves there, which keeps the energy
// and drops what would be reflected on. Channels that are totally reflected go on.
override END_AT_FIRST_EXIT: bool = false;
// A ray also ends once it has travelled farther than material.distance_limit inside.
override LIMIT_DISTANCE: bool = false;
// A ray also ends when its light can no longer be seen: when no channel's throughput reaches
// material.throughput_limit.
override LIMIT_THROUGHPUT: bool = false;

const GEM_DISPERSION_PAPER: u32 = 0u;
const GEM_DISPERSION_SEPARATE: u32 = 2u;
const GEM_DISPERSION_SPLIT: u32 = 3u;

// Farther than anything that a ray may meet.
const GEM_FAR = 1e37f;

struct GemView {
    clip_from_world: mat4x4f,
    eye: vec3f,
}

struct GemMaterial {
    // Factor for light that passes through the surface, linear RGB.
    base_color: vec3f,
    // Index of refraction at the d line, relative to the medium outside.
    index: f32,
    // Absorption per unit of length: absorption_coefficient of the attenuation colour and distance.
    absorption: vec3f,
    // Distance inside at which LIMIT_DISTANCE ends a ray, in units of length.
    distance_limit: f32,
    // Indices of refraction at DISPERSION_RED, DISPERSION_GREEN, DISPERSION_BLUE.
    channel_indices: vec3f,
    // Factor of eq. (12) in the paper's tracker; 1 as printed.
    dispersion_strength: f32,
    // Throughput below which LIMIT_THROUGHPUT ends a ray: the smallest visible difference, divided
    // by the exposure, the largest base colour and the largest radiance of the environment. With
    // separate wavelengths it is also divided by the largest sum of absolute values in a row, taken
    // over all their weights.
    throughput_limit: f32,
}

// One of the wavelengths that form 2 traces.
struct GemWavelength {
    // Contribution of its radiance to the pixel's, both in linear RGB; the matrices of all
    // wavelengths add up to the identity.
    weights: mat3x3f,
    // Index of refraction at this wavelength.
    index: f32,
}

//+instances {
// A copy of the stone. Directions, positions and lengths inside are those of the stone's own space.
struct GemInstance {
    // Rows of the matrix from the stone's space to world space: a rotation, a scale that is the same
    // in all directions, and a translation.
    world_from_stone: mat3x4f,
    // Factor for light that passes through the surface, linear RGB, in place of the material's.
    base_color: vec3f,
    // Absorption per unit of length in world space, in place of the material's.
    absorption: vec3f,
}
//+instances }

// The camera.
@group(0) @binding(0) var<uniform> view: GemView;
// The stone's material. Not a uniform: lavapipe recompiles the shader for every uniform buffer that it is drawn with,
// which costs megabytes per body.
@group(1) @binding(0) var<storage, read> material: GemMaterial;
// Three floats per vertex, in world space; with instances, in the stone's own space.
@group(1) @binding(1) var<storage, read> positions: array<f32>;
@group(1) @binding(2) var<storage, read> indices: array<u32>;
// Those of form 2 of dispersion; one of any value otherwise.
@group(1) @binding(3) var<storage, read> wavelengths: array<GemWavelength>;
// The copies, in the order of their draw; one of any value without the effect.
@group(1) @binding(4) var<storage, read> instances: array<GemInstance>;  //+instances

// The next facet that a ray meets inside the stone.
struct GemHit {
    point: vec3f,
    // Unit normal, facing the ray.
    normal: vec3f,
    // Distance along the ray.
    distance: f32,
    hit: bool,
}

// The next facets of two rays.
struct GemHits {
    first: GemHit,
    second: GemHit,
}

//+instances {
// The copy that a fragment belongs to.
struct GemCopy {
    // Columns that are the rows of its rotation from the stone's space to world space.
    rotation: mat3x3f,
    // Length in world space of a unit of length in the stone's space.
    scale: f32,
    translation: vec3f,
    base_color: vec3f,
    // Absorption per unit of length in the stone's space.
    absorption: vec3f,
}

var<private> gem_copy: GemCopy;

fn gem_copy_of(instance: GemInstance) -> GemCopy {
    let rows = instance.world_from_stone;
    let scale = length(rows[0].xyz);
    let rotation = mat3x3f(rows[0].xyz / scale, rows[1].xyz / scale, rows[2].xyz / scale);
    let translation = vec3f(rows[0].w, rows[1].w, rows[2].w);
    return GemCopy(rotation, scale, translation, instance.base_color, scale * instance.absorption);
}
//+instances }

// The eye in the stone's space; with instances, also looks up the copy.
fn gem_eye(input: GemVertex) -> vec3f {
    if (EFFECT_INSTANCES) {
        gem_copy = gem_copy_of(instances[input.instance]);
        return gem_copy.rotation * (view.eye - gem_copy.translation) / gem_copy.scale;
    }
    return view.eye;
}

// The point where a vertex of the stone is drawn.
fn gem_clip(
    position: vec3f,
    instance: u32,  //+instances
) -> vec4f {
    if (EFFECT_INSTANCES) {
        return view.clip_from_world * vec4f(vec4f(position, 1.0f) * instances[instance].world_from_stone, 1.0f);
    }
    return view.clip_from_world * vec4f(position, 1.0f);
}

// World direction of a direction in the stone's space.
fn gem_world_direction(direction: vec3f) -> vec3f {
    if (EFFECT_INSTANCES) {
        return direction * gem_copy.rotation;
    }
    return direction;
}

// World length of a length in the stone's space.
fn gem_world_length(length_inside: f32) -> f32 {
    if (EFFECT_INSTANCES) {
        return gem_copy.scale * length_inside;
    }
    return length_inside;
}

// World position of a position in the stone's space.
fn gem_world_position(position: vec3f) -> vec3f {
    if (EFFECT_INSTANCES) {
        return gem_copy.scale * (position * gem_copy.rotation) + gem_copy.translation;
    }
    return position;
}

// What a ray that leaves the stone meets, before the environment.
struct GemMeeting {
    // Distance of a body that the picture shows, in lengths of the direction; below 0 if there is none.
    distance: f32,
    // Whether a body's triangles or bounds are met, and the radiance that it sends.
    is_bounded: bool,
    bounded: vec3f,
}

// Looks for what a ray meets, both in the stone's space.
fn gem_meeting(position: vec3f, direction: vec3f) -> GemMeeting {
    var meeting = GemMeeting(-1.0f, false, vec3f(0.0f));
    if (EFFECT_SCREEN_TRACE) {
        meeting.distance = screen_distance(gem_world_position(position), gem_world_direction(direction));
    }
    if (EFFECT_AROUND) {
        let met = beside_met(gem_world_position(position), gem_world_direction(direction), GEM_FAR);  //+around
        meeting.is_bounded = met.w >= 0.0f;  //+around
        meeting.bounded = met.rgb;  //+around
    }
    if (EFFECT_BOUNDS_TRACE) {
        let hit = bodies_hit(gem_world_position(position), gem_world_direction(direction));
        if (hit.number != BODIES_NONE) {
            meeting.is_bounded = true;
            meeting.bounded = bodies_radiance(hit, gem_world_position(position), gem_world_direction(direction));
        }
    }
    return meeting;
}

// Radiance that arrives along a ray, given what a ray beside it meets: the colours of one pixel leave
// a facet together.
fn gem_arriving(meeting: GemMeeting, position: vec3f, direction: vec3f) -> vec3f {
    if (EFFECT_SCREEN_TRACE) {
        if (meeting.distance >= 0.0f) {
            let seen = screen_seen(gem_world_position(position) + meeting.distance * gem_world_direction(direction));
            if (seen.a > 0.0f) {
                return seen.rgb;
            }
        }
    }
    if (EFFECT_AROUND) {
        if (meeting.is_bounded) {
            return meeting.bounded;
        }
    }
    if (EFFECT_BOUNDS_TRACE) {
        if (meeting.is_bounded) {
            return meeting.bounded;
        }
    }
    if (EFFECT_LIGHT) {
        return gem_lit(gem_world_position(position), gem_world_direction(direction));  //+light
    }
    return surroundings_radiance(gem_world_direction(direction));
}

//+light {
// Whether what is looked up stands in for the rest of a ray's light, whose direction is a guess.
var<private> gem_guesses: bool;

// Radiance of the environment and of lights, in world space.
fn gem_lit(position: vec3f, direction: vec3f) -> vec3f {
    let around = surroundings_radiance(direction);
    if (gem_guesses) {
        return around;
    }
    return around + glints_radiance(position, direction, view.eye);
}
//+light }

// Radiance that arrives at a position from a direction, both in the stone's space.
fn gem_surroundings(position: vec3f, direction: vec3f) -> vec3f {
    return gem_arriving(gem_meeting(position, direction), position, direction);
}

fn gem_base_color() -> vec3f {
    if (EFFECT_INSTANCES) {
        return gem_copy.base_color;
    }
    return material.base_color;
}

// The share of light that absorption leaves over a distance inside.
//+absorption {
fn gem_transmittance(distance: f32) -> vec3f {
    if (EFFECT_INSTANCES) {
        return absorption_transmittance(gem_copy.absorption, distance);
    }
    return absorption_transmittance(material.absorption, distance);
}
//+absorption }

// The direction of a ray that leaves through a facet, and its share of the light.
struct GemExit {
    direction: vec3f,
    // 0 under total internal reflection.
    share: f32,
}

fn gem_exit(inside: vec3f, normal: vec3f, index: f32) -> GemExit {
    let leaving = refraction_refract(inside, normal, 1.0f / index);
    if (leaving.total) {
        return GemExit(inside, 0.0f);
    }
    return GemExit(leaving.direction, 1.0f - fresnel_dielectric(-dot(normal, inside), 1.0f / index));
}

// The direction of a channel that leaves: green's, or red's or blue's where green is totally reflected.
fn gem_lead(red: GemExit, green: GemExit, blue: GemExit) -> vec3f {
    let other = select(blue.direction, red.direction, red.share > 0.0f);
    return select(other, green.direction, green.share > 0.0f);
}

// Whether a ray ends after it has travelled this distance.
fn gem_ends(travelled: f32) -> bool {
    return LIMIT_DISTANCE && gem_world_length(travelled) > material.distance_limit;
}

// A ray inside the stone.
struct GemRay {
    position: vec3f,
    // Unit vector.
    direction: vec3f,
    // Distance inside so far.
    travelled: f32,
    // Share of light that the ray still carries, per channel.
    throughput: vec3f,
    // Radiance found so far.
    radiance: vec3f,
    // False once the ray has ended; its throughput then weights the rest.
    followed: bool,
}

fn gem_ray(position: vec3f, direction: vec3f) -> GemRay {
    return GemRay(position, direction, 0.0f, vec3f(1.0f), vec3f(0.0f), true);
}

// Takes a ray as far as its next facet. Returns whether it is followed there. The loops below `break`
// only with LIMIT_THROUGHPUT or END_AT_FIRST_EXIT: without a `break` a compiler may unroll them, and
// few rays end before the last bounce for other reasons.
fn gem_arrive(ray: ptr<function, GemRay>, hit: GemHit) -> bool {
    if ((*ray).followed) {
        (*ray).travelled += hit.distance;
        (*ray).followed = hit.hit && !gem_ends((*ray).travelled);
    }
    var way = hit.distance;
    var met = vec4f(0.0f, 0.0f, 0.0f, -1.0f);
    if (EFFECT_AROUND) {
        if (EFFECT_NESTED && (*ray).followed) {
            let within = gem_world_length(hit.distance);  //+around,nested
            let start = gem_world_position((*ray).position);  //+around,nested
            met = beside_met(start, gem_world_direction((*ray).direction), within);  //+around,nested
            way *= select(1.0f, met.w / within, met.w >= 0.0f && within > 0.0f);  //+around,nested
        }
    }
    if (EFFECT_ABSORPTION && (*ray).followed) {
        (*ray).throughput *= gem_transmittance(way);
    }
    if (EFFECT_AROUND) {
        if (EFFECT_NESTED && met.w >= 0.0f) {
            // Nothing of the light comes back from there.
            (*ray).radiance += (*ray).throughput * met.rgb;
            (*ray).throughput = vec3f(0.0f);
            (*ray).followed = false;
        }
    }
    return (*ray).followed;
}

// Lets a share of each channel leave and adds the radiance that it meets outside.
fn gem_leave(ray: ptr<function, GemRay>, share: vec3f, outside: vec3f) {
    var left = share;
    if (END_AT_FIRST_EXIT) {
        left = ceil(share);
    }
    (*ray).radiance += left * (*ray).throughput * outside;
    (*ray).throughput *= 1.0f - left;
}

// Reflects the rest, which is followed further if it can be seen.
fn gem_reflect(ray: ptr<function, GemRay>, hit: GemHit) {
    (*ray).position = hit.point;
    (*ray).direction = refraction_reflect((*ray).direction, hit.normal);
    if (END_AT_FIRST_EXIT) {
        (*ray).followed = any((*ray).throughput > vec3f(0.0f));
    }
    if (LIMIT_THROUGHPUT) {
        let throughput = (*ray).throughput;
        (*ray).followed = max(max(throughput.r, throughput.g), throughput.b) >= material.throughput_limit;
    }
}

// The total radiance of a ray that has ended: the radiance found, and what lies outside for the rest.
fn gem_end(ray: GemRay, outside: vec3f) -> vec3f {
    return ray.radiance + ray.throughput * outside;
}

// Radiance that a ray of one refractive index finds inside the stone. At each facet, a share leaves
// and meets the environment; the rest is reflected and followed further.
fn gem_trace(input: GemVertex, direction: vec3f, index: f32) -> vec3f {
    if (EFFECT_LIGHT) {
        gem_guesses = false;  //+light
    }
    var place = gem_enter(input);
    var ray = gem_ray(input.position, refraction_refract(direction, input.face_normal, index).direction);
    for (var bounce = 0u; bounce < BOUNCES; bounce++) {
        if ((LIMIT_THROUGHPUT || END_AT_FIRST_EXIT) && !ray.followed) {
            break;
        }
        let hit = gem_hit(&place, ray);
        if (gem_arrive(&ray, hit)) {
            let exit = gem_exit(ray.direction, hit.normal, index);
            if (exit.share > 0.0f) {
                gem_leave(&ray, vec3f(exit.share), gem_surroundings(hit.point, exit.direction));
            }
            gem_reflect(&ray, hit);
        }
    }
    if (EFFECT_LIGHT) {
        gem_guesses = true;  //+light
    }
    if (REST_FROM_ENVIRONMENT) {
        return gem_end(ray, gem_surroundings(ray.position, ray.direction));
    }
    return ray.radiance;
}

// Radiance that arrives at a position from three directions, one per channel. `lead` is the one that
// is followed to other bodies.
fn gem_surroundings_channels(position: vec3f, lead: vec3f, red: vec3f, green: vec3f, blue: vec3f) -> vec3f {
    let meeting = gem_meeting(position, lead);
    return vec3f(
        gem_arriving(meeting, position, red).r,
        gem_arriving(meeting, position, green).g,
        gem_arriving(meeting, position, blue).b,
    );
}

fn gem_surroundings_red_green(position: vec3f, lead: vec3f, red: vec3f, green: vec3f) -> vec3f {
    let meeting = gem_meeting(position, lead);
    return vec3f(gem_arriving(meeting, position, red).r, gem_arriving(meeting, position, green).g, 0.0f);
}

fn gem_surroundings_blue(position: vec3f, blue: vec3f) -> vec3f {
    return vec3f(0.0f, 0.0f, gem_surroundings(position, blue).b);
}

// Radiance of three channels inside the stone, from one ray at the d line and its derivative with
// respect to the refractive index. The derivative gives each channel's ray inside. At a facet that
// ray is refracted with the channel's own index, so total internal reflection and reflectance are
// the channel's own, and the derivative's pole at the critical angle never occurs.
fn gem_trace_tracked(input: GemVertex, direction: vec3f) -> vec3f {
    let offsets = material.channel_indices - material.index;
    if (EFFECT_LIGHT) {
        gem_guesses = false;  //+light
    }
    var place = gem_enter(input);
    var ray = gem_ray(input.position, refraction_refract(direction, input.face_normal, material.index).direction);
    var gradient = dispersion_enter(direction, input.face_normal, material.index);
    for (var bounce = 0u; bounce < BOUNCES; bounce++) {
        if ((LIMIT_THROUGHPUT || END_AT_FIRST_EXIT) && !ray.followed) {
            break;
        }
        let hit = gem_hit(&place, ray);
        if (gem_arrive(&ray, hit)) {
            let red = gem_exit(
                dispersion_direction(ray.direction, gradient, offsets.r), hit.normal, material.channel_indices.r
            );
            let green = gem_exit(
                dispersion_direction(ray.direction, gradient, offsets.g), hit.normal, material.channel_indices.g
            );
            let blue = gem_exit(
                dispersion_direction(ray.direction, gradient, offsets.b), hit.normal, material.channel_indices.b
            );
            let share = vec3f(red.share, green.share, blue.share);
            if (any(share > vec3f(0.0f))) {
                let lead = gem_lead(red, green, blue);
                let outside = gem_surroundings_channels(
                    hit.point, lead, red.direction, green.direction, blue.direction
                );
                gem_leave(&ray, share, outside);
            }
            gem_reflect(&ray, hit);
            gradient = dispersion_reflect(gradient, hit.normal);
        }
    }
    if (EFFECT_LIGHT) {
        gem_guesses = true;  //+light
    }
    if (REST_FROM_ENVIRONMENT) {
        return gem_end(ray, gem_surroundings_channels(
            ray.position,
            ray.direction,
            dispersion_direction(ray.direction, gradient, offsets.r),
            dispersion_direction(ray.direction, gradient, offsets.g),
            dispersion_direction(ray.direction, gradient, offsets.b),
        ));
    }
    return ray.radiance;
}

// Radiance of three channels inside the stone, from two rays. What one ray cannot show is that the
// colours part: at an edge each goes on to a facet of its own. Blue's index is twice as far from
// green's as red's is, so that blue has a ray, and red is tracked from green's. As long as both rays
// meet the same facets, one search finds them.
fn gem_trace_split(input: GemVertex, direction: vec3f) -> vec3f {
    let channels = material.channel_indices;
    let offset = channels.r - channels.g;
    if (EFFECT_LIGHT) {
        gem_guesses = false;  //+light
    }
    var place = gem_enter(input);
    var place_blue = place;
    var ray = gem_ray(input.position, refraction_refract(direction, input.face_normal, channels.g).direction);
    var blue = gem_ray(input.position, refraction_refract(direction, input.face_normal, channels.b).direction);
    ray.throughput = vec3f(1.0f, 1.0f, 0.0f);
    blue.throughput = vec3f(0.0f, 0.0f, 1.0f);
    var gradient = dispersion_enter(direction, input.face_normal, channels.g);
    for (var bounce = 0u; bounce < BOUNCES; bounce++) {
        if ((LIMIT_THROUGHPUT || END_AT_FIRST_EXIT) && !ray.followed && !blue.followed) {
            break;
        }
        let hits = gem_hit_both(&place, ray, &place_blue, blue);
        if (gem_arrive(&ray, hits.first)) {
            let red = gem_exit(dispersion_direction(ray.direction, gradient, offset), hits.first.normal, channels.r);
            let green = gem_exit(ray.direction, hits.first.normal, channels.g);
            if (red.share > 0.0f || green.share > 0.0f) {
                let lead = gem_lead(red, green, green);
                let outside = gem_surroundings_red_green(hits.first.point, lead, red.direction, green.direction);
                gem_leave(&ray, vec3f(red.share, green.share, 0.0f), outside);
            }
            gem_reflect(&ray, hits.first);
            gradient = dispersion_reflect(gradient, hits.first.normal);
        }
        if (gem_arrive(&blue, hits.second)) {
            let exit = gem_exit(blue.direction, hits.second.normal, channels.b);
            if (exit.share > 0.0f) {
                gem_leave(&blue, vec3f(0.0f, 0.0f, exit.share),
                    gem_surroundings_blue(hits.second.point, exit.direction));
            }
            gem_reflect(&blue, hits.second);
        }
    }
    if (EFFECT_LIGHT) {
        gem_guesses = true;  //+light
    }
    if (REST_FROM_ENVIRONMENT) {
        let red = dispersion_direction(ray.direction, gradient, offset);
        let outside = gem_surroundings_red_green(ray.position, ray.direction, red, ray.direction);
        return gem_end(ray, outside) + gem_end(blue, gem_surroundings_blue(blue.position, blue.direction));
    }
    return ray.radiance + blue.radiance;
}

// Radiance around a red ray, with green and blue shifted along the paper's direction of dispersion,
// eq. (12).
fn gem_surroundings_paper(position: vec3f, red: vec3f, spread: vec3f, travelled_inside: f32) -> vec3f {
    let travelled = gem_world_length(travelled_inside);
    return gem_surroundings_channels(
        position,
        red,
        red,
        dispersion_paper_direction(red, spread, travelled, DISPERSION_PAPER_GREEN, material.dispersion_strength),
        dispersion_paper_direction(red, spread, travelled, DISPERSION_PAPER_BLUE, material.dispersion_strength),
    );
}

// Radiance of three channels by the paper's tracker, eq. (10) to (12): a red ray and a direction of
// dispersion.
fn gem_trace_paper(input: GemVertex, direction: vec3f) -> vec3f {
    let index = material.channel_indices.r;
    if (EFFECT_LIGHT) {
        gem_guesses = false;  //+light
    }
    var place = gem_enter(input);
    var ray = gem_ray(input.position, refraction_refract(direction, input.face_normal, index).direction);
    var spread = dispersion_paper_enter(direction, ray.direction);
    for (var bounce = 0u; bounce < BOUNCES; bounce++) {
        if ((LIMIT_THROUGHPUT || END_AT_FIRST_EXIT) && !ray.followed) {
            break;
        }
        let hit = gem_hit(&place, ray);
        if (gem_arrive(&ray, hit)) {
            let exit = gem_exit(ray.direction, hit.normal, index);
            if (exit.share > 0.0f) {
                let leaving = dispersion_paper_refract(
                    ray.direction, spread, hit.normal, 1.0f / index, DISPERSION_PAPER_EPSILON
                );
                let outside = gem_surroundings_paper(hit.point, exit.direction, leaving, ray.travelled);
                gem_leave(&ray, vec3f(exit.share), outside);
            }
            spread = dispersion_paper_reflect(ray.direction, spread, hit.normal, DISPERSION_PAPER_EPSILON);
            gem_reflect(&ray, hit);
        }
    }
    if (EFFECT_LIGHT) {
        gem_guesses = true;  //+light
    }
    if (REST_FROM_ENVIRONMENT) {
        return gem_end(ray, gem_surroundings_paper(ray.position, ray.direction, spread, ray.travelled));
    }
    return ray.radiance;
}

// Radiance that a stone sends to the eye.
struct GemRadiance {
    // Reflection of the environment in the surface.
    surface: vec3f,
    // Light from inside.
    inside: vec3f,
    // Reflectance of the surface, per channel.
    reflectance: vec3f,
}

// Reflectance of the surface at each channel's own index.
fn gem_reflectance_channels(cosine: f32) -> vec3f {
    return vec3f(
        fresnel_dielectric(cosine, material.channel_indices.r),
        fresnel_dielectric(cosine, material.channel_indices.g),
        fresnel_dielectric(cosine, material.channel_indices.b),
    );
}

// Radiance of the stone towards the eye. If `transmits` is false, only the surface contributes.
fn gem_radiance(
    input: GemVertex,
    transmits: bool,  //+bvh_trace,convex_trace,proxy_geometry
) -> GemRadiance {
    let direction = normalize(input.position - gem_eye(input));
    let cosine = clamp(-dot(input.face_normal, direction), 0.0f, 1.0f);
    let reflected = gem_surroundings(input.position, refraction_reflect(direction, input.face_normal));
    if (EFFECT_THIN_WALL) {
        // Light goes back and forth between the wall's two interfaces.
        let once = fresnel_dielectric(cosine, material.index);
        let reflectance = vec3f(2.0f * once / (1.0f + once));
        let behind = gem_surroundings(input.position, direction);
        return GemRadiance(reflectance * reflected, (1.0f - reflectance) * gem_base_color() * behind, reflectance);
    }
    if (EFFECT_DISPERSION && DISPERSION_FORM == GEM_DISPERSION_SEPARATE) {
        var separate = GemRadiance(vec3f(0.0f), vec3f(0.0f), vec3f(0.0f));
        for (var wavelength = 0u; wavelength < WAVELENGTHS; wavelength++) {
            let weights = wavelengths[wavelength].weights;
            let index = wavelengths[wavelength].index;
            let reflectance = fresnel_dielectric(cosine, index);
            separate.surface += weights * (reflectance * reflected);
            // Reflectance for white light.
            separate.reflectance += weights * vec3f(reflectance);
            if (transmits) {  //+bvh_trace,convex_trace,proxy_geometry
                separate.inside += weights  //+bvh_trace,convex_trace,proxy_geometry
                    * ((1.0f - reflectance)  //+bvh_trace,convex_trace,proxy_geometry
                    * gem_trace(input, direction, index));  //+bvh_trace,convex_trace,proxy_geometry
            }  //+bvh_trace,convex_trace,proxy_geometry
        }
        if (transmits) {  //+bvh_trace,convex_trace,proxy_geometry
            separate.inside *= gem_base_color();  //+bvh_trace,convex_trace,proxy_geometry
        }  //+bvh_trace,convex_trace,proxy_geometry
        return separate;
    }
    var reflectance = vec3f(fresnel_dielectric(cosine, material.index));
    var inside = vec3f(0.0f);  //+bvh_trace,convex_trace,proxy_geometry
    if (!EFFECT_DISPERSION) {  //+dispersion
        if (transmits) {  //+bvh_trace,convex_trace,proxy_geometry
            inside = gem_trace(input, direction, material.index);  //+bvh_trace,convex_trace,proxy_geometry
        }  //+bvh_trace,convex_trace,proxy_geometry
    //+dispersion {
    } else if (DISPERSION_FORM == GEM_DISPERSION_PAPER) {
        if (transmits) {  //+bvh_trace,convex_trace,proxy_geometry
            inside = gem_trace_paper(input, direction);  //+bvh_trace,convex_trace,proxy_geometry
        }  //+bvh_trace,convex_trace,proxy_geometry
    } else if (DISPERSION_FORM == GEM_DISPERSION_SPLIT) {
        reflectance = gem_reflectance_channels(cosine);
        if (transmits) {  //+bvh_trace,convex_trace,proxy_geometry
            inside = gem_trace_split(input, direction);  //+bvh_trace,convex_trace,proxy_geometry
        }  //+bvh_trace,convex_trace,proxy_geometry
    } else {
        reflectance = gem_reflectance_channels(cosine);
        if (transmits) {  //+bvh_trace,convex_trace,proxy_geometry
            inside = gem_trace_tracked(input, direction);  //+bvh_trace,convex_trace,proxy_geometry
        }  //+bvh_trace,convex_trace,proxy_geometry
    }
    //+dispersion }
    if (transmits) {  //+bvh_trace,convex_trace,proxy_geometry
        inside *= (1.0f - reflectance) * gem_base_color();  //+bvh_trace,convex_trace,proxy_geometry
    }  //+bvh_trace,convex_trace,proxy_geometry
    return GemRadiance(reflectance * reflected, inside, reflectance);  //+bvh_trace,convex_trace,proxy_geometry
    //-bvh_trace,convex_trace,proxy_geometry return GemRadiance(reflectance * reflected, vec3f(0.0f), reflectance);
}

// Geometry buffer of the stone for a deferred renderer (the paper's section 4.3.4); depth is in the
// depth buffer.
struct GemGeometryBuffer {
    // Light from inside, which the renderer adds like light that a surface emits. Alpha is 1 on a
    // stone.
    @location(0) emission: vec4f,
    // Normal of the facet.
    @location(1) normal: vec4f,
    // Reflectance of the surface as seen from the eye.
    @location(2) reflectance: vec4f,
}

fn gem_geometry_buffer(
    input: GemVertex,
    transmits: bool,  //+bvh_trace,convex_trace,proxy_geometry
) -> GemGeometryBuffer {
    let radiance = gem_radiance(input, transmits);  //+bvh_trace,convex_trace,proxy_geometry
    //-bvh_trace,convex_trace,proxy_geometry let radiance = gem_radiance(input);
    return GemGeometryBuffer(
        vec4f(radiance.inside, 1.0f),
        vec4f(gem_world_direction(input.face_normal), 0.0f),
        vec4f(radiance.reflectance, 1.0f)
    );
}
