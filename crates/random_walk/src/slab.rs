//! Mirror of the recipe `random_walk_slab`: whole walks through a slab. The recipe describes each
//! member.

use crate::{
    RANDOM_WALK_ABSORBED, RANDOM_WALK_SCATTERED, azimuth, boundary, collision, deflection, free_path, random, turn,
};
use glam::{UVec4, Vec3, Vec3Swizzles as _};

/// Outcome of a walk: absorbed.
pub const ABSORBED: u32 = 0;
/// Outcome of a walk: left through the face of entry, or reflected there.
pub const REFLECTED: u32 = 1;
/// Outcome of a walk: left through the other face.
pub const TRANSMITTED: u32 = 2;
/// Outcome of a walk: stopped after too many steps.
pub const UNFINISHED: u32 = 3;

/// A slab below z = 0, and the incident light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slab {
    /// Cosine of the angle between the incoming light and the normal.
    pub entry_cosine: f32,
    /// Thickness, a length.
    pub thickness: f32,
    /// Scattering coefficient per unit of length, at density 1.
    pub scattering: f32,
    /// Absorption coefficient per unit of length, at density 1.
    pub absorption: f32,
    /// Henyey and Greenstein's g.
    pub anisotropy: f32,
    /// Refractive index of the stone relative to its surroundings.
    pub relative_index: f32,
    /// Largest number of tentative collisions of a walk.
    pub most: u32,
    /// Seed of the random numbers.
    pub seed: u32,
    /// Greatest density.
    pub greatest: f32,
}

/// End of a walk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlabExit {
    /// Outcome, [`ABSORBED`] to [`UNFINISHED`].
    pub outcome: u32,
    /// Number of real collisions that scattered the light.
    pub scatterings: u32,
    /// Cosine of the angle between the direction outside and the normal of the face.
    pub cosine: f32,
    /// x of the point where light left.
    pub place: f32,
}

/// Runs a walk. Returns its end, and whether it is sure: each of its decisions stands if the
/// compared numbers are moved by `slack`.
pub fn walk(walk: u32, slab: &Slab, density: impl Fn(Vec3) -> f32, slack: f32) -> (SlabExit, bool) {
    // Whether a boundary makes the same decision for moved numbers.
    let firm = |direction: Vec3, normal: Vec3, index: f32, u: f32| {
        let crosses = |u: f32| boundary(direction, normal, index, u).crosses;
        crosses((u - slack).max(0.0)) == crosses((u + slack).min(1.0 - f32::EPSILON))
    };
    let majorant = (slab.scattering + slab.absorption) * slab.greatest;
    let sine = ((1.0 - slab.entry_cosine) * (1.0 + slab.entry_cosine)).sqrt();
    let mut position = Vec3::ZERO;
    let mut direction = Vec3::new(sine, 0.0, -slab.entry_cosine);
    let mut scatterings = 0;
    let mut margin = f32::INFINITY;
    let ended = |outcome, scatterings, cosine, place| SlabExit { outcome, scatterings, cosine, place };
    let first = random(UVec4::new(slab.seed, walk, 0, 0));
    let entry = boundary(direction, Vec3::Z, slab.relative_index, first.x);
    let mut sure = firm(direction, Vec3::Z, slab.relative_index, first.x);
    if !entry.crosses {
        return (ended(REFLECTED, 0, entry.direction.z, 0.0), sure);
    }
    direction = entry.direction;
    for step in 1..=slab.most {
        let u = random(UVec4::new(slab.seed, walk, step, 0));
        let upwards = direction.z > 0.0;
        let face = if upwards { 0.0 } else { -slab.thickness };
        let way = ((face - position.z) / if upwards { direction.z } else { direction.z.min(-1e-20) }).max(0.0);
        let free = free_path(u.x, majorant);
        // A horizontal direction may lead to either face.
        margin = margin.min((free - way).abs() * majorant).min(direction.z.abs());
        if free >= way {
            position = (position.xy() + way * direction.xy()).extend(face);
            let inwards = Vec3::new(0.0, 0.0, if upwards { -1.0 } else { 1.0 });
            let crossing = boundary(direction, inwards, 1.0 / slab.relative_index, u.y);
            sure &= firm(direction, inwards, 1.0 / slab.relative_index, u.y);
            direction = crossing.direction;
            if crossing.crosses {
                let outcome = if upwards { REFLECTED } else { TRANSMITTED };
                return (ended(outcome, scatterings, direction.z.abs(), position.x), sure && margin > slack);
            }
            continue;
        }
        position += free * direction;
        let density = density(position);
        let event = collision(u.y, density * slab.scattering, density * slab.absorption, majorant);
        let extinction = density * (slab.scattering + slab.absorption);
        for threshold in [density * slab.scattering, extinction] {
            margin = margin.min((u.y - threshold / majorant).abs());
        }
        if event == RANDOM_WALK_ABSORBED {
            return (ended(ABSORBED, scatterings, 0.0, position.x), sure && margin > slack);
        }
        if event == RANDOM_WALK_SCATTERED {
            scatterings += 1;
            direction = turn(direction, deflection(u.z, slab.anisotropy), azimuth(u.w));
        }
    }
    (ended(UNFINISHED, scatterings, 0.0, position.x), sure && margin > slack)
}
