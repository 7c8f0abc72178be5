//! What each diagram says is so, by another way than the one it was drawn by.

use super::scene::{Scene, Shape};
use super::*;
use glam::{DVec2, Vec3, Vec4Swizzles as _};

#[test]
fn every_label_can_be_read() {
    for diagram in all() {
        let faults = legible::faults(&(diagram.draw)());
        assert!(faults.is_empty(), "{}: {faults:?}", diagram.name);
    }
}

#[test]
fn a_label_that_cannot_be_read_is_found() {
    let mut scene = Scene::new(100, 100);
    scene.note(DVec2::new(50.0, 50.0), scene::Anchor::Middle, scene::Paint::Ink, "word");
    assert!(legible::faults(&scene).is_empty());
    let mut crossed = scene.clone();
    crossed.line(&[DVec2::new(0.0, 40.0), DVec2::new(100.0, 60.0)], scene::INK);
    assert_eq!(legible::faults(&crossed), ["a line crosses `word`"]);
    scene.note(DVec2::new(70.0, 54.0), scene::Anchor::Middle, scene::Paint::Ink, "long words");
    assert_eq!(legible::faults(&scene), ["`long words` leaves the sheet", "`long words` lies over `word`"]);
}

#[test]
fn each_belongs_to_a_module_and_has_a_name_of_its_own() {
    let mut names = std::collections::HashSet::new();
    for diagram in all() {
        let Diagram { name, module, caption, .. } = diagram;
        assert!(names.insert(name), "{name} twice");
        assert!(lapidary_cookbook::module(module).is_some(), "{name}: no module {module}");
        assert!(!caption.contains("  ") && caption.ends_with('.'), "{name}: {caption}");
    }
}

#[test]
fn a_file_carries_its_colours_and_a_page_does_not() {
    let diagram = all()[0];
    let file = diagram.file_text();
    assert!(file.contains("prefers-color-scheme: dark") && file.contains("role=\"img\""), "{file}");
    assert!(file.contains("<title id=") && file.contains("<desc id="), "{file}");
    let inline = diagram.inline();
    assert!(!inline.contains("<style>") && inline.contains("class=\"diagram\""), "{inline}");
    // The shapes are the same ones.
    let shapes = |text: &str| text.matches("class=\"line").count();
    assert_eq!(shapes(&file), shapes(&inline));
}

#[test]
fn symbols_have_indices_and_words_are_left_alone() {
    let runs = label::runs("a_b $'n_{ij}^t$ = 1", 20.0);
    let found: Vec<(&str, &str)> = runs.iter().map(|run| (run.class, run.text.as_str())).collect();
    let expected = [("word", "a_b "), ("vector", "n"), ("symbol", "ij"), ("symbol", "t"), ("word", " = 1")];
    assert_eq!(found, expected);
    // Below, above, and back to the line.
    let shifts: Vec<f64> = runs.iter().map(|run| run.shift.0).collect();
    assert!(shifts[2] > 0.0 && shifts[3] < 0.0 && shifts.iter().sum::<f64>().abs() < 1e-9, "{shifts:?}");
}

#[test]
fn the_critical_angle_is_the_arc_sine() {
    let exact = (1.0 / f64::from(refraction::INDEX)).asin().to_degrees();
    assert!((refraction::critical() - exact).abs() < 1e-3, "{} instead of {exact}", refraction::critical());
}

#[test]
fn no_point_nearby_is_nearer_to_the_lines_than_the_centre() {
    let normals = closest_point::of_stone();
    let [a, b, c] = closest_point::CORNERS;
    let away = lapidary_closest_point::fallback(a, b, c);
    let sum = |point: Vec3| {
        let distance = |(corner, normal): (Vec3, Vec3)| {
            let way = (point - corner).as_dvec3();
            (way - normal.as_dvec3() * normal.as_dvec3().dot(way)).length_squared()
        };
        let pull = f64::from(lapidary_closest_point::CLOSEST_POINT_REGULARISATION);
        let lines: f64 = closest_point::CORNERS.into_iter().zip(normals).map(distance).sum();
        lines + pull * (point - away).as_dvec3().length_squared()
    };
    let centre = closest_point::found(normals);
    for step in [Vec3::X, Vec3::Y, Vec3::Z].into_iter().flat_map(|axis| [0.01 * axis, -0.01 * axis]) {
        assert!(sum(centre) < sum(centre + step), "{centre} {step}");
    }
}

#[test]
fn the_proxys_tile_holds_the_hit_and_its_normal_points_to_the_centre() {
    let met = proxy_geometry::met();
    let [a, b, c] = [met.tile.vertex_first, met.tile.vertex_second, met.tile.vertex_third];
    let sides = [(a, b), (b, c), (c, a)].map(|(from, to)| (to - from).cross(met.point - from).z);
    assert!(sides.iter().all(|side| *side > 0.0) || sides.iter().all(|side| *side < 0.0), "{sides:?}");
    let toward = (met.centre - (a + b + c) / 3.0).normalize();
    assert!(toward.dot(met.normal) > 0.999_999, "{toward} {}", met.normal);
}

#[test]
fn the_nearest_crossing_leaves_the_stone_and_the_others_lie_outside() {
    let planes = convex_trace::planes();
    let [_, ray] = convex_trace::rays(&planes);
    let mut crossings = convex_trace::crossings(&planes, ray);
    crossings.sort_by(|one, other| one.distance.total_cmp(&other.distance));
    let outside = |distance: f32| {
        let point = ray.origin + distance * ray.direction;
        planes.iter().map(|plane| plane.xyz().dot(point) - plane.w).fold(f32::MIN, f32::max)
    };
    assert!(crossings.len() > 2 && outside(crossings[0].distance).abs() < 1e-5, "{crossings:?}");
    assert!(crossings[1..].iter().all(|crossing| outside(crossing.distance) > 0.05), "{crossings:?}");
}

#[test]
fn the_walk_ends_at_the_facet_of_the_exhaustive_search() {
    let planes = convex_walk::planes();
    let map = lapidary_convex_walk::FacetMap::of_planes(&planes, 20).expect("a map");
    let walk = convex_walk::walk(&map, &planes, convex_walk::RAY);
    let hit = lapidary_convex_trace::trace(&planes, walk.origin, walk.direction, u32::MAX);
    assert_eq!((walk.face, walk.distances.len()), (hit.face, 3));
    assert!((walk.distances[2] - hit.distance).abs() < 1e-6);
}

#[test]
fn the_boxes_lead_to_the_hit_of_all_triangles() {
    use lapidary_bvh_trace::{BVH_TRACE_NONE, traversal::trace_all, triangle};
    let bvh = bvh_trace::hierarchy();
    let (origin, direction) = (bvh_trace::RAY.0, bvh_trace::RAY.1.normalize());
    let all = trace_all(&bvh.nodes, &bvh.corners, origin, direction, BVH_TRACE_NONE, triangle);
    let visited = bvh_trace::visit(&bvh);
    assert_eq!(visited.hit, Some(all));
    assert!(visited.tested.contains(&all.triangle) && visited.tested.len() < bvh.order.len() / 4);
}

#[test]
fn a_seed_sees_the_lamp_and_the_point_in_shadow_does_not() {
    use reflective_shadow_map::{BODIES, LAMP, map, shadowed};
    // Whether a body lies between the lamp and a point of a surface.
    let is_hidden = |point: DVec2| {
        BODIES.iter().any(|(middle, radius)| {
            let way = point - LAMP;
            let nearest = ((*middle - LAMP).dot(way) / way.length_squared()).clamp(0.0, 0.995);
            (LAMP + nearest * way).distance(*middle) < radius - 0.01
        })
    };
    let seeds: Vec<_> = map().into_iter().flatten().collect();
    assert!(seeds.len() > 10 && seeds.iter().all(|seen| !is_hidden(seen.place)), "{seeds:?}");
    assert!(is_hidden(shadowed().0));
}

#[test]
fn a_path_costs_what_its_end_says() {
    let solved = optical_path::solve();
    for target in optical_path::TARGETS {
        let path = solved.path(target);
        let cells = optical_path::CELLS as i32;
        let nodes: Vec<usize> = path.iter().map(|v| (v.x + cells * (v.y + cells * v.z)) as usize).collect();
        let edges = path.windows(2).zip(nodes.windows(2)).map(|(voxels, nodes)| {
            let length = (voxels[1] - voxels[0]).as_dvec3().length();
            0.5 * f64::from(solved.extinction[nodes[0]] + solved.extinction[nodes[1]]) * length
        });
        let start = nodes[nodes.len() - 1];
        let sum = f64::from(solved.seeds[start]) + edges.sum::<f64>();
        assert!((sum - f64::from(solved.costs[nodes[0]])).abs() < 1e-4, "{target:?}: {sum}");
        // The straight way to the same start, through the vein, would cost more.
        assert!(path.len() > 3, "{target:?} begins where the light enters");
    }
}

#[test]
fn the_part_beyond_the_edge_is_the_share() {
    let line = ray_footprint::line();
    let corners = ray_footprint::beyond(line);
    let next = |k: usize| corners[(k + 1) % corners.len()];
    let area: f64 = corners.iter().enumerate().map(|(k, corner)| 0.5 * corner.perp_dot(next(k))).sum();
    let share = f64::from(lapidary_ray_footprint::share(line));
    assert!((area - share).abs() < 1e-6 && share > 0.1, "{area} instead of {share}");
}

#[test]
fn a_fact_can_be_found_by_its_name() {
    let scene = (refraction::DIAGRAM.draw)();
    assert!(matches!(scene.of_name("refracted").next(), Some(Shape::Line { .. })));
    assert!(scene.of_name("nothing").next().is_none());
}

#[test]
fn the_gradient_gives_the_red_of_a_ray_traced_alone() {
    use lapidary_dispersion::{DISPERSION_LINE_B, DISPERSION_LINE_D, direction};
    let [red, middle] = [DISPERSION_LINE_B, DISPERSION_LINE_D].map(dispersion::through);
    let offset = dispersion::index(DISPERSION_LINE_B) - dispersion::index(DISPERSION_LINE_D);
    let guessed = direction(middle.direction, middle.gradient, offset);
    let (off, spread) = (guessed.distance(red.direction), middle.direction.distance(red.direction));
    assert!(off < 0.15 * spread && spread > 0.01, "{off} of {spread}");
}

#[test]
fn darker_matter_is_brighter_at_a_grazing_view() {
    let grazing = half_space::GAMMAS.map(|gamma| half_space::seen(85.0, gamma));
    assert!(grazing.is_sorted_by(|one, other| one < other) && grazing[2] > 1.5, "{grazing:?}");
    let white: Vec<f64> = [0.0, 40.0, 80.0].map(|angle| half_space::seen(angle, 0.0)).into();
    assert!(white.iter().all(|seen| (seen - 1.0).abs() < 0.1), "{white:?}");
}
