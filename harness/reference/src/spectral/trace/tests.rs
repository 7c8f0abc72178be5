use super::*;
use crate::generator::generator;
use crate::spectral::geometry::Geometry;
use lapidary_scene::environment_map::EnvironmentMap;
use lapidary_scene::polyhedron::{Plane, Polyhedron};
use lapidary_scene::{Averaging, Material, Object};

const POLISHED: Surface = Surface {
    is_thin: false,
    is_opaque: false,
    alpha: 0.0,
    painted: Painted { color: DVec3::ONE, clear: 1.0, metallic: 0.0, metal_alpha: 0.0 },
    is_partly_clear: false,
    f0: DVec3::ZERO,
};

/// Returns a sky of radiance 1 above and 0 below, with a soft step of one texel in between.
fn sky() -> Environment {
    let pixels = (0..128).map(|place| if place < 64 { [1.0; 4] } else { [0.0; 4] }).collect();
    Environment::Map(EnvironmentMap { width: 2, height: 64, pixels })
}

/// Returns a plate of thickness 1 with its upper side at y = 0, too wide for light to reach its
/// rim.
fn plate() -> Object {
    let side = |normal: DVec3, distance| Plane { normal, distance };
    // A polyhedron is built z up: its z is the mesh's y.
    let around = [DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y].map(|normal| side(normal, 512.0));
    let planes = [around.as_slice(), &[side(DVec3::Z, 0.0), side(-DVec3::Z, 1.0)]].concat();
    let mesh = Polyhedron::from_planes(&planes).unwrap().to_mesh(Averaging::Angle);
    Object::new("plate", mesh, Material::standard())
}

fn surroundings<'a>(
    objects: &[Object],
    environment: &'a Environment,
    geometry: Geometry,
    eye: DVec3,
    energy_bound: f64,
) -> Surroundings<'a> {
    let bodies = Bodies::new(objects, geometry);
    let around_eye = Within::around(eye.as_vec3(), objects);
    Surroundings {
        bodies,
        order: Order::of(objects),
        lights: Vec::new(),
        surfaces: vec![POLISHED; objects.len()],
        is_random: false,
        scatterers: &[],
        around_eye,
        environment,
        energy_bound,
    }
}

fn outcome(
    object: &Object,
    environment: &Environment,
    geometry: Geometry,
    optics: Optics,
    direction: DVec3,
) -> Outcome {
    let eye = DVec3::new(0.3, 0.0, 0.2) - 3.0 * direction;
    let surroundings = surroundings(std::slice::from_ref(object), environment, geometry, eye, 1e-13);
    let primary = surroundings.primary(eye, direction).expect("met");
    surroundings.follow(&primary, &[optics], &mut generator(1, 0))
}

fn clear(index: f64) -> Optics {
    Optics { index, absorption: DVec3::ZERO, base_color: DVec3::ONE }
}

mod nested;

#[test]
fn a_plate_reflects_what_the_sum_of_all_its_reflections_says() {
    let sky = sky();
    for geometry in [Geometry::Planes, Geometry::Triangles] {
        for (index, angle) in [(2.41749, 0.0), (2.41749, 0.6), (1.5, 0.0), (1.5, 1.2), (1.00001, 0.3), (1.0, 0.5)] {
            let direction = DVec3::new(f64::sin(angle), -f64::cos(angle), 0.0);
            let seen = outcome(&plate(), &sky, geometry, clear(index), direction);
            let once = fresnel::dielectric(f64::cos(angle), index);
            let all = 2.0 * once / (1.0 + once);
            assert!(seen.radiance.abs_diff_eq(DVec3::splat(all), 1e-12), "{index} {angle}: {seen:?}, not {all}");
            assert!(seen.lost < 1e-13);
        }
    }
}

#[test]
fn an_absorbing_plate_follows_beer_and_lambert() {
    let (sky, index, absorption, angle) = (sky(), 1.77, DVec3::new(0.35, 0.0, 2.0), 0.7f64);
    let base_color = DVec3::new(0.2, 0.5, 1.0);
    let optics = Optics { index, absorption, base_color };
    let seen = outcome(&plate(), &sky, Geometry::Planes, optics, DVec3::new(angle.sin(), -angle.cos(), 0.0));
    let once = fresnel::dielectric(angle.cos(), index);
    let path = 1.0 / (angle.sin() / index).asin().cos();
    let through = (-absorption * path).exp();
    let inside = (1.0 - once).powi(2) * once * through * through / (1.0 - (once * through).powf(2.0));
    assert!(seen.radiance.abs_diff_eq(once + base_color * inside, 1e-12), "{seen:?}");
}

#[test]
fn the_surface_alone_reflects_by_fresnel() {
    // The inside is black, so only the first reflection remains.
    let optics = Optics { absorption: DVec3::splat(1e9), ..clear(2.41749) };
    let seen = outcome(&plate(), &sky(), Geometry::Planes, optics, -DVec3::Y);
    assert!((seen.radiance.x - 0.1720).abs() < 5e-5, "{seen:?}");
}

#[test]
fn an_index_of_one_is_not_seen() {
    for geometry in [Geometry::Planes, Geometry::Triangles] {
        let direction = DVec3::new(0.3, -0.8, 0.1).normalize();
        let seen = outcome(&plate(), &Environment::Studio, geometry, clear(1.0), direction);
        let behind = Environment::Studio.radiance(direction);
        assert!(seen.radiance.abs_diff_eq(behind, 1e-12));
    }
}

#[test]
fn what_is_dropped_is_counted() {
    let object = plate();
    let environment = sky();
    for energy_bound in [1e-1, 1e-3, 1e-6] {
        let eye = DVec3::new(0.3, 2.0, 0.2);
        let surroundings =
            surroundings(std::slice::from_ref(&object), &environment, Geometry::Planes, eye, energy_bound);
        let primary = surroundings.primary(eye, -DVec3::Y).expect("met");
        let seen = surroundings.follow(&primary, &[clear(2.41749)], &mut generator(1, 0));
        let whole = outcome(&object, &environment, Geometry::Planes, clear(2.41749), -DVec3::Y);
        assert!(seen.lost > 0.0 && seen.lost < energy_bound);
        let missing = whole.radiance.x - seen.radiance.x;
        assert!((0.0..=seen.lost + 1e-12).contains(&missing), "{missing} of {}", seen.lost);
    }
}

#[test]
fn reflection_is_the_oracles() {
    let normal = DVec3::new(2.0, -3.0, 6.0) / 7.0;
    let mut direction = DVec3::new(0.6, 0.0, -0.8);
    for k in 0..1000 {
        let expected = refraction::reflect(direction, normal);
        assert!(reflect(direction, normal).abs_diff_eq(expected, 1e-15), "{direction}");
        // Rotated by an angle that never repeats a direction.
        direction = glam::DMat3::from_axis_angle(DVec3::new(0.6, 0.48, 0.64), 1.0 + f64::from(k)) * expected;
        direction = direction.normalize();
    }
}

/// The oracle decides total reflection; the shortcut before it must agree.
#[test]
fn the_shortcut_to_total_reflection_agrees_with_the_oracle() {
    for index in [1.3, 1.5, 2.41749, 4.0] {
        let critical = (1.0 / f64::to_radians(90.0).sin() / index).asin();
        for step in -200..200i32 {
            let angle = critical + f64::from(step).powi(3) * 1e-10;
            if !(0.0..1.57).contains(&angle) {
                continue;
            }
            let arrival = Arrival {
                point: DVec3::ZERO,
                direction: DVec3::new(angle.sin(), -angle.cos(), 0.0),
                normal: DVec3::Y,
                shading: DVec3::Y,
                surface: POLISHED,
                enters: false,
                place: Place { body: 0, face: 0 },
                before: Within::default().with(0).expect("room"),
                behind: Within::default(),
                throughput: DVec3::ONE,
            };
            let order = Order::of(&[plate()]);
            let (reflectance, transmitted) = arrival.split(&order, &[clear(index)]);
            let truth = refraction::refract(arrival.direction, arrival.normal, 1.0 / index);
            assert_eq!(transmitted.is_none(), truth.total, "{index} {step}");
            assert!(transmitted.is_none_or(|ray| (ray.energy() + reflectance - 1.0).abs() < 1e-15));
        }
    }
}
