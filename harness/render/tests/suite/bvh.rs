//! The hierarchy over a mesh, and the recipe that traces rays with it: whole buffers, compared with
//! the mirror's and with f64 by brute force.

use glam::{DVec3, Vec2, Vec3};
use lapidary_assay::draws::{Domain, Draws};
use lapidary_assay::extremum::larger;
use lapidary_bvh_trace::traversal::{self, BVH_TRACE_LEAF, BVH_TRACE_LEVELS, met};
use lapidary_bvh_trace::{self as mirror, BVH_TRACE_NONE, BvhTraceExtent, BvhTraceHit, BvhTraceNode, oracle};
use lapidary_gpu::Gpu;
use lapidary_render::compute::{self, Binding, RecipeRun};
use lapidary_scene::{Bvh, Mesh, Scene};

/// Rays per body.
const RAYS: usize = 16_384;

struct Query {
    origin: Vec3,
    direction: Vec3,
    left: u32,
}

struct Body {
    name: &'static str,
    mesh: Mesh,
    bvh: Bvh,
}

fn body(name: &'static str) -> Body {
    let scene = Scene::named(name).expect("a built-in scene");
    let mesh = scene.objects[0].mesh.clone();
    let bvh = Bvh::build(&mesh.positions, &mesh.indices);
    Body { name, mesh, bvh }
}

fn bodies() -> [Body; 3] {
    ["brilliant", "bunny_stone", "prism"].map(body)
}

impl Body {
    fn corners(&self, triangle: usize) -> [Vec3; 3] {
        [0, 1, 2].map(|k| self.mesh.positions[self.bvh.indices[3 * triangle + k] as usize])
    }

    fn trace(&self, query: &Query) -> BvhTraceHit {
        traversal::trace(&self.bvh.nodes, &self.bvh.corners, query.origin, query.direction, query.left)
    }

    /// Reflects a ray at its hit.
    fn reflected(&self, query: &Query, hit: &BvhTraceHit) -> Query {
        let [a, b, c] = self.corners(hit.triangle as usize).map(|p| p.as_dvec3());
        let normal = (b - a).cross(c - a).normalize();
        let direction = query.direction.as_dvec3();
        Query {
            origin: query.origin + hit.distance * query.direction,
            direction: (direction - 2.0 * direction.dot(normal) * normal).normalize().as_vec3(),
            left: hit.triangle,
        }
    }

    /// Returns rays that start on the surface and go inwards: to a vertex, to a point of an edge
    /// that is not behind the ray, or anywhere; and the same after some reflections.
    fn queries(&self, seed: u64, count: usize) -> Vec<Query> {
        (0..count as u64)
            .map(|row| {
                let draws = &mut Draws::of_row(seed ^ lapidary_testing::seed(), row);
                let mut query = self.start(draws);
                for _ in 0..draws.below(3) {
                    let hit = self.trace(&query);
                    if met(&hit) {
                        query = self.reflected(&query, &hit);
                    }
                }
                query
            })
            .collect()
    }

    fn start(&self, draws: &mut Draws<'_>) -> Query {
        let count = self.bvh.order.len() as u32;
        loop {
            let left = draws.below(count);
            let [a, b, c] = self.corners(left as usize).map(|p| p.as_dvec3());
            let normal = (b - a).cross(c - a).normalize_or_zero();
            let (mut v, mut w) = (draws.unit(), draws.unit());
            if v + w > 1.0 {
                (v, w) = (1.0 - v, 1.0 - w);
            }
            let origin = (a + v * (b - a) + w * (c - a)).as_vec3();
            let [from, to, _] = self.corners(draws.below(count) as usize).map(|p| p.as_dvec3());
            let direction = match draws.below(3) {
                0 => (from - origin.as_dvec3()).normalize(),
                1 => (from.lerp(to, draws.unit()) - origin.as_dvec3()).normalize(),
                _ => draws.direction(),
            };
            // Grazing rays too, but no ray that starts outwards.
            if normal.dot(direction) < -1e-4 {
                return Query { origin, direction: direction.as_vec3(), left };
            }
        }
    }
}

/// Runs the recipe over `queries`.
fn traced(gpu: &Gpu, body: &Body, queries: &[Query], constants: &[(&str, f64)]) -> Vec<BvhTraceHit> {
    let words: Vec<[u32; 8]> = queries
        .iter()
        .map(|query| {
            let [x, y, z] = query.origin.to_array().map(f32::to_bits);
            let [u, v, w] = query.direction.to_array().map(f32::to_bits);
            [x, y, z, query.left, u, v, w, 0]
        })
        .collect();
    let nodes = body.bvh.words();
    let mesh =
        [Binding::Storage(bytemuck::cast_slice(&nodes)), Binding::Storage(bytemuck::cast_slice(&body.bvh.corners))];
    // Distance, padding, weights, triangle, padding.
    let rays = [Binding::Storage(bytemuck::cast_slice(&words)), Binding::Result((queries.len() * 24) as u64)];
    let run = RecipeRun {
        recipe: "trace",
        entry: "trace_rays",
        constants,
        bindings: &[&mesh, &rays],
        workgroups: [queries.len().div_ceil(64) as u32, 1, 1],
    };
    let words = compute::run_recipe(gpu, &run).unwrap_or_else(|error| panic!("{error}"));
    let hit = |words: &[u32]| BvhTraceHit {
        distance: f32::from_bits(words[0]),
        barycentrics: Vec2::new(f32::from_bits(words[2]), f32::from_bits(words[3])),
        triangle: words[4],
    };
    words.chunks_exact(6).map(hit).collect()
}

/// Returns the distance by which a ray may pass a triangle and still meet it: the margin in the
/// ray's own, slanted frame, times √3 across and √3 for the slant.
fn bound(body: &Body, query: &Query) -> f64 {
    let BvhTraceExtent { lower, upper } = mirror::bounds(body.bvh.nodes[0]);
    let ray = mirror::ray(query.origin, query.direction, lower, upper);
    3.0 * f64::from(ray.margin)
}

/// Returns the tolerance of a distance. If a ray meets two planes at the same place up to the
/// bound, its distances to them agree up to the bound over the cosine at the triangle.
fn slack(body: &Body, query: &Query, triangle: u32) -> f64 {
    let [a, b, c] = body.corners(triangle as usize).map(|p| p.as_dvec3());
    let normal = (b - a).cross(c - a).normalize();
    bound(body, query) / normal.dot(query.direction.as_dvec3())
}

/// Compares a hit with f64 without a margin: no triangle that the ray clearly meets is missed, and
/// none is made up.
fn fault(body: &Body, positions: &[DVec3], query: &Query, hit: &BvhTraceHit) -> Option<String> {
    let bound = bound(body, query);
    let (origin, direction) = (query.origin.as_dvec3(), query.direction.as_dvec3());
    let crossings = oracle::crossings(positions, &body.bvh.indices, origin, direction, query.left, bound);
    let distance = f64::from(hit.distance);
    let matching = crossings.iter().find(|crossing| crossing.triangle == hit.triangle);
    if matching.is_none() {
        return Some(format!("{hit:?} is passed by more than {bound:e}"));
    }
    let nearer = |crossing: &&oracle::Crossing| {
        let slack = slack(body, query, crossing.triangle);
        crossing.clearance > bound && crossing.distance > slack && crossing.distance + slack < distance
    };
    crossings.iter().find(nearer).map(|crossing| format!("{hit:?} although {crossing:?}"))
}

#[test]
fn the_recipe_traces_as_its_mirror_does_and_as_f64_does() {
    let gpu = lapidary_testing::gpu();
    for body in lapidary_testing::sampled(bodies(), 3) {
        let queries = body.queries(11, RAYS);
        let found = traced(gpu, &body, &queries, &[]);
        let mirrored: Vec<BvhTraceHit> = queries.iter().map(|query| body.trace(query)).collect();
        let positions: Vec<DVec3> = body.mesh.positions.iter().map(|p| p.as_dvec3()).collect();
        let (mut others, mut largest) = (0, 0f32);
        for ((query, found), mirrored) in queries.iter().zip(&found).zip(&mirrored) {
            assert!(met(found), "{}: a leak from {} to {}", body.name, query.origin, query.direction);
            if found.triangle == mirrored.triangle {
                largest = larger(largest, (found.distance - mirrored.distance).abs());
            } else {
                others += 1;
            }
            for hit in [found, mirrored] {
                let fault = fault(&body, &positions, query, hit);
                assert_eq!(fault, None, "{}: from {} to {}", body.name, query.origin, query.direction);
            }
        }
        println!(
            "{}: {} nodes in {} levels; {RAYS} rays, {others} meet another triangle than the mirror's, distance off by {largest:e}",
            body.name,
            body.bvh.nodes.len(),
            body.bvh.levels()
        );
        // On lavapipe every operation rounds as in the mirror, except for the order of a product of
        // matrices, which this recipe does not use.
        if gpu.is_lavapipe() {
            assert_eq!(found, mirrored, "{}", body.name);
        }
    }
}

#[test]
fn a_loop_over_all_triangles_meets_the_same() {
    let gpu = lapidary_testing::gpu();
    for body in bodies() {
        let queries = body.queries(12, if body.name == "bunny_stone" { 2_048 } else { RAYS });
        let by_tree = traced(gpu, &body, &queries, &[]);
        let by_loop = traced(gpu, &body, &queries, &[("TRAVERSAL_LOOP", 1.0)]);
        let positions: Vec<DVec3> = body.mesh.positions.iter().map(|p| p.as_dvec3()).collect();
        let mut others = 0;
        for ((query, tree), every) in
            queries.iter().zip(&by_tree).zip(&by_loop).filter(|((_, tree), every)| tree != every)
        {
            // Near an edge, a ray meets two triangles at one place, up to the margin. The tree does
            // not open the box of one triangle if the hit on the other is nearer than the box. The
            // loop takes the nearer hit. Either is right.
            others += 1;
            assert_ne!(tree.triangle, every.triangle, "{}: from {} to {}", body.name, query.origin, query.direction);
            for hit in [tree, every] {
                let fault = fault(&body, &positions, query, hit);
                assert_eq!(fault, None, "{}: from {} to {}", body.name, query.origin, query.direction);
            }
            let reach: f64 = [tree, every].map(|hit| slack(&body, query, hit.triangle).abs()).iter().sum();
            let difference = f64::from(tree.distance - every.distance).abs();
            // A NaN fails.
            assert!(
                difference <= reach,
                "{}: {tree:?} and {every:?} are {difference:e} apart, at most {reach:e}",
                body.name
            );
        }
        println!("{}: {others} of {} rays meet another triangle by the loop", body.name, queries.len());
        // Not a bound, but it detects a tree that leads elsewhere.
        assert!(others * 1000 <= queries.len(), "{}: {others} of {}", body.name, queries.len());
    }
}

#[test]
fn rays_to_vertices_and_edges_leak_with_the_naive_test_only() {
    let gpu = lapidary_testing::gpu();
    for body in bodies() {
        let queries = body.queries(13, RAYS);
        let leaks =
            |constants: &[(&str, f64)]| traced(gpu, &body, &queries, constants).iter().filter(|hit| !met(hit)).count();
        assert_eq!(leaks(&[]), 0, "{}", body.name);
        let naive = leaks(&[("TRIANGLE_NAIVE", 1.0)]);
        println!("{}: {naive} of {RAYS} leak with the naive test", body.name);
        assert!(naive > 50, "{}: {naive}", body.name);
    }
}

#[test]
fn sixty_four_reflections_inside_the_bunny_lose_no_ray() {
    let body = body("bunny_stone");
    for mut query in body.queries(14, 2_000) {
        for bounce in 0..64 {
            let hit = body.trace(&query);
            assert!(met(&hit), "bounce {bounce}: a leak from {} to {}", query.origin, query.direction);
            query = body.reflected(&query, &hit);
        }
    }
}

/// Returns a mesh of any kind: random, of equal triangles, without area, huge, tiny, flat, or with
/// corners that are not finite or do not exist.
fn any_mesh(draws: &mut Draws<'_>) -> Mesh {
    let count = 1 + draws.below(300);
    let size = draws.pick(&[1.0, 1e-30, 1e37, 1.0, 3e38]);
    let kind = draws.below(7);
    let mut positions = Vec::new();
    for _ in 0..count {
        let a = size * draws.in_cube();
        let (b, c) = (a + 0.1 * size * draws.in_cube(), a + 0.1 * size * draws.in_cube());
        let triangle = match kind {
            0 => [Vec3::ZERO, Vec3::X, Vec3::Y],
            1 => [a; 3],
            2 => [a, b, 0.5 * a + 0.5 * b],
            3 => [a, b, c].map(|p| Vec3::new(p.x, 0.0, p.z)),
            4 if draws.below(4) == 0 => [a, Vec3::NAN, c],
            4 if draws.below(4) == 0 => [a, b, Vec3::INFINITY],
            // Smaller and smaller towards the origin, which clusters one by one.
            5 => [a, b, c].map(|p| p * 2f32.powi(-((positions.len() / 3) as i32))),
            _ => [a, b, c],
        };
        positions.extend(triangle);
    }
    let mut indices: Vec<u32> = (0..positions.len() as u32).collect();
    if kind == 6 {
        let place = draws.below(indices.len() as u32) as usize;
        indices[place] = u32::MAX;
    }
    Mesh { normals: vec![Vec3::Y; positions.len()], positions, indices, ..Mesh::default() }
}

/// Checks the properties that a shader relies on.
fn check_hierarchy(mesh: &Mesh, bvh: &Bvh) {
    assert!(bvh.levels() <= BVH_TRACE_LEVELS, "{} levels", bvh.levels());
    assert_eq!(bvh.indices.len(), 3 * bvh.order.len());
    let finite = |index: &u32| mesh.positions.get(*index as usize).is_some_and(|position| position.is_finite());
    let mut wanted: Vec<u32> =
        mesh.indices.chunks_exact(3).zip(0..).filter(|(t, _)| t.iter().all(finite)).map(|(_, number)| number).collect();
    let mut reached = Vec::new();
    // A box of f64, in which the sum of a corner and its steps does not round.
    let inside = |point: Vec3, node: &BvhTraceNode, child: usize| {
        (0..3).all(|axis| {
            let step = 2f64.powi((node.steps >> (8 * axis) & 255) as i32 - 127);
            let side =
                |bytes: glam::UVec3| f64::from(node.corner[axis]) + f64::from(bytes[axis] >> (8 * child) & 255) * step;
            (side(node.lower)..=side(node.upper)).contains(&f64::from(point[axis]))
        })
    };
    // Nodes, with the places in their ancestors that lead to them.
    let mut open = if bvh.nodes.is_empty() { vec![] } else { vec![(0, vec![])] };
    let mut visited = 0;
    while let Some((place, above)) = open.pop() {
        visited += 1;
        for child in 0..4 {
            let path: Vec<(usize, usize)> = above.iter().copied().chain([(place, child)]).collect();
            let number = bvh.nodes[place].children[child];
            if number == BVH_TRACE_NONE {
                continue;
            }
            if number < BVH_TRACE_LEAF {
                assert!(number as usize > place);
                open.push((number as usize, path));
                continue;
            }
            let first = (number & (BVH_TRACE_LEAF - 1)) as usize;
            for triangle in first..first + (number >> 30) as usize {
                let number = bvh.order[triangle];
                reached.push(number);
                for k in 0..3 {
                    let vertex = mesh.indices[3 * number as usize + k];
                    assert_eq!(bvh.indices[3 * triangle + k], vertex);
                    let position = mesh.positions[vertex as usize];
                    assert_eq!(bvh.corners[3 * triangle + k], position.extend(0.0));
                    assert!(path.iter().all(|(place, child)| inside(position, &bvh.nodes[*place], *child)));
                }
            }
        }
    }
    assert_eq!(visited, bvh.nodes.len(), "no node without a parent");
    reached.sort_unstable();
    wanted.sort_unstable();
    assert_eq!(reached, wanted, "every triangle once");
}

#[test]
fn every_hierarchy_holds_its_mesh() {
    let meshes = Domain::new(any_mesh);
    for row in 0..2_000 {
        let mesh = meshes.row(15, row);
        check_hierarchy(&mesh, &Bvh::build(&mesh.positions, &mesh.indices));
    }
    for body in bodies() {
        check_hierarchy(&body.mesh, &body.bvh);
    }
    let empty = Bvh::build(&[], &[]);
    assert_eq!((empty.nodes.len(), empty.indices.len(), empty.levels()), (0, 0, 0));
}

#[test]
fn many_equal_triangles_still_fit_the_stack() {
    let count = 20_000;
    let positions = [Vec3::ZERO, Vec3::X, Vec3::Y].repeat(count);
    let indices = (0..3 * count as u32).collect();
    let mesh = Mesh { normals: vec![Vec3::Z; positions.len()], positions, indices, ..Mesh::default() };
    let bvh = Bvh::build(&mesh.positions, &mesh.indices);
    check_hierarchy(&mesh, &bvh);
    println!("{count} equal triangles: {} levels", bvh.levels());
}
