use super::*;
use lapidary_scene::Scene;

fn bodies(name: &str, geometry: Geometry) -> (Scene, Bodies) {
    let scene = Scene::named(name).unwrap();
    let bodies = Bodies::new(&scene.objects, geometry);
    (scene, bodies)
}

/// Returns evenly spread rays from a sphere around the scene through a ball within its bounds.
fn rays(scene: &Scene, count: u32) -> impl Iterator<Item = (DVec3, DVec3)> {
    let centre = scene.bounds().centre().as_dvec3();
    let radius = f64::from(scene.bounds().radius());
    let spiral = move |k: f64, turn: f64| {
        let height = 1.0 - 2.0 * (k + 0.5) / f64::from(count);
        let (sine, cosine) = (turn * k).sin_cos();
        DVec3::new(cosine, 0.0, sine) * (1.0 - height * height).sqrt() + DVec3::Y * height
    };
    (0..count).map(move |k| {
        let origin = centre + 2.0 * radius * spiral(f64::from(k), 2.4);
        let through = centre + 0.5 * radius * spiral(f64::from(k * 7 % count), 5.1);
        (origin, (through - origin).normalize())
    })
}

/// Finds where a ray inside the body of `left`, from which it starts, leaves that body.
fn leave(bodies: &Bodies, origin: DVec3, direction: DVec3, left: Place) -> Option<Hit> {
    bodies.leave_body(origin, direction, left.body, Some(left.face), f64::INFINITY)
}

#[test]
fn through_a_closed_surface_ways_in_and_out_alternate() {
    let (scene, bodies) = bodies("bunny_stone", Geometry::Triangles);
    let mut entered = 0;
    for (mut origin, direction) in rays(&scene, 5000) {
        let mut left = None;
        while let Some(hit) = bodies.enter(origin, direction, left) {
            assert!(hit.normal.dot(direction) < 1e-9);
            origin += hit.distance * direction;
            let out = leave(&bodies, origin, direction, hit.place).expect("a way out");
            assert!(out.normal.dot(direction) > -1e-9);
            origin += out.distance * direction;
            left = Some(out.place);
            entered += 1;
        }
    }
    assert!(entered > 2000, "{entered}");
}

/// Counts the entries of rays, and the entries that lead to no exit.
fn ways_in(scene: &Scene) -> [u32; 2] {
    let bodies = Bodies::new(&scene.objects, Geometry::Triangles);
    let [mut entered, mut trapped] = [0, 0];
    for (mut origin, direction) in rays(scene, 5000) {
        let (mut left, mut passes) = (None, 0);
        while let Some(hit) = bodies.enter(origin, direction, left) {
            entered += 1;
            origin += hit.distance * direction;
            let Some(out) = leave(&bodies, origin, direction, hit.place) else {
                trapped += 1;
                break;
            };
            origin += out.distance * direction;
            left = Some(out.place);
            passes += 1;
            assert!(passes < 30, "to and fro");
        }
    }
    [entered, trapped]
}

/// A bunny with some triangles back to back.
#[test]
fn between_triangles_back_to_back_there_is_nothing() {
    let mut scene = Scene::named("bunny_stone").expect("built in");
    let mesh = &mut scene.objects[0].mesh;
    let folded: Vec<u32> =
        mesh.indices.chunks_exact(3).step_by(7).flat_map(|t| [t[0], t[1], t[2], t[2], t[1], t[0]]).collect();
    mesh.indices.extend(folded);
    let [entered, trapped] = ways_in(&scene);
    assert!(entered > 2000 && trapped == 0, "{trapped} of {entered}");
}

/// The dragon's scan intersects itself in places.
#[test]
fn where_a_mesh_crosses_itself_few_rays_are_trapped() {
    let [entered, trapped] = ways_in(&Scene::named("dragon").expect("built in"));
    assert!(entered > 2000 && trapped * 200 < entered, "{trapped} of {entered}");
}

#[test]
fn the_tree_finds_what_a_search_of_all_triangles_finds() {
    let (scene, _) = bodies("bunny_stone", Geometry::Triangles);
    let triangles = Triangles::new(&scene.objects[0].mesh);
    for (origin, direction) in rays(&scene, 500) {
        let shear = Shear::new(direction);
        let all = triangles.corners.iter().filter_map(|corners| shear.meet(origin, corners, Side::Front));
        let nearest = all.filter(|distance| *distance >= 0.0).reduce(f64::min);
        let found = triangles.first(origin, direction, None, f64::INFINITY, Side::Front);
        assert_eq!(found.map(|(distance, ..)| distance), nearest);
    }
}

#[test]
fn planes_and_triangles_of_one_stone_are_met_alike() {
    let (scene, planes) = bodies("brilliant", Geometry::Planes);
    let (_, triangles) = bodies("brilliant", Geometry::Triangles);
    let mut met = 0;
    for (origin, direction) in rays(&scene, 2000) {
        let (a, b) = (planes.enter(origin, direction, None), triangles.enter(origin, direction, None));
        // A ray that grazes an edge may meet one and not the other.
        let (Some(a), Some(b)) = (a, b) else { continue };
        let slope = a.normal.dot(direction).abs();
        assert!((a.distance - b.distance).abs() < 1e-6 / slope, "{a:?} {b:?}");
        let inside = origin + a.distance * direction;
        let (c, d) = (leave(&planes, inside, direction, a.place), leave(&triangles, inside, direction, b.place));
        let (c, d) = (c.unwrap(), d.unwrap());
        let slope = c.normal.dot(direction).abs();
        assert!((c.distance - d.distance).abs() < 2e-6 / slope, "{c:?} {d:?}");
        met += 1;
    }
    assert!(met > 800, "{met}");
}

/// The sieve is only an aid: it never leaves out the answer.
#[test]
fn the_sieve_keeps_the_nearest_plane() {
    for (name, offset) in [("brilliant", 0.0), ("step_cut", 0.0), ("prism", 0.0), ("brilliant", 300.0)] {
        let mut scene = Scene::named(name).unwrap();
        scene.objects[0].mesh.positions.iter_mut().for_each(|position| *position += offset);
        let bodies = Bodies::new(&scene.objects, Geometry::Planes);
        let [Body::Convex(planes)] = &bodies.bodies[..] else { panic!("{name} is convex") };
        let (mut searches, mut candidates) = (0, 0);
        for (origin, direction) in rays(&scene, 2000) {
            let Some(hit) = bodies.enter(origin, direction, None) else { continue };
            let (mut origin, mut direction, mut left) = (origin + hit.distance * direction, direction, hit.place.face);
            // Reflected repeatedly, to come near edges.
            for _ in 0..20 {
                let distances = planes.planes.iter().enumerate().filter_map(|(face, plane)| {
                    let slope = plane.normal.dot(direction);
                    (slope > 0.0 && face != left).then(|| (face, -plane.height(origin) / slope))
                });
                let (face, distance) = distances.min_by(|a, b| a.1.total_cmp(&b.1)).expect("a way out");
                let found = planes.leave(origin, direction, Some(left)).expect("a way out");
                assert_eq!((found.0, found.1), (distance.max(0.0), face), "{name}");
                planes.sieve.candidates(origin, direction, |_| candidates += 1);
                searches += 1;
                (origin, left) = (origin + found.0 * direction, face);
                direction -= 2.0 * direction.dot(found.2) * found.2;
            }
        }
        println!("{name}: {candidates} candidates in {searches} searches");
        assert!(searches > 5000 && candidates < 3 * searches, "{name}: {candidates} of {searches}");
    }
}

/// Rays pass exactly through an edge shared by two triangles, and through a corner shared by
/// several.
#[test]
fn nothing_slips_through_edges_and_corners() {
    let (_, octahedron) = bodies("octahedron", Geometry::Triangles);
    for direction in [DVec3::Z, -DVec3::Z, DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y] {
        for aside in [DVec3::ZERO, 0.25 * direction.any_orthonormal_vector(), DVec3::splat(0.0625)] {
            let aside = aside - aside.dot(direction) * direction;
            let hit = octahedron.enter(aside - 3.0 * direction, direction, None).expect("a way in");
            let inside = aside + (hit.distance - 3.0) * direction;
            let out = leave(&octahedron, inside, direction, hit.place).expect("a way out");
            let depth = 2.0 * (1.0 - aside.abs().element_sum());
            assert!((out.distance - depth).abs() < 1e-12, "{direction} {aside}");
        }
    }
}

#[test]
fn what_leaves_a_stone_may_enter_another() {
    let (mut scene, _) = bodies("octahedron", Geometry::Planes);
    let mut second = scene.objects[0].clone();
    second.mesh.positions.iter_mut().for_each(|position| position.z += 5.0);
    scene.objects.push(second);
    for geometry in [Geometry::Planes, Geometry::Triangles] {
        let bodies = Bodies::new(&scene.objects, geometry);
        let aside = DVec3::new(0.125, 0.25, -3.0);
        let first = bodies.enter(aside, DVec3::Z, None).unwrap();
        let out = leave(&bodies, aside + first.distance * DVec3::Z, DVec3::Z, first.place).unwrap();
        let after = aside + (first.distance + out.distance) * DVec3::Z;
        let second = bodies.enter(after, DVec3::Z, Some(out.place)).unwrap();
        assert_eq!((first.place.body, out.place.body, second.place.body), (0, 0, 1));
        assert!((after.z + second.distance - (5.0 - 0.625)).abs() < 1e-12);
        assert!(bodies.enter(after, -DVec3::Y, Some(out.place)).is_none());
    }
}

/// Rays from a point inside leave at the body's surface in any direction. With a nearer limit, no
/// exit is found.
#[test]
fn rays_from_inside_leave() {
    for geometry in [Geometry::Planes, Geometry::Triangles] {
        let (_, octahedron) = bodies("octahedron", geometry);
        let inside = DVec3::new(0.125, 0.25, -0.0625);
        for k in 0..500u32 {
            let direction = DVec3::new(f64::from(k % 7) - 2.9, f64::from(k % 11) - 5.2, f64::from(k % 13) - 6.1);
            let direction = direction.normalize();
            let out = octahedron.leave_body(inside, direction, 0, None, f64::INFINITY).expect("a way out");
            let height = (inside + out.distance * direction).abs().element_sum();
            assert!((height - 1.0).abs() < 1e-6 && out.normal.dot(direction) > 0.0, "{direction}: {height}");
            assert_eq!(octahedron.leave_body(inside, direction, 0, None, 1.001 * out.distance), Some(out));
            assert_eq!(octahedron.leave_body(inside, direction, 0, None, 0.999 * out.distance), None);
        }
    }
}
