//! Bodies within one another, against closed forms.

use super::*;
use crate::spectral::matte::Mattes;
use crate::spectral::within::MOST;
use glam::DQuat;
use lapidary_scene::Scene;
use lapidary_scene::surfaces::sphere;

/// Returns a plate between two heights, of the width of [`plate`].
fn layer(bottom: f64, top: f64) -> Object {
    let side = |normal: DVec3, distance| Plane { normal, distance };
    let around = [DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y].map(|normal| side(normal, 512.0));
    let planes = [around.as_slice(), &[side(DVec3::Z, top), side(-DVec3::Z, -bottom)]].concat();
    let mesh = Polyhedron::from_planes(&planes).unwrap().to_mesh(Averaging::Angle);
    Object::new("layer", mesh, Material { transmission: 1.0, thickness: 1.0, roughness: 0.0, ..Material::standard() })
}

fn with_priority(mut object: Object, priority: i32) -> Object {
    object.material.priority = priority;
    object
}

fn seen(objects: &[Object], optics: &[Optics], geometry: Geometry, eye: DVec3, direction: DVec3) -> Outcome {
    let sky = sky();
    let surroundings = surroundings(objects, &sky, geometry, eye, 1e-13);
    let primary = surroundings.primary(eye, direction).expect("met");
    surroundings.follow(&primary, optics, &mut generator(1, 0))
}

/// Returns the share of light from above that a pile of layers sends back up, at an angle in the air: each layer's index,
/// thickness and absorption, from the top, over air. Summed over all reflections from the lowest interface upwards.
fn piled(layers: &[(f64, f64, f64)], angle: f64) -> f64 {
    let cosine = |index: f64| (angle.sin() / index).asin().cos();
    let reflectance = |above: f64, below: f64| fresnel::dielectric(cosine(above), below / above);
    let mut index_below = 1.0;
    let mut returned = 0.0;
    for &(index, thickness, absorption) in layers.iter().rev() {
        let once = reflectance(index, index_below);
        let below = once + (1.0 - once).powi(2) * returned / (1.0 - once * returned);
        returned = below * (-2.0 * absorption * thickness / cosine(index)).exp();
        index_below = index;
    }
    let once = reflectance(1.0, index_below);
    once + (1.0 - once).powi(2) * returned / (1.0 - once * returned)
}

fn absorbing(index: f64, absorption: f64) -> Optics {
    Optics { absorption: DVec3::splat(absorption), ..clear(index) }
}

/// Compares what an eye above sees of the sky with a pile, at several angles and by both representations.
fn assert_piled(objects: &[Object], optics: &[Optics], layers: &[(f64, f64, f64)]) {
    for geometry in [Geometry::Planes, Geometry::Triangles] {
        for angle in [0.0, 0.4, 1.1] {
            let direction = DVec3::new(f64::sin(angle), -f64::cos(angle), 0.0);
            let eye = DVec3::new(0.3, 0.0, 0.2) - 3.0 * direction;
            let seen = seen(objects, optics, geometry, eye, direction);
            let expected = piled(layers, angle);
            // Rays split at every interface, so that of many interfaces a little is left after 20,000 hits.
            let missing = expected - seen.radiance.x;
            let is_known = (-1e-12..seen.lost + 1e-12).contains(&missing) && seen.lost < 1e-4;
            assert!(is_known, "{geometry:?} {angle}: {seen:?}, not {expected}");
        }
    }
}

#[test]
fn a_slab_in_a_slab_is_a_pile_of_three() {
    let [outer, inner] = [absorbing(1.5, 0.2), absorbing(2.4, 0.7)];
    let pile = [(1.5, 1.0, 0.2), (2.4, 0.5, 0.7), (1.5, 1.5, 0.2)];
    let objects = [layer(-3.0, 0.0), layer(-1.5, -1.0)];
    assert_piled(&objects, &[outer, inner], &pile);
    // Whichever comes first in the file.
    let [outermost, innermost] = objects;
    assert_piled(&[innermost.clone(), outermost.clone()], &[inner, outer], &pile);
    // By its priority the outer one is everywhere.
    let strong = [with_priority(outermost, 1), innermost];
    assert_piled(&strong, &[outer, inner], &[(1.5, 3.0, 0.2)]);
}

#[test]
fn a_body_within_an_index_of_one_is_as_if_alone() {
    let objects = [layer(-3.0, 0.0), layer(-1.5, -1.0)];
    assert_piled(&objects, &[clear(1.0), absorbing(1.7, 0.4)], &[(1.7, 0.5, 0.4)]);
    assert_piled(&objects, &[absorbing(1.7, 0.4), absorbing(1.7, 0.4)], &[(1.7, 3.0, 0.4)]);
}

/// Water in a glass: three ways to model it, three numbers.
#[test]
fn liquid_overlaps_its_glass_touches_it_or_leaves_a_gap() {
    let optics = [clear(1.52), absorbing(1.333, 0.1)];
    let glass = layer(-1.0, 0.0);
    let touching = [(1.52, 1.0, 0.0), (1.333, 2.0, 0.1)];
    // The glass is the smaller one, and wins.
    assert_piled(&[glass.clone(), layer(-3.0, -0.5)], &optics, &touching);
    assert_piled(&[glass.clone(), layer(-3.0, -1.0)], &optics, &touching);
    let gap = [(1.52, 1.0, 0.0), (1.0, 0.01, 0.0), (1.333, 2.0, 0.1)];
    assert_piled(&[glass.clone(), layer(-3.01, -1.01)], &optics, &gap);
    let wet = [(1.52, 0.5, 0.0), (1.333, 2.5, 0.1)];
    assert_piled(&[glass, with_priority(layer(-3.0, -0.5), 1)], &optics, &wet);
    let numbers = [&touching[..], &gap, &wet].map(|pile| piled(pile, 0.4));
    println!(
        "touching or overlapping {:.4}, a gap {:.4}, the liquid stronger {:.4}",
        numbers[0], numbers[1], numbers[2]
    );
    assert!(numbers[1] > numbers[0] + 0.04 && numbers[0] > numbers[2] + 1e-4, "{numbers:?}");
}

/// A matte ball of radius r in a ball of index n appears with the radius n r, from far away.
#[test]
fn a_ball_within_a_ball_is_magnified_by_its_index() {
    let environment = Environment::Studio;
    for index in [1.0, 1.3, 1.5] {
        let mut objects = [1.0, 0.5].map(|radius| Object::new("ball", sphere(radius, 256), Material::standard()));
        objects[0].material.transmission = 1.0;
        let mut scene = Scene::named("octahedron").unwrap();
        scene.objects = objects.to_vec();
        let mattes = Mattes::new(&scene, None);
        let eye = DVec3::new(0.0, 0.0, 1e3);
        let surroundings = Surroundings {
            bodies: Bodies::with_mattes(&objects, Geometry::Triangles, mattes),
            order: Order::of(&objects),
            lights: Vec::new(),
            surfaces: vec![POLISHED; objects.len()],
            is_random: false,
            scatterers: &[],
            around_eye: Within::default(),
            environment: &environment,
            energy_bound: 1e-6,
        };
        // The transmitted part of the first hit goes on to the matte ball, or not.
        let meets = |away: f64| {
            let turned = DQuat::from_rotation_z(0.7) * DVec3::X;
            let primary = surroundings.primary(eye + away * turned, -DVec3::Z).expect("met");
            let Primary::Clear(entry) = primary else { panic!("the outer ball is clear") };
            let Entry { arrival, .. } = *entry;
            let ray = arrival.split(&surroundings.order, &[clear(index), clear(1.5)]).1.expect("refracted");
            matches!(surroundings.ahead(&ray), Some(Ahead::Light(..)))
        };
        // Facets of 1.4 degrees: the angle of incidence is off by .7 at most, and so the distance by 1 %.
        let radius = 0.5 * index;
        assert!(meets(0.985 * radius) && !meets(1.015 * radius), "{index}");
    }
}

#[test]
fn an_eye_within_bodies_sees_out_of_them() {
    let objects = [layer(-3.0, 0.0), layer(-1.5, -1.0)];
    let base_color = DVec3::new(0.5, 0.25, 1.0);
    let optics = [Optics { base_color, ..absorbing(1.5, 0.2) }, absorbing(2.4, 0.7)];
    let eye = DVec3::new(0.3, -1.25, 0.2);
    let around = |point: DVec3| Within::around(point.as_vec3(), &objects);
    assert_eq!(around(eye).bodies().collect::<Vec<_>>(), [0, 1]);
    assert_eq!(around(DVec3::new(0.3, -2.0, 0.2)).bodies().collect::<Vec<_>>(), [0]);
    assert!(around(DVec3::Y).is_empty());
    // In radiance 1 without absorption it sees the colour of the outer body, through which all light comes.
    let ones = Environment::Map(EnvironmentMap { width: 4, height: 2, pixels: vec![[1.0; 4]; 8] });
    let without = optics.map(|optics| Optics { absorption: DVec3::ZERO, ..optics });
    for direction in [DVec3::Y, DVec3::new(0.6, 0.0, -0.8), DVec3::new(0.3, -0.9, 0.1).normalize()] {
        let surroundings = surroundings(&objects, &ones, Geometry::Planes, eye, 1e-9);
        let primary = surroundings.primary(eye, direction).expect("within");
        let seen = surroundings.follow(&primary, &without, &mut generator(1, 0));
        assert!((seen.radiance / base_color + seen.lost - 1.0).abs().max_element() < 1e-8, "{direction}: {seen:?}");
    }
}

/// Twelve plates, each within the one before, are a pile; a thirteenth is too many, and its light is counted as lost.
#[test]
fn a_dozen_bodies_may_lie_within_one_another() {
    let nested = |count: usize| -> (Vec<Object>, Vec<Optics>) {
        let one = |k: usize| (layer(-3.0 + 0.1 * k as f64, -0.1 * k as f64), clear(1.0 + 0.1 * (k + 1) as f64));
        (0..count).map(one).unzip()
    };
    let pile = |count: usize| -> Vec<(f64, f64, f64)> {
        let index = |k: usize| 1.0 + 0.1 * (k + 1) as f64;
        (0..count).chain((0..count - 1).rev()).map(|k| (index(k), 0.1, 0.0)).collect()
    };
    let (objects, optics) = nested(MOST);
    assert_piled(&objects, &optics, &pile(MOST));
    let (objects, optics) = nested(MOST + 1);
    let lost = seen(&objects, &optics, Geometry::Planes, DVec3::Y, -DVec3::Y).lost;
    assert!(lost > 0.5, "{lost}");
}
