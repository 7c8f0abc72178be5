//! A homogeneous ball under parallel light, whose costs have a closed form.

use super::bodies::Case;
use super::solve;
use glam::{UVec3, Vec3};
use lapidary_optical_path::oracle;
use lapidary_optical_path::{OPTICAL_PATH_UNREACHED, relax, seed, through};
use lapidary_scene::solver::{Method, Stencil};

/// Radius of the ball in voxels.
const RADIUS: f32 = 30.0;
/// Radius of the ball in optical depths.
const DEPTH: f32 = 8.0;
/// Points along an edge of the shadow map.
const MAP: u32 = 512;

/// Returns the ball in 64³ voxels, lit along -z by the points of a shadow map. Each point seeds the
/// 27 voxels about it, by its distance to their centres, as in the recipe.
fn lit() -> Case {
    let middle = Vec3::splat(32.0);
    let inside = |voxel: UVec3| (voxel.as_vec3() + 0.5 - middle).length() <= RADIUS;
    let mut case = Case::of(64, DEPTH / RADIUS, inside);
    for index in 0..MAP * MAP {
        let across = (UVec3::new(index % MAP, index / MAP, 0).as_vec3() + 0.5) * (2.0 / MAP as f32) - 1.0;
        let height = 1.0 - across.x * across.x - across.y * across.y;
        if height <= 0.0 {
            continue;
        }
        let normal = Vec3::new(across.x, across.y, height.sqrt());
        // Slightly inside, so that the point lies in matter if the centre of its voxel does.
        let point = middle + (RADIUS - 0.5) * normal;
        if !case.matter[case.grid.index(point.floor().as_uvec3())] {
            continue;
        }
        for near in about(point) {
            let voxel = case.grid.index(near);
            if case.matter[voxel] {
                let offset = (middle + RADIUS * normal - case.grid.centre(near)).length();
                case.seeds[voxel] = case.seeds[voxel].min(seed(normal.z, case.extinction, offset));
            }
        }
    }
    case
}

/// Returns the voxels about a point.
fn about(point: Vec3) -> impl Iterator<Item = UVec3> {
    let first = point.floor().as_ivec3() - 1;
    (0..27).map(move |place| (first + glam::IVec3::new(place % 3, place / 3 % 3, place / 9)).as_uvec3())
}

/// Returns the cost at a shaded point of the surface: the least of its own light and the voxels
/// about it.
fn looked_up(case: &Case, costs: &[f32], normal: Vec3) -> f32 {
    let point = Vec3::splat(32.0) + RADIUS * normal;
    let own_cost = seed(normal.z, case.extinction, 0.0);
    about(point).fold(own_cost, |least, voxel| {
        let offset = (point - case.grid.centre(voxel)).length();
        relax(least, through(costs[case.grid.index(voxel)], case.extinction, offset), 0.0)
    })
}

/// Returns the root mean square errors of the costs in nats: at the ball's surface, as looked up
/// there, and in its voxels.
fn rms(case: &Case, method: Method) -> [f64; 2] {
    let costs = solve(case, method);
    let inside: Vec<f64> = (0..costs.len())
        .filter(|index| case.matter[*index])
        .map(|index| {
            let place = (case.grid.centre(case.grid.voxel(index)) - 32.0).as_dvec3();
            let distance = place.length() * f64::from(case.extinction);
            let exact = oracle::ball(f64::from(DEPTH), distance, place.angle_between(glam::DVec3::Z));
            (f64::from(costs[index]) - exact).powi(2)
        })
        .collect();
    let inside = (inside.iter().sum::<f64>() / inside.len() as f64).sqrt();
    let count = 4000;
    let squares = (0..count).map(|index| {
        // Evenly over the sphere: a Fibonacci lattice.
        let z = 1.0 - (2.0 * f64::from(index) + 1.0) / f64::from(count);
        let azimuth = f64::from(index) * std::f64::consts::PI * (3.0 - 5f64.sqrt());
        let radius = (1.0 - z * z).sqrt();
        let normal = glam::DVec3::new(radius * azimuth.cos(), radius * azimuth.sin(), z);
        let exact = oracle::ball(f64::from(DEPTH), f64::from(DEPTH), z.acos());
        (f64::from(looked_up(case, &costs, normal.as_vec3())) - exact).powi(2)
    });
    [(squares.sum::<f64>() / f64::from(count)).sqrt(), inside]
}

#[test]
fn godunov_finds_the_balls_costs_and_stencils_their_own() {
    let case = lit();
    // From docs/optical_path.md.
    let stated = [
        (Method::Tiled(Stencil::Faces), [1.066, 1.302]),
        (Method::Tiled(Stencil::Edges), [0.326, 0.266]),
        (Method::Tiled(Stencil::Corners), [0.326, 0.255]),
        (Method::Godunov, [0.076, 0.058]),
    ];
    for (method, stated) in lapidary_testing::sampled(stated, 4) {
        let found = rms(&case, method);
        println!("{method}: {:.3} nats at the surface, {:.3} in the voxels", found[0], found[1]);
        for (found, stated) in found.into_iter().zip(stated) {
            assert!((found / stated - 1.0).abs() < 0.03, "{method}: {found} nats, {stated} stated");
        }
    }
}

/// Without the distance between voxel and lit point, the far side is too bright.
#[test]
fn offsets_count() {
    let case = lit();
    let mut naive = case.clone();
    for index in 0..naive.seeds.len() {
        if naive.seeds[index] < OPTICAL_PATH_UNREACHED {
            let normal = (naive.grid.centre(naive.grid.voxel(index)) - 32.0).normalize();
            naive.seeds[index] = seed(normal.z.max(1e-6), naive.extinction, 0.0);
        }
    }
    let exact = oracle::ball(f64::from(DEPTH), f64::from(DEPTH), std::f64::consts::PI) as f32;
    let with = looked_up(&case, &solve(&case, Method::Godunov), Vec3::NEG_Z);
    let pole = (Vec3::splat(32.0) - (RADIUS - 0.5) * Vec3::Z).as_uvec3();
    let without = solve(&naive, Method::Godunov)[case.grid.index(pole)];
    println!("far pole: {exact} exact, {with} with offsets, {without} without");
    assert!((with - exact).abs() < 0.05, "{exact}: {with} with");
    // By a factor of e^0.7, about two.
    assert!((0.6..0.8).contains(&(exact - without)), "{exact}: {without} without");
}
