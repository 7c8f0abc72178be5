//! Random walks of light through scattering media, on the CPU: the reference for the translucent
//! techniques.
//!
//! Media in this file and in `sphere` are homogeneous and scatter isotropically, and their surfaces
//! do not refract light. Lengths are in mean free paths. A walk is analogue: at each scattering it
//! ends with the probability of absorption, so that counts of walks are shares of light with the
//! statistics of coin tosses. [`mesh`] follows weighted walks through bodies of any density, phase
//! function and boundary. A seed gives the same walks on any number of threads.

pub mod half_space;
pub mod mesh;
mod sphere;

pub use sphere::{BINS, Profile, profile};

use crate::generator::generator;
use glam::DVec3;
use rand::RngExt as _;
use rand::rngs::Xoshiro256PlusPlus;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Number of walks that share a generator.
const BATCH: u64 = 1 << 14;

/// A convex body of a scattering medium.
pub trait Body: Sync {
    /// Distance to the surface along a unit direction, from a point inside or on the surface;
    /// infinite if the surface is not met.
    fn exit(&self, position: DVec3, direction: DVec3) -> f64;
}

/// The half space below the plane z = 0.
pub struct HalfSpace;

impl Body for HalfSpace {
    fn exit(&self, position: DVec3, direction: DVec3) -> f64 {
        if direction.z > 0.0 { (-position.z / direction.z).max(0.0) } else { f64::INFINITY }
    }
}

/// A ball centred at the origin.
pub struct Ball {
    /// Radius in mean free paths.
    pub radius: f64,
}

impl Body for Ball {
    fn exit(&self, position: DVec3, direction: DVec3) -> f64 {
        let along = position.dot(direction);
        // Distance of the chord from the centre, by the cross product: radius^2 - |position|^2
        // alone would lose digits at the surface.
        let beside = position.cross(direction).length_squared();
        ((self.radius * self.radius - beside).max(0.0).sqrt() - along).max(0.0)
    }
}

/// State of a walk that leaves a body.
#[derive(Clone, Copy, Debug)]
pub struct Exit {
    /// Position on the surface.
    pub position: DVec3,
    /// Unit direction.
    pub direction: DVec3,
    /// Number of scatterings; 0 for light that went straight through.
    pub scatterings: u32,
    /// Length of the whole path.
    pub travelled: f64,
}

/// Samples all directions uniformly.
fn isotropic(random: &mut Xoshiro256PlusPlus) -> DVec3 {
    let z = 2.0 * random.random::<f64>() - 1.0;
    let (sine, cosine) = (TAU * random.random::<f64>()).sin_cos();
    let radius = ((1.0 - z) * (1.0 + z)).sqrt();
    DVec3::new(radius * cosine, radius * sine, z)
}

/// Walks from `position`, on the surface or inside, along `direction`; returns `None` if the walk
/// is absorbed.
fn walk(
    body: &impl Body,
    mut position: DVec3,
    mut direction: DVec3,
    albedo: f64,
    random: &mut Xoshiro256PlusPlus,
) -> Option<Exit> {
    let (mut scatterings, mut travelled) = (0, 0.0);
    loop {
        // 1 - [0, 1) is never 0.
        let free = -(1.0 - random.random::<f64>()).ln();
        let exit = body.exit(position, direction);
        if free >= exit {
            let position = position + exit * direction;
            return Some(Exit { position, direction, scatterings, travelled: travelled + exit });
        }
        position += free * direction;
        travelled += free;
        if random.random::<f64>() >= albedo {
            return None;
        }
        scatterings += 1;
        direction = isotropic(random);
    }
}

/// Number, albedo and seed of walks.
#[derive(Clone, Copy, Debug)]
pub struct Walks {
    /// Share of light left after one scattering, 0 to 1.
    pub albedo: f64,
    /// Number of walks.
    pub count: u64,
    /// Random seed; the same seed gives the same walks.
    pub seed: u64,
}

/// Folds walks through `body`: `enter` returns the position and direction where a walk starts, and
/// `add` receives its exit, `None` if it was absorbed.
pub fn fold<T: Send>(
    body: &impl Body,
    Walks { albedo, count, seed }: Walks,
    enter: impl Fn(&mut Xoshiro256PlusPlus) -> (DVec3, DVec3) + Sync,
    new: impl Fn() -> T + Sync,
    add: impl Fn(&mut T, Option<Exit>) + Sync,
    join: impl Fn(T, T) -> T,
) -> T {
    let batches = count.div_ceil(BATCH);
    // Batches are joined in order, so that sums of floats are the same on any number of threads.
    let parts: Vec<T> = (0..batches)
        .into_par_iter()
        .map(|batch| {
            let mut random = generator(seed, batch);
            let mut total = new();
            for _ in 0..BATCH.min(count - batch * BATCH) {
                let (position, direction) = enter(&mut random);
                add(&mut total, walk(body, position, direction, albedo, &mut random));
            }
            total
        })
        .collect();
    parts.into_iter().reduce(join).unwrap_or_else(new)
}

/// Samples the unit disc uniformly: the points where a parallel beam falls on a sphere or, lifted
/// to the hemisphere, the directions of diffuse light.
fn in_disc(random: &mut Xoshiro256PlusPlus) -> (f64, f64) {
    let radius = random.random::<f64>().sqrt();
    let (sine, cosine) = (TAU * random.random::<f64>()).sin_cos();
    (radius * cosine, radius * sine)
}

#[cfg(test)]
mod tests {
    use super::*;
    use lapidary_scene::Scene;

    /// Share of walks that leave a half space, and its standard error.
    fn reflectance(albedo: f64, count: u64, enter: impl Fn(&mut Xoshiro256PlusPlus) -> DVec3 + Sync) -> (f64, f64) {
        let out = fold(
            &HalfSpace,
            Walks { albedo, count, seed: 7 },
            |random| (DVec3::ZERO, enter(random)),
            || 0u64,
            |out, exit| *out += u64::from(exit.is_some()),
            |a, b| a + b,
        );
        let share = out as f64 / count as f64;
        (share, (share * (1.0 - share) / count as f64).sqrt())
    }

    /// Samples a direction of diffuse light from above.
    fn diffuse_down(random: &mut Xoshiro256PlusPlus) -> DVec3 {
        let (x, y) = in_disc(random);
        DVec3::new(x, y, -(1.0 - x * x - y * y).max(0.0).sqrt())
    }

    /// The base colour of a built-in scene's translucent material is the reflectance of a half
    /// space of its medium for diffuse light.
    #[test]
    fn base_colors_are_the_reflectances_of_their_media() {
        for name in ["skin", "wax", "jade"] {
            let scene = Scene::named(name).expect("built in");
            let material = &scene.objects[0].material;
            let medium = material.medium.as_ref().expect("a medium");
            for channel in 0..3 {
                let scattering = f64::from(medium.scattering[channel]);
                let albedo = scattering / (scattering + f64::from(medium.absorption[channel]));
                let (found, error) = reflectance(albedo, 400_000, diffuse_down);
                let stated = f64::from(material.base_color[channel]);
                println!("{name}, channel {channel}: albedo {albedo:.4}, {found:.4} ± {error:.4}, stated {stated:.3}");
                // Plus half a unit of the last of three decimals.
                assert!(
                    (found - stated).abs() <= 4.0 * error + 0.0005,
                    "{name} {channel}: {found} ± {error}, stated {stated}"
                );
            }
        }
    }

    /// Chandrasekhar, "Radiative Transfer": 1 - H(1) sqrt(1 - albedo) for light at normal
    /// incidence, and the corresponding mean over diffuse light.
    #[test]
    fn half_spaces_reflect_as_chandrasekhar_has_it() {
        for (albedo, normal, diffuse) in
            [(0.5, 0.115226, 0.146544), (0.9, 0.414947, 0.478024), (0.99, 0.752721, 0.794564)]
        {
            let down = |_: &mut Xoshiro256PlusPlus| DVec3::NEG_Z;
            for ((found, error), expected) in
                [(reflectance(albedo, 400_000, down), normal), (reflectance(albedo, 400_000, diffuse_down), diffuse)]
            {
                println!("albedo {albedo}: {found:.5} ± {error:.5}, expected {expected}");
                assert!(
                    (found - expected).abs() <= 4.0 * error,
                    "albedo {albedo}: {found} ± {error}, expected {expected}"
                );
            }
        }
    }

    /// In a body that absorbs nothing and is lit diffusely from all sides, the mean path length is
    /// 4 V / S, however much it scatters (Blanco and Fournier, "An invariance property of diffusive
    /// random walks", 2003): 4/3 of the radius for a ball.
    #[test]
    fn the_mean_way_through_a_ball_does_not_depend_on_scattering() {
        for radius in [0.5, 2.0, 10.0] {
            let (count, body) = (200_000u64, Ball { radius });
            let enter = |random: &mut Xoshiro256PlusPlus| (DVec3::new(0.0, 0.0, radius), diffuse_down(random));
            let add = |sums: &mut [f64; 2], exit: Option<Exit>| {
                let way = exit.expect("nothing is absorbed").travelled;
                sums[0] += way;
                sums[1] += way * way;
            };
            let [sum, squares] = fold(
                &body,
                Walks { albedo: 1.0, count, seed: 3 },
                enter,
                || [0.0; 2],
                add,
                |a, b| [a[0] + b[0], a[1] + b[1]],
            );
            let mean = sum / count as f64;
            let error = ((squares / count as f64 - mean * mean) / count as f64).sqrt();
            println!("radius {radius}: {mean:.4} ± {error:.4}");
            assert!((mean - 4.0 / 3.0 * radius).abs() <= 4.0 * error, "{radius}: {mean} ± {error}");
        }
    }

    #[test]
    fn a_seed_gives_the_same_walks() {
        let run = |seed| profile(3.0, 0.9, 50_000, seed).exitance;
        assert_eq!(run(1), run(1));
        assert_ne!(run(1), run(2));
    }
}
