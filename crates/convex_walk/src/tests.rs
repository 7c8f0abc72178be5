//! Tests of the map, and of walks in whole stones: each hit against a loop over all planes from the
//! same state, for stones of every size, with rays from edges and vertices and along facets.

use super::*;
use glam::{DVec3, DVec4, Vec4, Vec4Swizzles as _};
use lapidary_assay::draws::Draws;
use lapidary_convex_trace::{self as convex_trace, CONVEX_TRACE_FAR, CONVEX_TRACE_NONE, ConvexTraceHit};
use std::f64::consts::PI;

/// Returns the hit of the loop that the WGSL file's header shows, and the number of its passes before
/// the last.
fn walk(map: &FacetMap, planes: &[Vec4], position: Vec3, direction: Vec3, left: u32) -> (ConvexTraceHit, u32) {
    let mut hit = convex_trace::start(exit(position, direction, map.lower, map.upper));
    let (mut words, mut passes) = (0, 0);
    while words < CONVEX_WALK_STEPS {
        let before = hit.face;
        for (number, face) in (0..).zip(map.candidates(position + hit.distance * direction)) {
            hit = convex_trace::step(hit, position, direction, planes[face as usize], face, left);
            // Two candidates a word.
            words += number % 2;
        }
        if hit.face == before {
            return (hit, passes);
        }
        passes += 1;
    }
    panic!("no end of the walk from {position} along {direction}");
}

/// Returns the point with these cylindrical coordinates.
fn at(radius: f64, azimuth: f64, z: f64) -> DVec3 {
    DVec3::new(radius * azimuth.cos(), radius * azimuth.sin(), z)
}

/// Returns the plane through a point.
fn through(point: DVec3, normal: DVec3) -> DVec4 {
    let normal = normal.normalize();
    normal.extend(normal.dot(point))
}

/// Returns the planes of a brilliant of `turns` main facets and `tiers` of facets above the girdle
/// and below, with one outline: tiers are tangents to its arcs. Tier by tier, from the table down.
fn brilliant(turns: usize, tiers: usize) -> Vec<DVec4> {
    let mut planes = vec![through(DVec3::Z * 0.34, DVec3::Z)];
    let step = 2.0 * PI / turns as f64;
    for tier in 0..tiers {
        let along = (tier as f64 + 0.5) / tiers as f64;
        for turn in 0..turns {
            let azimuth = step * (turn as f64 + 0.5 * (tier % 2) as f64);
            for (side, slope) in [(1.0, 0.55 + 0.35 * along), (-1.0, 0.75 + 0.25 * along)] {
                let (radius, height) = (1.0 - 0.3 * (1.0 - along), 0.02 + 0.15 * (1.0 - along));
                planes.push(through(at(radius, azimuth, side * height), at(slope, azimuth, side)));
            }
        }
    }
    for turn in 0..turns {
        let azimuth = step * (turn as f64 + 0.25);
        planes.push(through(at(1.0, azimuth, 0.0), at(1.0, azimuth, 0.0)));
    }
    planes
}

/// Returns the planes of a lens of about `count` facets, tangent to two caps.
fn lens(count: usize) -> Vec<DVec4> {
    let golden = PI * (3.0 - 5f64.sqrt());
    let facet = |index: usize| {
        let along = (index as f64 + 0.5) / (count / 2) as f64;
        let tilt = 0.6 * along.sqrt();
        let normal = at(tilt.sin(), golden * index as f64, tilt.cos());
        // Two spheres of radius 1 about (0, 0, ±0.7).
        [1.0, -1.0].map(|side| {
            let normal = DVec3::new(normal.x, normal.y, side * normal.z);
            normal.extend(1.0 - 0.7 * normal.z.abs())
        })
    };
    let mut planes: Vec<DVec4> = (0..count / 2).flat_map(facet).collect();
    planes.extend(
        (0..12).map(|turn| through(at(0.5, PI * f64::from(turn) / 6.0, 0.0), at(1.0, PI * f64::from(turn) / 6.0, 0.0))),
    );
    planes
}

/// Returns the planes of a needle, 40 times as long as wide.
fn needle() -> Vec<DVec4> {
    let sides = (0..6).map(|turn| PI * f64::from(turn) / 3.0);
    let mut planes: Vec<DVec4> =
        sides.clone().map(|azimuth| through(at(0.05, azimuth, 0.0), at(1.0, azimuth, 0.0))).collect();
    for end in [1.0, -1.0] {
        planes.extend(sides.clone().map(|azimuth| through(DVec3::Z * 2.0 * end, at(1.0, azimuth, 0.3 * end))));
    }
    planes
}

/// A stone in f32, with its map.
struct Stone {
    planes: Vec<Vec4>,
    map: FacetMap,
    size: f64,
}

impl Stone {
    fn of(planes: &[DVec4], size: f64, side: u32) -> Self {
        let planes: Vec<Vec4> = planes.iter().map(|plane| plane.xyz().extend(size * plane.w).as_vec4()).collect();
        let map = FacetMap::of_planes(&planes, side).expect("a map");
        Self { planes, map, size }
    }
}

/// Rounding of a height over a plane, and of a point of the ray, in units of the stone's size: the
/// product of the distance and the direction, the sum with the position, and three products and
/// sums each in height and slope, of numbers up to three sizes, all to 2^-24.
const BACKWARD: f64 = 16.0 / (1 << 24) as f64 * 3.0;

/// What a path did.
#[derive(Default, Debug)]
struct Counts {
    hits: u64,
    /// Hits on another facet than the loop over all planes finds.
    other: u64,
    /// Largest height of such a hit over the planes of the stone, in units of its size.
    outside: f64,
    steps: u64,
    most_steps: u32,
}

impl Counts {
    /// Follows a ray through `bounces` reflections. Each hit is also found by the loop; where the
    /// facets differ, the point must lie on the stone's surface to within rounding, so that either
    /// facet is right.
    fn follow(&mut self, stone: &Stone, mut position: Vec3, mut direction: Vec3, mut left: u32, bounces: usize) {
        for bounce in 0..bounces {
            let (hit, steps) = walk(&stone.map, &stone.planes, position, direction, left);
            let all = convex_trace::trace(&stone.planes, position, direction, left);
            self.hits += 1;
            self.steps += u64::from(steps);
            self.most_steps = self.most_steps.max(steps);
            assert_ne!(
                hit.face, CONVEX_TRACE_NONE,
                "bounce {bounce} from {position} along {direction}, left {left}: {all:?}"
            );
            if hit != all {
                let end = position.as_dvec3() + f64::from(hit.distance) * direction.as_dvec3();
                let height = |plane: &Vec4| plane.as_dvec4().xyz().dot(end) - f64::from(plane.w);
                let outside = stone.planes.iter().map(height).fold(f64::NEG_INFINITY, f64::max) / stone.size;
                assert!(
                    hit.distance >= all.distance && outside <= BACKWARD,
                    "bounce {bounce} from {position} along {direction}, left {left}: {hit:?}, not {all:?}, {outside:e} outside"
                );
                self.other += u64::from(hit.face != all.face);
                self.outside = self.outside.max(outside);
            }
            let plane = stone.planes[all.face as usize];
            position = convex_trace::point(position, direction, all.distance, plane);
            direction -= 2.0 * plane.xyz().dot(direction) * plane.xyz();
            left = all.face;
        }
    }

    fn mean_steps(&self) -> f64 {
        self.steps as f64 / self.hits as f64
    }
}

/// Number of hits of the tests: a million; `LAPIDARY_WALKS=100000000` for the long run.
fn hits() -> u64 {
    std::env::var("LAPIDARY_WALKS").ok().and_then(|text| text.parse().ok()).unwrap_or(1_000_000)
}

fn inside(stone: &Stone, seed: u64, hits: u64, bounces: usize) -> Counts {
    let mut counts = Counts::default();
    let mut draws = Draws::of_row(seed, 0);
    while counts.hits < hits {
        // From a point inside all planes, at a share of the way to the surface.
        let outwards = draws.direction();
        let way = |plane: &Vec4| f64::from(plane.w) / plane.as_dvec4().xyz().dot(outwards).max(1e-9);
        let most = stone.planes.iter().map(way).fold(f64::INFINITY, f64::min);
        let position = (0.99 * draws.unit() * most * outwards).as_vec3();
        counts.follow(stone, position, draws.direction().as_vec3(), CONVEX_TRACE_NONE, bounces);
    }
    counts
}

#[test]
fn each_hit_is_that_of_all_planes() {
    let share = hits() / 15;
    for (name, planes, size, most) in [
        ("brilliant", brilliant(8, 4), 1.0, 4.0),
        ("small", brilliant(8, 4), 1e-4, 4.0),
        ("large", brilliant(8, 4), 1e4, 4.0),
        ("lens", lens(2_000), 1.0, 6.0),
        ("needle", needle(), 1.0, 5.0),
    ] {
        for side in [16, 64, 256] {
            let stone = Stone::of(&planes, size, side);
            let counts = inside(&stone, 1, share, 64);
            println!("{name}, {} planes, side {side}: {counts:?}, {:.2} steps", planes.len(), counts.mean_steps());
            assert!(counts.other * 1_000 < counts.hits, "{name}, {side}: {counts:?}");
            assert!(counts.mean_steps() < most, "{name}, {side}: {counts:?}");
        }
    }
}

#[test]
fn rays_from_corners_and_along_facets() {
    let mut draws = Draws::of_row(2, 0);
    for (planes, size) in [(brilliant(8, 4), 1.0), (brilliant(8, 4), 1e-4), (needle(), 1.0), (lens(200), 1e4)] {
        let stone = Stone::of(&planes, size, 64);
        let mut counts = Counts::default();
        for _ in 0..4_000 {
            // A point of the surface, and the edge of its facet in a direction.
            let outwards = draws.direction();
            let slope = |plane: &Vec4| plane.as_dvec4().xyz().dot(outwards) / f64::from(plane.w);
            let faces = (0..).zip(&stone.planes);
            let Some((face, plane)) = faces.max_by(|a, b| slope(a.1).total_cmp(&slope(b.1))) else { continue };
            let (start, normal) = (outwards / slope(plane), plane.as_dvec4().xyz());
            let tangent = normal.cross(draws.direction()).normalize();
            let way = |(other, plane): (u32, &Vec4)| {
                let (height, slope) =
                    (f64::from(plane.w) - plane.as_dvec4().xyz().dot(start), plane.as_dvec4().xyz().dot(tangent));
                if other != face && slope > 0.0 { height / slope } else { f64::INFINITY }
            };
            let edge = (0..).zip(&stone.planes).map(way).fold(f64::INFINITY, f64::min);
            let position = (start + edge * tangent).as_vec3();
            // Along the facet to the last ulp, back along it, and inwards.
            for towards in [tangent, -tangent, draws.direction() - normal] {
                counts.follow(&stone, position, towards.normalize().as_vec3(), face, 16);
            }
        }
        println!("{size}: {counts:?}");
        assert!(counts.hits > 2_000, "{counts:?}");
    }
}

#[test]
fn every_facet_of_a_direction_is_in_its_cell() {
    let mut draws = Draws::of_row(3, 0);
    for planes in [brilliant(8, 4), lens(2_000), needle()] {
        let stone = Stone::of(&planes, 1.0, 32);
        for _ in 0..20_000 {
            let direction = draws.direction();
            let height = |plane: &Vec4| plane.as_dvec4().xyz().dot(direction) / f64::from(plane.w);
            let seen =
                (0..stone.planes.len()).max_by(|a, b| height(&stone.planes[*a]).total_cmp(&height(&stone.planes[*b])));
            let list: Vec<u32> = stone.map.candidates(direction.as_vec3()).collect();
            assert!(list.contains(&(seen.expect("a plane") as u32)), "{direction}: {list:?} without {seen:?}");
        }
    }
}

#[test]
fn without_one_candidate_a_walk_goes_wrong() {
    // The test above notices a list that lacks a facet.
    let stone = Stone::of(&brilliant(8, 4), 1.0, 64);
    let mut map = stone.map.clone();
    let side = map.side as usize;
    for word in &mut map.words[..side * side] {
        *word = (*word & CONVEX_WALK_FACE) * (1 + (1 << CONVEX_WALK_SHIFT));
    }
    let mut draws = Draws::of_row(4, 0);
    let wrong = (0..10_000).filter(|_| {
        let (position, direction) = ((0.1 * draws.direction()).as_vec3(), draws.direction().as_vec3());
        let (hit, _) = walk(&map, &stone.planes, position, direction, CONVEX_TRACE_NONE);
        hit.face != convex_trace::trace(&stone.planes, position, direction, CONVEX_TRACE_NONE).face
    });
    assert!(wrong.count() > 100);
}

#[test]
fn a_plane_that_bounds_nothing_is_in_no_cell() {
    let mut planes = vec![DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
    planes.push(DVec3::ONE.normalize());
    let planes: Vec<Vec4> = planes.iter().map(|normal| normal.as_vec3().extend(1.0)).collect();
    let mut far = planes.clone();
    far[6].w = 1.8;
    let lists = |planes: &[Vec4]| FacetMap::of_planes(planes, 16).expect("a map");
    let holds = |map: &FacetMap| map.candidates(Vec3::ONE).any(|face| face == 6);
    assert!(holds(&lists(&planes)) && !holds(&lists(&far)));
}

#[test]
fn what_has_no_map_is_told() {
    let cube: Vec<Vec4> =
        [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z].map(|n| n.extend(1.0)).to_vec();
    let error_of = |planes: &[Vec4], side| FacetMap::of_planes(planes, side).expect_err("no map").to_string();
    assert!(error_of(&cube, 0).contains("even number") && error_of(&cube, 7).contains("a map of side 7"));
    assert!(error_of(&cube[..5], 8).contains("leave a side open") && error_of(&[], 8).contains("leave a side open"));
    let mut away = cube.clone();
    away[3].w = -0.5;
    assert!(error_of(&away, 8).contains("plane 3"), "{}", error_of(&away, 8));
    away[3].w = f32::NAN;
    assert!(error_of(&away, 8).contains("plane 3"));
    assert!(error_of(&vec![Vec4::W; 5_000], 8).contains("5000 facets"));
}

/// The runner-up of a walk, of the candidates that it tests, is the second plane of all where the edge
/// between the two is within half a pixel of a stone of 250; farther off, it matters to no pixel.
#[test]
fn the_runner_up_of_a_walk_is_that_of_all_planes_beside_an_edge() {
    for (name, planes, side) in
        [("brilliant", brilliant(8, 4), 64), ("more facets", brilliant(16, 8), 128), ("lens", lens(200), 64)]
    {
        let stone = Stone::of(&planes, 1.0, side);
        let mut draws = Draws::of_row(4, 0);
        let (mut near, mut other) = (0, 0);
        for _ in 0..4_000 {
            let (mut position, mut direction) = (Vec3::ZERO, draws.direction().as_vec3());
            let mut left = CONVEX_TRACE_NONE;
            for _ in 0..16 {
                let mut found = [exit(position, direction, stone.map.lower, stone.map.upper), CONVEX_TRACE_FAR]
                    .map(convex_trace::start);
                let both = |[nearest, runner_up]: [ConvexTraceHit; 2], face: u32| {
                    let far = convex_trace::start(CONVEX_TRACE_FAR);
                    let hit = convex_trace::step(far, position, direction, stone.planes[face as usize], face, left);
                    let nearer = if hit.distance < nearest.distance { hit } else { nearest };
                    [nearer, convex_trace::runner_up(nearest, runner_up, hit)]
                };
                loop {
                    let before = found[0].face;
                    let point = position + found[0].distance * direction;
                    found = stone.map.candidates(point).fold(found, both);
                    if found[0].face == before {
                        break;
                    }
                }
                let far = [CONVEX_TRACE_FAR; 2].map(convex_trace::start);
                let all = (0..stone.planes.len() as u32).fold(far, both);
                // How far the edge is from the ray, across it: docs/ray_footprint.md.
                let normals = all.map(|hit| stone.planes[hit.face as usize].xyz());
                let slopes = normals.map(|normal| normal.dot(direction));
                let across = slopes[0] * normals[1] - slopes[1] * normals[0];
                let gap = (all[1].distance - all[0].distance) * slopes[0] * slopes[1];
                if gap < 0.004 * across.length() && all[0].face == found[0].face {
                    near += 1;
                    other += u32::from(all[1].face != found[1].face);
                }
                let plane = stone.planes[all[0].face as usize];
                position = convex_trace::point(position, direction, all[0].distance, plane);
                direction -= 2.0 * plane.xyz().dot(direction) * plane.xyz();
                left = all[0].face;
            }
        }
        println!("{name}: {other} of {near} runners-up near an edge are others");
        assert!(near > 500 && other * 20 < near, "{name}: {other} of {near}");
    }
}
