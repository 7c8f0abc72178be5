//! The lights' shadow maps, against ray queries. In a medium so dense that no light passes, each
//! pixel shows whether the map counts it as lit.

use super::{RADIUS, ball, draw, lamp, scene, settings, spot, stone, sun};
use glam::{DVec3, Vec3};
use lapidary_scene::surfaces::torus;
use lapidary_scene::{Light, Scene};
use lapidary_testing::pixels::{on_the_ball, rays};
use std::f64::consts::PI;

/// Extinction at which no light remains after a hundredth of a voxel.
const OPAQUE: f32 = 1e5;
/// Major radius of the torus.
const MAJOR: f64 = 10.0;
const MINOR: f64 = 4.0;

/// Returns the distance from a torus about the y axis, negative inside.
fn distance(point: DVec3) -> f64 {
    (point.x.hypot(point.z) - MAJOR).hypot(point.y) - MINOR
}

/// Returns the point at which a ray meets the torus, by sphere tracing.
fn met(origin: DVec3, direction: DVec3) -> Option<DVec3> {
    let mut along = 0.0;
    for _ in 0..1000 {
        let free = distance(origin + along * direction);
        if free < 1e-7 {
            return Some(origin + along * direction);
        }
        along += free;
        if along > 300.0 {
            return None;
        }
    }
    None
}

fn normal(point: DVec3) -> DVec3 {
    let across = DVec3::new(point.x, 0.0, point.z);
    (point - MAJOR * across.normalize()).normalize()
}

/// Returns the least distance from the torus along a ray to the light, from `start` on.
fn clearance(point: DVec3, direction: DVec3, [start, end]: [f64; 2]) -> f64 {
    let step = 0.02;
    let steps = ((end.min(60.0) - start) / step).max(0.0) as u32;
    (0..=steps).map(|k| distance(point + (start + step * f64::from(k)) * direction)).fold(f64::INFINITY, f64::min)
}

/// Returns the numbers of lit pixels, of pixels in a cast shadow, and of pixels too near its edge
/// to tell.
fn compare(what: &str, scene: &Scene, light: &Light, band: f64) -> [u32; 3] {
    let (mut lit, mut dark, mut between) = (0, 0, 0);
    let eye = scene.camera.eye.as_dvec3();
    for (direction, pixel) in rays(scene, &draw(scene, &settings("godunov-64"))) {
        let Some(point) = met(eye, direction).filter(|_| pixel[3] == 1.0) else { continue };
        let (normal, arrival) = (normal(point), light.arrival(point));
        let cosine = normal.dot(arrival.direction);
        // At silhouettes and in grazing light, the mesh differs from the torus.
        if normal.dot(-direction) < 0.15 || cosine < 0.2 || arrival.irradiance.x < 1e-2 {
            continue;
        }
        let share = PI * f64::from(pixel[0]) / (cosine * arrival.irradiance.x);
        // From the distance at which the ray is farther than `band` from the surface that it
        // leaves, if that is flat.
        let free = clearance(point, arrival.direction, [2.0 * band / cosine, arrival.distance]);
        if free > band {
            assert!((share - 1.0).abs() < 0.03, "{what}: lit at {point}, {share} of the light");
            lit += 1;
        } else if free < -band {
            assert!(share < 1e-3, "{what}: in shadow at {point}, {share} of the light");
            dark += 1;
        } else {
            between += 1;
        }
    }
    println!("{what}: {lit} lit, {dark} in shadow, {between} between");
    [lit, dark, between]
}

#[test]
fn a_ring_throws_the_shadow_on_itself_that_rays_find() {
    let position = Vec3::new(30.0, 7.0, 21.0);
    let spot_toward = |toward: Vec3| {
        let direction = (toward - position).normalize();
        Light::Spot { position, direction, intensity: Vec3::splat(1500.0), inner_angle: 0.3, outer_angle: 0.5 }
    };
    let lights = [
        ("sun", Light::Directional { toward: Vec3::new(0.8, 0.25, 0.55).normalize(), irradiance: Vec3::ONE }),
        ("lamp", Light::Point { position, intensity: Vec3::splat(1500.0) }),
        ("spot", spot_toward(Vec3::ZERO)),
        // Within the scene: six views.
        ("lamp beside the tube", Light::Point { position: Vec3::new(11.3, 2.0, 11.3), intensity: Vec3::splat(300.0) }),
    ];
    for (what, light) in lights {
        let ring = stone("ring", torus(MAJOR, MINOR, 256, 128), Vec3::splat(OPAQUE));
        let scene = scene(vec![ring], vec![light]).seen_from(58.0, 45.0);
        // A texel is 1/256 of a map's extent: 0.16 for a sun, up to 0.2 for one of six views at the
        // far end of the ring. The band is three texels.
        let [lit, dark, between] = compare(what, &scene, &light, 0.6);
        assert!(lit > 1000 && dark > 100, "{what}: {lit} {dark}");
        assert!(between < (lit + dark) / 4, "{what}: {between} pixels are not told apart");
    }
}

/// No point of a convex body that faces the light is in shadow, at any slant.
#[test]
fn a_ball_has_no_acne() {
    let near = Light::Point { position: Vec3::new(4.0, 3.0, 10.5), intensity: Vec3::splat(30.0) };
    for (what, light) in [("sun", sun()), ("lamp", lamp()), ("spot", spot()), ("lamp near by", near)] {
        let scene = ball(OPAQUE, vec![light]);
        let mut seen = 0;
        for (position, found) in on_the_ball(&scene, &draw(&scene, &settings("godunov-64"))) {
            let arrival = light.arrival(position);
            let cosine = (position / RADIUS).dot(arrival.direction);
            if cosine > 0.02 && arrival.irradiance.x > 1e-2 {
                let share = PI * found.x / (cosine * arrival.irradiance.x);
                // The mesh's normals are off by up to 1e-3 in the cosine, with the slant of the
                // view. Its position is off in a spot's soft edge, where light falls by half within
                // a hundredth of a radian.
                let tolerance = if what == "spot" { 0.1 } else { 0.01 };
                assert!((share - 1.0).abs() < tolerance + 1e-3 / cosine, "{what}: {share} at a cosine of {cosine}");
                seen += 1;
            } else if cosine < -0.02 {
                assert!(found.x < 1e-6, "{what}: {found} behind");
            }
        }
        assert!(seen > 300, "{what}: {seen}");
    }
}
