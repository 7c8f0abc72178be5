//! Whole walks through a slab on the GPU: compared with the mirror decision by decision, and in the
//! mean with results known without walks.

use glam::Vec3;
use lapidary_random_walk::slab::{self, Slab, SlabExit};
use lapidary_reference::random_walk::half_space;
use lapidary_render::compute::{Binding, RecipeRun, run_recipe};
use lapidary_veins::{self as veins, VeinsPattern};

const UNIFORM: VeinsPattern =
    VeinsPattern { frequency: 1.0, width: 1.0, least: 1.0, greatest: 1.0, octaves: 0, seed: 0 };

const MARBLED: VeinsPattern =
    VeinsPattern { frequency: 0.4, width: 0.2, least: 0.25, greatest: 2.0, octaves: 3, seed: 5 };

/// Returns a slab so thick that walks cannot tell it from a half space.
fn deep(albedo: f32) -> Slab {
    Slab {
        entry_cosine: 1.0,
        thickness: 1e20,
        scattering: albedo,
        absorption: 1.0 - albedo,
        anisotropy: 0.0,
        relative_index: 1.0,
        most: 100_000,
        seed: 1,
        greatest: 1.0,
    }
}

/// Returns the recipe's result for each walk.
fn walked(slab: &Slab, pattern: VeinsPattern, walks: u32) -> Vec<SlabExit> {
    let words = [
        slab.entry_cosine.to_bits(),
        slab.thickness.to_bits(),
        slab.scattering.to_bits(),
        slab.absorption.to_bits(),
        slab.anisotropy.to_bits(),
        slab.relative_index.to_bits(),
        walks,
        slab.most,
        slab.seed,
        pattern.octaves,
        pattern.seed,
        pattern.frequency.to_bits(),
        pattern.width.to_bits(),
        pattern.least.to_bits(),
        pattern.greatest.to_bits(),
        0,
    ];
    let run = RecipeRun {
        recipe: "random_walk_slab",
        entry: "random_walk_slab",
        constants: &[],
        bindings: &[&[Binding::Uniform(bytemuck::cast_slice(&words)), Binding::Result(16 * u64::from(walks))]],
        workgroups: [walks.div_ceil(64), 1, 1],
    };
    let exit = |words: &[u32]| SlabExit {
        outcome: words[0],
        scatterings: words[1],
        cosine: f32::from_bits(words[2]),
        place: f32::from_bits(words[3]),
    };
    let words = run_recipe(lapidary_testing::gpu(), &run).unwrap_or_else(|error| panic!("{error}"));
    words.chunks_exact(4).map(exit).collect()
}

/// Returns the share of walks with an outcome, and its standard error.
fn share(exits: &[SlabExit], outcome: u32) -> (f64, f64) {
    let count = exits.len() as f64;
    let share = exits.iter().filter(|exit| exit.outcome == outcome).count() as f64 / count;
    (share, (share * (1.0 - share) / count).sqrt())
}

#[test]
fn shader_and_mirror_walk_the_same_ways() {
    let thin = Slab { thickness: 3.0, anisotropy: 0.7, ..deep(0.9) };
    let glassy = Slab { relative_index: 1.5, entry_cosine: 0.5, thickness: 2.0, ..deep(0.8) };
    for (slab, pattern) in [
        (deep(0.9), UNIFORM),
        (thin, UNIFORM),
        (Slab { greatest: 2.0, ..thin }, MARBLED),
        (Slab { greatest: 2.0, anisotropy: -0.4, ..glassy }, MARBLED),
    ] {
        let slack = 1e-4;
        let (mut compared, mut skipped) = (0, 0);
        for (number, shader) in (0..).zip(walked(&slab, pattern, 20_000)) {
            let density = |position: Vec3| veins::density(position, pattern);
            let (mirror, sure) = slab::walk(number, &slab, density, slack);
            if !sure {
                skipped += 1;
                continue;
            }
            compared += 1;
            assert_eq!((shader.outcome, shader.scatterings), (mirror.outcome, mirror.scatterings), "{slab:?} {number}");
            let difference = (shader.cosine - mirror.cosine).abs().max((shader.place - mirror.place).abs() * 0.1);
            assert!(difference < slack, "{slab:?} {number}: {shader:?} {mirror:?}");
        }
        println!("{compared} compared, {skipped} too close to tell");
        assert!(skipped * 20 < compared);
    }
}

#[test]
fn half_spaces_reflect_as_chandrasekhar_has_it() {
    for (albedo, normal) in [(0.5, 0.115226), (0.9, 0.414947), (0.99, 0.752721)] {
        for cosine in [1.0f32, 0.4] {
            let slab = Slab { entry_cosine: cosine, ..deep(albedo as f32) };
            let exits = walked(&slab, UNIFORM, 200_000);
            let (found, error) = share(&exits, slab::REFLECTED);
            let expected = half_space::reflectance(cosine.into(), albedo);
            println!("albedo {albedo}, cosine {cosine}: {found:.5} ± {error:.5}, expected {expected:.5}");
            assert!((found - expected).abs() < 4.0 * error);
            assert!(cosine < 1.0 || (expected - normal).abs() < 6e-7);
            assert_eq!(share(&exits, slab::UNFINISHED).0, 0.0);
        }
    }
}

/// Null collisions change nothing: a majorant three times the density gives the same half space.
#[test]
fn a_majorant_too_large_changes_nothing_but_time() {
    // Without octaves the density is `greatest`; `least` raises the majorant alone.
    let pattern = VeinsPattern { least: 3.0, ..UNIFORM };
    let (found, error) = share(&walked(&deep(0.9), pattern, 200_000), slab::REFLECTED);
    println!("{found:.5} ± {error:.5}");
    assert!((found - 0.414947).abs() < 4.0 * error);
}

/// A purely absorbing medium transmits exp(-d) along a path of optical depth d. Here the oracle's
/// quadrature gives the depth through veins.
#[test]
fn the_mean_transmittance_of_veins_is_beers() {
    let slab = Slab { thickness: 2.5, scattering: 0.0, absorption: 0.8, ..deep(0.5) };
    let oracle = veins::oracle::VeinsPattern {
        frequency: MARBLED.frequency.into(),
        width: MARBLED.width.into(),
        least: MARBLED.least.into(),
        greatest: MARBLED.greatest.into(),
        octaves: MARBLED.octaves,
        seed: MARBLED.seed,
    };
    let steps = 20_000;
    let depth: f64 = (0..steps)
        .map(|k| 2.5 * (f64::from(k) + 0.5) / f64::from(steps))
        .map(|z| 0.8 * 2.5 / f64::from(steps) * veins::oracle::density(glam::DVec3::new(0.0, 0.0, -z), oracle))
        .sum();
    let (found, error) = share(&walked(&slab, MARBLED, 400_000), slab::TRANSMITTED);
    println!("{found:.5} ± {error:.5}, expected {:.5}", (-depth).exp());
    assert!((found - (-depth).exp()).abs() < 4.0 * error && (0.3..3.0).contains(&depth));
}

/// What `diffusion_slab` says of itself: how near it is to walks through a slab that collide at least once.
#[test]
fn diffusion_through_a_slab_is_near_the_walks() {
    for (albedo, thicknesses, most) in [
        (1.0f32, &[0.5f32, 1.0, 2.0, 4.0, 8.0][..], 0.02),
        (0.99, &[0.5, 1.0, 2.0, 4.0, 8.0], 0.02),
        (0.9, &[0.5, 1.0, 2.0, 4.0], 0.1),
    ] {
        for &thickness in thicknesses {
            let exits = walked(&Slab { thickness, ..deep(albedo) }, UNIFORM, 400_000);
            let through = |exit: &&SlabExit| exit.outcome == slab::TRANSMITTED && exit.scatterings > 0;
            let found = exits.iter().filter(through).count() as f64 / exits.len() as f64;
            let error = (found * (1.0 - found) / exits.len() as f64).sqrt();
            let gamma = lapidary_half_space::gamma(albedo, 0.0);
            let expected = f64::from(lapidary_diffusion::slab(thickness, gamma, lapidary_diffusion::DIFFUSION_MILNE));
            println!("albedo {albedo}, thickness {thickness}: {found:.4} ± {error:.4}, by diffusion {expected:.4}");
            assert!((found - expected).abs() < most * found + 4.0 * error, "{albedo} {thickness}: {found} {expected}");
        }
    }
}

/// Without absorption nothing is lost. A boundary, veins and forward scattering change where light
/// leaves, not how much.
#[test]
fn what_absorbs_nothing_gives_all_back() {
    let slab = Slab { thickness: 4.0, relative_index: 1.5, anisotropy: 0.6, greatest: 2.0, ..deep(1.0) };
    let exits = walked(&slab, MARBLED, 50_000);
    assert_eq!(share(&exits, slab::ABSORBED).0 + share(&exits, slab::UNFINISHED).0, 0.0);
    let (back, _) = share(&exits, slab::REFLECTED);
    assert!((0.2..0.8).contains(&back), "{back}");
}

#[test]
fn half_spaces_behind_glass_reflect_as_the_reflection_function_has_it() {
    for (albedo, index, cosine) in [(0.9f32, 1.5f32, 1.0f32), (0.99, 1.5, 0.6), (0.8, 1.3, 0.2)] {
        let slab = Slab { relative_index: index, entry_cosine: cosine, ..deep(albedo) };
        let (found, error) = share(&walked(&slab, UNIFORM, 200_000), slab::REFLECTED);
        let expected = half_space::reflectance_behind(cosine.into(), albedo.into(), index.into());
        println!("albedo {albedo}, index {index}, cosine {cosine}: {found:.5} ± {error:.5}, expected {expected:.5}");
        assert!((found - expected).abs() < 4.0 * error);
    }
}

/// Similarity: in an oblique beam and at high albedo, a forward scattering medium reflects about
/// as much as an isotropic one that scatters (1 - g) times as often.
#[test]
fn forward_scattering_is_like_less_scattering() {
    let absorption = 0.01;
    let reflected = |g: f32| {
        let scattering = 1.0 / (1.0 - g);
        let slab = Slab { scattering, absorption, anisotropy: g, entry_cosine: 0.6, ..deep(0.5) };
        share(&walked(&slab, UNIFORM, 100_000), slab::REFLECTED).0
    };
    let (isotropic, forwards) = (reflected(0.0), reflected(0.8));
    println!("{isotropic} {forwards}");
    assert!((forwards / isotropic - 1.0).abs() < 0.04);
    let without = share(
        &walked(
            &Slab { scattering: 1.0, absorption, anisotropy: 0.8, entry_cosine: 0.6, ..deep(0.5) },
            UNIFORM,
            100_000,
        ),
        slab::REFLECTED,
    );
    assert!(without.0 < 0.85 * isotropic);
}
