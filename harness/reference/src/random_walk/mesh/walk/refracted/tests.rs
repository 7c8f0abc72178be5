use super::super::tests::{grey, scene, sun};
use super::*;
use crate::generator::generator;
use crate::random_walk::isotropic;
use crate::spectral::geometry::Geometry;
use glam::DQuat;
use lapidary_scene::Mesh;
use lapidary_scene::surfaces::{sphere, torus};
use rand::RngExt as _;
use std::f64::consts::{PI, TAU};

fn bodies(mesh: Mesh) -> Bodies {
    Bodies::new(&scene(vec![(mesh, grey(0.9))], vec![sun(DVec3::Z)]).objects, Geometry::Triangles)
}

fn sources() -> [Source; 4] {
    let place = DVec3::new(0.4, 0.3, 3.1);
    let near = DVec3::new(2.1, -0.2, 0.1);
    [Source::Far(DVec3::new(0.3, -0.5, 0.7).normalize()), Source::At(place), Source::At(near), Source::At(1e7 * place)]
}

/// Unit direction from a point on the surface to the source.
fn toward(source: Source, point: DVec3) -> DVec3 {
    match source {
        Source::Far(toward) => toward,
        Source::At(place) => (place - point).normalize(),
    }
}

/// The tree finds what a search of all triangles finds, and every path obeys Snell's law.
#[test]
fn every_path_is_found_and_obeys_snells_law() {
    let bodies = bodies(torus(1.2, 0.5, 40, 20).placed(DQuat::from_rotation_x(0.6), DVec3::ZERO));
    let mut random = generator(4, 0);
    for source in sources() {
        for index in [1.0, 1.4, 2.4, 0.8] {
            let facing = Facing::new(&bodies, 0, source, index);
            let mut count = 0;
            for _ in 0..400 {
                let position = 1.8 * random.random::<f64>() * isotropic(&mut random);
                let limit = if random.random::<f64>() < 0.5 { f64::INFINITY } else { random.random() };
                let mut found = Vec::new();
                facing.visit(position, limit, |path| found.push(path.face));
                found.sort_unstable();
                let all = || facing.triangles.iter().filter_map(|triangle| facing.path(triangle, position, limit));
                let mut expected: Vec<usize> = all().map(|path| path.face).collect();
                expected.sort_unstable();
                assert_eq!(found, expected);
                count += found.len();
                for path in all() {
                    let normal = bodies.triangles(0).nth(path.face).map_or(DVec3::ZERO, |(_, normal)| *normal);
                    let along = |direction: DVec3| direction - direction.dot(normal) * normal;
                    let outside = toward(source, path.crossing);
                    let difference = along(outside).distance(index * along(path.direction));
                    assert!(difference < 1e-7, "{source:?} {index}: {difference}");
                    assert!((path.direction.length() - 1.0).abs() < 1e-12 && path.distance <= limit);
                    assert!(path.crossing.distance(position + path.distance * path.direction) < 1e-12);
                }
            }
            assert!(count > 40, "{source:?} {index}: {count}");
        }
    }
}

/// The gain is the solid angle into which a lamp sends the light of a small area at the point,
/// measured by moving the point.
#[test]
fn the_gain_is_the_change_of_a_beams_cross_section() {
    let bodies = bodies(sphere(1.0, 8));
    let mut random = generator(5, 0);
    let mut count = 0;
    for source in sources() {
        for index in [1.4, 2.4] {
            let facing = Facing::new(&bodies, 0, source, index);
            for _ in 0..300 {
                let position = 0.9 * random.random::<f64>() * isotropic(&mut random);
                let mut paths = Vec::new();
                facing.visit(position, f64::INFINITY, |path| paths.push(path));
                for path in paths {
                    let Some(triangle) = facing.triangles.iter().find(|triangle| triangle.face == path.face) else {
                        continue;
                    };
                    let step = 1e-5;
                    let moved = |aside: DVec3| facing.path(triangle, position + step * aside, f64::INFINITY);
                    let (a, b) = path.direction.any_orthonormal_pair();
                    let (Some(first), Some(second)) = (moved(a), moved(b)) else { continue };
                    let cosine = toward(source, path.crossing).dot(triangle.normal);
                    let transmittance = 1.0 - dielectric(cosine, index);
                    // Area at the crossing, perpendicular to the light.
                    let area = (first.crossing - path.crossing).cross(second.crossing - path.crossing);
                    let cross_section = area.length() * cosine / (step * step);
                    let expected = match source {
                        // A beam of parallel light keeps its power.
                        Source::Far(_) => cross_section,
                        // Per solid angle instead: the crossing moves along the surface.
                        Source::At(place) => {
                            let ways = [path, first, second].map(|path| (path.crossing - place).normalize());
                            let angle = (ways[1] - ways[0]).cross(ways[2] - ways[0]).length();
                            angle / (step * step) * path.crossing.distance_squared(place)
                        }
                    };
                    let expected = transmittance * expected / (index * index);
                    let is_far = matches!(source, Source::At(place) if place.length() > 1e6);
                    assert!(
                        is_far || (path.gain / expected - 1.0).abs() < 1e-3,
                        "{source:?} {index}: {} {expected}",
                        path.gain
                    );
                    count += 1;
                }
            }
        }
    }
    assert!(count > 1000, "{count}");
}

/// Irradiance summed over a ball's inside is the power that enters, times the length of its first
/// way through.
#[test]
fn what_enters_a_ball_is_found_inside() {
    let (radius, index, far) = (1.0, 1.4, 2.5);
    let bodies = bodies(sphere(radius, 96));
    // By the sine of the angle at which light falls on the ball.
    let entering = |sine: f64| {
        let cosine = (1.0 - sine * sine).sqrt();
        let chord = 2.0 * radius * (1.0 - sine * sine / (index * index)).sqrt();
        (1.0 - dielectric(cosine, index)) * chord
    };
    let count = 4000;
    let middles = || (0..count).map(|k| (f64::from(k) + 0.5) / f64::from(count));
    let parallel: f64 = middles().map(|sine| TAU * sine * radius * radius * entering(sine) / f64::from(count)).sum();
    // A ray at the angle a from the axis passes the middle at far · sin a.
    let widest = (radius / far).asin();
    let lamp: f64 = middles()
        .map(|share| widest * share)
        .map(|angle| TAU * angle.sin() * entering(far * angle.sin() / radius) * widest / f64::from(count))
        .sum();
    for (source, expected) in [(Source::Far(DVec3::X), parallel), (Source::At(DVec3::new(0.0, far, 0.0)), lamp)] {
        let facing = Facing::new(&bodies, 0, source, index);
        let mut random = generator(6, 0);
        let samples = 40_000;
        let (mut sum, mut squares) = (0.0, 0.0);
        for _ in 0..samples {
            let position = radius * random.random::<f64>().cbrt() * isotropic(&mut random);
            let mut found = 0.0;
            facing.visit(position, f64::INFINITY, |path| {
                let irradiance = match source {
                    Source::Far(_) => 1.0,
                    Source::At(place) => path.crossing.distance_squared(place).recip(),
                };
                found += path.gain * index * index * irradiance;
            });
            sum += found;
            squares += found * found;
        }
        let mean = sum / f64::from(samples);
        let error = ((squares / f64::from(samples) - mean * mean) / f64::from(samples)).sqrt();
        let volume = 4.0 / 3.0 * PI * radius.powi(3);
        println!("{source:?}: {} ± {}, expected {expected}", volume * mean, volume * error);
        // The ball of triangles is smaller by a fraction of a percent.
        assert!((volume * mean - expected).abs() < 4.0 * volume * error + 4e-3 * expected);
        assert!(volume * error < 0.02 * expected);
    }
}

#[test]
fn a_path_along_the_normal_and_one_that_almost_grazes() {
    assert_eq!(crossing(2.0, 3.0, 0.0, 1.4), 0.0);
    for (depth, height, width, index) in [
        (1.0, 1.0, 2.0, 1.0),
        (1e-9, 1.0, 5.0, 1.4),
        (1.0, 1e-6, 8.0, 1.4),
        (1e-3, 1e9, 1e10, 2.4),
        (3.0, 1e-9, 1.0, 4.0),
    ] {
        let near = crossing(depth, height, width, index);
        let (inside, outside) = (near / near.hypot(depth), (width - near) / (width - near).hypot(height));
        assert!((0.0..=width).contains(&near) && (index * inside - outside).abs() < 1e-9, "{depth} {height}: {near}");
    }
}

#[test]
fn a_body_that_faces_away_has_no_path() {
    let bodies = bodies(Mesh::with_shared_normals(Vec::new(), Vec::new(), lapidary_scene::Averaging::Angle));
    let facing = Facing::new(&bodies, 0, Source::Far(DVec3::Z), 1.4);
    facing.visit(DVec3::ZERO, f64::INFINITY, |_| panic!("there is no triangle"));
    assert_eq!(refracted(DVec3::Z, DVec3::Z, 1.4), None);
    assert_eq!(refracted(DVec3::X, DVec3::Z, 1.4), None);
}
