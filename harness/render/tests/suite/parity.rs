//! Compares the whole path of a pixel on the GPU with the same path through the Rust mirrors, at
//! random pixels.

mod compare;

use compare::Parity;
use glam::{DQuat, DVec3, EulerRot, Quat, Vec3};
use lapidary_assay::extremum::largest;
use lapidary_plan::{Effect, Effects, Outside};
use lapidary_render as render;
use lapidary_render::pixel::{Shading, Stone, Viewer};
use lapidary_render::{GemOptions, Settings};
use lapidary_scene::cuts::octahedron;
use lapidary_scene::environment_map::EnvironmentMap;
use lapidary_scene::polyhedron::{Plane, Polyhedron};
use lapidary_scene::{Averaging, Camera, Copies, Environment, Material, Mesh, Object, Place, Scene};

/// Pixels compared for each scene and rung.
const PIXELS: usize = 2000;
const SIDE: u32 = 192;
/// Largest share of pixels whose rays rounding may send to other facets. For a facet with a
/// fiftieth of the stone's size, 2e-4 of all rays lie within the drift of an edge, which is 1e-6 of
/// the stone's size. Over 64 hits the share is a hundredth.
const MOST_PARTING: f64 = 0.01;

/// First line of a recipe's fragment shader.
const FRAGMENT: &str = "fn gem_fragment(input: GemVertex) -> @location(0) vec4f {\n";
/// Statement inserted after [`FRAGMENT`] that returns the shaded point of the surface. Its
/// condition always holds, and keeps the following code in use.
const POSITION: &str = "    if (input.position.x < 1e30f) { return vec4f(input.position, 1.0f); }\n";

/// Compares the recipe's picture with the mirror. `faulty` replaces the recipe's text with one that
/// holds a fault.
fn parity(scene: &Scene, settings: &Settings, faulty: Option<&str>) -> Parity {
    let source = lapidary_wgsl::recipe_source(settings.rung.recipe());
    assert_eq!(source.matches(FRAGMENT).count(), 1);
    let positions = source.replace(FRAGMENT, &format!("{FRAGMENT}{POSITION}"));
    let render =
        |source: &str| render::render_with(lapidary_testing::gpu(), scene, settings, source).expect("rendered");
    let [picture, positions] = [faulty.unwrap_or(&source), positions.as_str()].map(render);
    compare::compare(scene, settings, [&picture, &positions], PIXELS, 1).expect("compared")
}

fn compare(scene: &str, settings: Settings) -> Parity {
    let scene = Scene::named(scene).expect("built in");
    parity(&scene, &Settings { samples: 1, ..settings }, None)
}

fn of_rung(rung: &str) -> Settings {
    let gem = GemOptions { limit_throughput: Some(false), ..GemOptions::default() };
    Settings { rung: rung.parse().expect(rung), gem, ..Settings::of_size(SIDE, SIDE) }
}

/// Returns the settings of [`of_rung`] with other options.
fn with(rung: &str, set: impl FnOnce(&mut GemOptions)) -> Settings {
    let mut settings = of_rung(rung);
    set(&mut settings.gem);
    settings
}

fn check(scene: &str, what: &str, parity: &Parity) {
    let of_compared = |count: usize| count as f64 / parity.compared as f64;
    let expected = parity.edge_share * parity.compared as f64;
    println!(
        "{scene:12} {what:18} {:4} pixels, {} at an edge (of {expected:.1} at most), {:.2} % part ({} of both differ), {} at the silhouette, \
         {:.5} pixels misplaced, worst {:.3} tolerances",
        parity.compared,
        parity.at_an_edge,
        100.0 * of_compared(parity.parting),
        parity.differing_at_an_edge,
        parity.silhouette,
        parity.misplaced,
        parity.worst
    );
    assert!(parity.compared > 300, "{scene} {what}: {} pixels", parity.compared);
    assert!(parity.failed.is_empty(), "{scene} {what}: {:?}", &parity.failed[..parity.failed.len().min(3)]);
    // The pixels are random: four standard deviations of the count, and one for an expected count
    // of 0.
    let most_at_an_edge = expected + 4.0 * expected.sqrt() + 1.0;
    assert!(parity.at_an_edge as f64 <= most_at_an_edge, "{scene} {what}: {} at an edge", parity.at_an_edge);
    // The GPU may show either side. Its value must lie in the span of the sides, except for one
    // pixel where more than two meet.
    assert!(parity.differing_at_an_edge <= 1, "{scene} {what}: {}", parity.differing_at_an_edge);
    assert!(of_compared(parity.parting) <= MOST_PARTING, "{scene} {what}: {}", parity.parting);
    assert!(parity.silhouette <= PIXELS / 500, "{scene} {what}: {} at the silhouette", parity.silhouette);
    assert!(parity.misplaced <= compare::SNAP, "{scene} {what}: {} pixels", parity.misplaced);
}

#[test]
fn the_picture_is_the_mirrors() {
    for (scene, rung) in [
        ("brilliant", "surface"),
        ("brilliant", "proxy-0"),
        ("brilliant", "proxy-1"),
        ("brilliant", "proxy-1+paper"),
        ("brilliant", "proxy-4+tracker"),
        ("brilliant", "proxy-2+31"),
        ("brilliant", "convex-1"),
        ("brilliant", "convex-8+tracker"),
        ("brilliant", "convex-64"),
        ("brilliant", "walk-8+tracker"),
        ("brilliant", "walk-8+split"),
        ("sapphire", "convex-4+split"),
        ("brilliant", "walk-64"),
        ("step_cut", "walk-4+3"),
        ("brilliant", "triangles-1+3"),
        ("brilliant", "bvh-4+paper"),
        ("sapphire", "proxy-8"),
        ("sapphire", "convex-4+tracker"),
        ("step_cut", "convex-8"),
        ("octahedron", "bvh-8+tracker"),
        ("bunny_stone", "proxy-1+tracker"),
        ("bunny_stone", "bvh-2"),
    ] {
        check(scene, rung, &compare(scene, of_rung(rung)));
    }
}

#[test]
fn so_it_is_with_every_choice() {
    if !lapidary_testing::on_lavapipe("mirrors are compared on the reference device alone") {
        return;
    }
    let limited = with("convex-8", |gem| gem.distance_limit = Some(2.5));
    check("brilliant", "limited", &compare("brilliant", limited));
    for rung in ["proxy-8+paper", "convex-8+paper", "convex-8+tracker"] {
        let limited = with(rung, |gem| (gem.distance_limit, gem.dispersion_strength) = (Some(1.2), 0.02));
        check("brilliant", "limited, colours", &compare("brilliant", limited));
    }
    for (scene, rung) in [
        ("brilliant", "proxy-8+tracker"),
        ("brilliant", "convex-16+tracker"),
        ("brilliant", "convex-8+3"),
        ("ruby", "bvh-16"),
        ("brilliant", "convex-8+paper"),
    ] {
        let limited = with(rung, |gem| gem.limit_throughput = Some(true));
        check(scene, "limited by throughput", &compare(scene, limited));
    }
    let dropped = with("proxy-4+tracker", |gem| gem.rest_from_environment = false);
    let first = with("walk-8+tracker", |gem| gem.end_at_first_exit = true);
    check("brilliant", "rest dropped", &compare("brilliant", dropped));
    check("brilliant", "ended at the first exit", &compare("brilliant", first));
    let paper = with("proxy-1", |gem| gem.paper_centre = true);
    check("brilliant", "paper's centre", &compare("brilliant", paper));
    let clear = Settings { without: Effects::of(&[Effect::Absorption]), ..of_rung("convex-4") };
    check("sapphire", "no absorption", &compare("sapphire", clear));
    let pixel = |k: usize| [(k % 7) as f32 / 3.0, (k % 5) as f32 / 2.0, (k % 3) as f32, 1.0];
    let map = EnvironmentMap { width: 16, height: 8, pixels: (0..128).map(pixel).collect() };
    let mapped = Settings { environment: Environment::Map(map), ..of_rung("convex-2+tracker") };
    check("brilliant", "a map", &compare("brilliant", mapped));
}

/// Returns a scene with its stone as one copy, turned, scaled and moved, of a shape that is elsewhere.
fn copied(scene: &str) -> Scene {
    let mut scene = Scene::named(scene).expect("built in");
    let object = scene.objects.remove(0);
    let place = Place {
        rotation: Quat::from_euler(EulerRot::XYZ, 0.4, -1.3, 2.2),
        scale: 0.25,
        translation: Vec3::new(0.5, -2.0, 1.0),
        base_color: Vec3::new(0.9, 0.7, 0.8),
        attenuation_color: Some(Vec3::new(0.2, 0.5, 0.9)),
    };
    let material = Material { attenuation_distance: 1.5, ..object.material };
    let shape = object.mesh.transformed(place.transform().inverse());
    let copies = Copies { shape, places: vec![place] };
    scene.objects.push(Object::of_copies(object.name, copies, material));
    scene
}

#[test]
fn so_it_is_with_copies() {
    for (scene, rung) in [
        ("brilliant", "surface"),
        ("brilliant", "proxy-2+tracker"),
        ("brilliant", "walk-8+tracker"),
        ("brilliant", "convex-4+3"),
        ("sapphire", "bvh-4+paper"),
    ] {
        let settings = Settings { samples: 1, ..of_rung(rung) };
        check(scene, &format!("copied, {rung}"), &parity(&copied(scene), &settings, None));
    }
    let limited = Settings { samples: 1, ..with("walk-8", |gem| gem.distance_limit = Some(2.5)) };
    check("brilliant", "copied, limited", &parity(&copied("brilliant"), &limited, None));
    let limited = Settings { samples: 1, ..with("walk-16", |gem| gem.limit_throughput = Some(true)) };
    check("brilliant", "copied, by throughput", &parity(&copied("brilliant"), &limited, None));
}

/// Returns a scene with matte bodies beside its stone, beyond the edges of the picture. They are no
/// nearer to the camera than need be: the near plane before them takes digits of the stone's depth.
fn among(mut scene: Scene) -> Scene {
    let Camera { eye, target, .. } = scene.camera;
    let (away, size) = ((eye - target).as_dvec3(), f64::from(scene.bounds().radius()));
    let matte = |base_color| Material { base_color, ior: 1.0, roughness: 1.0, ..Material::standard() };
    let (right, up) = away.normalize().any_orthonormal_pair();
    // Convex, since the rung is named for all of them.
    let side = |normal: DVec3| Plane::through(normal * DVec3::new(0.8, 0.5, 0.9) * size, normal);
    let sides: Vec<Plane> = DVec3::AXES.into_iter().flat_map(|axis| [side(axis), side(-axis)]).collect();
    let plate = Polyhedron::from_planes(&sides).expect("a plate").to_mesh(Averaging::default());
    let ball = octahedron().expect("an octahedron").to_mesh(Averaging::default()).scaled(0.9 * size as f32);
    let place = |mesh: Mesh, place: DVec3| mesh.placed(DQuat::IDENTITY, target.as_dvec3() + place);
    let plate = place(plate, 2.6 * size * right);
    let ball = place(ball, -2.6 * size * (right - 0.3 * up));
    scene.objects.push(Object::new("plate", plate, matte(Vec3::new(0.8, 0.3, 0.1))));
    scene.objects.push(Object::new("ball", ball, matte(Vec3::new(0.1, 0.3, 0.9))));
    scene
}

#[test]
fn so_it_is_among_other_bodies() {
    for (scene, rung) in [
        ("brilliant", "surface"),
        ("brilliant", "proxy-2+tracker"),
        ("brilliant", "walk-8+tracker"),
        ("brilliant", "walk-4+split"),
        ("brilliant", "convex-4+3"),
        ("sapphire", "bvh-4+paper"),
    ] {
        let settings = Settings { samples: 1, ..of_rung(rung) };
        let one = Scene::named(scene).expect("built in");
        check(scene, &format!("among, {rung}"), &parity(&among(one), &settings, None));
    }
    let settings = Settings { samples: 1, ..of_rung("walk-8+tracker") };
    check("brilliant", "copied, among", &parity(&among(copied("brilliant")), &settings, None));
    // Many pixels do show them.
    let scene = among(Scene::named("brilliant").expect("built in"));
    let alone =
        Settings { gem: GemOptions { outside: Some(Outside::Environment), ..settings.gem }, ..settings.clone() };
    let [met, unmet] =
        [settings, alone].map(|one| render::render(lapidary_testing::gpu(), &scene, &one).expect("rendered").linear);
    let differ = met.iter().zip(&unmet).filter(|(met, unmet)| met != unmet).count();
    let covered = met.iter().filter(|pixel| pixel[3] == 1.0).count();
    assert!(differ > covered / 8, "{differ} of {covered} pixels show another body");
}

/// Fault planted in a recipe's text.
struct Fault {
    scene: &'static str,
    rung: &'static str,
    what: &'static str,
    right: &'static str,
    wrong: &'static str,
}

const fn fault(scene_rung: [&'static str; 2], what: &'static str, right: &'static str, wrong: &'static str) -> Fault {
    let [scene, rung] = scene_rung;
    Fault { scene, rung, what, right, wrong }
}

const FAULTS: [Fault; 23] = [
    fault(
        ["brilliant", "proxy-1"],
        "another index",
        "refraction_refract(direction, input.face_normal, index)",
        "refraction_refract(direction, input.face_normal, 1.01f * index)",
    ),
    fault(["brilliant", "proxy-1"], "no Fresnel", "throughput *= 1.0f - left;", "throughput *= 1.0f;"),
    fault(
        ["brilliant", "proxy-1"],
        "the tile of the other half",
        "proxy_geometry_cell(coordinates)",
        "proxy_geometry_cell(coordinates + 0.5f)",
    ),
    fault(["brilliant", "proxy-2"], "the plane is not renewed", "(*place).plane = ", "let next = "),
    fault(["brilliant", "convex-2"], "planes are left out", "face < count; face++", "face + 9u < count; face++"),
    fault(["brilliant", "convex-2"], "the place is not renewed", "(*ray).position = hit.point;", ""),
    fault(["brilliant", "walk-2"], "second candidates are left out", "select(rest, first, more)", "first"),
    fault(["brilliant", "walk-2"], "a walk ends at its first pass", "nearest.face == before", "true"),
    fault(["brilliant", "walk-2"], "the place is not renewed", "*place = GemPlace(", "let next = GemPlace("),
    fault(["brilliant", "bvh-2"], "farther children are forgotten", "return height + 1u;", ""),
    fault(
        ["brilliant", "bvh-1"],
        "another triangle's normal",
        "gem_face_normal(nearest.",
        "gem_face_normal(1u + nearest.",
    ),
    fault(["brilliant", "triangles-1"], "triangles are left out", "triangle = 0u;", "triangle = 40u;"),
    fault(
        ["brilliant", "convex-4+tracker"],
        "the derivative is not reflected",
        "gradient = dispersion_reflect(gradient, hit.normal);",
        "",
    ),
    fault(
        ["brilliant", "convex-4+tracker"],
        "the surface reflects all channels alike",
        "reflectance = gem_reflectance_channels(cosine);",
        "",
    ),
    fault(
        ["brilliant", "convex-4+paper"],
        "the direction of dispersion is not reflected",
        "spread = dispersion_paper_reflect(ray.direction, spread, hit.normal, DISPERSION_PAPER_EPSILON);",
        "",
    ),
    fault(["brilliant", "convex-4+paper"], "only the last way counts", "travelled += hit.", "travelled = hit."),
    fault(["sapphire", "convex-4"], "all ways absorb alike", "gem_transmittance(way)", "gem_transmittance(1.0f)"),
    fault(
        ["ruby", "convex-16"],
        "rays end by blue alone",
        "max(max(throughput.r, throughput.g), throughput.b)",
        "throughput.b",
    ),
    fault(
        ["brilliant", "convex-16"],
        "rays end by thirty times the limit",
        ">= material.throughput_limit",
        ">= 30.0f * material.throughput_limit",
    ),
    fault(
        ["brilliant", "walk-2"],
        "copies are turned the wrong way",
        "return direction * gem_copy.rotation;",
        "return gem_copy.rotation * direction;",
    ),
    fault(
        ["brilliant", "walk-2"],
        "copies absorb alike, large or small",
        "scale * instance.absorption",
        "instance.absorption",
    ),
    fault(
        ["brilliant", "walk-2"],
        "copies have one colour",
        "return gem_copy.base_color;",
        "return material.base_color;",
    ),
    fault(["brilliant", "proxy-4+paper"], "a ray that has ended goes on", "if ((*ray).followed) {", "if (true) {"),
];

/// A comparison that a wrong shader passes checks nothing.
#[test]
fn a_wrong_picture_is_seen() {
    for Fault { scene, rung, what, right, wrong } in FAULTS {
        let scene = if what.starts_with("copies") { copied(scene) } else { Scene::named(scene).expect("built in") };
        let distance_limit = what.contains("has ended").then_some(1.2);
        let limit_throughput = Some(what.contains("rays end by"));
        let set =
            |gem: &mut GemOptions| (gem.distance_limit, gem.limit_throughput) = (distance_limit, limit_throughput);
        let settings = Settings { samples: 1, ..with(rung, set) };
        let source = lapidary_wgsl::recipe_source(settings.rung.recipe());
        assert!(source.contains(right), "{rung}: {what}");
        let planted = source.replace(right, wrong);
        let parity = parity(&scene, &settings, Some(&planted));
        println!("{rung:18} {what:46} {:4} of {} fail", parity.failed.len(), parity.compared);
        assert!(parity.failed.len() > parity.compared / 20, "{rung}, {what}: {} fail", parity.failed.len());
    }
}

/// Near the critical angle one channel leaves the stone and its neighbour does not. The tracker
/// decides for each channel as a separate ray of that channel does. A single index decides for all
/// channels at once, and is wrong for some.
#[test]
fn total_reflection_is_decided_for_each_channel() {
    let scene = Scene::named("brilliant").expect("built in");
    let object = &scene.objects[0];
    let settings = |rung: &str| Settings { samples: 1, ..of_rung(rung) };
    let [tracker, separate, one] = ["convex-6+tracker", "convex-6+3", "convex-6"].map(settings);
    let picture = render::render(lapidary_testing::gpu(), &scene, &tracker).expect("rendered");
    let viewer = Viewer::new(&scene, SIDE, SIDE);
    let stone = Stone::new(object, &tracker).expect("convex");
    let [tracked, split, alike] = [&tracker, &separate, &one].map(|settings| Shading::new(&object.material, settings));
    let (mut mixed, mut agree, mut one_agrees) = (0, 0, 0);
    for (row, column) in (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| (row, column))) {
        let Some(seen) = viewer.see(&object.mesh, f64::from(column) + 0.5, f64::from(row) + 0.5) else { continue };
        let eye = scene.camera.eye;
        let rays = split.pixel(&stone, seen, eye).rays;
        let same_facets = |k: usize| rays.iter().all(|ray| ray[k].facet == rays[0][k].facet);
        let Some(hit) = (0..6).find(|&k| rays.iter().any(|ray| ray[k].total != rays[0][k].total)) else { continue };
        if !(0..=hit).all(same_facets) {
            continue;
        }
        mixed += 1;
        let by_channel = (0..3).fold(0, |bits, k| bits | rays[k][hit].total << k);
        let pixel = tracked.pixel(&stone, seen, eye);
        agree += usize::from(pixel.rays[0][hit].total == by_channel);
        one_agrees += usize::from(alike.pixel(&stone, seen, eye).rays[0][hit].total * 0b111 == by_channel);
        let [r, g, b, _] = picture.linear[(row * SIDE + column) as usize];
        let difference = largest((glam::Vec3::new(r, g, b) - pixel.radiance).abs().to_array());
        // At the critical angle a channel's reflectance departs from 1 like a square root: by 0.1
        // for an angle off by 2^-13.
        assert!(difference <= 0.05 * pixel.radiance.max_element().max(1.0), "{column} {row}: {difference}");
    }
    println!("{mixed} pixels; the tracker decides {agree} as separate rays do, one index {one_agrees}");
    assert!(mixed >= 20, "{mixed}");
    assert!(agree * 20 >= mixed * 19, "{agree} of {mixed}");
    assert_eq!(one_agrees, 0);
}
