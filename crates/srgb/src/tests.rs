//! Mirror against oracle: the error of f32, and the inputs for which the naive forms fail.

use super::*;
use glam::DVec3;
use lapidary_assay::draws::Draws;
use lapidary_assay::extremum::larger;
use lapidary_assay::extremum::largest;
use lapidary_assay::tolerance::ulp_of;

fn vector_ulps(got: Vec3, exact: DVec3) -> f64 {
    largest((got.as_dvec3() - exact).abs().to_array()) / ulp_of(exact.abs().max_element())
}

fn report(what: &str, worst: f64, bound: f64) {
    println!("{what}: {worst:.3e} of {bound:.3e}");
    assert!(worst <= bound, "{what}: {worst:e} > {bound:e}");
}

const EDGES: [f32; 14] =
    [-1e19, -1.0, -1e-20, 0.0, 1e-30, 0.0031307, 0.0031308, 0.0031309, 0.04044, 0.04045, 0.04046, 1.0, 1.0000001, 1e19];

#[test]
fn transfer_function_matches_the_oracle() {
    let mut rng = Draws::of_row(1, 0);
    let mut worst = [0.0f64; 3];
    let inputs: Vec<f32> = EDGES
        .into_iter()
        .chain((0..400_000).map(|i| match i % 4 {
            0 => rng.magnitude(-40, 2),
            1 => 0.0031308 * (0.95 + 0.1 * (rng.unit() as f32)),
            2 => 0.04045 * (0.95 + 0.1 * (rng.unit() as f32)),
            _ => rng.unit() as f32,
        }))
        .collect();
    for x in inputs {
        let relative = |got: f32, exact: f64| (f64::from(got) - exact).abs() / exact.max(f64::from(f32::MIN_POSITIVE));
        worst[0] = larger(worst[0], relative(encode(x), oracle::encode(f64::from(x))));
        worst[1] = larger(worst[1], relative(decode(x), oracle::decode(f64::from(x))));
        worst[2] = larger(worst[2], (f64::from(encode_gamma(x)) - oracle::encode_gamma(f64::from(x))).abs());
    }
    report("encode rel", worst[0], 1.2e-6);
    report("decode rel", worst[1], 1.2e-6);
    report("encode_gamma abs", worst[2], 3e-7);
    assert_eq!(encode(0.0), 0.0);
    assert_eq!(decode(1.0), 1.0);
    assert!((encode(1.0) - 1.0).abs() <= 1e-7, "{}", encode(1.0));
}

/// Checks that `encode` is monotone and the inverse of `decode`, and that the error of the gamma
/// rung is as documented.
#[test]
fn transfer_function_invariants() {
    let (mut before, mut worst, mut gamma) = (0.0, 0.0f32, [0.0f32; 2]);
    for i in 0..=1_000_000 {
        let light = i as f32 / 1e6;
        let code = encode(light);
        assert!(code >= before - 1e-7 && (0.0..=1.0).contains(&code));
        before = code;
        worst = larger(worst, (decode(code) - light).abs() / light.max(1e-6));
        let error = (encode_gamma(light) - code).abs();
        gamma[usize::from(light > 0.07)] = gamma[usize::from(light > 0.07)].max(error);
    }
    println!("round trip {worst:e}, gamma {gamma:?}");
    assert!(worst < 5e-6);
    assert!((0.0330..0.0336).contains(&gamma[0]) && (0.0055..0.0059).contains(&gamma[1]));
}

/// Checks that the weights follow from the Rec. 709 primaries and D65, to four digits.
#[test]
fn luminance_weights_follow_from_the_primaries() {
    let xyz = |x: f64, y: f64| DVec3::new(x / y, 1.0, (1.0 - x - y) / y);
    let primaries = glam::DMat3::from_cols(xyz(0.64, 0.33), xyz(0.30, 0.60), xyz(0.15, 0.06));
    let weights = primaries.inverse() * xyz(0.3127, 0.3290);
    for (axis, weight) in [(DVec3::X, weights.x), (DVec3::Y, weights.y), (DVec3::Z, weights.z)] {
        assert!((oracle::luminance(axis) - weight).abs() < 0.5e-4);
    }
}

#[test]
fn colours_match_the_oracle() {
    let mut rng = Draws::of_row(2, 0);
    let mut worst = [0.0f64; 2];
    for i in 0..400_000 {
        let mut channel = || match i % 5 {
            0 => rng.magnitude(-40, 100),
            1 => (rng.unit() as f32) * 0.2,
            2 => rng.magnitude(-6, 6),
            3 => rng.magnitude(-3, 4) - 0.5,
            _ => 0.7 + (rng.unit() as f32) * 0.2,
        };
        let mut color = Vec3::new(channel(), channel(), channel());
        if i % 7 == 0 {
            color = Vec3::splat(color.x.abs()) * (1.0 + 1e-5 * (rng.unit() as f32));
        }
        let exact = oracle::tone_curve(color.as_dvec3());
        let got = tone_curve(color);
        assert!(got.min_element() >= 0.0 && got.max_element() <= 1.0 + 3e-7, "{color} {got}");
        worst[0] = larger(worst[0], vector_ulps(got, exact));
        let positive = color.abs();
        let exact = oracle::luminance(positive.as_dvec3());
        worst[1] = larger(worst[1], (f64::from(luminance(positive)) - exact).abs() / ulp_of(exact));
    }
    report("tone_curve ulp", worst[0], 6.0);
    report("luminance ulp", worst[1], 3.0);
}

#[test]
fn naive_forms_fail_where_the_docs_say_so() {
    // A dark grey x becomes x^2 / 0.16, of which x - (x - x^2 / 0.16) keeps no digit.
    for x in [1e-4f32, 1e-5, 1e-8] {
        let exact = oracle::tone_curve(DVec3::splat(f64::from(x)));
        let stable = vector_ulps(tone_curve(Vec3::splat(x)), exact);
        let naive = tone_curve_naive(Vec3::splat(x));
        println!(
            "grey {x:e}: exact {:e}, naive {:e}, {:e} ulp, stable {stable}",
            exact.x,
            naive.x,
            vector_ulps(naive, exact)
        );
        assert!(stable <= 6.0 && vector_ulps(naive, exact) > 50.0);
    }
    let naive = tone_curve_naive(Vec3::splat(-1.0));
    println!("grey -1: naive {naive}, stable {}", tone_curve(Vec3::splat(-1.0)));
    assert_eq!(encode_naive(0.0), -0.055);
    assert!(encode_naive(-1e-20).is_nan());
    assert!(encode_naive(5e-4) < 0.0 && encode(5e-4) > 0.006);
    println!("encode 5e-4 {} naive {}; 1e19 naive {}", encode(5e-4), encode_naive(5e-4), encode_naive(1e19));
    println!(
        "decode 0.04 {:e} naive {:e} oracle {:e}",
        decode(0.04),
        decode_naive(0.04),
        oracle::decode(f64::from(0.04f32))
    );
    println!("decode -0.06 naive {:e}, 1e19 {:e}", decode_naive(-0.06), decode_naive(1e19));
    assert!((decode_naive(0.04) / decode(0.04) - 1.0).abs() > 1e-4);
}

/// Checks that the naive forms are the same functions on their benign domains.
#[test]
fn naive_forms_hold_on_benign_inputs() {
    let mut rng = Draws::of_row(3, 0);
    let mut worst = [0.0f64; 3];
    for _ in 0..200_000 {
        let light = 0.0031309 + (1.0 - 0.0031309) * (rng.unit() as f32);
        let exact = oracle::encode(f64::from(light));
        worst[0] = worst[0].max((f64::from(encode_naive(light)) - exact).abs() / exact);
        let code = 0.04046 + (1.0 - 0.04046) * (rng.unit() as f32);
        let exact = oracle::decode(f64::from(code));
        worst[1] = worst[1].max((f64::from(decode_naive(code)) - exact).abs() / exact);
        let mut channel = || rng.magnitude(-6, 6);
        let color = Vec3::new(channel(), channel(), channel());
        worst[2] = worst[2].max(vector_ulps(tone_curve_naive(color), oracle::tone_curve(color.as_dvec3())));
    }
    println!("benign naive: encode {:e} rel, decode {:e} rel, tone curve {} ulp", worst[0], worst[1], worst[2]);
    assert!(worst[0] < 1.2e-6 && worst[1] < 1.2e-6 && worst[2] < 150.0);
}
