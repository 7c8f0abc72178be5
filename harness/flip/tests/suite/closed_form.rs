//! Cases whose error is known beforehand.

use lapidary_flip::{flip, magma, mean};

/// A picture of values that look random, the same for each seed.
fn noise(pixels: usize, seed: u32) -> Vec<u8> {
    let mut state = seed;
    let next = || {
        state = state.wrapping_mul(1664525).wrapping_add(1013904223);
        (state >> 24) as u8
    };
    std::iter::repeat_with(next).take(3 * pixels).collect()
}

fn uniform(pixels: usize, color: [u8; 3]) -> Vec<u8> {
    color.repeat(pixels)
}

/// The error of two uniform pictures, by its definition in f64: there are no features.
fn uniform_error(lab: [f64; 3], other: [f64; 3]) -> f64 {
    let hunt = |[l, a, b]: [f64; 3]| [l, 0.01 * l * a, 0.01 * l * b];
    let hyab = |p: [f64; 3], q: [f64; 3]| (p[0] - q[0]).abs() + (p[1] - q[1]).hypot(p[2] - q[2]);
    let compressed = |p, q| hyab(hunt(p), hunt(q)).powf(0.7);
    let share = compressed(lab, other) / compressed(GREEN, BLUE);
    if share < 0.4 { share * 0.95 / 0.4 } else { 0.95 + 0.05 * (share - 0.4) / 0.6 }
}

// L*a*b* for D65.
const BLACK: [f64; 3] = [0.0; 3];
const WHITE: [f64; 3] = [100.0, 0.0, 0.0];
const RED: [f64; 3] = [53.2408, 80.0925, 67.2032];
const GREEN: [f64; 3] = [87.7347, -86.1827, 83.1793];
const BLUE: [f64; 3] = [32.2970, 79.1875, -107.8602];

#[test]
fn uniform_pictures_differ_by_their_colour() {
    let colors = [([0; 3], BLACK), ([255; 3], WHITE), ([255, 0, 0], RED), ([0, 255, 0], GREEN), ([0, 0, 255], BLUE)];
    for (code, lab) in colors {
        for (other_code, other_lab) in colors {
            let expected = uniform_error(lab, other_lab) as f32;
            let errors = flip((40, 30), &uniform(1200, code), &uniform(1200, other_code));
            assert!(
                errors.iter().all(|e| (e - expected).abs() < 2e-4),
                "{code:?} {other_code:?}: {expected}, {errors:?}"
            );
        }
    }
}

#[test]
fn the_largest_difference_is_that_of_green_and_blue() {
    let error = mean(&flip((8, 8), &uniform(64, [0, 255, 0]), &uniform(64, [0, 0, 255])));
    assert!((error - 1.0).abs() < 1e-5, "{error}");
}

#[test]
fn equal_pictures_do_not_differ() {
    for (width, height) in [(1, 1), (3, 2), (17, 9), (64, 33)] {
        let picture = noise((width * height) as usize, 1);
        let errors = flip((width, height), &picture, &picture);
        assert_eq!(errors, vec![0.0; (width * height) as usize], "{width} x {height}");
    }
}

/// Pictures that are smaller than the filters.
#[test]
fn pictures_may_be_small() {
    let black_white = uniform_error(BLACK, WHITE) as f32;
    for (width, height) in [(1, 1), (3, 2), (1, 7), (5, 1)] {
        let pixels = (width * height) as usize;
        let errors = flip((width, height), &uniform(pixels, [0; 3]), &uniform(pixels, [255; 3]));
        assert_eq!(errors.len(), pixels);
        assert!(errors.iter().all(|error| (error - black_white).abs() < 2e-4), "{errors:?}");
    }
    assert!(flip((0, 4), &[], &[]).is_empty() && flip((4, 0), &[], &[]).is_empty());
}

#[test]
fn the_pictures_may_be_exchanged() {
    let (a, b) = (noise(37 * 21, 1), noise(37 * 21, 2));
    assert_eq!(flip((37, 21), &a, &b), flip((37, 21), &b, &a));
}

/// A picture with its rows and columns exchanged.
fn transposed<T: Copy>(width: usize, values: &[T]) -> Vec<T> {
    let height = values.len() / width;
    (0..values.len()).map(|k| values[k % height * width + k / height]).collect()
}

/// A picture with its rows in the other order.
fn upside_down<T: Copy>(width: usize, values: &[T]) -> Vec<T> {
    values.chunks(width).rev().flatten().copied().collect()
}

#[test]
fn directions_are_alike() {
    let pixels = |seed| noise(37 * 21, seed).chunks(3).map(|c| [c[0], c[1], c[2]]).collect::<Vec<_>>();
    let (a, b) = (pixels(1), pixels(2));
    let errors = flip((37, 21), a.as_flattened(), b.as_flattened());
    let near = |found: &[f32], expected: &[f32]| {
        let largest = found.iter().zip(expected).map(|(found, expected)| (found - expected).abs()).fold(0.0, f32::max);
        assert!(found.len() == expected.len() && largest < 2e-4, "{largest}");
    };
    let turned = flip((21, 37), transposed(37, &a).as_flattened(), transposed(37, &b).as_flattened());
    near(&turned, &transposed(37, &errors));
    let turned = flip((37, 21), upside_down(37, &a).as_flattened(), upside_down(37, &b).as_flattened());
    near(&turned, &upside_down(37, &errors));
}

#[test]
fn errors_are_between_0_and_1() {
    for (a, b) in [(noise(4096, 3), noise(4096, 4)), (noise(4096, 5), uniform(4096, [0; 3]))] {
        assert!(flip((64, 64), &a, &b).iter().all(|error| (0.0..=1.0).contains(error)));
    }
}

#[test]
#[should_panic(expected = "the test picture has 11 bytes for 2 x 2 pixels")]
fn a_picture_of_another_size_is_refused() {
    flip((2, 2), &[0; 12], &[0; 11]);
}

#[test]
fn the_mean_is_plain() {
    assert_eq!(mean(&[0.0, 1.0, 0.5, 0.5]), 0.5);
    assert_eq!(mean(&[]), 0.0);
    // A sum in f32 would be off by 1e-3 of its value.
    assert!((mean(&vec![0.1; 1 << 20]) - 0.1).abs() < 1e-7);
}

#[test]
fn magma_goes_from_black_to_light_yellow() {
    assert_eq!([0.0, 0.5, 1.0].map(magma), [[0, 0, 4], [183, 55, 121], [252, 253, 191]]);
    // Rounded to the nearest of 256, and clamped.
    assert_eq!(magma(0.49 / 255.0), magma(0.0));
    assert_eq!(magma(0.51 / 255.0), magma(1.0 / 255.0));
    assert_eq!([-1.0, 2.0, f32::NAN].map(magma), [magma(0.0), magma(1.0), magma(0.0)]);
}
