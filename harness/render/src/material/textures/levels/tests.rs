use super::*;

#[test]
fn levels_go_down_to_one_texel() {
    for (size, expected) in [([1, 1], 1), ([2, 1], 2), ([5, 3], 3), ([8192, 1], 14), ([1023, 1024], 11)] {
        assert_eq!(count(size), expected, "{size:?}");
        assert_eq!(level_size(size, expected - 1), [1, 1], "{size:?}");
    }
}

/// Each texel of a level covers equal parts of the one before, so that no level changes the mean.
#[test]
fn a_level_has_the_mean_of_the_image() {
    for side in [1u32, 2, 3, 5, 7, 64, 100, 1023] {
        let shares = covered(side);
        let mut taken = vec![0.0f32; side as usize];
        for texel in &shares {
            let whole: f32 = texel.iter().map(|(_, share)| share).sum();
            assert!((whole - 1.0).abs() < 1e-6, "{side}: {texel:?}");
            for (place, share) in texel {
                taken[*place] += share;
            }
        }
        let each = shares.len() as f32 / side as f32;
        assert!(taken.iter().all(|share| (share - each).abs() < 1e-6), "{side}: {taken:?}");
    }
}

/// Black and white in turn have half the light, whose code value is 188, and not the mean of the codes.
#[test]
fn colours_are_light_when_they_are_averaged() {
    let bytes = (0..16u32).flat_map(|place| [[0, 0, 0, 255], [255, 255, 255, 0]][((place + place / 4) % 2) as usize]);
    let checks = Texels::new(4, 4, bytes.collect()).expect("an image");
    let (count, bytes) = of_image(&checks, Encoding::Srgb);
    assert_eq!((count, bytes.len()), (3, 4 * (16 + 4 + 1)));
    assert!(bytes[64..].chunks_exact(4).all(|texel| texel == [188, 188, 188, 128]), "{:?}", &bytes[64..]);
    let (_, bytes) = of_image(&checks, Encoding::Linear);
    assert!(bytes[64..].chunks_exact(4).all(|texel| texel == [128; 4]), "{:?}", &bytes[64..]);
}

/// Slopes of opposite signs leave a flat surface, and a level holds all layers.
#[test]
fn slopes_even_out() {
    let slope = |sign: f32| Vec2::new(0.5 * sign, -0.25);
    let layer = vec![slope(1.0), slope(-1.0), slope(-1.0), slope(1.0)];
    let (count, bytes) = Layers { size: [2, 2], layers: vec![layer.clone(), layer] }.levels();
    let half = |value: f32| f16::from_f32(value).to_le_bytes();
    assert_eq!((count, bytes.len()), (2, 4 * (2 * 4 + 2)));
    let last = [half(0.0), half(-0.25), half(0.0), half(-0.25)].concat();
    assert_eq!(bytes[32..], last);
}
