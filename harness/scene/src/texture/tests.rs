use super::*;

/// Returns a texture of these texels, row by row.
fn texture(width: u32, texels: &[[u8; 4]], encoding: Encoding) -> Texture {
    let texels = Texels::new(width, texels.len() as u32 / width, texels.concat()).unwrap();
    Texture::new(Arc::new(texels), encoding)
}

/// Two columns and two rows, in red: 0, 51; 102, 255 of 255.
fn small() -> Texture {
    texture(2, &[[0, 0, 0, 255], [51, 0, 0, 255], [102, 0, 0, 255], [255, 0, 0, 255]], Encoding::Linear)
}

fn red(texture: &Texture, u: f32, v: f32) -> f32 {
    texture.at(Vec2::new(u, v)).x
}

fn near(found: f32, expected: f32) {
    assert!((found - expected).abs() < 1e-5, "{found} is not {expected}");
}

#[test]
fn centres_of_texels_are_their_values_and_between_them_is_the_mean() {
    let texture = small();
    for (u, v, value) in [(0.25, 0.25, 0.0), (0.75, 0.25, 0.2), (0.25, 0.75, 0.4), (0.75, 0.75, 1.0)] {
        near(red(&texture, u, v), value);
    }
    near(red(&texture, 0.5, 0.5), 0.4);
    near(red(&texture, 0.4, 0.25), 0.06);
    assert_eq!(texture.at(Vec2::ZERO).w, 1.0);
}

#[test]
fn wraps_go_on_as_they_say_on_both_sides() {
    let row = |wrap| Texture { wrap: [wrap, Wrap::ClampToEdge], ..small() };
    // Values of the upper row at the centres of the texels from -2 to 4.
    for (wrap, values) in [
        (Wrap::Repeat, [0.0, 0.2, 0.0, 0.2, 0.0, 0.2, 0.0]),
        (Wrap::MirroredRepeat, [0.2, 0.0, 0.0, 0.2, 0.2, 0.0, 0.0]),
        (Wrap::ClampToEdge, [0.0, 0.0, 0.0, 0.2, 0.2, 0.2, 0.2]),
    ] {
        let texture = row(wrap);
        for (texel, value) in (-2..).zip(values) {
            // Above the image as well, where it is clamped.
            near(red(&texture, 0.5 * (texel as f32 + 0.5), -7.0), value);
        }
        for between in [-1i16, 0, 1, 2, 3] {
            let mean = 0.5 * (values[(between + 1) as usize] + values[(between + 2) as usize]);
            near(red(&texture, 0.5 * f32::from(between), 0.0), mean);
        }
    }
    // Each side has its own mode: u repeats, v is mirrored.
    let texture = Texture { wrap: [Wrap::Repeat, Wrap::MirroredRepeat], ..small() };
    near(red(&texture, 1.25, 1.25), 0.4);
    near(red(&texture, 1.75, 1.75), 0.2);
}

#[test]
fn no_coordinate_does_harm() {
    for wrap in [Wrap::Repeat, Wrap::MirroredRepeat, Wrap::ClampToEdge] {
        let texture = Texture { wrap: [wrap; 2], ..small() };
        for odd in [0.0, -0.0, 1.0, -1e-30, 1e30, -1e30, f32::MAX, f32::MIN, f32::INFINITY, f32::NAN, 0.999_999_94] {
            let value = texture.at(Vec2::new(odd, -odd));
            assert!(value.cmpge(Vec4::ZERO).all() && value.cmple(Vec4::ONE).all(), "{odd}: {value}");
        }
    }
    let one = texture(1, &[[255, 0, 0, 0]], Encoding::Linear);
    assert_eq!(one.at(Vec2::new(0.3, 17.0)), Vec4::X);
}

#[test]
fn colours_are_decoded_before_they_are_mixed() {
    let texels = [[0, 188, 255, 128], [255, 188, 255, 128]];
    let color = texture(2, &texels, Encoding::Srgb).at(Vec2::new(0.5, 0.5));
    near(color.x, 0.5);
    near(color.z, 1.0);
    // The code value of middle light, and alpha, which is never encoded.
    assert!((color.y - 0.5).abs() < 0.005);
    near(color.w, 128.0 / 255.0);
    near(texture(2, &texels, Encoding::Linear).at(Vec2::new(0.5, 0.5)).y, 188.0 / 255.0);
}

#[test]
fn coordinates_are_scaled_then_turned_then_moved() {
    let quarter = std::f32::consts::FRAC_PI_2;
    let transform = TextureTransform { offset: Vec2::new(0.0, 1.0), rotation: quarter, scale: Vec2::splat(0.5) };
    // The extension's own example: the lower left quarter of the image, turned clockwise.
    let place = |u: f32, v: f32| transform.affine().transform_point2(Vec2::new(u, v));
    for ((u, v), expected) in [((0.0, 0.0), (0.0, 1.0)), ((1.0, 0.0), (0.0, 0.5)), ((0.0, 1.0), (0.5, 1.0))] {
        assert!(place(u, v).distance(Vec2::from(expected)) < 1e-6, "{u} {v}: {}", place(u, v));
    }
    // Only one order of an uneven scale, a turn and an offset gives this.
    let transform = TextureTransform { offset: Vec2::new(3.0, 5.0), rotation: quarter, scale: Vec2::new(2.0, 7.0) };
    assert!(transform.affine().transform_point2(Vec2::new(10.0, 100.0)).distance(Vec2::new(703.0, -15.0)) < 1e-3);
    // The other example counts v from below.
    let below = TextureTransform { offset: Vec2::Y, rotation: 0.0, scale: Vec2::new(1.0, -1.0) };
    let texture = Texture { transform: below, ..small() };
    near(red(&texture, 0.25, 0.25), 0.4);
    assert_eq!(TextureTransform::default().affine(), Affine2::IDENTITY);
}

#[test]
fn sizes_that_do_not_fit_are_no_image() {
    assert!(Texels::new(2, 1, vec![0; 8]).is_some());
    for (width, height, bytes) in
        [(0, 0, 0), (0, 1, 0), (2, 1, 7), (2, 1, 9), (8193, 1, 4 * 8193), (u32::MAX, u32::MAX, 4)]
    {
        assert_eq!(Texels::new(width, height, vec![0; bytes]), None, "{width} x {height}");
    }
    assert_eq!(format!("{:?}", small().texels), "Texels(2 x 2)");
}

#[test]
fn a_transform_that_is_not_finite_is_a_problem() {
    assert_eq!(small().problem(), None);
    for rotation in [f32::NAN, f32::INFINITY] {
        let transform = TextureTransform { rotation, ..TextureTransform::IDENTITY };
        assert!(Texture { transform, ..small() }.problem().unwrap().contains("transform"));
    }
}

/// Every code comes back from its light, and light between two codes is the nearer one.
#[test]
fn texels_are_encoded_as_they_are_decoded() {
    for encoding in [Encoding::Srgb, Encoding::Linear] {
        for code in 0..=255u8 {
            let texel = [code, 255 - code, code / 2, code];
            assert_eq!(encoding.encoded(encoding.decoded(texel)), texel, "{encoding:?}");
        }
        assert_eq!(encoding.encoded(Vec4::new(-1.0, 2.0, f32::INFINITY, -0.0)), [0, 255, 255, 0]);
    }
}
