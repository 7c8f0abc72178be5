//! A homogeneous ball, in which every cheapest way is a straight chord.

use super::{RADIUS, ball, draw, lamp, settings, spot, sun};
use glam::{DVec3, Vec3};
use lapidary_assay::extremum::larger;
use lapidary_optical_path::oracle;
use lapidary_render::voxel_grid::VoxelGrid;
use lapidary_scene::{Light, Scene};
use lapidary_testing::pixels::on_the_ball;
use std::f64::consts::PI;

/// Radius of the ball in optical depths.
const DEPTH: f64 = 8.0;
/// Largest compared cost in nats.
const DEEPEST: f64 = 12.0;

/// Returns the irradiance that enters the ball at the end of a unit vector.
fn entering(light: &Light, place: DVec3) -> f64 {
    let arrival = light.arrival(RADIUS * place);
    arrival.irradiance.x * place.dot(arrival.direction).max(0.0)
}

/// Returns the most light that reaches a point in the ball of radius 1 along any chord: the best of
/// `places`, then a search about it.
fn along_chords(light: &Light, places: &[(DVec3, f64)], point: DVec3) -> f64 {
    let past = |place: DVec3| (-DEPTH * place.distance(point)).exp();
    let from = |place: DVec3| entering(light, place) * past(place);
    let best = places.iter().max_by(|a, b| (a.1 * past(a.0)).total_cmp(&(b.1 * past(b.0)))).expect("some").0;
    let (mut best, mut most) = (best, from(best));
    // Light falls only on the surface.
    if point.is_normalized() && from(point) > most {
        (best, most) = (point, from(point));
    }
    let mut step = 0.05;
    while step > 1e-5 {
        let (right, up) = best.any_orthonormal_pair();
        let tried =
            [right, -right, up, -up].map(|way| (best + step * way).normalize()).map(|place| (place, from(place)));
        match tried.into_iter().max_by(|a, b| a.1.total_cmp(&b.1)) {
            Some((place, value)) if value > most => (best, most) = (place, value),
            _ => step *= 0.5,
        }
    }
    most
}

/// Evenly over the unit sphere: a Fibonacci lattice.
fn lattice(light: &Light) -> Vec<(DVec3, f64)> {
    let count = 4000;
    let place = |index: u32| {
        let z = 1.0 - (2.0 * f64::from(index) + 1.0) / f64::from(count);
        let (sine, cosine) = (f64::from(index) * PI * (3.0 - 5f64.sqrt())).sin_cos();
        let radius = (1.0 - z * z).sqrt();
        DVec3::new(radius * cosine, radius * sine, z)
    };
    let places = (0..count).map(place).map(|place| (place, entering(light, place)));
    places.filter(|(_, entering)| *entering > 0.0).collect()
}

fn lit_ball(light: Light) -> Scene {
    ball(DEPTH as f32, vec![light])
}

/// Returns the grid's contribution, at first order in the voxel, to the cost at an unlit point of
/// the ball's surface. `cost` is the true cost of points in the ball of radius 1.
fn of_grid(point: DVec3, grid: VoxelGrid, cost: &dyn Fn(DVec3) -> f64) -> f64 {
    let voxel = f64::from(grid.spacing) / RADIUS;
    let shift = 0.0025;
    let differences = |place: DVec3| {
        let middle = cost(place);
        let ends = DVec3::AXES.map(|axis| [cost(place + shift * axis), cost(place - shift * axis)]);
        let first = ends.map(|[after, before]| (after - before) / (2.0 * shift));
        let second = ends.map(|[after, before]| (after - 2.0 * middle + before) / (shift * shift));
        (DVec3::from_array(first), DVec3::from_array(second))
    };
    let end = (1.0 - 2.0 * shift) * point;
    let way = differences(end).0.normalize();
    // Godunov's update takes backward differences. On each axis these are off by half a voxel times
    // the second derivative. The cost is off by their sum along the way, weighted by the first
    // derivatives over the slope of the cost. The way is a chord, and in the voxels about its
    // beginning the seeds are exact.
    let length = (2.0 * end.dot(way) - voxel).max(0.0);
    let steps = 16;
    let step = length / f64::from(steps);
    let growth = |index: u32| {
        let (first, second) = differences(end - (f64::from(index) + 0.5) * step * way);
        first.abs().dot(second) / DEPTH
    };
    let solver = 0.5 * voxel * step * (0..steps).map(growth).sum::<f64>();
    // The way from the best node about the point to the point is straight too, but not along the
    // chord.
    let origin = grid.origin.as_dvec3() / RADIUS;
    let cell = ((point - origin) / voxel).floor();
    let nodes = (0..27).map(|index| DVec3::new(f64::from(index % 3), f64::from(index / 3 % 3), f64::from(index / 9)));
    let nodes = nodes.map(|node| origin + (cell + node - 0.5) * voxel).filter(|node| node.length() < 1.0);
    let detours = nodes.map(|node| (point - node).length() - (point - node).dot(way));
    solver + DEPTH * detours.fold(f64::INFINITY, f64::min)
}

/// Errors of a picture of the ball.
struct Errors {
    /// Root mean square error of the costs in nats, over all pixels.
    nats: f64,
    /// The same according to [`of_grid`].
    theory: f64,
    /// Largest relative error of pixels whose cheapest path begins at the pixel itself, with at least
    /// a tenth of the brightest light that enters.
    lit: f64,
}

impl Errors {
    /// Upper limit of the relative contribution of higher orders in the voxel.
    const HIGHER_ORDERS: f64 = 0.35;

    /// Compares one pixel in `every`. `cost` is the cost of points in the ball of radius 1, 0 at
    /// the point that the most light enters.
    fn of(light: Light, cells: u32, every: usize, cost: &dyn Fn(DVec3) -> f64) -> Self {
        let scene = lit_ball(light);
        let grid = VoxelGrid::about(scene.bounds(), cells);
        let brightest = lattice(&light).iter().fold(0.0f64, |most, (_, entering)| most.max(*entering));
        let (mut squares, mut theory, mut worst_lit) = (0.0, 0.0, 0.0f64);
        let (mut count, mut lit, mut dark) = (0, 0, 0);
        let picture = draw(&scene, &settings(&format!("godunov-{cells}")));
        for (position, found) in on_the_ball(&scene, &picture).into_iter().step_by(every) {
            assert!(found.x == found.y && found.y == found.z, "grey: {found}");
            let point = position.normalize();
            let (found, wanted, own_light) = (-(PI * found.x / brightest).ln(), cost(point), entering(&light, point));
            if wanted > DEEPEST {
                continue;
            }
            let own_is_cheapest = -(own_light / brightest).ln() <= wanted + 1e-9;
            squares += (found - wanted).powi(2);
            theory += if own_is_cheapest { 0.0 } else { of_grid(point, grid, cost).powi(2) };
            count += 1;
            if own_is_cheapest && own_light >= 0.1 * brightest {
                worst_lit = larger(worst_lit, ((wanted - found).exp() - 1.0).abs());
                lit += 1;
            }
            dark += usize::from(own_light == 0.0);
        }
        assert!(lit * every > 1000 && dark * every > 1500, "{lit} lit, {dark} dark of {count} pixels");
        let [nats, theory] = [squares, theory].map(|sum| (sum / f64::from(count)).sqrt());
        println!(
            "rms {nats:.3} nats, by theory {theory:.3}, over {count} pixels; lit ones off by {worst_lit:.1e} at most"
        );
        Self { nats, theory, lit: worst_lit }
    }

    fn check(&self, what: &str) {
        let Self { nats, theory, lit } = *self;
        assert!((nats / theory - 1.0).abs() <= Self::HIGHER_ORDERS, "{what}: {nats} nats, by theory {theory}");
        assert!(lit <= LIT, "{what}: {lit}");
    }
}

/// Largest relative error of lit pixels. The place of a pixel on the mesh of 256 columns is off the
/// sphere by (2π / 256)² / 8 of its radius, and interpolated normals are off by less. At a cosine
/// of a tenth this gives 3e-3, with the slant at which the camera sees it.
const LIT: f64 = 3e-3;

#[test]
fn a_ball_under_a_sun_is_the_closed_form() {
    for toward in lapidary_testing::sampled([Vec3::NEG_X, Vec3::Y, Vec3::new(-0.8, 0.6, 0.0)], 4) {
        let light = Light::Directional { toward, irradiance: Vec3::splat(2.0) };
        let cost = |place: DVec3| oracle::ball(DEPTH, DEPTH * place.length(), place.angle_between(toward.as_dvec3()));
        for cells in [64, 128] {
            Errors::of(light, cells, 45, &cost).check(&format!("{toward}, {cells}"));
        }
        // The search over chords finds the same.
        let places = lattice(&light);
        for (point, _) in places.iter().step_by(7) {
            let (searched, closed) = (along_chords(&light, &places, -*point), 2.0 * (-cost(-*point)).exp());
            assert!((searched / closed).ln().abs() < 1e-6, "{searched} {closed}");
        }
    }
}

#[test]
fn balls_under_a_lamp_and_under_a_spot_are_the_best_of_all_chords() {
    for light in [lamp(), spot()] {
        let places = lattice(&light);
        let brightest = places.iter().fold(0.0f64, |most, (_, entering)| most.max(*entering));
        let cost = |place: DVec3| -(along_chords(&light, &places, place) / brightest).ln();
        Errors::of(light, 64, 135, &cost).check(&format!("{light:?}"));
    }
}

/// A finer grid is more accurate: the remaining error is the grid's.
#[test]
fn errors_fall_with_the_voxels() {
    let Light::Directional { toward, irradiance } = sun() else { panic!("a sun") };
    let scene = lit_ball(sun());
    let rms = ["godunov-32", "godunov-64", "godunov-128"].map(|rung| {
        let (mut squares, mut count) = (0.0, 0);
        for (position, found) in on_the_ball(&scene, &draw(&scene, &settings(rung))) {
            let cost = oracle::ball(DEPTH, DEPTH, position.angle_between(toward.as_dvec3()));
            if cost < DEEPEST {
                squares += ((PI * found.x / f64::from(irradiance.x)).ln() + cost).powi(2);
                count += 1;
            }
        }
        (squares / f64::from(count)).sqrt()
    });
    println!("32, 64 and 128 voxels: {rms:.3?} nats");
    assert!(rms[0] > 1.5 * rms[1] && rms[1] > 1.5 * rms[2] && rms[2] <= 0.1, "{rms:?}");
}
