//! Effects of lights, colours and densities on one another's pictures.

use super::{apart, ball, coarse, covered, draw, lamp, settings, spot, sun};
use glam::{UVec3, Vec3};
use lapidary_assay::extremum::larger;
use lapidary_scene::{Density, DensityGrid, Light, Medium, Scene};
use lapidary_veins::VeinsPattern;
use std::sync::Arc;

/// Relative tolerance of Godunov's solver, which ends when a pass would lower costs by less than
/// 1e-5, here of up to 9 nats. The order of voxels is not specified.
const SOLVED: f32 = 1e-3;

/// Returns a ball with a changed medium.
fn with_medium(lights: Vec<Light>, change: impl FnOnce(Medium) -> Medium) -> Scene {
    let mut scene = ball(4.0, lights);
    let material = &mut scene.objects[0].material;
    material.medium = material.medium.take().map(change);
    scene
}

fn with_density(density: Density) -> Scene {
    with_medium(vec![sun()], |medium| Medium { density, ..medium })
}

fn grid(densities: Vec<f32>) -> Density {
    let size = UVec3::new(3, 2, 4);
    let grid = DensityGrid::new(Vec3::splat(-9.0), Vec3::splat(10.0), size, densities).expect("a grid");
    Density::Grid(Arc::new(grid))
}

#[test]
fn what_is_not_lit_seeds_nothing() {
    let black = Light::Directional { toward: Vec3::Y, irradiance: Vec3::ZERO };
    let away = Light::Spot {
        position: Vec3::new(0.0, 30.0, 0.0),
        direction: Vec3::Y,
        intensity: Vec3::splat(1e4),
        inner_angle: 0.1,
        outer_angle: 0.5,
    };
    for lights in [vec![], vec![black], vec![away], vec![black, away]] {
        let what = format!("{lights:?}");
        let picture = draw(&ball(1.0, lights), &coarse());
        assert!(covered(&what, &picture) > 1000);
        assert!(picture.linear.iter().all(|pixel| pixel[..3] == [0.0; 3]), "{what}");
    }
}

#[test]
fn another_light_darkens_no_pixel() {
    let lights = [sun(), lamp(), spot()];
    let pictures = [1, 2, 3].map(|count| draw(&ball(4.0, lights[..count].to_vec()), &settings("godunov-64")));
    for pair in pictures.windows(2) {
        let (mut brighter, mut lost) = (0, 0.0f32);
        for (before, after) in pair[0].linear.iter().zip(&pair[1].linear).filter(|(before, _)| before[3] == 1.0) {
            lost = larger(lost, 1.0 - after[0] / before[0]);
            brighter += i32::from(after[0] > 1.01 * before[0]);
        }
        println!("darker by {lost:.1e} at most, {brighter} pixels brighter");
        assert!(lost < SOLVED && brighter > 500, "{lost} {brighter}");
    }
}

#[test]
fn each_colour_goes_its_own_way() {
    let extinction = Vec3::new(0.1, 0.3, 0.9);
    let scene_of = |extinction: Vec3| with_medium(vec![sun(), lamp()], |_| Medium::isotropic(extinction, Vec3::ZERO));
    // The least costs of this rung are the same to the bit for any order of voxels.
    let rung = "tiled-26-64";
    let colored = draw(&scene_of(extinction), &settings(rung));
    for (channel, grey) in extinction.to_array().into_iter().enumerate() {
        let grey = draw(&scene_of(Vec3::splat(grey)), &settings(rung));
        let mut seen = 0;
        for (colored, grey) in colored.linear.iter().zip(&grey.linear) {
            assert_eq!(colored[channel].to_bits(), grey[channel].to_bits(), "channel {channel}: {colored:?} {grey:?}");
            seen += i32::from(colored[3] == 1.0 && colored[0] > colored[2]);
        }
        assert!(seen > 500, "{seen} pixels have a colour");
    }
}

/// Checks light of a single colour, and a light of each colour from its own side.
#[test]
fn coloured_lights_do_not_mix() {
    let picture_of = |lights: Vec<Light>| draw(&ball(4.0, lights), &settings("tiled-26-32"));
    let from = |toward: Vec3, irradiance: Vec3| Light::Directional { toward, irradiance };
    let [x, y, z] = [Vec3::NEG_X, Vec3::Y, Vec3::Z];
    let all = picture_of(vec![from(x, Vec3::X), from(y, 0.5 * Vec3::Y), from(z, 0.25 * Vec3::Z)]);
    for (channel, light) in [from(x, Vec3::X), from(y, 0.5 * Vec3::Y), from(z, 0.25 * Vec3::Z)].into_iter().enumerate()
    {
        let one = picture_of(vec![light]);
        for (all, one) in all.linear.iter().zip(&one.linear).filter(|(_, one)| one[3] == 1.0) {
            assert_eq!(all[channel].to_bits(), one[channel].to_bits(), "channel {channel}");
            assert!((0..3).all(|other| other == channel || one[other] == 0.0), "{one:?}");
        }
    }
}

#[test]
fn a_density_of_one_changes_nothing() {
    let uniform = draw(&with_density(Density::Uniform), &settings("godunov-64"));
    let ones = draw(&with_density(grid(vec![1.0; 24])), &settings("godunov-64"));
    let pattern = VeinsPattern { frequency: 0.2, width: 0.5, least: 1.0, greatest: 1.0, octaves: 4, seed: 3 };
    let veins = draw(&with_density(Density::Veins(pattern)), &settings("godunov-64"));
    let [ones, veins] = [ones, veins].map(|picture| apart(&picture, &uniform));
    println!("ones {ones:.1e}, veins {veins:.1e}");
    assert!(ones < SOLVED && veins < SOLVED, "{ones} {veins}");
}

#[test]
fn a_density_of_two_is_twice_the_extinction() {
    let twos = draw(&with_density(grid(vec![2.0; 24])), &settings("godunov-64"));
    let twice = with_medium(vec![sun()], |medium| Medium { scattering: 2.0 * medium.scattering, ..medium });
    let twice = draw(&twice, &settings("godunov-64"));
    let (difference, once) = (apart(&twos, &twice), draw(&with_density(Density::Uniform), &settings("godunov-64")));
    println!("apart {difference:.1e}");
    assert!(difference < SOLVED, "{difference}");
    assert!(apart(&once, &twice) > 1.0, "and not once");
}

/// A wall of dense matter through the middle: light passes around it or not at all.
#[test]
fn dense_matter_throws_a_shadow_inside() {
    let mut densities = vec![0.25f32; 1000];
    for (index, density) in densities.iter_mut().enumerate() {
        // Perpendicular to x, from the bottom to the top.
        if index % 10 == 5 {
            *density = 20.0;
        }
    }
    let size = UVec3::splat(10);
    let wall = DensityGrid::new(Vec3::splat(-10.0), Vec3::splat(10.0), size, densities).expect("a grid");
    let light = Light::Directional { toward: Vec3::NEG_X, irradiance: Vec3::ONE };
    let picture_of = |density: Density| {
        let scene = with_medium(vec![light], |medium| Medium { density, ..medium }).seen_from(90.0, 60.0);
        draw(&scene, &settings("godunov-64"))
    };
    let (walled, free) = (picture_of(Density::Grid(Arc::new(wall))), picture_of(grid(vec![0.25; 24])));
    let mut darker = 0;
    for (walled, free) in walled.linear.iter().zip(&free.linear).filter(|(_, free)| free[3] == 1.0) {
        assert!(walled[0] <= 1.01 * free[0], "{walled:?} {free:?}");
        darker += i32::from(walled[0] < 0.2 * free[0]);
    }
    assert!(darker > 2000, "{darker}");
}
