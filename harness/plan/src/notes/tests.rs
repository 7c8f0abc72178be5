use super::*;
use lapidary_scene::environment_map::EnvironmentMap;
use lapidary_scene::light::Light;
use lapidary_scene::surfaces::sphere;
use lapidary_scene::{BUILT_IN, Camera, Material, Mesh};

fn usual() -> Request<'static> {
    Request::of_size([64, 64])
}

fn by(rung: &str) -> Request<'static> {
    Request { rung: rung.parse().expect("a rung"), ..usual() }
}

fn named(name: &str) -> Scene {
    Scene::named(name).expect("built in")
}

/// Returns the built-in scene `name` with its first object changed.
fn changed(name: &str, change: impl FnOnce(&mut Object)) -> Scene {
    let mut scene = named(name);
    change(&mut scene.objects[0]);
    scene
}

fn said(scene: &Scene, request: &Request<'_>) -> Vec<String> {
    let decisions = Decisions::all(scene, request);
    of(scene, request, &decisions.iter().collect::<Vec<_>>()).iter().map(Note::to_string).collect()
}

/// Asserts that there is exactly one note, and that it contains `part`.
fn one(scene: &Scene, request: &Request<'_>, part: &str) {
    let said = said(scene, request);
    assert!(matches!(&said[..], [note] if note.contains(part)), "`{part}` is not all that is said: {said:?}");
}

fn turned(mesh: &Mesh) -> Mesh {
    let indices = mesh.indices.chunks_exact(3).flat_map(|t| [t[0], t[2], t[1]]).collect();
    Mesh { indices, ..mesh.clone() }
}

#[test]
fn little_is_said_of_the_built_ins() {
    for built_in in BUILT_IN {
        let expected: &[&str] = match built_in.name {
            "tray" => &["2 objects, first `diamond`: other clear bodies overlap it in the view"],
            "ring" => &["first `side stone 1`: other clear bodies overlap it in the view"],
            "pave_ring" => &["follows light through one copy"],
            "tumbler" => {
                &["`water`: shares space with the clear `glass`", "`straw`: shares space with the clear `water`"]
            }
            _ => &[],
        };
        let said = said(&named(built_in.name), &usual());
        let is_as_expected =
            said.len() == expected.len() && said.iter().zip(expected).all(|(note, part)| note.contains(part));
        assert!(is_as_expected, "{}: {said:?}", built_in.name);
    }
}

/// Of a body that its node makes a point or a line nothing else is said: neither its thickness nor its mesh is at fault.
#[test]
fn bodies_without_area_are_named_whatever_they_are_made_of() {
    let scaled = |scale: Vec3, change: fn(&mut Material)| {
        changed("brilliant", |object| {
            change(&mut object.material);
            object.mesh.positions.iter_mut().for_each(|position| *position *= scale);
        })
    };
    for scale in [Vec3::ZERO, Vec3::X] {
        let ways: [fn(&mut Material); 3] =
            [|_| (), |material| material.thickness = 0.0, |material| material.transmission = 0.0];
        for way in ways {
            let said = said(&scaled(scale, way), &usual());
            assert!(matches!(&said[..], [note] if note.contains("no triangle has an area")), "{scale}: {said:?}");
        }
    }
    // However small, a body is one.
    let small = said(&scaled(Vec3::splat(1e-20), |_| ()), &usual());
    assert!(small.iter().all(|note| !note.contains("area")), "{small:?}");
}

#[test]
fn meshes_that_are_no_solids_are_named_where_a_rung_needs_one() {
    let open = changed("ruby", |object| object.mesh.indices.truncate(object.mesh.indices.len() - 3));
    one(
        &open,
        &by("bvh-4"),
        "object `ruby`: rung `bvh-4` takes a mesh for the surface of a solid, but 3 edges are open;",
    );
    let inverted = changed("ruby", |object| object.mesh = turned(&object.mesh));
    one(&inverted, &by("bvh-4"), "but 1 part is inside out;");
    let doubled = changed("ruby", |object| {
        let again = object.mesh.clone();
        object.mesh.append(&again);
    });
    one(&doubled, &by("proxy-1"), "triangles are there twice;");
    let flat = changed("ruby", |object| object.mesh.positions.iter_mut().for_each(|position| position.y = 0.0));
    assert!(said(&flat, &by("bvh-4"))[0].contains("all corners lie in one plane"));
    let degenerate = changed("ruby", |object| object.mesh.indices.extend([0, 1, 1]));
    one(&degenerate, &by("bvh-4"), "but 1 triangle has no area;");
    // Paths through a body need its inside too; a body drawn by its surface alone may be open.
    let open = changed("bunny", |object| object.mesh.indices.truncate(object.mesh.indices.len() - 3));
    one(&open, &by("godunov-64"), "3 edges are open");
    assert_eq!(said(&open, &by("accurate")), [""; 0]);
    let inverted = changed("bunny", |object| object.mesh = turned(&object.mesh));
    one(&inverted, &by("accurate"), "the far side is drawn");
}

#[test]
fn many_objects_are_one_note() {
    let mut scene = changed("ruby", |object| object.mesh.indices.truncate(object.mesh.indices.len() - 3));
    let ruby = scene.objects[0].clone();
    let placed = |k: i32| {
        let mesh = ruby.mesh.placed(glam::DQuat::IDENTITY, 9.0 * f64::from(k) * glam::DVec3::X);
        Object { mesh, ..ruby.clone() }
    };
    scene.objects = (0..5).map(placed).collect();
    one(&scene, &by("bvh-4"), "5 objects, first `ruby`: rung `bvh-4`");
}

#[test]
fn both_sides_are_asked_for_in_vain_where_there_is_a_hole() {
    let double = |object: &mut Object| object.material.double_sided = true;
    assert_eq!(said(&changed("bunny", double), &by("accurate")), [""; 0]);
    let open = changed("bunny", |object| {
        double(object);
        object.mesh.indices.truncate(object.mesh.indices.len() - 3);
    });
    one(&open, &by("accurate"), "doubleSided");
}

#[test]
fn thin_walls_and_black_insides_are_named() {
    let thin = changed("ruby", |object| object.material.thickness = 0.0);
    one(&thin, &usual(), "without refraction, absorption and dispersion;");
    let thin = changed("brilliant", |object| {
        object.material =
            Material { thickness: 0.0, ior: 1.5, dispersion: Dispersion::None, ..object.material.clone() };
    });
    one(&thin, &usual(), "without refraction; if it is solid");
    // Millimetres in a scene in metres.
    let black = changed("ruby", |object| object.material.attenuation_distance *= 1e-3);
    one(&black, &usual(), "drawn black");
    one(&changed("brilliant", |object| object.material.base_color = Vec3::ZERO), &usual(), "drawn black");
}

#[test]
fn light_that_no_picture_can_show_is_named() {
    let mut scene = named("bunny");
    // Lux instead of watts.
    scene.lights = vec![Light::Directional { toward: Vec3::Y, irradiance: Vec3::splat(100_000.0) }];
    one(&scene, &by("lambert"), "is shown as plain white");
    assert_eq!(said(&scene, &Request { exposure: 1e-5, ..by("lambert") }), [""; 0]);
    let bounds = scene.bounds();
    let near =
        Light::Point { position: bounds.centre() + 1.1 * bounds.radius() * Vec3::Y, intensity: Vec3::splat(1e9) };
    one(&Scene { lights: vec![near], ..scene.clone() }, &by("lambert"), "plain white");
    let map = EnvironmentMap { width: 2, height: 2, pixels: vec![[1000.0, 1000.0, 1000.0, 1.0]; 4] };
    let environment = Environment::Map(map);
    let bright = Request { environment: &environment, ..usual() };
    one(&named("brilliant"), &bright, "plain white");
}

#[test]
fn light_that_a_rung_does_not_draw_is_named_once_for_all_bodies() {
    let mut scene = named("bunny");
    scene.lights.push(Light::Point { position: scene.bounds().centre(), intensity: Vec3::ONE });
    scene.objects.push(scene.objects[0].clone());
    one(&scene, &by("accurate"), "2 objects, first `bunny`: a lamp stands inside, and rung `accurate`");
    assert_eq!(said(&scene, &by("diffusion-64")), [""; 0]);
    let mut partial = named("bunny");
    partial.objects.push(partial.objects[0].clone());
    for object in &mut partial.objects {
        object.material.diffuse_transmission = 0.5;
    }
    one(
        &partial,
        &by("diffusion-64"),
        "2 objects, first `bunny`: rung `diffusion-64` draws no diffuseTransmissionFactor",
    );
    assert_eq!(said(&partial, &by("accurate")), [""; 0]);
}

#[test]
fn a_camera_that_sees_nothing_is_named() {
    let mut scene = named("ruby");
    let Camera { eye, target, .. } = scene.camera;
    scene.camera.target = eye + (eye - target);
    one(&scene, &usual(), "nothing is in view");
    // To the side of the picture, not behind the eye.
    scene.camera.target = eye + (target - eye).cross(Vec3::Y) + 0.2 * (target - eye);
    one(&scene, &usual(), "nothing is in view");
}

#[test]
fn hard_edges_are_named_where_the_proxy_softens_them() {
    let split = |object: &mut Object| {
        let mesh = &object.mesh;
        let corners: Vec<Vec3> = mesh.indices.iter().map(|&k| mesh.positions[k as usize]).collect();
        let normals = corners.chunks_exact(3).flat_map(|t| [(t[1] - t[0]).cross(t[2] - t[0]).normalize(); 3]).collect();
        let indices = (0..corners.len() as u32).collect();
        object.mesh = Mesh { positions: corners, normals, indices, ..Mesh::default() };
    };
    one(&changed("brilliant", split), &by("proxy-1"), "averaged by angle");
    assert_eq!(said(&changed("brilliant", split), &by("convex-1")), [""; 0]);
}

#[test]
fn what_is_not_clear_is_never_drawn_as_glass() {
    let mut scene = named("ruby");
    scene.objects.extend(named("bunny").objects);
    let mut opaque = named("ruby").objects.remove(0);
    opaque.name = "coin".to_owned();
    opaque.material = Material { base_color: Vec3::splat(0.5), ..Material::standard() };
    opaque.mesh = sphere(1.0, 32);
    scene.objects.push(opaque);
    for rung in ["convex-2", "proxy-2", "bvh-2", "surface"] {
        let rungs = scene.objects.iter().map(|object| Decisions::of(object, &scene, &by(rung)).rung.to_string());
        let rungs: Vec<String> = rungs.collect();
        assert_eq!((rungs[0].as_str(), rungs[2].as_str()), (rung, "lambert"));
        assert!(!rungs[1].parse::<Rung>().expect("a rung").is_for_clear_stones(), "{rungs:?}");
        let said = said(&scene, &by(rung));
        let is_noted = |name: &str| {
            said.iter().any(|note| note.contains(&format!("object `{name}`: rung `{rung}` is for clear stones")))
        };
        assert!(is_noted("coin") && is_noted(&scene.objects[1].name) && !is_noted("ruby"), "{said:?}");
    }
}

/// A ball of a radius about a place on the x axis.
fn ball(name: &str, radius: f64, x: f64, material: Material) -> Object {
    let mesh = sphere(radius, 24).placed(glam::DQuat::IDENTITY, glam::DVec3::new(x, 0.0, 0.0));
    Object::new(name, mesh, material)
}

#[test]
fn bodies_that_share_space_with_clear_ones_are_named() {
    let glass = || Material { transmission: 1.0, thickness: 1.0, roughness: 0.0, ..Material::standard() };
    let said_of = |objects: Vec<Object>, request: &Request<'_>| {
        let mut scene = named("octahedron");
        scene.objects = objects;
        said(&scene, request)
    };
    let within = vec![ball("glass", 1.0, 0.0, glass()), ball("pearl", 0.3, 0.2, Material::standard())];
    assert_eq!(said_of(within.clone(), &usual()), [""; 0]);
    let notes = said_of(within.clone(), &by("bvh-8"));
    let notes: Vec<&String> = notes.iter().filter(|note| !note.contains("so drawn by `lambert`")).collect();
    assert!(matches!(&notes[..], [note] if note.contains("object `pearl`: inside the clear `glass`")), "{notes:?}");
    assert_eq!(said_of(within, &by("reference")), [""; 0]);
    // Two that overlap are named once, with the smaller.
    let overlap = vec![ball("water", 1.0, 0.0, glass()), ball("glass", 0.8, 1.0, glass())];
    let notes = said_of(overlap.clone(), &by("reference"));
    assert!(matches!(&notes[..], [note] if note.contains("; `glass` is there")), "{notes:?}");
    let twice = vec![overlap[0].clone(); 3];
    let notes = said_of(twice, &by("reference"));
    assert!(matches!(&notes[..], [note] if note.starts_with("3 objects, first `water`: shares space")), "{notes:?}");
    let mut strong = overlap;
    strong[0].material.priority = 1;
    let notes = said_of(strong, &by("reference"));
    assert!(matches!(&notes[..], [note] if note.contains("; `water` is there")), "{notes:?}");
    // Side by side, touching, and opaque around clear: nothing is shared.
    let apart = vec![ball("one", 1.0, 0.0, glass()), ball("other", 0.5, 1.5, glass())];
    assert_eq!(said_of(apart, &usual()), [""; 0]);
}

#[test]
fn a_camera_inside_a_clear_body_is_named() {
    let mut scene = named("ruby");
    scene.camera.eye = scene.bounds().centre();
    scene.camera.target = scene.camera.eye + glam::Vec3::X;
    one(&scene, &usual(), "object `ruby`: the camera stands inside");
    assert_eq!(said(&scene, &by("reference")), [""; 0]);
}

#[test]
fn a_base_color_beside_other_coefficients_is_named() {
    let mut scene = named("wax");
    assert_eq!(said(&scene, &usual()), [""; 0]);
    scene.objects[0].material.base_color = glam::Vec3::new(0.2, 0.5, 0.9);
    one(&scene, &usual(), "coefficients of scattering and absorption decide its colour, (0.891, 0.8");
    scene.objects[0].material.base_color = glam::Vec3::ONE;
    assert_eq!(said(&scene, &usual()), [""; 0]);
}
