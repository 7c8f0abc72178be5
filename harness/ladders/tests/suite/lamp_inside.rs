//! Lamps inside bodies through which light diffuses: what leaves a body is what its lamp sends out, and it leaves where random
//! walks say.

use crate::diffusion::{drawn, scene_of};
use glam::{DVec3, Vec3};
use lapidary_render::Picture;
use lapidary_scene::surfaces::sphere;
use lapidary_scene::{Light, Medium, Scene};
use lapidary_snapshots::exposure::distance;
use lapidary_snapshots::frames::halved;
use lapidary_testing::pixels::rays;
use std::f64::consts::{PI, TAU};

/// A ball of this matter around the origin, with lights.
fn ball(radius: f32, medium: Medium, lights: Vec<Light>) -> Scene {
    scene_of(sphere(radius.into(), 96), medium, lights, (80.0, 10.0))
}

fn lamp(position: Vec3, intensity: Vec3) -> Light {
    Light::Point { position, intensity }
}

/// SplitMix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut word = self.0;
        word = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((word ^ (word >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn direction(&mut self) -> DVec3 {
        let height = 2.0 * self.next() - 1.0;
        let (sine, cosine) = (TAU * self.next()).sin_cos();
        let radius = (1.0 - height * height).sqrt();
        DVec3::new(radius * cosine, radius * sine, height)
    }
}

/// Length of the way from a point inside a ball about the origin to its surface.
fn way_out(position: DVec3, direction: DVec3, radius: f64) -> f64 {
    let along = position.dot(direction);
    (along * along + radius * radius - position.length_squared()).max(0.0).sqrt() - along
}

/// The picture of a grey ball with a lamp of intensity 1 inside, by walks from the lamp: each collision sends light to the eye.
/// A lamp is met by none of them, so that no step is singular.
fn walked(
    scene: &Scene,
    radius: f64,
    [extinction, albedo]: [f64; 2],
    cone: f64,
    walks: u32,
    side: u32,
) -> Vec<[f32; 4]> {
    let (Light::Point { position, .. } | Light::Spot { position, .. }) = scene.lights[0] else { panic!("a lamp") };
    let clip_from_world = lapidary_scene::clip_from_world(scene, side, side).as_dmat4();
    let eye = scene.camera.eye.as_dvec3();
    let blank = Picture { linear: vec![[0.0; 4]; (side * side) as usize], ..drawn(scene, "lambert", side) };
    // Solid angle of each pixel, by that in the middle and the cosine from the axis.
    let axis = -eye.normalize();
    let beside = rays(scene, &blank);
    let across = (beside[0].0 / beside[0].0.dot(axis) - beside[1].0 / beside[1].0.dot(axis)).length();
    let solid = |direction: DVec3| across * across * direction.dot(axis).powi(3);
    let mut random = Random(7);
    let mut picture = vec![[0.0f32; 4]; (side * side) as usize];
    for _ in 0..walks {
        let (mut place, mut weight) = (position.as_dvec3(), 4.0 * PI / f64::from(walks));
        let mut direction = random.direction();
        if direction.z < cone {
            continue;
        }
        loop {
            let step = -(1.0 - random.next()).ln() / extinction;
            if step > way_out(place, direction, radius) {
                break;
            }
            place += step * direction;
            weight *= albedo;
            let toward = eye - place;
            let seen = toward.normalize();
            let found = clip_from_world.project_point3(place);
            let [x, y] = [found.x, -found.y].map(|part| ((0.5 * part + 0.5) * f64::from(side)) as usize);
            let left = (-extinction * way_out(place, seen, radius)).exp();
            let radiance = weight * left / (4.0 * PI * toward.length_squared() * solid(-seen));
            let pixel = &mut picture[y.min(side as usize - 1) * side as usize + x.min(side as usize - 1)];
            (0..3).for_each(|channel| pixel[channel] += radiance as f32);
            direction = random.direction();
        }
    }
    picture
}

/// The mean radiance of a ball's disc is the flux through its surface over pi, whatever the angles are by which light leaves:
/// of matter that absorbs nothing, all that its lamp sends out but what never collides.
#[test]
fn a_white_ball_sends_out_all_that_its_lamp_does() {
    for extinction in [4.0f32, 16.0] {
        let intensity = Vec3::new(1.0, 2.0, 3.0);
        let medium = Medium::isotropic(Vec3::splat(extinction), Vec3::ZERO);
        let scene = ball(1.0, medium, vec![lamp(Vec3::ZERO, intensity)]);
        for rung in ["diffusion-32", "diffusion-64"] {
            let picture = drawn(&scene, rung, 96);
            let eye = scene.camera.eye.as_dvec3();
            let (mut sum, mut count) = (Vec3::ZERO, 0);
            for (direction, pixel) in rays(&scene, &picture) {
                if eye.reject_from(direction).length() < 0.98 {
                    sum += Vec3::from_slice(&pixel[..3]);
                    count += 1;
                }
            }
            let share = sum / count as f32 * PI as f32 / intensity / (1.0 - (-extinction).exp());
            println!("extinction {extinction}, {rung}: {share:.3} of the light that collides");
            // Below a plane, where the fluence is t + z, diffusion's integral sends out 1.033 of its flux, of which the angles'
            // factor leaves 1.019. Within a ball the fluence rises faster, at first by t / r of itself, which is up to 1.1 /
            // extinction more; the grid adds some hundredths.
            let most = 1.019 + 1.1 / extinction + 0.07;
            assert!(share.min_element() > 1.0 && share.max_element() < most, "{extinction}, {rung}: {share} of {most}");
        }
    }
}

/// The light of a spot, however narrow, is a share of a lamp's: its solid angle weighted by how its edge fades, over the sphere's.
/// It shines across the eye's direction, so that what it adds on one side is missing on the other.
#[test]
fn a_narrow_spot_sends_out_its_share_of_a_lamps_light() {
    let medium = || Medium::isotropic(Vec3::splat(16.0), Vec3::ZERO);
    let sum = |light: Light| -> f64 {
        let picture = drawn(&ball(1.0, medium(), vec![light]), "diffusion-64", 96);
        picture.linear.iter().map(|pixel| f64::from(pixel[0])).sum()
    };
    let of_lamp = sum(lamp(Vec3::ZERO, Vec3::ONE));
    let across = ball(1.0, medium(), vec![]).camera.eye.cross(Vec3::Y).normalize();
    for outer in [0.02f64, 0.1, 0.5] {
        let inner = 0.8 * outer;
        let spot = Light::Spot {
            position: Vec3::ZERO,
            direction: across,
            intensity: Vec3::ONE,
            inner_angle: inner as f32,
            outer_angle: outer as f32,
        };
        // The square of what fades evenly with the cosine has the mean 1/3.
        let angle = (1.0 - inner.cos()) + (inner.cos() - outer.cos()) / 3.0;
        let share = sum(spot) / of_lamp / (0.5 * angle);
        println!("a spot of {outer}: {share:.4} of its share of a lamp's light");
        assert!((share - 1.0).abs() < 0.06, "{outer}: {share}");
    }
}

/// A lamp in the middle, one near the surface, and a spot, beside random walks.
#[test]
#[ignore = "long; .ci/full runs it"]
fn a_lamp_shines_through_a_body_as_walks_do() {
    let side = 16;
    let place = |z: f32| Vec3::new(0.0, 1.0, z);
    let spot = Light::Spot {
        position: place(0.0),
        direction: Vec3::Z,
        intensity: Vec3::ONE,
        inner_angle: 0.799,
        outer_angle: 0.8,
    };
    for (name, light, cone) in [
        ("middle", lamp(Vec3::ZERO, Vec3::ONE), -1.0),
        ("near the side", lamp(place(5.0), Vec3::ONE), -1.0),
        ("spot", spot, 0.8f64.cos()),
    ] {
        for (extinction, absorption) in [(1.0f32, 0.005f32), (2.0, 0.002)] {
            let medium = Medium::isotropic(Vec3::splat(extinction - absorption), Vec3::splat(absorption));
            let scene = ball(8.0, medium, vec![light]);
            let matter = [f64::from(extinction), f64::from(1.0 - absorption / extinction)];
            let truth = walked(&scene, 8.0, matter, cone, 20_000, side);
            for rung in ["diffusion-32", "diffusion-64"] {
                let found = halved(&halved(&drawn(&scene, rung, 4 * side))).linear;
                let total = |picture: &[[f32; 4]]| picture.iter().map(|pixel| pixel[0]).sum::<f32>();
                let share = total(&found) / total(&truth);
                let off = distance(&found, &truth);
                println!("{name} in {extinction}, {absorption}, {rung}: distance {off:.3}, {share:.3} of the light");
                // Light of a spot keeps its direction for some collisions, which diffusion does not know.
                let most = if cone > 0.0 { 0.3 } else { 0.2 };
                assert!(off < most && (share - 1.0).abs() < 0.2, "{name} in {extinction}, {rung}: {off} {share}");
            }
        }
    }
}
