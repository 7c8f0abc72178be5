// random_walk_slab: a walk of light through a slab of stone per invocation: the reference in its smallest closed case.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: Chandrasekhar, "Radiative Transfer", 1950: what a half space must give back; Woodcock et
//   al., 1965: delta tracking.
// requires: random_walk, veins
//
// The slab lies below z = 0. Light enters at the origin, travelling along x and downwards. A walk
// ends when its light leaves, when it is absorbed, or after `most` tentative collisions; the
// numbers of walks with each outcome give shares of light.

struct RandomWalkSlab {
    // Cosine of the angle between the incoming light and the normal, above 0.
    entry_cosine: f32,
    thickness: f32,
    // Scattering and absorption coefficients at density 1.
    scattering: f32,
    absorption: f32,
    // Henyey and Greenstein's g.
    anisotropy: f32,
    // Refractive index of the stone relative to its surroundings; 1 for a boundary that neither
    // refracts nor reflects.
    relative_index: f32,
    walks: u32,
    most: u32,
    seed: u32,
    // The density: the members of VeinsPattern. Without octaves it is `greatest` everywhere.
    octaves: u32,
    pattern_seed: u32,
    frequency: f32,
    width: f32,
    least: f32,
    greatest: f32,
}

struct RandomWalkSlabExit {
    outcome: u32,
    // Number of real collisions that scattered the light.
    scatterings: u32,
    // Cosine of the angle between the direction outside and the normal of the face through which
    // light left; 0 if it did not leave.
    cosine: f32,
    // x of the point where light left.
    place: f32,
}

const RANDOM_WALK_SLAB_ABSORBED = 0u;
const RANDOM_WALK_SLAB_REFLECTED = 1u;
const RANDOM_WALK_SLAB_TRANSMITTED = 2u;
const RANDOM_WALK_SLAB_UNFINISHED = 3u;

@group(0) @binding(0) var<uniform> slab: RandomWalkSlab;
@group(0) @binding(1) var<storage, read_write> exits: array<RandomWalkSlabExit>;

@compute @workgroup_size(64)
fn random_walk_slab(@builtin(global_invocation_id) invocation: vec3u) {
    if invocation.x < slab.walks {
        exits[invocation.x] = random_walk_slab_walk(invocation.x);
    }
}

fn random_walk_slab_walk(walk: u32) -> RandomWalkSlabExit {
    let pattern = VeinsPattern(slab.frequency, slab.width, slab.least, slab.greatest, slab.octaves, slab.pattern_seed);
    let majorant = (slab.scattering + slab.absorption) * max(slab.least, slab.greatest);
    let sine = sqrt((1.0f - slab.entry_cosine) * (1.0f + slab.entry_cosine));
    var position = vec3f(0.0f);
    var direction = vec3f(sine, 0.0f, -slab.entry_cosine);
    var scatterings = 0u;
    let first = random_walk_random(vec4u(slab.seed, walk, 0u, 0u));
    let entry = random_walk_boundary(direction, vec3f(0.0f, 0.0f, 1.0f), slab.relative_index, first.x);
    if !entry.crosses {
        return RandomWalkSlabExit(RANDOM_WALK_SLAB_REFLECTED, 0u, entry.direction.z, 0.0f);
    }
    direction = entry.direction;
    for (var step = 1u; step <= slab.most; step++) {
        let u = random_walk_random(vec4u(slab.seed, walk, step, 0u));
        let upwards = direction.z > 0.0f;
        let face = select(-slab.thickness, 0.0f, upwards);
        let way = max((face - position.z) / select(min(direction.z, -1e-20f), direction.z, upwards), 0.0f);
        let free = random_walk_free_path(u.x, majorant);
        if free >= way {
            position = vec3f(position.xy + way * direction.xy, face);
            let inwards = vec3f(0.0f, 0.0f, select(1.0f, -1.0f, upwards));
            let crossing = random_walk_boundary(direction, inwards, 1.0f / slab.relative_index, u.y);
            direction = crossing.direction;
            if crossing.crosses {
                let outcome = select(RANDOM_WALK_SLAB_TRANSMITTED, RANDOM_WALK_SLAB_REFLECTED, upwards);
                return RandomWalkSlabExit(outcome, scatterings, abs(direction.z), position.x);
            }
            continue;
        }
        position += free * direction;
        let density = veins_density(position, pattern);
        let event = random_walk_collision(u.y, density * slab.scattering, density * slab.absorption, majorant);
        if event == RANDOM_WALK_ABSORBED {
            return RandomWalkSlabExit(RANDOM_WALK_SLAB_ABSORBED, scatterings, 0.0f, position.x);
        }
        if event == RANDOM_WALK_SCATTERED {
            scatterings++;
            direction = random_walk_turn(
                direction, random_walk_deflection(u.z, slab.anisotropy), random_walk_azimuth(u.w)
            );
        }
    }
    return RandomWalkSlabExit(RANDOM_WALK_SLAB_UNFINISHED, scatterings, 0.0f, position.x);
}
