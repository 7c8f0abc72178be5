//! Mirror of the recipe `random_walk_slab`: whole walks through a slab. The recipe says what each member means.

use crate::{
    RANDOM_WALK_ABSORBED, RANDOM_WALK_SCATTERED, azimuth, boundary, collision, deflection, free_path, random, turn,
};
use glam::{UVec4, Vec3, Vec3Swizzles as _};

/// How a walk ended: absorbed.
pub const ABSORBED: u32 = 0;
/// Through the face by which it came, or reflected there.
pub const REFLECTED: u32 = 1;
/// Through the other face.
pub const TRANSMITTED: u32 = 2;
/// After too many steps.
pub const UNFINISHED: u32 = 3;

/// A slab below z = 0, and the light that falls on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slab {
    /// Of the angle to the normal under which light comes in.
    pub entry_cosine: f32,
    /// A length.
    pub thickness: f32,
    /// Per unit of length, at density 1.
    pub scattering: f32,
    /// Per unit of length, at density 1.
    pub absorption: f32,
    /// Henyey and Greenstein's g.
    pub anisotropy: f32,
    /// Of the stone to what is about it.
    pub relative_index: f32,
    /// The most tentative collisions of a walk.
    pub most: u32,
    /// Of the random numbers.
    pub seed: u32,
    /// The greatest density.
    pub greatest: f32,
}

/// How a walk ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlabExit {
    /// [`ABSORBED`] to [`UNFINISHED`].
    pub outcome: u32,
    /// Real ones.
    pub scatterings: u32,
    /// Of the direction outside.
    pub cosine: f32,
    /// x of the place where light left.
    pub place: f32,
}

/// A walk, and whether it is sure: whether each of its decisions stands if the numbers compared are moved by `slack`.
pub fn walk(walk: u32, slab: &Slab, density: impl Fn(Vec3) -> f32, slack: f32) -> (SlabExit, bool) {
    // Whether a boundary does the same for a number that is moved.
    let firm = |direction: Vec3, normal: Vec3, index: f32, u: f32| {
        let crosses = |u: f32| boundary(direction, normal, index, u).crosses;
        crosses((u - slack).max(0.0)) == crosses((u + slack).min(1.0 - f32::EPSILON))
    };
    let majorant = (slab.scattering + slab.absorption) * slab.greatest;
    let sine = ((1.0 - slab.entry_cosine) * (1.0 + slab.entry_cosine)).sqrt();
    let mut position = Vec3::ZERO;
    let mut direction = Vec3::new(sine, 0.0, -slab.entry_cosine);
    let mut scatterings = 0;
    let mut apart = f32::INFINITY;
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
        // A direction that is level may lead to either face.
        apart = apart.min((free - way).abs() * majorant).min(direction.z.abs());
        if free >= way {
            position = (position.xy() + way * direction.xy()).extend(face);
            let inwards = Vec3::new(0.0, 0.0, if upwards { -1.0 } else { 1.0 });
            let crossing = boundary(direction, inwards, 1.0 / slab.relative_index, u.y);
            sure &= firm(direction, inwards, 1.0 / slab.relative_index, u.y);
            direction = crossing.direction;
            if crossing.crosses {
                let outcome = if upwards { REFLECTED } else { TRANSMITTED };
                return (ended(outcome, scatterings, direction.z.abs(), position.x), sure && apart > slack);
            }
            continue;
        }
        position += free * direction;
        let density = density(position);
        let event = collision(u.y, density * slab.scattering, density * slab.absorption, majorant);
        let extinction = density * (slab.scattering + slab.absorption);
        for threshold in [density * slab.scattering, extinction] {
            apart = apart.min((u.y - threshold / majorant).abs());
        }
        if event == RANDOM_WALK_ABSORBED {
            return (ended(ABSORBED, scatterings, 0.0, position.x), sure && apart > slack);
        }
        if event == RANDOM_WALK_SCATTERED {
            scatterings += 1;
            direction = turn(direction, deflection(u.z, slab.anisotropy), azimuth(u.w));
        }
    }
    (ended(UNFINISHED, scatterings, 0.0, position.x), sure && apart > slack)
}
