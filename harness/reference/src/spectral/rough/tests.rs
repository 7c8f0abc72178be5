//! Rough surfaces beside their limits, by means over many paths.

use super::*;
use rand::SeedableRng as _;

const PATHS: u32 = 200_000;

/// Returns the share of light that goes through a rough surface, and its mean direction's z, of light that comes at a cosine.
fn through(cosine: f64, alpha: f64, relative_index: f64) -> (f64, f64) {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    let direction = DVec3::new(((1.0 - cosine) * (1.0 + cosine)).sqrt(), 0.0, -cosine);
    let (mut passed, mut along) = (0, 0.0);
    for _ in 0..PATHS {
        let (left, passes) = scatter(&mut random, direction, DVec3::Z, alpha, relative_index);
        assert!((left.length() - 1.0).abs() < 1e-9 && (left.z < 0.0) == passes, "{left} {passes}");
        passed += u32::from(passes);
        along += if passes { left.z } else { 0.0 };
    }
    (f64::from(passed) / f64::from(PATHS), along / f64::from(PATHS))
}

#[test]
fn a_surface_that_is_hardly_rough_is_like_a_polished_one() {
    for (cosine, index) in [(1.0, 1.5), (0.5, 1.5), (0.8, 1.0 / 1.5), (0.5, 1.0 / 1.5), (0.6, 2.42)] {
        let transmitted = 1.0 - fresnel::dielectric(cosine, index);
        let (passed, _) = through(cosine, 1e-3, index);
        assert!((passed - transmitted).abs() < 5e-3, "{cosine} {index}: {passed} {transmitted}");
    }
}

/// Light that comes evenly from one side leaves as the second law of thermodynamics wants it: what goes from air to glass,
/// times its solid angle, is what comes back.
#[test]
fn as_much_light_goes_in_as_comes_out() {
    for alpha in [0.1, 0.3, 0.7] {
        let hemisphere = |index: f64| {
            let steps = 40;
            let each = (0..steps).map(|step| {
                let squared = (f64::from(step) + 0.5) / f64::from(steps);
                through(squared.sqrt(), alpha, index).0
            });
            each.sum::<f64>() / f64::from(steps)
        };
        let (into, out) = (hemisphere(1.5), hemisphere(1.0 / 1.5));
        assert!((into - 2.25 * out).abs() < 4e-3, "alpha {alpha}: {into} {out}");
    }
}

/// Returns the mean of what leaves a metal, and of what the first facets that light meets send towards a light.
fn from_metal(cosine: f64, alpha: f64, f0: f64, light: DVec3) -> (f64, f64) {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(2);
    let direction = DVec3::new(((1.0 - cosine) * (1.0 + cosine)).sqrt(), 0.0, -cosine);
    let metal = (DVec3::Z, alpha, DVec3::splat(f0));
    let (mut all, mut lit) = (0.0, 0.0);
    for _ in 0..PATHS {
        let (toward_eye, left) = reflect(&mut random, direction, metal, |direction, below, left| {
            if left == DVec3::ONE {
                lit += toward(light, direction, metal, below).x;
            }
        });
        assert!(toward_eye.z > 0.0, "{toward_eye}");
        all += left.x;
    }
    (all / f64::from(PATHS), lit / f64::from(PATHS))
}

/// White facets lose no light, and what first ones send towards a light is the reflectance of single scattering.
#[test]
fn a_metal_reflects_all_and_lights_as_the_brdf_says() {
    for (cosine, alpha) in [(1.0, 0.04), (0.6, 0.3), (0.2, 1.0), (0.9, 0.6)] {
        let light = DVec3::new(0.3, 0.4, 1.0).normalize();
        let (all, _) = from_metal(cosine, alpha, 1.0, light);
        assert!((all - 1.0).abs() < 1e-9, "{cosine} {alpha}: {all}");
        let (_, lit) = from_metal(cosine, alpha, 0.5, light);
        let toward_eye = DVec3::new(-((1.0 - cosine) * (1.0 + cosine)).sqrt(), 0.0, cosine);
        let facing = (light + toward_eye).normalize().dot(light);
        let fresnel = schlick(DVec3::splat(0.5), facing).x;
        let once = microfacet::reflectance(DVec3::Z, light, toward_eye, alpha, fresnel);
        // Of 200,000 paths.
        assert!((lit - once).abs() < 0.01 * once, "{cosine} {alpha}: {lit} {once}");
    }
}
