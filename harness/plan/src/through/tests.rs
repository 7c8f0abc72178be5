use super::*;
use crate::{Decisions, Effect, Quality, Request, Rung};
use glam::DQuat;
use lapidary_scene::{Light, Material, Place};

const SIZE: [u32; 2] = [256, 256];

fn glass(ior: f32) -> Material {
    Material { transmission: 1.0, thickness: 1.0, roughness: 0.0, ior, ..Material::standard() }
}

fn block(half: f64, at: DVec3, material: Material) -> Object {
    let mut object = Scene::named("octahedron").expect("built in").objects.remove(0);
    object.mesh = lapidary_scene::surfaces::rounded_box(DVec3::splat(half), 0.0, 1).placed(DQuat::IDENTITY, at);
    Object { material, ..object }
}

/// The bodies seen from +z at a distance of 20, without lights.
fn scene(objects: Vec<Object>) -> Scene {
    let camera = Camera::upright(20.0 * Vec3::Z, Vec3::ZERO, 0.3);
    Scene { objects, camera, lights: Vec::new(), ..Scene::named("octahedron").expect("built in") }
}

fn share(objects: Vec<Object>) -> f32 {
    let scene = scene(objects);
    others(&scene.objects[0], &scene, SIZE).share
}

/// What stands behind a block of index 1 sends as much of its light as it covers of it.
#[test]
fn through_a_block_of_index_1_all_is_seen_that_stands_behind_it() {
    let front = || block(1.0, DVec3::ZERO, glass(1.0));
    let behind = |x: f64| block(3.0, DVec3::new(x, 0.0, -6.0), glass(1.5));
    assert_eq!(share(vec![front()]), 0.0);
    assert!(share(vec![front(), behind(0.0)]) > 0.999);
    // Its edge runs behind the middle, and half the columns of rays pass it.
    assert!((share(vec![front(), behind(3.0)]) - 0.5).abs() < 1e-3);
    // Before it, and behind a wall, it is not seen through the block.
    assert_eq!(share(vec![front(), block(3.0, DVec3::new(0.0, 0.0, 8.0), glass(1.5))]), 0.0);
    let wall = block(2.0, DVec3::new(0.0, 0.0, -3.5), Material::standard());
    assert_eq!(share(vec![front(), behind(0.0), wall]), 0.0);
}

/// A block of index n lets what falls on it straight pass two faces: (1 - R)^2 of the light, and the rest comes from its front's
/// reflection and by several reflections between the faces.
#[test]
fn what_faces_reflect_comes_from_elsewhere() {
    let front = block(1.0, DVec3::ZERO, glass(1.5));
    let behind = block(40.0, DVec3::new(0.0, 0.0, -60.0), glass(1.5));
    let reflectance = 0.04;
    // Of what enters, 1 / (1 + R) leaves through the back.
    let expected = (1.0 - reflectance) / (1.0 + reflectance);
    let found = share(vec![front, behind]);
    // Rays beside the middle fall on it at up to 4 degrees, and rays through its sides see the same body.
    assert!((found - expected).abs() < 0.01, "{found} for {expected}");
}

/// A stone whose pavilion reflects all is walked, whatever stands behind it; a block of glass is not.
#[test]
fn a_cut_stone_is_walked_before_another_and_a_block_of_glass_is_not() {
    let stone = || Scene::named("brilliant").expect("built in").objects.remove(0);
    let behind = || block(1.0, DVec3::new(0.0, -4.0, 0.0), glass(1.5));
    let decided = |front: Object, quality| {
        let mut scene = scene(vec![front, behind()]);
        // From above, on the table.
        scene.camera = Camera { eye: 20.0 * Vec3::Y, target: Vec3::ZERO, up: Vec3::Z, vertical_fov: 0.3 };
        let request = Request { quality, ..Request::of_size(SIZE) };
        let decisions = Decisions::all(&scene, &request);
        let share = others(&scene.objects[0], &scene, SIZE).share;
        let notes = crate::notes(&scene, &request, &decisions.iter().collect::<Vec<_>>());
        let said = notes.iter().any(|note| note.to_string().contains("overlap it in the view"));
        let walks = !decisions[0].rung.is_among();
        assert_eq!(said, walks && share > 0.0, "{notes:?}");
        (decisions[0].rung, decisions[0].reason.clone())
    };
    for quality in [Quality::Fast, Quality::Good] {
        let (rung, reason) = decided(stone(), quality);
        assert!(!rung.is_among(), "{quality:?}: {rung}, {reason}");
        let (rung, reason) = decided(block(1.0, DVec3::ZERO, glass(1.5)), quality);
        assert!(rung.is_among(), "{quality:?}: {rung}");
        assert!(reason.contains("% of its light comes from such"), "{reason}");
    }
    assert!(decided(stone(), Quality::Best).0.is_among());
}

/// Copies in a band are walked too, and meet it by its triangles; beside lights the stage has no room for that.
#[test]
fn copies_in_a_band_are_walked() {
    let mut stone = Scene::named("brilliant").expect("built in").objects.remove(0);
    let shape = stone.mesh.clone();
    let places: Vec<Place> =
        [-3.0, 3.0].map(|x| Place { translation: Vec3::new(x, 0.0, 0.0), ..Place::IDENTITY }).into();
    stone.mesh = Mesh::default();
    places.iter().for_each(|place| stone.mesh.append(&shape.transformed(place.transform())));
    stone.copies = Some(lapidary_scene::Copies { shape, places });
    // A bar that reaches into the girdle of one, so deep as a prong does.
    let bar = Object { name: "bar".to_owned(), ..block(1.0, DVec3::new(-4.9, 0.0, 0.0), Material::standard()) };
    let mut scene = scene(vec![stone, bar]);
    let of = |scene: &Scene| Decisions::of(&scene.objects[0], scene, &Request::of_size(SIZE));
    let decisions = of(&scene);
    assert!(matches!(decisions.rung, Rung::Inside { .. }) && !decisions.rung.is_among(), "{}", decisions.reason);
    assert!([Effect::Instances, Effect::Around, Effect::Nested].iter().all(|effect| decisions.has(*effect)));
    scene.lights = vec![Light::Directional { toward: Vec3::Y, irradiance: Vec3::ONE }];
    let decisions = of(&scene);
    assert!(!decisions.has(Effect::Around) || !decisions.has(Effect::Light) || decisions.rung.is_among());
}

/// A stone that is small in the picture may lack more than one that fills it, as long as all such together lack little.
#[test]
fn small_stones_may_lack_more_and_all_together_little() {
    let is_little = |found: &[(f32, f32)]| little(found).iter().map(|others| others.is_little).collect::<Vec<_>>();
    assert_eq!(is_little(&[(0.05, 1.0), (0.06, 0.02), (0.5, 0.01), (0.0, 0.0)]), [true, false, true, true]);
    // The least first: .006 + .007, and .0075 more are too many.
    assert_eq!(is_little(&[(0.75, 0.01), (0.6, 0.01), (0.7, 0.01)]), [false, true, true]);
    // The same scene from near and from far.
    let pair = || vec![block(1.0, DVec3::ZERO, glass(1.5)), block(3.0, DVec3::new(0.0, 0.0, -6.0), glass(1.5))];
    let seen_from = |distance: f32| {
        let mut scene = scene(pair());
        scene.camera = Camera::upright(distance * Vec3::Z, Vec3::ZERO, 0.3);
        others(&scene.objects[0], &scene, SIZE)
    };
    let (near, far) = (seen_from(20.0), seen_from(200.0));
    assert!(!near.is_little && far.is_little && far.share > 0.5, "{near:?} {far:?}");
}
