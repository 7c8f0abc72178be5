//! Compares the mirror with the oracle at all magnitudes, and checks known values and the table of
//! docs/fresnel.md.

use super::*;
use lapidary_assay::draws::Draws;
use lapidary_assay::tolerance::ulp_of;

/// Moves a float by `steps` units in the last place.
fn step(value: f32, steps: i32) -> f32 {
    f32::from_bits((value.to_bits() as i32 + steps) as u32)
}

/// Draws an input of the domain: every magnitude of cosine, index - 1, and distance from the
/// critical angle.
fn input(random: &mut Draws<'_>) -> (f32, f32) {
    let relative_index = match random.below(4) {
        0 => (1.0 + 2f64.powf(-24.0 * random.unit()) * 0.75 * (random.unit() - 0.5).signum()) as f32,
        1 => step(1.0, random.below(41) as i32 - 20),
        2 => [0.25f32, 4.0, 1.0, 2.41749, 1.0 / 2.41749, 1.0 / 1.5168][random.below(6) as usize],
        _ => (4f64.powf(2.0 * random.unit() - 1.0)) as f32,
    };
    let cosine = match random.below(6) {
        0 => 2f64.powf(-149.0 * random.unit()) as f32,
        1 => step(1.0, -(random.below(20) as i32)),
        2 if relative_index < 1.0 => {
            let n = f64::from(relative_index);
            step(((1.0 - n) * (1.0 + n)).sqrt() as f32, random.below(41) as i32 - 20)
        }
        3 => [0.0f32, 1.0, -0.5, 1.5, 1e-45, f32::MIN_POSITIVE][random.below(6) as usize],
        4 => 2f64.powf(-26.0 * random.unit()) as f32,
        _ => random.unit() as f32,
    };
    (cosine, relative_index)
}

/// Returns the error of `mirror` in ulp beyond the allowance for an input error of `backward` ulp.
fn excess(mirror: fn(f32, f32) -> f32, oracle: fn(f64, f64) -> f64, (cosine, index): (f32, f32), backward: f64) -> f64 {
    let exact = oracle(f64::from(cosine), f64::from(index));
    let (mut low, mut high) = (exact, exact);
    for (i, j) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0), (0.0, 1.0), (0.0, -1.0), (1.0, 0.0), (-1.0, 0.0)]
    {
        let near = oracle(
            f64::from(cosine) + i * backward * ulp_of(f64::from(cosine.abs())),
            f64::from(index) + j * backward * ulp_of(f64::from(index)),
        );
        (low, high) = (low.min(near), high.max(near));
    }
    let value = f64::from(mirror(cosine, index));
    assert!(value.is_finite() && (0.0..=1.0).contains(&value), "{cosine:e} {index:e} gives {value}");
    (value - high).max(low - value).max(0.0) / ulp_of(exact)
}

fn worst(mirror: fn(f32, f32) -> f32, oracle: fn(f64, f64) -> f64, backward: f64, keep: fn(f32, f32) -> bool) -> f64 {
    let mut random = Draws::of_row(1, 0);
    let mut worst = (0.0, (0.0, 0.0));
    for _ in 0..1_000_000 {
        let input = input(&mut random);
        if keep(input.0, input.1) {
            let error = excess(mirror, oracle, input, backward);
            if error > worst.0 {
                worst = (error, input);
            }
        }
    }
    println!("backward {backward}: {:.2} ulp at cosine {:e}, index {:e}", worst.0, worst.1.0, worst.1.1);
    worst.0
}

#[test]
fn dielectric_is_accurate() {
    assert!(worst(dielectric, oracle::dielectric, 0.75, |_, _| true) <= 16.0);
    // For light that enters a denser medium the problem is well-conditioned: no allowance for the
    // input.
    assert!(worst(dielectric, oracle::dielectric, 0.0, |_, n| n >= 1.0) <= 16.0);
}

#[test]
fn cheap_rungs_are_accurate() {
    assert!(worst(schlick, oracle::schlick, 1.5, |_, _| true) <= 8.0);
    assert!(worst(|_, n| normal_incidence(n), |_, n| oracle::normal_incidence(n), 0.0, |_, _| true) <= 6.0);
}

#[test]
fn known_values() {
    // Normal incidence with the Sellmeier indices at 587.6 nm, and Brewster's angle, at which
    // r_p = 0.
    for (relative_index, reflectance) in [(2.41749, 0.1720), (1.76817, 0.0770), (1.54428, 0.0458), (1.5168, 0.0422)] {
        assert!((dielectric(1.0, relative_index) - reflectance).abs() < 5e-5);
        assert!((normal_incidence(relative_index) - reflectance).abs() < 5e-5);
        assert!((schlick(1.0, relative_index) - reflectance).abs() < 5e-5);
    }
    let brewster = 67.53f64.to_radians();
    let s = (brewster - (brewster.sin() / 2.41749).asin()).sin();
    assert!((f64::from(dielectric(brewster.cos() as f32, 2.41749)) - 0.5 * s * s).abs() < 1e-6);
    for (index, critical) in [(2.41749f32, 24.43f32), (1.76817, 34.44), (1.54428, 40.36), (1.5168, 41.25)] {
        assert!(dielectric((critical - 0.01).to_radians().cos(), 1.0 / index) < 1.0);
        assert_eq!(dielectric((critical + 0.01).to_radians().cos(), 1.0 / index), 1.0);
        assert_eq!(schlick((critical + 0.01).to_radians().cos(), 1.0 / index), 1.0);
    }
}

#[test]
fn light_that_returns_on_its_path_is_reflected_alike() {
    let mut random = Draws::of_row(7, 0);
    for _ in 0..100_000 {
        let (cosine, index) = (random.unit(), 1.0 + 3.0 * random.unit());
        let transmitted = (1.0 - (1.0 - cosine * cosine) / (index * index)).sqrt();
        let there = oracle::dielectric(cosine, index);
        let back = oracle::dielectric(transmitted, 1.0 / index);
        assert!((there - back).abs() < 1e-9, "{cosine} {index}: {there} {back}");
    }
}

#[test]
fn textbook_form_is_that_formula() {
    for i in 0..100 {
        for j in 0..100 {
            let (cosine, index) = (0.02 + 0.0098 * i as f32, 1.1 + 0.029 * j as f32);
            let exact = oracle::dielectric(f64::from(cosine), f64::from(index));
            assert!((f64::from(dielectric_textbook(cosine, index)) - exact).abs() < 5e-7);
        }
    }
}

/// Checks the table of docs/fresnel.md: the error of Schlick's approximation, from the f64 oracle.
#[test]
fn table_is_current() {
    let mut table = String::new();
    for (name, index) in [("BK7", 1.5168), ("quartz", 1.54428), ("corundum", 1.76817), ("diamond", 2.41749)] {
        for (side, index) in [("in", index), ("out", 1.0 / index)] {
            let steps = 20_000;
            let (mut most, mut angle, mut exact_mean, mut schlick_mean) = (0.0f64, 0.0, 0.0, 0.0);
            for i in 0..steps {
                // Uniform in cos², the measure of diffuse light.
                let cosine = ((f64::from(i) + 0.5) / f64::from(steps)).sqrt();
                let (exact, approximate) = (oracle::dielectric(cosine, index), oracle::schlick(cosine, index));
                exact_mean += exact / f64::from(steps);
                schlick_mean += approximate / f64::from(steps);
                if (approximate - exact).abs() > most.abs() {
                    (most, angle) = (approximate - exact, cosine.acos().to_degrees());
                }
            }
            let normal = oracle::normal_incidence(index);
            table += &format!(
                "| {name}, {side} | {index:.4} | {normal:.4} | {most:+.3} at {angle:.1}° | {exact_mean:.4} | {schlick_mean:.4} |\n"
            );
        }
    }
    let page = include_str!("../../../docs/fresnel.md");
    assert!(page.contains(&table), "docs/fresnel.md should hold:\n{table}");
}
