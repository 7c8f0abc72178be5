//! Tests of whole meshes: no ray escapes between triangles, the hierarchy finds the same hits as
//! the loop over all triangles, and both find the same hits as f64.

use super::*;
use crate::traversal::{TriangleFn, met, trace, trace_all, trace_with};
use glam::DVec3;
use lapidary_assay::draws::Draws;
use std::collections::BTreeMap;

struct Body {
    bvh: Bvh,
    positions: Vec<Vec3>,
}

fn body(positions: Vec<Vec3>, indices: &[u32]) -> Body {
    Body { bvh: Bvh::build(&positions, indices), positions }
}

impl Body {
    fn trace(&self, origin: Vec3, direction: Vec3, left: u32) -> BvhTraceHit {
        trace(&self.bvh.nodes, &self.bvh.corners, origin, direction, left)
    }
}

/// Builds a sphere from an icosahedron by cutting every triangle into four, `times` times over;
/// `radius` moves its vertices in and out.
fn icosphere(times: u32, radius: impl Fn(DVec3) -> f64) -> Body {
    let golden = 0.5 * (1.0 + 5f64.sqrt());
    let mut positions = Vec::new();
    for (a, b) in [(-1.0, golden), (1.0, golden), (-1.0, -golden), (1.0, -golden)] {
        positions.extend([DVec3::new(a, b, 0.0), DVec3::new(0.0, a, b), DVec3::new(b, 0.0, a)]);
    }
    let mut positions: Vec<DVec3> = positions.into_iter().map(DVec3::normalize).collect();
    // The faces are the triples of vertices at the smallest distance from one another.
    let near = |a: usize, b: usize| positions[a].distance(positions[b]) < 1.1;
    let mut faces = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                if near(a, b) && near(b, c) && near(c, a) {
                    let outside = (positions[b] - positions[a]).cross(positions[c] - positions[a]).dot(positions[a]);
                    faces.push(if outside > 0.0 { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    assert_eq!(faces.len(), 20);
    for _ in 0..times {
        let mut middles = BTreeMap::new();
        let mut finer = Vec::new();
        for [a, b, c] in faces {
            let mut middle = |a: usize, b: usize| {
                *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                    positions.push((positions[a] + positions[b]).normalize());
                    positions.len() - 1
                })
            };
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            finer.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
        }
        faces = finer;
    }
    let indices: Vec<u32> = faces.iter().flatten().map(|index| *index as u32).collect();
    body(positions.iter().map(|p| (radius(*p) * *p).as_vec3()).collect(), &indices)
}

fn sphere() -> Body {
    icosphere(3, |_| 1.0)
}

/// Builds a concave body with dents and bumps, every point of which is visible from the middle.
fn bumpy() -> Body {
    icosphere(4, |p| 1.0 + 0.3 * (5.0 * p.x).sin() * (4.0 * p.y + 1.0).cos() * (6.0 * p.z).sin())
}

/// Builds a body of few facets, with edges as sharp as at the girdle of a brilliant.
fn lens() -> Body {
    let solid = icosphere(0, |_| 1.0);
    body(solid.positions.iter().map(|p| Vec3::new(p.x, 0.2 * p.y, p.z)).collect(), &solid.bvh.indices)
}

/// Draws a ray from near the middle, aimed exactly at a vertex or at a point of an edge.
fn aimed_ray(random: &mut Draws<'_>, body: &Body) -> (Vec3, Vec3) {
    let origin = (0.1 * random.unit() * random.direction()).as_vec3();
    let origin = if random.below(4) == 0 { Vec3::ZERO } else { origin };
    let corner = 3 * random.below((body.bvh.indices.len() / 3) as u32) as usize;
    let [a, b] = [0, 1].map(|k| body.positions[body.bvh.indices[corner + k] as usize].as_dvec3());
    let target = if random.below(2) == 0 { a } else { a.lerp(b, random.unit()) };
    (origin, (target - origin.as_dvec3()).normalize().as_vec3())
}

fn leaks(body: &Body, rays: usize, with: TriangleFn) -> usize {
    let mut random = Draws::of_row(1, 0);
    (0..rays)
        .filter(|_| {
            let (origin, direction) = aimed_ray(&mut random, body);
            !met(&trace_with(&body.bvh.nodes, &body.bvh.corners, origin, direction, BVH_TRACE_NONE, with))
        })
        .count()
}

#[test]
fn no_ray_leaks_at_a_vertex_or_an_edge() {
    for body in [sphere(), bumpy()] {
        assert_eq!(leaks(&body, 200_000, triangle), 0);
    }
}

#[test]
#[ignore = "a minute"]
fn no_ray_of_a_million_leaks() {
    for body in [sphere(), bumpy(), lens()] {
        assert_eq!(leaks(&body, 1_000_000, triangle), 0);
        assert_eq!(lost(&body, 100_000, 64), 0);
    }
}

#[test]
fn the_naive_test_leaks_there() {
    for body in [sphere(), bumpy()] {
        let leaks = leaks(&body, 200_000, triangle_naive);
        println!("naive: {leaks} of 200000 rays leak");
        assert!(leaks > 100, "{leaks}");
    }
}

/// Returns a contradiction between the hit and f64 without any margin: a triangle that the ray
/// clearly meets is missed, or a triangle is hit that the ray does not meet.
fn faults(body: &Body, origin: Vec3, direction: Vec3, left: u32, hit: &BvhTraceHit) -> Option<String> {
    let BvhTraceExtent { lower, upper } = bounds(body.bvh.nodes[0]);
    let ray = ray(origin, direction, lower, upper);
    // The margin is measured along two axes of the ray's frame, which is oblique: at most √3 each
    // way.
    let bound = 3.0 * f64::from(ray.margin);
    let positions: Vec<DVec3> = body.positions.iter().map(|p| p.as_dvec3()).collect();
    let all = oracle::crossings(&positions, &body.bvh.indices, origin.as_dvec3(), direction.as_dvec3(), left, bound);
    let distance = f64::from(hit.distance);
    if met(hit) && !all.iter().any(|crossing| crossing.triangle == hit.triangle) {
        return Some(format!("{hit:?} is passed by more than {bound:e}"));
    }
    all.iter()
        .find(|crossing| crossing.clearance > bound && crossing.distance > bound && crossing.distance < distance - 1e-4)
        .map(|crossing| format!("{hit:?} although {crossing:?}"))
}

#[test]
fn the_nearest_triangle_is_that_of_f64() {
    let mut random = Draws::of_row(2, 0);
    let body = bumpy();
    for count in 0..4000 {
        let (mut origin, mut direction) = aimed_ray(&mut random, &body);
        if count % 2 == 0 {
            direction = random.direction().as_vec3();
        }
        let mut left = BVH_TRACE_NONE;
        if count % 4 == 0 {
            // From the surface back inside.
            let hit = body.trace(origin, direction, BVH_TRACE_NONE);
            origin += hit.distance * direction;
            direction = -direction;
            left = hit.triangle;
        }
        let hit = body.trace(origin, direction, left);
        assert!(met(&hit));
        let fault = faults(&body, origin, direction, left, &hit);
        assert_eq!(fault, None, "from {origin} to {direction}");
    }
}

#[test]
fn the_hierarchy_finds_what_the_loop_finds() {
    let mut random = Draws::of_row(3, 0);
    let body = bumpy();
    for _ in 0..3000 {
        let (origin, direction) = aimed_ray(&mut random, &body);
        let found = body.trace(origin, direction, BVH_TRACE_NONE);
        let all = trace_all(&body.bvh.nodes, &body.bvh.corners, origin, direction, BVH_TRACE_NONE, triangle);
        assert_eq!(found, all);
    }
}

/// Counts the rays that escape. Each starts from a facet inwards, aimed at a vertex or an edge of
/// another facet, where the neighbouring facets know nothing of the reflected direction, and goes
/// on by mirror reflections.
fn lost(body: &Body, rays: usize, bounces: usize) -> usize {
    let mut random = Draws::of_row(4, 0);
    let count = body.bvh.indices.len() / 3;
    let corners =
        |triangle: usize| [0, 1, 2].map(|k| body.positions[body.bvh.indices[3 * triangle + k] as usize].as_dvec3());
    let normal = |triangle: usize| {
        let [a, b, c] = corners(triangle);
        (b - a).cross(c - a).normalize()
    };
    let mut start = || loop {
        let left = random.below(count as u32) as usize;
        let [a, b, c] = corners(left);
        let (v, w) = (random.unit(), random.unit());
        let (v, w) = if v + w > 1.0 { (1.0 - v, 1.0 - w) } else { (v, w) };
        let origin = (a + v * (b - a) + w * (c - a)).as_vec3();
        let [from, to, _] = corners(random.below(count as u32) as usize);
        let target = if random.below(2) == 0 { from } else { from.lerp(to, random.unit()) };
        let direction = (target - origin.as_dvec3()).normalize();
        if normal(left).dot(direction) < -1e-4 {
            return (origin, direction.as_vec3(), left as u32);
        }
    };
    (0..rays)
        .filter(|_| {
            let (mut origin, mut direction, mut left) = start();
            (0..bounces).any(|_| {
                let hit = body.trace(origin, direction, left);
                if !met(&hit) {
                    return true;
                }
                let normal = normal(hit.triangle as usize);
                let slope = direction.as_dvec3().dot(normal);
                origin += hit.distance * direction;
                direction = (direction.as_dvec3() - 2.0 * slope * normal).normalize().as_vec3();
                left = hit.triangle;
                false
            })
        })
        .count()
}

#[test]
fn sixty_four_reflections_stay_inside_at_every_size() {
    for (name, solid) in [("bumpy", bumpy()), ("lens", lens())] {
        for scale in [1.0, 1e-4, 1e4] {
            let scaled = body(solid.positions.iter().map(|position| scale * *position).collect(), &solid.bvh.indices);
            let lost = lost(&scaled, 10_000, 64);
            println!("{name} at scale {scale}: {lost} of 10000 lost within 64 reflections");
            assert_eq!(lost, 0, "{name} at scale {scale}");
        }
    }
}

/// A body is a million times its size away from the world's origin. f32 resolves only quarters
/// to thirty-seconds there, so the mesh loses its shape. In the body's own coordinates the ray hits
/// the same point as in f64, as far as its origin is exact.
#[test]
fn a_body_far_away_is_traced_in_its_own_coordinates() {
    let body = sphere();
    let place = Vec3::new(1_048_576.0, -2_097_152.0, 524_288.0);
    let moved = self::body(body.positions.iter().map(|position| *position + place).collect(), &body.bvh.indices);
    let positions: Vec<DVec3> = body.positions.iter().map(|position| position.as_dvec3()).collect();
    let mut random = Draws::of_row(11, 0);
    let (mut worst, mut worst_there) = (0.0f64, 0.0f64);
    for _ in 0..200 {
        let origin = place + (Vec3::new(1.0, 0.0, -2.0) * 0.125);
        let direction = random.direction().as_vec3();
        let ray = to_object(origin, direction, place, Vec3::X, Vec3::Y, Vec3::Z);
        let hit = body.trace(ray.origin, ray.direction, BVH_TRACE_NONE);
        assert!(met(&hit));
        let (start, along) = ((origin - place).as_dvec3(), direction.as_dvec3());
        let crossings = oracle::crossings(&positions, &body.bvh.indices, start, along, BVH_TRACE_NONE, 1e-9);
        let ahead = crossings.iter().map(|crossing| crossing.distance).filter(|distance| *distance > 0.0);
        let exact = ahead.fold(f64::INFINITY, f64::min);
        worst = worst.max((f64::from(hit.distance / ray.stretch) - exact).abs());
        let there = moved.trace(origin, direction, BVH_TRACE_NONE);
        worst_there = worst_there.max((f64::from(there.distance) - exact).abs());
    }
    assert!(worst < 1e-5, "{worst:e}");
    assert!(worst_there > 0.01, "{worst_there:e}");
}
