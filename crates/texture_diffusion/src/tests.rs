//! Tests of the placement in docs/texture_diffusion.md: its promises about sums over taps.

use super::*;

/// Materials, in units of their widest channel.
const MATERIALS: [Vec3; 4] =
    [Vec3::ONE, Vec3::new(1.0, 0.5, 0.25), Vec3::new(0.3, 1.0, 0.125), Vec3::new(0.25, 0.0625, 1.0)];

/// Returns the mean of `f` over the offsets of all taps, both of each pair, with the weights of
/// each channel.
fn mean(sigma0: Vec3, f: impl Fn(f32) -> f32) -> Vec3 {
    let count = pairs(sigma0);
    let (mut sum, mut total) = (Vec3::splat(f(0.0)), Vec3::ONE);
    for index in 1..=count {
        let tap = tap(index, count, sigma0);
        sum += tap.weight * (f(tap.offset) + f(-tap.offset));
        total += 2.0 * tap.weight;
    }
    sum / total
}

#[test]
fn taps_damp_each_harmonic_as_the_gaussian_does() {
    for sigma0 in MATERIALS {
        // Harmonics as in a blur of one radian. The part beyond the last tap is 7e-4 of the widest
        // Gaussian.
        for order in 1..=3u8 {
            let order = f32::from(order);
            let damped = mean(sigma0, |x| (order * x).cos());
            let wanted = (-0.5 * order * order * sigma0 * sigma0).exp();
            assert!((damped - wanted).abs().cmplt(Vec3::splat(1.5e-3)).all(), "{sigma0} {order}: {damped} {wanted}");
        }
    }
}

#[test]
fn offsets_rise_from_the_middle_to_the_reach() {
    for sigma0 in MATERIALS {
        let count = pairs(sigma0);
        let taps: Vec<TextureDiffusionTap> = (0..=count).map(|index| tap(index, count, sigma0)).collect();
        assert_eq!((taps[0].offset, taps[0].weight), (0.0, Vec3::ONE));
        assert!((taps[count as usize].offset - TEXTURE_DIFFUSION_REACH).abs() < 1e-5);
        let gaps: Vec<f32> = taps.windows(2).map(|pair| pair[1].offset - pair[0].offset).collect();
        assert!(gaps.is_sorted() && gaps[0] > 0.0, "{sigma0}: {gaps:?}");
        // The gap in the middle is narrower than the standard deviation of the narrowest channel.
        assert!(gaps[0] < ratio(sigma0), "{sigma0}: {}", gaps[0]);
    }
}

#[test]
fn a_channel_that_does_not_scatter_keeps_to_the_middle() {
    for sigma0 in [Vec3::ZERO, Vec3::new(f32::NAN, -1.0, 0.0)] {
        assert!((1..=pairs(sigma0)).all(|index| tap(index, pairs(sigma0), sigma0).weight == Vec3::ZERO));
    }
    let sigma0 = Vec3::new(1.0, 0.0, f32::NAN);
    let weight = |index| tap(index, pairs(sigma0), sigma0).weight;
    assert!((1..=pairs(sigma0)).all(|index| weight(index).y == 0.0 && weight(index).z == 0.0 && weight(index).x > 0.0));
}
